"""Diagrams over a frequency, and motions that still settle."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Harmonic, Plate, Spring
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.orbits.branch import continuation
from nonsmooth.studies.orbits.diagram import bifurcation, hysteresis
from nonsmooth.studies.orbits.exponents import lyapunov
from nonsmooth.studies.orbits.periodic import orbit
from nonsmooth.studies.orbits.scan import check_period
from nonsmooth.studies.periods import settling
from scenarios.bouncing_ball import BouncingBall

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of periods take minutes in plain mode")


def _shaken(frequency: float, damping: float = 4.0) -> ns.System:
    """Return a ball below a plate that vibrates, on a spring."""
    top, ball = Plate(Harmonic(0.01, frequency)), Ball(0.01)
    system = ns.System([top, ball], gravity=0.0)
    system.exclude(top, ball)
    mass = ball.total_mass
    system.load(Spring(mass * 400.0, 0.3, mass * damping, first=(0.0, 0.0, 0.0)), top, ball)
    system.place(ball, position=(0.0, 0.0, -0.3))
    return system


def test_a_period_must_be_that_of_each_frequency() -> None:
    """A fixed period fits one value only; a function of the value fits all."""
    family = Family(_shaken, {"frequency": 5.0})
    fixed = bifurcation(family, "frequency", [4.0, 5.0], 0.2, "z", settle=60, keep=8)
    assert "must be one of the system" in fixed.failures[0]
    assert "period=lambda" in fixed.failures[0]
    assert fixed.failures[1] == ""
    found = bifurcation(family, "frequency", [4.0, 5.0], lambda f: 1.0 / f, "z", settle=60, keep=8)
    assert found.failures == ("", "")
    assert found.periods.tolist() == [1, 1]
    both = hysteresis(family, "frequency", [4.0, 5.0], lambda f: 1.0 / f, "z", settle=60, keep=8)
    np.testing.assert_allclose(both.up.points, found.points, atol=1e-9)
    np.testing.assert_allclose(both.down.points, found.points, atol=1e-9)
    with pytest.raises(ns.InvalidInput, match="must be one of the system"):
        bifurcation(family, "frequency", [4.0, 4.5], 0.2, "z", settle=60, keep=8)


def test_lyapunov_exponents_need_no_period_of_the_drive() -> None:
    """Their sum is the damping over the mass, after whatever times the directions are made orthogonal."""
    for period in (0.2, 0.13):
        found = lyapunov(_shaken(5.0, damping=3.0), period, 6, settle=1.0, within=("z", "vz"))
        assert np.sum(found.exponents) == pytest.approx(-3.0, abs=1e-6)


def test_a_diagram_says_which_motions_still_settle() -> None:
    family = Family(_shaken, {"frequency": 5.0, "damping": 4.0})
    found = bifurcation(family, "damping", [0.6, 4.0], 0.2, "z", settle=60, keep=32)
    assert found.settling.tolist() == [True, False]


@pytest.mark.parametrize("multiplier", [0.9, -0.9, 0.99, -0.99])
def test_a_geometric_approach_is_settling_until_it_is_over(multiplier: float) -> None:
    looks = np.arange(64)
    approach = multiplier**looks
    points = np.array([approach, 1e-12 * approach, np.cos(math.sqrt(2.0) * looks), np.tile([0.0, 1.0], 32)])
    assert settling(points[:, :, np.newaxis], 1e-5).tolist() == [True, False, False, False]


def test_a_function_must_return_a_period() -> None:
    family = Family(_shaken, {"frequency": 5.0})
    with pytest.raises(ns.InvalidInput, match="bifurcation: period must be positive and finite at the value 5"):
        bifurcation(family, "frequency", [4.0, 5.0], lambda f: -1.0 / f, "z")
    with pytest.raises(ns.InvalidInput, match="hysteresis: period must be positive and finite at the value 5"):
        hysteresis(family, "frequency", [4.0, 5.0], lambda f: math.nan, "z")
    with pytest.raises(ns.InvalidInput, match="hysteresis: settle must be positive and a whole number"):
        hysteresis(family, "frequency", [4.0, 5.0], 0.2, "z", settle=1.5)  # type: ignore[arg-type]
    found = orbit(family, 0.2, settle=2.0, within=("z", "vz"))
    with pytest.raises(ns.InvalidInput, match=r"continuation: period must be a function, called as period\(value\)"):
        continuation(found, "frequency", (4.9, 5.1), period=0.2)  # type: ignore[arg-type]
    with pytest.raises(ns.InvalidInput, match=r"continuation: period must be positive and finite at the value 4\.9"):
        continuation(found, "frequency", (4.9, 5.1), period=lambda f: 5.0 - f - 0.1)


@pytest.mark.parametrize("speed", [0.1, 0.2])
def test_a_flight_over_periods_does_not_hide_that_the_drive_has_another_one(speed: float) -> None:
    """Balls between impacts move in the same way whenever they begin."""
    ball = BouncingBall(gamma=0.8, start_phase=1.0, speed=speed)
    model = ns.assemble(dataclasses.replace(ball, frequency=24.0).build())
    state = model.run(3.0).state
    check_period(model, state, 1.0 / 24.0, "period")
    check_period(model, state, 2.0 / 24.0, "period")
    with pytest.raises(ns.InvalidInput, match="period must be one of the system, where the same motion a period later"):
        check_period(model, state, 0.04, "period")
