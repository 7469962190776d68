"""The stick-slip cycle against scipy, the threshold of damping, energy, wrong input."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from scenarios.block_on_belt import BlockOnBelt

FINE = ns.EventDriven(tolerance=1e-12)
OTHER = {"mass": 2.0, "stiffness": 30.0, "static_force": 5.0, "decay": 1.2, "belt_speed": 0.5, "t_end": 8.0}


def _cycle(scenario: BlockOnBelt) -> tuple[float, float, float]:
    """Return the period of the cycle, its share of stick, and where the belt catches the block, by scipy."""
    k, m, limit = scenario.stiffness, scenario.mass, scenario.static_force

    def slope(t: float, y: Any) -> list[float]:
        slip = scenario.belt_speed - y[1]
        return [y[1], (limit / (1.0 + scenario.decay * abs(slip)) - k * y[0] - scenario.damping * y[1]) / m]

    def caught(t: float, y: Any) -> float:
        return float(scenario.belt_speed - y[1])

    caught.terminal, caught.direction = True, -1.0  # type: ignore[attr-defined]
    start = [(limit - scenario.damping * scenario.belt_speed) / k, scenario.belt_speed]
    done = solve_ivp(slope, (0.0, 100.0), start, "DOP853", events=caught, rtol=1e-13, atol=1e-14)
    assert done.status == 1
    stick = (start[0] - done.y[0, -1]) / scenario.belt_speed
    return float(done.t[-1]) + stick, stick / (float(done.t[-1]) + stick), float(done.y[0, -1])


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("given", [{}, OTHER, {"damping": 0.3}])
def test_limit_cycle(given: dict[str, float]) -> None:
    """Period, share of stick and place of the catch agree with scipy to 1e-8, and so do two cycles in a row."""
    scenario = BlockOnBelt(**given)
    solution = ns.simulate(scenario.build(), scenario.t_end, engine=FINE)
    period, stick, place = _cycle(scenario)
    summary = scenario.summarise(solution)
    assert summary["period"] == pytest.approx(period, abs=1e-8)
    assert summary["stick_share"] == pytest.approx(stick, abs=1e-8)
    catches = solution.events.q[np.isin(solution.events.time, scenario.catches(solution)), 0]
    assert len(catches) >= 3
    np.testing.assert_allclose(catches, place, rtol=0, atol=1e-8)
    np.testing.assert_allclose(np.diff(scenario.breakaways(solution)), period, rtol=0, atol=1e-8)


def test_published_case() -> None:
    """It sticks until q = 1, at t = 5 s; the default tolerance keeps the period to 1e-6."""
    scenario = BlockOnBelt()
    solution = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
    summary = scenario.summarise(solution)
    np.testing.assert_allclose(summary["breakaway"], 1.0, rtol=0, atol=1e-9)
    assert scenario.breakaways(solution)[0] == pytest.approx(5.0, abs=1e-9)
    assert summary["period"] == pytest.approx(_cycle(scenario)[0], abs=1e-6)
    assert set(solution.events.causes()) == {"start", "stick to slip", "slip to stick"}
    stuck = solution.t < 5.0
    np.testing.assert_allclose(solution.u[stuck, 0], 0.2, rtol=0, atol=1e-12)
    assert np.max(np.abs(solution.q[:, 1:3])) <= 1e-12


def test_energy() -> None:
    """The account closes; over one cycle the belt gives what friction takes."""
    scenario = BlockOnBelt()
    period = _cycle(scenario)[0]
    ends = [ns.simulate(scenario.build(), t, engine=FINE).energy for t in (6.0, 6.0 + 2.0 * period)]
    assert all(account.residual <= 1e-10 for account in ends)
    given, taken = (b - a for a, b in ((getattr(ends[0], n), getattr(ends[1], n)) for n in ("driven_work", "loss")))
    assert given > 1.0
    assert given == pytest.approx(taken, rel=1e-8)


@pytest.mark.parametrize(("share", "slips_steadily"), [(0.9, False), (1.1, True)])
def test_damping_threshold(share: float, slips_steadily: bool) -> None:
    """The balance of spring and friction is stable from the damping F_s delta / (1 + delta v)^2 on."""
    critical = 3.0 / (1.0 + 3.0 * 0.2) ** 2
    scenario = BlockOnBelt(damping=share * critical, elongation=0.63, velocity=0.0, t_end=150.0)
    solution = ns.simulate(scenario.build(), scenario.t_end)
    late = solution.t > 120.0
    swing = float(np.ptp(solution.q[late, 0]))
    if slips_steadily:
        assert swing < 1e-4
        assert solution.q_end[0] == pytest.approx(1.0 / 1.6, abs=1e-4)
    else:
        assert swing > 0.1
    assert (len(scenario.catches(solution)) == 0) == slips_steadily


def test_short_run_has_no_period() -> None:
    """Before two breakaways there is no period to report."""
    scenario = BlockOnBelt(t_end=6.0)
    summary = scenario.summarise(ns.simulate(scenario.build(), scenario.t_end))
    assert len(summary["breakaway"]) == 1
    assert summary["period"] is None
    assert summary["stick_share"] is None


def test_wrong_input() -> None:
    """Numbers that make no block, spring or belt are refused."""
    for wrong in ({"mass": 0.0}, {"stiffness": -1.0}, {"belt_speed": 0.0}, {"decay": -1.0}, {"t_end": float("inf")}):
        with pytest.raises(ns.InvalidInput, match=rf"BlockOnBelt\.{next(iter(wrong))}"):
            BlockOnBelt(**wrong)


@pytest.mark.slow
def test_coordinates_and_end_agree() -> None:
    scenario = BlockOnBelt(t_end=10.0, velocity=0.1)
    assert scenario.resolved()["velocity"] == 0.1
    assert BlockOnBelt().resolved()["velocity"] == 0.2
    solution = ns.simulate(scenario.build(), scenario.t_end)
    coordinates, end = scenario.coordinates(solution), scenario.final(solution)
    assert [coordinates["elongation"][-1], coordinates["elongation_rate"][-1]] == pytest.approx([*end["q"], *end["u"]])
