"""Orbits with a contact that is closed all the time: a ball on a plate that vibrates sideways, in closed form.

Friction mu changes its slip by 7/2 mu g, which the plate exceeds K times.  From K = sqrt(1 + pi^2 / 4) on the slip only
turns round, where cos(theta) = pi / (2 K), and a perturbation of it shrinks by (K sin(theta) - 1) / (K sin(theta) + 1)
each time.  Below K = 1 the ball rolls, with 2/7 of the plate's velocity.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Harmonic, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.orbits.branch import continuation
from nonsmooth.studies.orbits.exponents import lyapunov
from nonsmooth.studies.orbits.periodic import Orbit, orbit
from scenarios.bouncing_ball import BouncingBall
from scenarios.dumbbell import DumbbellScenario

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
RADIUS, FRICTION, FREQUENCY = 0.01, 0.1, 10.0
PERIOD, RATE = 1.0 / FREQUENCY, 2.0 * math.pi * FREQUENCY
SLOWS = 3.5 * FRICTION * 9.81


def _shaken(ratio: float) -> ns.System:
    way = Harmonic(ratio * SLOWS / RATE**2, FREQUENCY, axis_x=1.0, axis_z=0.0)
    plate, ball = Plate(way), Ball(RADIUS)
    system = ns.System([plate, ball])
    law = EnergeticImpact(0.5)
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(FRICTION), impact=law)
    system.place(ball, position=(0.0, 0.0, RADIUS))
    return system


def _slips(ratio: float, settle: float = 0.3) -> Orbit:
    return orbit(Family(_shaken, {"ratio": ratio}), PERIOD, settle=settle, within=("vx", "wy"))


def _plate(ratio: float, time: float) -> float:
    return ratio * SLOWS / RATE * math.cos(RATE * time)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [2.0, 3.0])
def test_a_ball_that_slips_to_and_fro(ratio: float) -> None:
    """The other multiplier is 1: nothing changes the angular momentum about the contact."""
    found = _slips(ratio)
    angle = math.acos(math.pi / (2.0 * ratio))
    each = (ratio * math.sin(angle) - 1.0) / (ratio * math.sin(angle) + 1.0)
    np.testing.assert_allclose(found.multipliers, [1.0, each**2], atol=1e-9)
    history = lyapunov(Family(_shaken, {"ratio": ratio}), PERIOD, 12, settle=1.0, within=("vx", "wy")).history
    # of the last period alone: in the first ones directions have not yet turned to where they stay
    np.testing.assert_allclose(12 * history[11] - 11 * history[10], [0.0, 2.0 * math.log(each) / PERIOD], atol=1e-5)
    # the slip that friction brought about since it turned round last
    time, turned = found.state.time, angle / RATE - PERIOD / 2.0
    turns = math.floor((time - turned) / (PERIOD / 2.0))
    last, sign = turned + turns * PERIOD / 2.0, (-1.0) ** turns
    expected = _plate(ratio, last) + sign * SLOWS * (time - last) - _plate(ratio, time)
    x, spin = found.state.u[0], found.state.u[4]
    assert x - RADIUS * spin - _plate(ratio, time) == pytest.approx(expected, abs=1e-10)


def test_a_ball_that_rolls() -> None:
    """What sticks leaves one direction of two, along which nothing happens."""
    found = _slips(0.8)
    assert found.state.modes.tolist() == [1]
    assert len(found.map.chart.names) == 1
    assert found.multipliers == pytest.approx([1.0], abs=1e-9)
    end = found.family.model().run(found.state.time + PERIOD / 3.0, start=found.state).state
    change = _plate(0.8, end.time) - _plate(0.8, found.state.time)
    assert end.u[0] - found.state.u[0] == pytest.approx(2.0 / 7.0 * change, abs=1e-11)


@pytest.mark.slow
def test_the_dumbbell_drifts_alike_whatever_the_section() -> None:
    """Where a ball is on the plate tilt, its rate and the drift are left; in flight two multipliers are 0."""
    scenario = DumbbellScenario(mode="drift")
    within = ("z", "ry", "vy", "vz", "wy")
    closed, free = (orbit(scenario, 0.04, at=at, settle=1.0, within=within) for at in (0.024, 0.008))
    assert closed.state.modes.tolist() == [2, 0]
    assert closed.map.chart.names == ("dumbbell.vy", "dumbbell.wy", "dumbbell.ry")
    np.testing.assert_allclose(closed.multipliers, free.multipliers[:3], atol=1e-7)


@pytest.mark.slow
def test_drift_is_followed_with_a_ball_on_the_plate() -> None:
    """The plate's height differs with its amplitude, and what lies on it goes with it."""
    scenario = DumbbellScenario(mode="drift")
    within = ("z", "ry", "vy", "vz", "wy")
    branch = continuation(orbit(scenario, 0.04, at=0.024, settle=1.0, within=within), "gamma", (0.8, 1.0), most=3)
    assert [one.residual < 1e-11 for one in branch.orbits] == 7 * [True]
    last = branch.orbits[-1]
    alone = orbit(last.family, 0.04, at=0.008, settle=1.0, within=within)
    assert last.family["gamma"] > scenario.gamma
    np.testing.assert_allclose(last.multipliers, alone.multipliers[:3], atol=1e-7)


def test_a_ball_at_rest_is_an_orbit() -> None:
    """Nothing is left that could be perturbed."""
    found = orbit(BouncingBall(gamma=0.5, height=1e-4, restitution=0.1), 0.04, settle=2.0, within=("z", "vz"))
    assert found.map.chart.names == ()
    assert found.multipliers.tolist() == []
    assert found.residual == 0.0
