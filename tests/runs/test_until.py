"""Runs until a condition is met: where they end, and that they go on as if they had not ended there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.plugins import registry
from nonsmooth.runs.so_far import RunSoFar
from tests.runs.continued import differences, lost_by_stopping

T_END = 0.5


@pytest.fixture(scope="module")
def model() -> ns.Model:
    return ns.assemble(registry.load("scenarios", "dumbbell")().build())


@pytest.fixture(scope="module")
def whole(model: ns.Model) -> ns.Solution:
    return model.run(T_END)


@pytest.mark.parametrize("n", [1, 7, 40])
def test_it_ends_with_the_nth_impact_and_goes_on_to_the_last_bit(model: ns.Model, whole: ns.Solution, n: int) -> None:
    """No event is there behind it but those of its instant."""
    before = model.run(T_END, until=lambda run: run.n_impacts >= n)
    assert (before.status, before.message) == ("done", "the condition that was given was met")
    assert before.events.count(Cause.IMPACT) == before.counters.impacts == n
    assert before.t_end == before.events.time[before.events.cause == Cause.IMPACT][-1]
    assert lost_by_stopping(whole, before, model.run(T_END, start=before.state)) == []


def test_a_condition_sees_what_there_is(model: ns.Model, whole: ns.Solution) -> None:
    """One that is never met changes nothing; one on the state ends the first step in which it holds."""
    seen: list[tuple[Any, ...]] = []

    def look(run: RunSoFar) -> bool:
        seen.append((run.time, run.n_events, len(run.events), len(run.q), len(run.u)))
        assert repr(run) == f"RunSoFar(t = {run.time:.9g} s; {run.n_events} events, {run.n_impacts} impacts)"
        return False

    assert differences(whole, model.run(T_END, until=look)) == []
    times = [one[0] for one in seen]
    assert times == sorted(times)
    assert times[-1] < T_END
    assert all(one[1] == one[2] and one[3:] == (7, 6) for one in seen)
    run = model.run(T_END, until=lambda run: run.time > 0.1 and run.u[2] > 0.0)
    assert 0.1 < run.t_end < 0.2
    assert run.u_end[2] > 0.0


@pytest.mark.parametrize("n", [1, 60])
def test_a_limit_of_steps_stops_a_run_that_continues_to_the_last_bit(
    model: ns.Model, whole: ns.Solution, n: int
) -> None:
    before = model.run(T_END, most_steps=n)
    assert (before.status, before.message) == ("done", "the condition that was given was met")
    assert n <= before.counters.steps < whole.counters.steps
    assert lost_by_stopping(whole, before, model.run(T_END, start=before.state)) == []
    assert differences(whole, model.run(T_END, most_steps=whole.counters.steps + 1)) == []


def test_what_a_condition_raises_is_raised(model: ns.Model) -> None:
    """And the model runs again."""
    with pytest.raises(ZeroDivisionError):
        model.run(T_END, until=lambda run: 1 / 0 > 0)
    assert model.run(0.01).status == "done"


def test_results_on_disk_end_there_too(model: ns.Model, tmp_path: Path) -> None:
    run = model.run(T_END, until=lambda run: run.n_impacts >= 7, output=tmp_path)
    assert differences(run, ns.open_solution(tmp_path)) == []


@pytest.mark.parametrize("n", [0, 1, 7])
def test_samples_reach_from_the_start_to_the_end(model: ns.Model, n: int) -> None:
    """Also where a condition is met before the first step; both are known there as the state is."""
    run = model.run(T_END, until=lambda run: run.n_impacts >= n)
    assert (run.t[0], run.t[-1]) == (0.0, run.t_end)
    assert len(run.t) == 1 or np.all(np.diff(run.t) > 0.0)
    np.testing.assert_array_equal(run.q[-1], run.q_end)
    np.testing.assert_array_equal(run.u[-1], run.u_end)


def test_the_end_is_a_sample_where_the_interval_does_not_lead_to_it(model: ns.Model, tmp_path: Path) -> None:
    run = model.run(0.1, sample_interval=0.03, output=tmp_path)
    np.testing.assert_allclose(run.t, [0.0, 0.03, 0.06, 0.09, 0.1], rtol=1e-15)
    np.testing.assert_array_equal(ns.open_solution(tmp_path).q, run.q)
    np.testing.assert_array_equal(run.q[-1], run.q_end)
    assert run.history("kinetic_energy", times=run.t[-1])["kinetic_energy"] == pytest.approx(
        run.energy.kinetic_end, rel=1e-12
    )
