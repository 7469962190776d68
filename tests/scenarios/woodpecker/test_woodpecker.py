"""The woodpecker toy: its limit cycle with either impact law, and what the run must keep."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from laws import StrongeImpact
from nonsmooth.engine.memory.modes import Cause
from scenarios.woodpecker.scenario import _LAWS, Woodpecker
from tests.scenarios.woodpecker.time_stepping import cycle


def _run(scenario: Woodpecker) -> ns.Solution:
    return ns.run_scenario(scenario)


@pytest.fixture(scope="module")
def long() -> dict[str, tuple[Woodpecker, ns.Solution]]:
    """Return some forty cycles with either law."""
    scenarios = (Woodpecker(law=law, t_end=6.0) for law in ("newton", "energetic"))
    return {scenario.law: (scenario, _run(scenario)) for scenario in scenarios}


def test_published_limit_cycle(long: Any) -> None:
    """Newton's law in Moreau's form, that of the source: about 0.146 s and 19.5 mm per cycle."""
    scenario, solution = long["newton"]
    duration, descent = scenario.cycle(solution)
    assert duration == pytest.approx(0.146, abs=1e-4)
    assert descent == pytest.approx(19.5e-3, abs=1e-4)


@pytest.mark.slow
def test_against_time_stepping(long: Any) -> None:
    """Moreau's scheme, which sees no events, has the same cycle to the order of its step."""
    scenario, solution = long["newton"]
    assert cycle(scenario, 2e-6, 4.0) == pytest.approx(scenario.cycle(solution), rel=2e-4)


def test_the_energetic_law_gives_another_cycle(long: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is not the law of the source; one contact hits at a time, so that Stronge's closed form gives the same."""
    scenario, solution = long["energetic"]
    duration, descent = scenario.cycle(solution)
    published = long["newton"][0].cycle(long["newton"][1])
    assert duration > 1.1 * published[0]
    assert descent > 1.5 * published[1]
    monkeypatch.setitem(_LAWS, "energetic", StrongeImpact)
    closed_form = scenario.cycle(_run(scenario))
    assert (duration, descent) == pytest.approx(closed_form, rel=1e-6)


@pytest.mark.parametrize("law", ["newton", "energetic"])
def test_the_cycle_is_a_limit(long: Any, law: str) -> None:
    """Successive pecks come ever more alike."""
    scenario, solution = long[law]
    times, heights = scenario.pecks(solution)
    durations, descents = np.diff(times), -np.diff(heights)
    assert len(durations) > 30
    assert abs(durations[-1] - durations[-2]) < 1e-6
    assert abs(descents[-1] - descents[-2]) < 1e-6
    early, late = np.abs(np.diff(durations[:10])), np.abs(np.diff(durations[-10:]))
    assert np.max(late) < 0.01 * np.max(early)


@pytest.mark.parametrize("law", ["newton", "energetic"])
def test_energy_and_gaps(long: Any, law: str) -> None:
    """Descent is paid for by losses; sleeve and beak stay outside of the pole; one contact at a time hits."""
    scenario, solution = long[law]
    account = solution.energy
    assert account.residual < 1e-8
    assert account.loss == pytest.approx(-account.change, rel=1e-6)
    clearance = scenario.sleeve_radius - scenario.pole_radius
    reach = scenario.sleeve_arm + scenario.bird_arm - scenario.beak_arm - scenario.pole_radius
    assert np.min(clearance - scenario.sleeve_height * np.abs(solution.q[:, 1])) > -1e-10
    assert np.min(reach - scenario.beak_height * solution.q[:, 2]) > -1e-10
    hits = solution.events.impulse[solution.events.cause == Cause.IMPACT][:, :, 0] > 0.0
    assert np.all(hits.sum(axis=1) == 1)
    # each point has one contact, with the face that it belongs to, and all of them are met
    assert hits.any(axis=0).tolist() == [True] * 3


def test_restitution_of_each_contact(long: Any) -> None:
    """With Newton's law the beak comes back at half its speed, the sleeve not at all."""
    scenario, solution = long["newton"]
    events = solution.events
    rows = {0: [0.0, 0.0, -scenario.beak_height], 1: [0.0, scenario.sleeve_height, 0.0]}
    rows[2] = [-x for x in rows[1]]
    for contact, e in ((0, scenario.beak_restitution), (1, 0.0), (2, 0.0)):
        hit = (events.cause == Cause.IMPACT) & (events.impulse[:, contact, 0] > 0.0)
        assert hit.sum() > 10
        before, after = events.u_before[hit] @ rows[contact], events.u_after[hit] @ rows[contact]
        np.testing.assert_allclose(after, -e * before, rtol=0, atol=1e-9)


def test_wrong_input() -> None:
    """Unknown laws and negative masses are refused by name."""
    with pytest.raises(ns.UnknownName, match=r"Woodpecker\.law.*Did you mean 'newton'"):
        Woodpecker(law="newtons")
    with pytest.raises(ns.InvalidInput, match=r"Woodpecker\.bird_mass must be > 0"):
        Woodpecker(bird_mass=-1.0)


def test_a_short_run_has_no_cycle() -> None:
    """Where there are too few pecks, the numbers say so."""
    scenario = Woodpecker(t_end=0.05)
    summary = scenario.summarise(_run(scenario))
    assert summary["pecks"] == 0
    assert np.isnan(summary["cycle_duration"])
