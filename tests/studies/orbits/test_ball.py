"""A ball on a vibrating table, of which all is known in closed form.

Orbits whose flights take a period: the phase theta of impacts has Gamma cos(theta) = pi (1 - e) / (1 + e); of the map
the determinant is e^2 and the trace 1 + e^2 - (1 + e)^2 Gamma sin(theta).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.orbits.branch import continuation
from nonsmooth.studies.orbits.exponents import lyapunov
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit, orbit
from scenarios.bouncing_ball import BouncingBall

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
E = 0.8
FOLD = math.pi * (1.0 - E) / (1.0 + E)
DOUBLING = math.sqrt(FOLD**2 + 4.0 * (1.0 + E**2) ** 2 / (1.0 + E) ** 4)


def _orbit(gamma: float, **given: float) -> Orbit:
    known = BouncingBall(gamma=gamma, restitution=E)
    start = known.resolved()
    # a table whose phase does not move with gamma
    scenario = BouncingBall(
        gamma=gamma, restitution=E, start_phase=start["start_phase"], speed=start["speed"] + given.get("off", 0.0)
    )
    return orbit(scenario, scenario.period, within=("z", "vz"))


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("gamma", [0.4, 0.8, 1.05, 1.1])
def test_multipliers(gamma: float) -> None:
    """From a start that is off by some millimetres a second; beyond the period doubling the orbit is unstable."""
    found = _orbit(gamma, off=2e-3)
    trace = 1.0 + E**2 - (1.0 + E) ** 2 * gamma * math.sin(math.acos(FOLD / gamma))
    assert found.residual < 1e-12
    assert np.linalg.det(found.monodromy) == pytest.approx(E**2, abs=1e-10)
    assert np.trace(found.monodromy) == pytest.approx(trace, abs=1e-9)
    assert found.stable is (gamma < DOUBLING)
    assert "impact of 'plate - ball'" in str(found)


@pytest.mark.slow
def test_fold_and_period_doubling() -> None:
    """Followed both ways: down round the fold, where the orbit turns into the unstable one, and up."""
    below = continuation(_orbit(0.37), "gamma", (0.3, 0.38))
    (fold,) = below.special
    assert fold.kind == "fold"
    assert fold.value == pytest.approx(FOLD, abs=1e-9)
    assert np.min(below.values) >= FOLD - 1e-9
    turns = np.flatnonzero(np.diff(np.sign(np.diff(below.values))))
    assert len(turns) == 1
    assert not below.orbits[0].stable
    assert below.orbits[-1].stable
    above = continuation(_orbit(1.06), "gamma", (1.05, 1.08))
    (doubling,) = above.special
    assert doubling.kind == "period doubling"
    assert doubling.value == pytest.approx(DOUBLING, abs=1e-9)
    assert np.min(np.abs(doubling.orbit.multipliers + 1.0)) < 1e-8


@pytest.mark.slow
def test_a_period_that_the_system_has_not_is_refused() -> None:
    found = _orbit(0.8)
    with pytest.raises(ns.InvalidInput, match=r"period must be one of the system at frequency = 24, .*period=lambda"):
        continuation(found, "frequency", (24.0, 26.0))
    branch = continuation(found, "frequency", (24.99, 25.01), period=lambda frequency: 1.0 / frequency)
    assert branch.ending == "the end of the range; the end of the range"
    assert branch.orbits[0].period == pytest.approx(1.0 / branch.values[0], rel=1e-12)


@pytest.mark.slow
def test_a_branch_goes_where_the_start_of_its_system_would_not() -> None:
    """A ball that is placed on the table, and would be within a larger one."""
    radius = "bodies.ball.radius"
    found = orbit(BouncingBall(gamma=0.8, restitution=E).build(), 0.04, settle=0.5, within=("z", "vz"))
    branch = continuation(found, radius, (0.0099, 0.0101))
    assert branch.ending == "the end of the range; the end of the range"
    trace = [np.trace(one.monodromy) for one in branch.orbits]
    np.testing.assert_allclose(trace, trace[0], atol=1e-8)


@pytest.mark.slow
def test_a_start_that_follows_the_parameter_ends_the_branch() -> None:
    """The phase of the table, by default that of the orbit, has no derivative at the fold; no event changes there."""
    found = orbit(BouncingBall(gamma=0.36, restitution=E), 0.04, within=("z", "vz"))
    branch = continuation(found, "gamma", (0.3, 0.361))
    assert branch.ending.startswith("no orbit farther on (")
    assert "sequence" not in [one.kind for one in branch.special]


@pytest.mark.slow
def test_lyapunov_exponents() -> None:
    """Of a spiralling orbit both are f ln e, in the mean over a turn; of chaos one is positive."""
    scenario = BouncingBall(gamma=0.8, restitution=E)
    found = lyapunov(scenario, scenario.period, 20, within=("z", "vz"))
    assert np.mean(found.exponents) == pytest.approx(25.0 * math.log(E), rel=1e-9)
    np.testing.assert_allclose(found.exponents, 25.0 * math.log(E), rtol=5e-3)
    wild = BouncingBall(gamma=2.2, restitution=E, start_phase=1.0, speed=0.3)
    chaos = lyapunov(wild, wild.period, 40, settle=1.0, within=("z", "vz"))
    assert chaos.left_out == 0
    assert chaos.exponents[0] > 5.0 > -5.0 > chaos.exponents[1]


def _turning(x: float, y: float, z: float) -> ns.System:
    """Return a ball that turns so often about its axes in a period."""
    system = BouncingBall(gamma=0.8, restitution=E).build()
    ball = system.bodies[1]
    q, u = system.start(ball)
    system.set_start(ball, q, np.concatenate([u[:3], 2.0 * math.pi * 25.0 * np.array([x, y, z])]))
    return system


@pytest.mark.slow
def test_lyapunov_exponents_of_a_ball_that_turns() -> None:
    """What it is turned by neither grows nor shrinks, in axes that turn with it."""
    found = lyapunov(Family(_turning, {"x": 0.1, "y": 0.3, "z": 0.0}), 0.04, 10, within=("z", "vz", "rx", "ry", "rz"))
    np.testing.assert_allclose(found.exponents[:3], 0.0, atol=1e-9)
    assert np.mean(found.exponents[3:]) == pytest.approx(25.0 * math.log(E), rel=1e-8)


@pytest.mark.slow
def test_a_whole_turn_leads_to_the_same_orientation() -> None:
    """Of whose two quaternions a period ends with the other one."""
    found = orbit(Family(_turning, {"x": 0.0, "y": 1.0, "z": 0.0}), 0.04, within=("z", "vz", "rx", "ry", "rz"))
    assert found.residual < 1e-12
    np.testing.assert_allclose(np.abs(found.multipliers), [1.0, 1.0, 1.0, E, E], atol=1e-8)
    with pytest.raises(NoOrbit):
        orbit(Family(_turning, {"x": 0.0, "y": 0.9, "z": 0.0}), 0.04, within=("z", "vz", "rx", "ry", "rz"))


@pytest.mark.slow
def test_what_is_no_orbit() -> None:
    scenario = BouncingBall(gamma=0.8)
    with pytest.raises(ns.InvalidInput, match="period must be positive and finite, but it is 0"):
        orbit(scenario, 0.0)
    with pytest.raises(ns.InvalidInput, match=r"'ball\.zz'.*Did you mean 'ball\.z'"):
        orbit(scenario, scenario.period, within=("ball.zz",))
    with pytest.raises(ns.InvalidInput, match="must be one of the system, but after a second one"):
        orbit(scenario, 0.0311, within=("z", "vz"))
    # beyond the fold there is none
    with pytest.raises(NoOrbit, match="meet at a fold"):
        orbit(BouncingBall(gamma=0.3, start_phase=0.1, speed=0.19), 0.04, within=("z", "vz"))
    found = orbit(scenario, scenario.period, within=("z", "vz"))
    with pytest.raises(ns.InvalidInput, match=r"around the value of the orbit.*gamma = 0\.8"):
        continuation(found, "gamma", (0.9, 1.0))
    with pytest.raises(ns.InvalidInput, match="Did you mean 'gamma'"):
        continuation(found, "gama", (0.7, 1.0))
