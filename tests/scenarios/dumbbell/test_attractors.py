"""The modes of the paper, their numbers, and closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from nonsmooth.solution.modes import mode_shares
from tests.benchmarks.compliant import drift

ONE_DEGREE = math.radians(1.0)
REFERENCE = {
    "radius": 5e-3,
    "rod_mass_fraction": 0.0,
    "aspect_ratio": 3.9,
    "restitution": 0.6,
    "friction": 0.15,
    "t_end": 8.0,
}
Runner = Callable[..., Any]


@pytest.mark.slow
def test_reference_drift_has_the_velocity_of_the_compliant_limit(dumbbell: Runner) -> None:
    """That of an integration through every contact on stiff springs, without an impact law and without events."""
    on_springs, _ = drift(2e-5, 100, 4.0)
    found = dumbbell(**REFERENCE).summary
    assert (found["attractor"], found["period"]) == ("drift", 1)
    assert found["drift_velocity"][0] == pytest.approx(0.0, abs=1e-12)
    assert found["drift_velocity"][1] == pytest.approx(on_springs, abs=0.15e-3)


def test_newton_restitution_reverses_the_drift(dumbbell: Runner) -> None:
    """With the velocity that time-stepping engines with Newton's restitution converge to."""
    found = dumbbell(**REFERENCE, impact="newton").summary
    assert (found["attractor"], found["period"]) == ("drift", 1)
    assert found["drift_velocity"][1] == pytest.approx(-10.6e-3, abs=0.15e-3)


@pytest.mark.parametrize("across", [0.0, 1.0])
@pytest.mark.parametrize(
    ("start", "period"),
    [
        ({"mode": "drift"}, 1),
        ({"mode": "jump"}, 1),
        ({"mode": "jump", "beta0": ONE_DEGREE}, 1),
        ({"mode": "flutter"}, 2),
    ],
)
def test_nominal_starts_reach_their_modes(dumbbell: Runner, start: dict[str, Any], period: int, across: float) -> None:
    found = dumbbell(**start, transverse_velocity=across).summary
    assert found["attractor"] == start["mode"]
    assert found["period"] == period


def test_drift_shows_the_mode_words_of_the_paper(dumbbell: Runner) -> None:
    run = dumbbell(mode="drift")
    late = run.solution.events.time > 3.0
    during = np.array(run.solution.events.words("during"))[late]
    assert "{11,10,11}" in during
    assert "{01,01,01}" in during
    assert mode_shares(run.solution)["{01,00,01}"] > 0.5


def test_flutter_is_symmetric_about_level(dumbbell: Runner) -> None:
    """With the amplitude of the compliant limit, on stiff springs; without friction there is a closed form, below."""
    low, high = dumbbell(mode="flutter", t_end=8.0).summary["beta_range"]
    assert math.degrees(high) == pytest.approx(10.4, abs=0.2)
    assert low == pytest.approx(-high, rel=1e-3)


def test_frictionless_flutter_obeys_its_closed_form(dumbbell: Runner) -> None:
    run = dumbbell(mode="flutter", friction=0.0, t_end=20.0)
    low, high = run.summary["beta_range"]
    beta, f = (high - low) / 2.0, run.scenario.frequency
    body = run.solution.system.bodies[1]
    k_squared = body.inertia[1] / body.total_mass
    rate = abs(run.scenario.final(run.solution)["u"][4])
    assert rate == pytest.approx(2.0 * beta * f, rel=1e-4)
    half = body.centre_distance / 2.0
    assert 4.0 * beta * f**2 * k_squared == pytest.approx(9.81 * half * math.cos(beta), rel=1e-3)


def test_jump_gap_is_that_of_the_bouncing_ball(dumbbell: Runner) -> None:
    run = dumbbell(mode="jump", t_end=8.0)
    e, f, g = 0.65, run.scenario.frequency, 9.81
    angle = math.acos(math.pi * (1.0 - e) / (1.0 + e) / run.scenario.gamma)
    t = np.linspace(0.0, 1.0 / f, 200001)
    plate = run.scenario.amplitude * (np.sin(angle + 2.0 * math.pi * f * t) - math.sin(angle))
    expected = float((g / (2.0 * f) * t - g * t**2 / 2.0 - plate).max())
    assert run.summary["max_gap"] == pytest.approx([expected, expected], abs=2e-8)


@pytest.mark.parametrize(("factor", "inside"), [(0.98, False), (1.02, True)])
def test_jump_exists_above_its_lower_bound(dumbbell: Runner, factor: float, inside: bool) -> None:
    lower, _ = _bounds(0.65)
    gamma = factor * lower
    run = dumbbell(mode="jump", gamma=gamma, phase=math.acos(min(1.0, lower / gamma)), t_end=8.0)
    assert (run.summary["attractor"] == "jump") == inside


@pytest.mark.parametrize(("factor", "period"), [(0.98, 1), (1.02, 2)])
def test_jump_doubles_its_period_at_its_upper_bound(dumbbell: Runner, factor: float, period: int) -> None:
    lower, upper = _bounds(0.65)
    gamma = factor * upper
    run = dumbbell(mode="jump", gamma=gamma, phase=math.acos(lower / gamma), t_end=8.0)
    assert run.summary["period"] == period


def _bounds(e: float) -> tuple[float, float]:
    lower = math.pi * (1.0 - e) / (1.0 + e)
    return lower, math.sqrt(lower**2 + 4.0 * (1.0 + e * e) ** 2 / (1.0 + e) ** 4)


def test_printed_jump_start_is_a_flight_of_four_periods(dumbbell: Runner) -> None:
    run = dumbbell(mode="jump", vertical_velocity=2.0 * 9.81 / 25.0)
    first = run.solution.events.time[1]
    assert first * run.scenario.frequency == pytest.approx(4.0, abs=0.05)


@pytest.mark.parametrize("start", [{"mode": "drift"}, {"mode": "jump", "beta0": ONE_DEGREE}, {"mode": "flutter"}])
def test_planar_start_stays_planar(dumbbell: Runner, start: dict[str, Any]) -> None:
    run = dumbbell(**start, transverse_velocity=0.0)
    found = run.scenario.coordinates(run.solution)
    for name in ("x1", "theta", "gamma"):
        assert np.abs(found[name]).max() < 1e-12, name


@pytest.mark.parametrize("mode", ["drift", "flutter"])
def test_reflected_start_reflects_the_path(dumbbell: Runner, mode: str) -> None:
    one, other = (dumbbell(mode=mode, transverse_velocity=v, t_end=1.0) for v in (0.3, -0.3))
    a, b = (run.scenario.coordinates(run.solution) for run in (one, other))
    for name, sign in {"x1": -1.0, "y1": 1.0, "z1": 1.0, "theta": -1.0, "beta": 1.0, "gamma": -1.0}.items():
        np.testing.assert_allclose(a[name], sign * b[name], atol=1e-7, err_msg=name)


def test_a_plate_that_hardly_moves_brings_rest(dumbbell: Runner) -> None:
    found = dumbbell(gamma=0.3).summary
    assert (found["attractor"], found["period"]) == ("rest", None)
    assert max(found["max_gap"]) < 1e-9


def test_a_start_too_short_to_settle_is_no_attractor(dumbbell: Runner) -> None:
    found = dumbbell(mode="jump", t_end=0.05).summary
    assert (found["attractor"], found["period"]) == ("other", None)


def test_long_runs_are_sampled_coarsely_and_still_told_apart(dumbbell: Runner) -> None:
    run = dumbbell(mode="flutter", t_end=200.0)
    assert run.scenario.sample_interval == pytest.approx(0.25 / run.scenario.frequency)
    assert (run.summary["attractor"], run.summary["period"]) == ("flutter", 2)
