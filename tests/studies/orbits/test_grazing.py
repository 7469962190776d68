"""Where branches end as events change: grazing and two impacts at once, in closed form.

A ball on a spring whose other end vibrates grazes the floor where its amplitude is its clearance, whether it passes
over the floor or strikes it once a period: with the speed v of the impact given, the motion between two impacts follows
from linear equations.  Two balls on one table strike it where cos(theta) = pi (1 - e) / ((1 + e) Gamma), each with its
own e, and at once where these are equal.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Ball, Harmonic, Plate, Rest, Spring
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.orbits.branch import continuation
from nonsmooth.studies.orbits.periodic import Orbit, orbit

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
Floats = NDArray[np.float64]
RADIUS, E = 0.01, 0.8
OWN, DAMPING, FREQUENCY, CLEARANCE, LENGTH = 20.0, 0.05, 8.0, 0.01, 0.3
RATE, PERIOD = 2.0 * math.pi * FREQUENCY, 1.0 / FREQUENCY
GAIN = complex(OWN**2, 2.0 * DAMPING * OWN * RATE) / complex(OWN**2 - RATE**2, 2.0 * DAMPING * OWN * RATE)
WITHIN = ("z", "vz")


def _on_a_spring(amplitude: float) -> ns.System:
    floor, top, ball = Plate(Rest()), Plate(Harmonic(amplitude, FREQUENCY)), Ball(RADIUS)
    system = ns.System([floor, top, ball], gravity=0.0)
    system.contact(floor, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(E))
    system.exclude(top, ball)
    end = (0.0, 0.0, RADIUS + CLEARANCE + LENGTH)
    mass = ball.total_mass
    system.load(Spring(mass * OWN**2, LENGTH, 2.0 * DAMPING * mass * OWN, first=end), top, ball)
    # as it moves where it never strikes the floor
    height, speed = RADIUS + CLEARANCE + amplitude * GAIN.imag, RATE * amplitude * GAIN.real
    system.place(ball, position=(0.0, 0.0, max(height, RADIUS)), velocity=(0.0, 0.0, speed))
    return system


def _free(t: float) -> Floats:
    """Return position and velocity of free motions and of forced ones, shape [2, 4]."""
    turn = complex(-DAMPING * OWN, OWN * math.sqrt(1.0 - DAMPING**2))
    own, forced = np.exp(turn * t), np.exp(1j * RATE * t)
    rates = turn * own, 1j * RATE * forced
    return np.array([[own.real, own.imag, forced.real, forced.imag], [x for r in rates for x in (r.real, r.imag)]])


def _between_impacts(speed: float) -> Floats:
    """Return how much of each motion there is from an impact of this speed to the next one, shape [4]."""
    rows = np.concatenate([_free(0.0), _free(PERIOD)])
    return np.linalg.solve(rows, [-CLEARANCE, E * speed, -CLEARANCE, -speed])


def _amplitude(speed: float) -> float:
    """Return the amplitude of the spring's end of an orbit with one impact, of this speed."""
    return float(np.hypot(*_between_impacts(speed)[2:]) / abs(GAIN))


def _striking(speed: float) -> Orbit:
    """Return the orbit with one impact of about this speed, begun half a period behind it."""
    shares = _between_impacts(speed)
    family = Family(_on_a_spring, {"amplitude": _amplitude(speed)})
    # the response to sin(w t) is gain e^(i w t), of which the real part of c - i s is turned by the time of the impact
    turned = np.angle(1j * complex(shares[2], -shares[3]) / GAIN) / RATE
    way, rate = _free(PERIOD / 2.0) @ shares
    system = family.model().system
    q, u = (x.copy() for x in system.starts())
    q[2], u[2] = RADIUS + CLEARANCE + way, rate
    start = ns.State.at(system, turned + PERIOD / 2.0, q, u)
    return orbit(family, PERIOD, start=start, within=WITHIN)


@pytest.mark.slow
def test_a_missed_contact_is_grazed() -> None:
    grazes = CLEARANCE / abs(GAIN)
    found = orbit(Family(_on_a_spring, {"amplitude": 0.99 * grazes}), PERIOD, within=WITHIN)
    branch = continuation(found, "amplitude", (0.98 * grazes, 1.1 * grazes))
    (special,) = branch.special
    assert special.kind == "grazing"
    assert special.value == pytest.approx(grazes, abs=1e-8 * grazes)
    for value, left in zip(branch.values, branch.grazing_distances, strict=True):
        assert left.gap == pytest.approx(CLEARANCE - value * abs(GAIN), abs=1e-12)


@pytest.mark.slow
def test_an_impact_ends_by_grazing() -> None:
    """Its speed is that of the closed form all along, and 0 where the branch ends."""
    grazes = CLEARANCE / abs(GAIN)
    found = _striking(0.005)
    assert found.residual < 1e-12
    branch = continuation(found, "amplitude", (0.999 * grazes, 1.009 * grazes))
    special = next(one for one in branch.special if one.kind == "grazing")
    assert special.value == pytest.approx(grazes, abs=1e-8 * grazes)
    for value, left in zip(branch.values, branch.grazing_distances, strict=True):
        assert value == pytest.approx(_amplitude(left.approach), rel=1e-9)


def _two_balls(restitution: float) -> ns.System:
    gamma, frequency = 0.8, 25.0
    rate = 2.0 * math.pi * frequency
    table = Plate(Harmonic(gamma * 9.81 / rate**2, frequency))
    balls = [Ball(RADIUS), Ball(RADIUS)]
    system = ns.System([table, *balls])
    for i, (ball, e) in enumerate(zip(balls, (E, restitution), strict=True)):
        system.contact(table, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(e))
        # in the middle of a flight from where the table throws it off
        angle = math.acos(math.pi * (1.0 - e) / ((1.0 + e) * gamma))
        height = RADIUS + gamma * 9.81 / rate**2 * math.sin(angle) + 9.81 / frequency**2 / 8.0
        late = 0.5 - angle / (2.0 * math.pi)
        system.place(
            ball,
            position=(0.1 * i, 0.0, height - 0.5 * 9.81 * (late / frequency) ** 2),
            velocity=(0.0, 0.0, 9.81 * late / frequency),
        )
    return system


@pytest.mark.slow
def test_two_impacts_at_once_are_a_corner() -> None:
    found = orbit(Family(_two_balls, {"restitution": 0.79}), 0.04, within=WITHIN)
    branch = continuation(found, "restitution", (0.78, 0.82))
    (special,) = branch.special
    assert special.kind == "simultaneous impacts"
    assert special.value == pytest.approx(E, abs=1e-8)
    for value, left in zip(branch.values, branch.grazing_distances, strict=True):
        angles = [math.acos(math.pi * (1.0 - e) / ((1.0 + e) * 0.8)) for e in (E, value)]
        assert left.between_impacts == pytest.approx(abs(angles[1] - angles[0]) * 0.04 / (2.0 * math.pi), abs=1e-10)
