"""Errors of multipliers: an oscillator that strikes a stop once in some periods of its force, in closed form.

x'' + c x' + x = F cos(w t), x <= s, and x' -> -e x' at x = s (Shaw and Holmes 1983).  Between impacts the motion is a
forced one and a free one.  The map of a period has the derivative P S: the flow P of the free motion, and the jump S
of small perturbations at an impact of speed V, which grows as 1 / V next to grazing.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import FunctionLoad, LineBody, Point, Wall
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.orbits.branch import continuation
from nonsmooth.studies.orbits.linear import eigenvalues
from nonsmooth.studies.orbits.periodic import Orbit, orbit

needs_machine_code = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
Floats = NDArray[np.float64]
E = 0.8


def _push(t: float, a: Floats, b: Floats, out: Floats, force: float, omega: float, damping: float) -> None:
    out[0] = force * math.cos(omega * t) - b[0] - damping * b[12]
    out[1] = out[2] = 0.0
    for i in range(3):
        out[3 + i] = b[i]
        out[6 + i] = 0.0


def _oscillator(force: float, omega: float, stop: float, damping: float) -> ns.System:
    mass = LineBody(1.0, direction=(1.0, 0.0, 0.0), carried=(Point(),))
    wall = Wall(normal=(-1.0, 0.0, 0.0), point=(stop, 0.0, 0.0))
    system = ns.System([wall, mass], gravity=0.0)
    system.contact(wall, mass, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(E))
    system.load(FunctionLoad(_push, {"force": force, "omega": omega, "damping": damping}), wall, mass)
    system.place(mass, position=stop - 1e-3, velocity=-0.1)
    return system


def _closed(force: float, omega: float, stop: float, damping: float, n: int) -> tuple[float, float, Floats]:
    """Return time and speed of the impact of the orbit, and the derivative of its map."""
    period, z = 2.0 * math.pi * n / omega, 0.5 * damping
    own, gain = math.sqrt(1.0 - z * z), 1.0 / math.hypot(1.0 - omega**2, damping * omega)
    c, s = math.cos(own * period), math.sin(own * period)
    flow = math.exp(-z * period) * np.array([[c + z / own * s, s / own], [-s / own, c - z / own * s]])
    # the forced motion has position stop - k[0] V and velocity -k[1] V at the impact
    k = np.linalg.solve(np.eye(2) - flow, -E * flow[:, 1] - np.array([0.0, 1.0]))
    square, half, rest = k @ (k / [1.0, omega**2]), k[0] * stop, stop**2 - (force * gain) ** 2
    speed = (half + math.sqrt(half**2 - square * rest)) / square
    lag = math.atan2(damping * omega, 1.0 - omega**2)
    time = (math.atan2(k[1] * speed / omega, stop - k[0] * speed) + lag) / omega
    push = force * math.cos(omega * time) - stop
    kick = (push + damping * E * speed + E * (push - damping * speed)) / speed
    return time, speed, flow @ np.array([[-E, 0.0], [kick, -E]])


def _orbit(force: float, omega: float, stop: float, damping: float, n: int) -> Orbit:
    time, speed, _ = _closed(force, omega, stop, damping, n)
    values = {"force": force, "omega": omega, "stop": stop, "damping": damping}
    family, period = Family(_oscillator, values), 2.0 * math.pi / omega
    model = family.model()
    struck = ns.State.at(model.system, time % period, np.array([stop]), np.array([-E * speed]))
    return orbit(family, n * period, start=model.run(struck.time + 0.4 * n * period, start=struck).state)


@needs_machine_code
@pytest.mark.parametrize("force", [4.0, 2.0, 1.8, 1.75, 1.735])
def test_multipliers_are_right_within_their_errors(force: float) -> None:
    """The speed of the impact falls from 1.1 to 0.0027 m/s; the linear motion grazes at a force of 1.72976."""
    case = (force, 2.6, 0.3, 0.1, 1)
    found = _orbit(*case)
    expected = np.linalg.eigvals(_closed(*case)[2])
    expected = expected[np.argsort(-np.abs(expected))]
    off = np.abs(found.multipliers - expected)
    assert np.all(off <= found.multiplier_errors)
    assert off[0] <= 1e-6 * abs(expected[0])
    assert found.multiplier_errors[0] <= 1e-5 * abs(expected[0])
    assert "(+-" in str(found)


def _flip(omega: float, stop: float, damping: float, n: int, low: float, high: float) -> float:
    from scipy.optimize import brentq

    def left(force: float) -> float:
        return float(np.linalg.det(_closed(force, omega, stop, damping, n)[2] + np.eye(2)))

    return float(brentq(left, low, high, xtol=1e-14))


@needs_machine_code
@pytest.mark.slow
def test_steps_are_chosen_anew_along_a_branch() -> None:
    """The motion comes near to grazing along the branch, so that the steps of its first orbit are too large."""
    case = (4.2, 0.2, 0.05, 2)
    branch = continuation(_orbit(4.0, *case), "force", (3.5, 4.1))
    for value, one in zip(branch.values, branch.orbits, strict=True):
        error = 2.0 * np.max(one.map.error)
        off = abs(np.trace(one.monodromy) - np.trace(_closed(float(value), *case)[2]))
        assert off <= error <= 1e-5
    (special,) = branch.special
    assert special.kind == "period doubling"
    assert special.value == pytest.approx(_flip(*case, 3.5, 4.0), abs=1e-9)


@needs_machine_code
@pytest.mark.slow
@pytest.mark.parametrize("high", [2.0, 12.0])
def test_a_branch_ends_at_the_same_grazing_for_either_range(high: float) -> None:
    branch = continuation(_orbit(1.9, 2.6, 0.3, 0.1, 1), "force", (0.05, high), most=150)
    gain = 1.0 / math.hypot(1.0 - 2.6**2, 0.26)
    grazing = next(one for one in branch.special if one.kind == "grazing")
    assert grazing.value == pytest.approx(0.3 / gain, abs=1e-8)


def test_errors_of_eigenvalues_hold() -> None:
    """Also where two eigenvalues are the same, which an error of 1e-12 moves by 1e-6."""
    draw = np.random.default_rng(0)
    jordan = np.array([[0.5, 1.0], [0.0, 0.5]])
    for matrix in (jordan, np.diag([0.5, 0.5]), *draw.normal(size=(20, 2, 2)), *draw.normal(size=(20, 4, 4))):
        error = 1e-12 * np.ones_like(matrix)
        values, bounds = eigenvalues(matrix, error)
        for _ in range(20):
            moved = np.linalg.eigvals(matrix + error * draw.uniform(-1.0, 1.0, matrix.shape))
            apart = np.min(np.abs(values[:, None] - moved), axis=1)
            assert np.all(apart <= bounds + 1e-14)
    assert eigenvalues(jordan, 1e-12 * np.ones((2, 2)))[1].max() < 1e-5
