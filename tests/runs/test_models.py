"""A model runs as often as it is asked to, and nothing of a run is left for the next."""

from __future__ import annotations

import dataclasses
import gc
import math
import pickle
import threading
from dataclasses import dataclass
from typing import Any, final

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Harmonic
from nonsmooth.engine.memory import owners
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Guard
from nonsmooth.parameters import parameter
from nonsmooth.plugins import registry
from nonsmooth.types import Floats
from tests.benchmarks.bodies_on_hills import scene
from tests.runs.continued import differences, lost_by_stopping

SCENARIOS = (("dumbbell", 0.4), ("dice_throw", 0.05), ("newtons_cradle", 0.4), ("mesh_drop", 0.2))


def _spoil(model: ns.Model) -> None:
    """Fill what no run may read before it has written it."""
    memory = model._laid.memory
    memory.floats[memory.start(owners.OutputNumbers.samples) : memory.blocks] = math.nan
    memory.floats[memory.start(owners.OutputNumbers.event_numbers) : memory.tables] = math.nan
    memory.integers[memory.start(owners.OutputNumbers.event_codes) :] = -7


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(("name", "t_end"), SCENARIOS)
def test_a_model_runs_twice_to_the_same_bits(name: str, t_end: float) -> None:
    """Also after a run of another kind, and whatever stands where runs write."""
    system = registry.load("scenarios", name)().build()
    model = ns.assemble(system)
    first = model.run(t_end)
    model.run(0.3 * t_end, start=ns.State.at(system, time=0.1 * t_end), sample_interval=t_end)
    _spoil(model)
    assert differences(first, model.run(t_end)) == []
    assert differences(first, ns.simulate(system, t_end)) == []


def test_copies_run_at_once_in_threads() -> None:
    model = ns.assemble(registry.load("scenarios", "dumbbell")().build())
    alone, found = model.run(1.0), dict[int, ns.Solution]()
    copies = [model.copy(), model.copy().copy(), model]

    def run(number: int) -> None:
        for _ in range(3):
            found[number] = copies[number].run(1.0)

    threads = [threading.Thread(target=run, args=(i,)) for i in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [differences(alone, found[i]) for i in range(3)] == [[], [], []]


@pytest.mark.slow
def test_copies_read_the_tables_of_the_first() -> None:
    """Also where the first is gone, and where a run goes on with features that a search has found."""
    model = ns.assemble(scene(20, 1, 1, 0, 7))
    tables, first = len(model._laid.memory.floats) - model._laid.memory.tables, model.run(0.4)
    before, second = model.run(0.3), model.copy()
    third = second.copy()
    del model, second
    gc.collect()
    assert tables > 1000
    assert PLAIN or len(third._laid.memory.floats) == third._laid.memory.tables
    assert differences(first, third.run(0.4)) == []
    state = pickle.loads(pickle.dumps(before.state))
    assert np.any(state.features)
    assert lost_by_stopping(first, before, third.run(0.4, start=state)) == []
    started = third.run(0.4, start=dataclasses.replace(state, time=0.0))
    assert started.events.time[0] == 0.0


def test_a_model_does_not_run_within_its_run(build: Any) -> None:
    system = build.over(Ball(0.01))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.02))
    model = ns.assemble(system)

    def again(t: float, t_end: float) -> None:
        model.run(0.1)

    with pytest.raises(ns.InvalidInput, match=r"Model.run must not be called while it runs"):
        model.run(0.1, progress=again)
    assert model.run(0.1).status == "done"


def test_a_run_may_start_at_any_time(build: Any) -> None:
    """A plate that vibrates: a period later everything happens a period later."""
    system = build.over(Ball(0.01), Harmonic(amplitude=1e-3, frequency=20.0))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.02))
    model = ns.assemble(system)
    first, later = model.run(0.2), model.run(0.25, start=ns.State.at(system, time=0.05))
    assert len(later.events) == len(first.events) > 5
    np.testing.assert_allclose(later.events.time - 0.05, first.events.time, atol=1e-9)
    assert later.t[0] == 0.05
    half = model.run(0.3, start=ns.State.at(system, 0.025, q=[0.0, 0.0, 0.03, 1.0, 0.0, 0.0, 0.0], u=np.zeros(6)))
    assert half.events.time[0] == 0.025
    assert half.q[0, 2] == 0.03


def test_what_is_changed_in_a_system_later_the_model_does_not_know(build: Any) -> None:
    system = build.over(Ball(0.01))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.02))
    model = ns.assemble(system)
    first = model.run(0.1)
    system.place(system.bodies[1], position=(0.0, 0.0, 0.05))
    assert differences(first, model.run(0.1)) == []
    assert model.run(0.1, start=ns.State.at(system)).q[0, 2] == 0.05


@final
@dataclass(frozen=True)
class _Until(Guard):
    """A clock without a value after its end."""

    end: float = parameter(0.1, doc="end", unit="s")
    ends_run = False

    @staticmethod
    def value(t: float, q: Floats, u: Floats, end: float) -> float:
        return 1.0 + math.sqrt(end - t)


def test_what_lies_behind_the_end_needs_no_value(build: Any) -> None:
    """A run steps as if it had no end; where that leads nowhere it keeps within its end."""
    system = build.over(Ball(0.01))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.01), velocity=(0.3, 0.0, 0.0))
    system.guard(_Until())
    solution = ns.simulate(system, 0.1)
    assert solution.status == "done"
    assert solution.t_end == 0.1
    with pytest.raises(ns.RunFailed, match="_Until"):
        ns.simulate(system, 0.11)
