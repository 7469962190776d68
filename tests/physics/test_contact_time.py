"""Islands slower than a contact time of their accelerations makes them: they close in place of colliding."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate, Rest
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.memory.modes import Cause

G, RADIUS, TIME = 9.81, 0.01, 1e-3
HALF = math.pi / 8.0


def _groove(down: float, along: float = 0.0, friction: float = 0.3) -> ns.System:
    """Put a ball into a rectangular groove along y, touching both sides, with a velocity down and one along it."""
    sides = [Plate(Rest(orientation=(math.cos(HALF), 0.0, sign * math.sin(HALF), 0.0))) for sign in (1.0, -1.0)]
    ball = Ball(RADIUS)
    system = ns.System([*sides, ball], G)
    for side in sides:
        law = EnergeticImpact(0.5, duration=TIME)
        system.contact(side, ball, normal=Unilateral(), friction=Coulomb(friction), impact=law)
    system.place(ball, position=(0.0, 0.0, math.sqrt(2.0) * RADIUS), velocity=(0.0, along, -down))
    return system


@pytest.mark.parametrize("part", [0.01, 0.5, 0.99])
def test_what_is_slower_closes(part: float) -> None:
    """Down by less than g T_c: no impact, no bounce, and the energy is lost to the closing."""
    down = part * G * TIME
    solution = ns.simulate(_groove(down), 0.1)
    assert Cause.IMPACT not in solution.events.cause
    assert np.max(np.abs(solution.u_end)) < 1e-9
    account = solution.energy
    mass = 2.0 * account.kinetic_start / down**2
    assert account.closing_loss == pytest.approx(0.5 * mass * down**2, rel=1e-9)


@pytest.mark.parametrize("part", [1.01, 3.0])
def test_what_is_faster_collides(part: float) -> None:
    """Down by more than g T_c: an impact first; the bounces behind it close."""
    solution = ns.simulate(_groove(part * G * TIME), 0.1)
    assert Cause.IMPACT in solution.events.cause[:2]
    assert Cause.CLOSING in solution.events.cause
    assert np.max(np.abs(solution.u_end)) < 1e-9


def test_a_closing_rubs_as_an_inelastic_impact_does() -> None:
    """A slip along the groove loses the friction of the impulses that stop the ball, sqrt(2) m w in both sides."""
    along, down = 0.3, 0.5 * G * TIME
    solution = ns.simulate(_groove(down, along), 1e-6)
    slowing = 0.3 * math.sqrt(2.0)
    assert solution.events.causes()[0] == "closing of an accumulation"
    assert solution.u_end[1] == pytest.approx(along - slowing * (down + G * 1e-6), abs=1e-9)
    assert abs(solution.u_end[2]) < 1e-9


@pytest.mark.parametrize("part", [0.1, 0.5])
def test_what_does_not_press_is_let_go(part: float) -> None:
    """A ball that sinks onto the floor and leaves the wall that it touches: the floor closes, the wall does not."""
    floor, wall, ball = Plate(), Plate(Rest(orientation=(math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0))), Ball(RADIUS)
    system = ns.System([floor, wall, ball], G)
    for side in (floor, wall):
        law = EnergeticImpact(0.5, duration=TIME)
        system.contact(side, ball, normal=Unilateral(), friction=Frictionless(), impact=law)
    leaving = part * G * TIME
    system.place(ball, position=(RADIUS, 0.0, RADIUS), velocity=(leaving, 0.0, -0.5 * G * TIME))
    solution = ns.simulate(system, 1e-2)
    assert Cause.IMPACT not in solution.events.cause
    assert solution.u_end[0] == pytest.approx(leaving, rel=1e-12)
    assert abs(solution.u_end[2]) < 1e-12


def test_what_rises_fast_beside_a_slow_approach_goes_on() -> None:
    """A ball that rises fast from one side, and hardly approaches the other: that stops, and pulls nothing back."""
    rising = 0.1 / math.sqrt(2.0)
    system = _groove(0.0, friction=0.0)
    ball = system.bodies[2]
    system.place(ball, position=(0.0, 0.0, math.sqrt(2.0) * RADIUS), velocity=(rising, 0.0, rising - 1e-3))
    solution = ns.simulate(system, 1e-4)
    assert Cause.IMPACT not in solution.events.cause
    x, _, z = solution.events.u_after[0][:3]
    c = math.sqrt(0.5)
    assert c * (x + z) == pytest.approx(c * (2.0 * rising - 1e-3), rel=1e-12)
    assert abs(c * (z - x)) < 1e-12
    assert solution.energy.residual < 1e-9
