"""Bifurcation diagrams of the ball on a table."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Ball, Plate
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.progress import Display
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.orbits.diagram import Diagram, Hysteresis, bifurcation, hysteresis
from scenarios.bouncing_ball import BouncingBall, orbits

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of periods take minutes in plain mode")


def _ball(gamma: float) -> ns.System:
    """Start on the orbit of one period, but for a little, with the phase of the table that it has there."""
    phase = orbits.impact_phase(gamma, 0.8, 1)
    return BouncingBall(gamma=gamma, start_phase=phase, speed=9.81 / 50.0 + 1e-4).build()


def test_one_period_becomes_two() -> None:
    """On either side of the period doubling of the closed form, at 1.0708364682."""
    fold = math.pi / 9.0
    doubling = math.sqrt(fold**2 + 4.0 * 1.64**2 / 1.8**4)
    family, values = Family(_ball, {"gamma": 0.9}), [0.9, 1.05, 1.09]
    found = bifurcation(family, "gamma", values, 0.04, "vz", at=0.02, settle=600, keep=16)
    assert doubling == pytest.approx(1.0708364682, abs=1e-9)
    assert found.periods.tolist() == [1, 1, 2]
    assert found.failures == ("", "", "")
    assert found.points.shape == (3, 16)


def _dropped(restitution: float) -> ns.System:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(restitution))
    system.place(ball, position=(0.0, 0.0, 0.02))
    return system


class _Told(Display):
    patience = interval = 0.0

    def __init__(self) -> None:
        self.told: list[str] = []

    def show(self, share: float, before: str, behind: str) -> None:
        self.told.append(before)

    def close(self) -> None:
        pass


def test_it_is_counted_and_refused() -> None:
    display = _Told()
    family = Family(_dropped, {"restitution": 0.5})
    found = bifurcation(family, "restitution", [0.4, 0.5], 0.05, "z", settle=20, keep=4, display=display)
    assert display.told == ["1 of 2 runs", "2 of 2 runs"]
    np.testing.assert_allclose(found.points, 0.01, atol=1e-12)
    with pytest.raises(ns.InvalidInput, match=r"display must be of the kind Display, .*Quiet\(\)"):
        bifurcation(family, "restitution", [0.5], 0.05, "z", display=print)  # type: ignore[arg-type]
    with pytest.raises(ns.InvalidInput, match=r"ball\.vzz.*Did you mean 'ball\.vz'"):
        bifurcation(family, "restitution", [0.5], 0.05, "ball.vzz")
    with pytest.raises(ns.InvalidInput, match=r"at must be a time within a period, but it is 0\.06"):
        bifurcation(family, "restitution", [0.5], 0.05, "vz", at=0.06)
    with pytest.raises(ns.InvalidInput, match="keep must be positive"):
        bifurcation(family, "restitution", [0.5], 0.05, "vz", keep=0)
    with pytest.raises(ns.InvalidInput, match="Did you mean 'restitution'"):
        bifurcation(family, "restituton", [0.5], 0.05, "vz")


def test_what_stays_as_it_is_repeats() -> None:
    """A parameter without effect leaves one point, of which round-off is no range."""
    found = bifurcation(_dropped(0.5), "bodies.ball.start.u.5", [0.0, 1.0], 0.05, "z", settle=20, keep=8)
    assert found.periods.tolist() == [1, 1]
    with pytest.raises(ns.InvalidInput, match="must be some"):
        bifurcation(_dropped(0.5), "gravity", [], 0.05, "z")


def test_a_value_without_a_system_is_told_and_the_rest_goes_on() -> None:
    """The place of the ball is below the plate for the second; where no value makes a system there is no diagram."""
    asked: dict[str, Any] = {"settle": 5, "keep": 2}
    place = "bodies.ball.start.q.2"
    found = bifurcation(_dropped(0.5), place, [0.02, 0.005], 0.05, "z", **asked)
    assert found.failures[0] == ""
    assert "must not overlap" in found.failures[1]
    both = hysteresis(_dropped(0.5), place, [0.005, 0.02], 0.05, "z", **asked)
    assert [bool(text) for text in both.up.failures] == [True, False]
    with pytest.raises(ns.InvalidInput, match="must not overlap"):
        bifurcation(_dropped(0.5), place, [0.005, 0.006], 0.05, "z", **asked)


@pytest.mark.slow
def test_it_persists_where_a_fresh_start_rests() -> None:
    """The orbit of one period ends at the fold, pi / 9; below it, and on the way up from there, the ball rests.

    In flight its height halfway through a period of the table follows from where the table throws it off.
    """
    fold, rate = math.pi / 9.0, 50.0 * math.pi
    family = Family(lambda gamma: BouncingBall(gamma=gamma, start_phase=1.1, speed=0.19).build(), {"gamma": 0.3})
    values = np.array([0.3, 0.97 * fold, 1.03 * fold, 0.5, 0.7, 0.9])
    display = _Told()
    found = hysteresis(family, "gamma", values, 0.04, "z", at=0.02, settle=400, keep=8, display=display)
    assert found.up.failures == found.down.failures == 6 * ("",)
    assert found.apart.tolist() == [False, False, True, True, True, True]
    assert found.up.periods.tolist() == found.down.periods.tolist() == 6 * [1]
    amplitude = values * 9.81 / rate**2
    rests = 0.01 + amplitude * math.sin(0.02 * rate + 1.1)
    np.testing.assert_allclose(found.up.points[:, 0], rests, atol=1e-12)
    np.testing.assert_allclose(found.down.points[:2, 0], rests[:2], atol=1e-12)
    angle = np.arccos(fold / values[2:])
    late = np.mod(0.02 - (angle - 1.1) / rate, 0.04)
    flies = 0.01 + amplitude[2:] * np.sin(angle) + 0.5 * 9.81 * late * (0.04 - late)
    np.testing.assert_allclose(found.down.points[2:, 0], flies, atol=1e-8)
    assert display.told[-1] == "12 of 12 runs"


def test_a_run_that_failed_is_no_other_motion() -> None:
    values, rest, none = np.array([1.0, 2.0, 3.0]), np.zeros(8), np.full(8, np.nan)
    jumps = np.ones(8)

    def one(*rows: NDArray[np.float64]) -> Diagram:
        failures = tuple("it failed" if np.isnan(row).any() else "" for row in rows)
        return Diagram("gamma", "gamma", values, "vz", "m/s", np.array(rows), failures, 0.3)

    assert Hysteresis(one(rest, rest, none), one(rest, jumps, rest)).apart.tolist() == [False, True, False]
    nothing = one(none, none, none)
    assert nothing.periods.tolist() == [-1, -1, -1]
    assert not Hysteresis(nothing, nothing).apart.any()
