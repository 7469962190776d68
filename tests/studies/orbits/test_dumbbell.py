"""Orbits of the dumbbell: drift, flutter without friction, the level jump."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import nonsmooth as ns
from bodies import Dumbbell
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.orbits.branch import continuation
from nonsmooth.studies.orbits.periodic import Orbit, orbit
from scenarios.dumbbell import DumbbellScenario

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
PLANE = ("z", "ry", "vz", "wy")


def _flutter(restitution: float) -> Orbit:
    scenario = DumbbellScenario(mode="flutter", friction=0.0, static_friction=0.0, restitution=restitution)
    return orbit(scenario, 2.0 / scenario.frequency, settle=2.0, within=PLANE)


@pytest.mark.slow
def test_drift_repeats_but_for_where_it_is() -> None:
    """With a contact that closes in each period two multipliers are 0; the others were found by other differences."""
    scenario = DumbbellScenario(mode="drift")
    found = orbit(scenario, 1.0 / scenario.frequency, settle=1.0, within=(*PLANE, "vy"))
    assert found.residual < 1e-12
    expected = [0.01100430 + 0.61326691j, 0.01100430 - 0.61326691j, 0.12076659, 0.0, 0.0]
    np.testing.assert_allclose(found.multipliers, expected, atol=1e-7)
    assert found.stable


def test_flutter_loses_energy_in_impacts_only() -> None:
    """An impact of each ball in two periods, each of which shrinks volume by e^2."""
    found = _flutter(0.8)
    assert found.residual < 1e-10
    assert np.prod(found.multipliers) == pytest.approx(0.8**4, abs=1e-9)


@pytest.mark.slow
def test_flutter_ends_where_the_plate_moves_fastest() -> None:
    """cos(theta) = (pi / Gamma) S (1 - e) / (1 + e) must not be more than 1, S = 1 + (a / k)^2 cos^2(beta).

    The balls strike at the tilt of beta / cos(beta) = g T^2 a / (4 k^2).
    """
    scenario = DumbbellScenario(mode="flutter")
    dumbbell = scenario.build().bodies[1]
    assert isinstance(dumbbell, Dumbbell)
    half, square = 0.5 * dumbbell.centre_distance, dumbbell.inertia[1] / dumbbell.total_mass
    rate = 9.81 * half / (4.0 * square * scenario.frequency**2)
    beta = brentq(lambda x: x - rate * math.cos(x), 0.0, 1.5, xtol=1e-15)
    swing = 1.0 + half**2 / square * math.cos(beta) ** 2
    bound = brentq(lambda e: math.pi / scenario.gamma * swing * (1.0 - e) / (1.0 + e) - 1.0, 0.1, 0.99, xtol=1e-15)
    branch = continuation(_flutter(0.7625), "restitution", (0.75, 0.765))
    (fold,) = (one for one in branch.special if one.kind == "fold")
    assert fold.value == pytest.approx(bound, abs=1e-8)
    assert round(bound, 6) == 0.757368


@pytest.mark.slow
def test_the_level_jump_is_a_corner() -> None:
    """Both balls strike at once: a tilt decides which one is first, so there are two maps and no derivative."""
    scenario = DumbbellScenario(mode="jump")
    found = orbit(scenario, 1.0 / scenario.frequency, settle=3.0, within=PLANE)
    assert {corner.direction for corner in found.non_differentiable} == {"dumbbell.ry", "dumbbell.wy"}
    assert found.smooth == ("dumbbell.z", "dumbbell.vz")
    np.testing.assert_allclose(np.abs(found.multipliers), 0.65, atol=1e-9)
    for corner in found.non_differentiable:
        # what a tilt does to the height is the same on either side, so it has a kink
        np.testing.assert_allclose(corner.before[:2], -corner.after[:2], atol=1e-5)
        assert np.max(np.abs(corner.after[:2])) > 1e-3
        assert sorted(corner.signatures[0]) == sorted(corner.signatures[1])
        assert corner.signatures[0] != corner.signatures[1]
    assert not found.stable
    with pytest.raises(ns.InvalidInput, match="must have a derivative"):
        continuation(found, "gamma", (0.8, 1.0))
