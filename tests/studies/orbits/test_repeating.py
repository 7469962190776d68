"""Diagrams over a frequency, and motions that still settle."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Harmonic, Plate, Spring
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.orbits.diagram import bifurcation
from nonsmooth.studies.orbits.hysteresis import hysteresis
from nonsmooth.studies.periods import settling

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
