"""A run that was stopped and goes on is the run that was not stopped, event by event, to the last bit."""

from __future__ import annotations

import dataclasses
import pickle
import random
from dataclasses import dataclass
from functools import partial
from typing import Any, final

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, Plate, Rest
from laws import Bristle, Coulomb, EnergeticImpact, HuntCrossley, RateAndState, Unilateral
from nonsmooth.interfaces import Guard
from nonsmooth.parameters import parameter
from nonsmooth.plugins import registry
from nonsmooth.types import Floats
from tests.runs.continued import lost_by_stopping

CUTS = (("dumbbell", 1.0, 4), ("dice_throw", 0.12, 2), ("rolling_disc", 0.3, 3), ("woodpecker", 0.4, 3))
"""Scenario, end time [s] and at how many times it is stopped."""


@pytest.mark.slow
@pytest.mark.parametrize(("name", "t_end", "times"), CUTS, ids=[cut[0] for cut in CUTS])
def test_nothing_is_lost_by_stopping(name: str, t_end: float, times: int) -> None:
    """At random times, on the same model, once by way of a file."""
    scenario, draw = registry.load("scenarios", name)(), random.Random(7)
    model = ns.assemble(scenario.build())
    run = partial(model.run, sample_interval=scenario.sample_interval)
    whole = run(t_end)
    for i in range(times):
        before = run(draw.uniform(0.0, t_end))
        state = pickle.loads(pickle.dumps(before.state)) if i == 0 else before.state
        assert lost_by_stopping(whole, before, run(t_end, start=state)) == []
    early = run(1e-6)
    assert lost_by_stopping(whole, early, run(t_end, start=early.state)) == []


@pytest.mark.slow
def test_a_run_may_be_stopped_often(build: Any) -> None:
    """A hundred pieces of a bouncing ball that comes to rest: within steps, at events, in accumulations."""
    system = build.over(Ball(0.01), restitution=0.6)
    system.place(system.bodies[1], position=(0.0, 0.0, 0.03), velocity=(0.1, 0.0, 0.0))
    model = ns.assemble(system)
    whole = model.run(0.6)
    state, times = model.start, list[float]()
    impact = float(whole.events.time[3])
    for t_end in sorted([*np.linspace(0.006, 0.6, 100).tolist(), impact]):
        piece = model.run(t_end, start=state)
        times += piece.events.time[len(times) > 0 :].tolist()
        state = piece.state
    assert times == whole.events.time.tolist()
    assert np.array_equal(piece.u_end, whole.u_end)
    assert piece.energy == whole.energy


@pytest.mark.slow
@pytest.mark.parametrize("laws", ["compliant", "rate and state"])
def test_inner_states_of_laws_go_on(laws: str) -> None:
    table, body = Plate(Rest()), Ball(0.02)
    system = ns.System([table, body])
    if laws == "compliant":
        system.contact(table, body, normal=HuntCrossley(stiffness=1e5, dissipation=0.2), friction=Bristle(0.3, 0.4))
    else:
        aging = RateAndState(0.3, 0.01, 0.02, 1e-3, 1e-4)
        system.contact(table, body, normal=Unilateral(), friction=aging, impact=EnergeticImpact(0.3))
    ns.at_height(system, body, 0.002, velocity=(0.4, 0.1, 0.0))
    model = ns.assemble(system)
    whole = model.run(0.08)
    for t_end in (0.013, 0.0291, 0.05):
        before = model.run(t_end)
        assert lost_by_stopping(whole, before, model.run(0.08, start=before.state)) == []
    assert np.any(before.state.law_states != 0.0)


@pytest.mark.parametrize("columns", [1, 4])
def test_boxes_whose_memory_has_grown_go_on(columns: int) -> None:
    """Columns of two boxes fall on each other: few or many features, with tables behind a memory that grows."""
    plate, boxes = Plate(Rest()), [BoxBody(0.01, 0.01, 0.01) for _ in range(2 * columns)]
    system = ns.System([plate, *boxes])
    for i, box in enumerate(boxes):
        for other in (plate, *boxes[:i]):
            system.contact(other, box, normal=Unilateral(), friction=Coulomb(0.5), impact=EnergeticImpact(0.3))
        floor = i // columns
        turn = ns.turned_about((1.0, 2.0, 3.0), 1e-3 * (i + 1))
        system.place(box, position=(0.021 * (i % columns), 0.0, 0.01 + 0.021 * (floor + 1)), orientation=turn)
    model = ns.assemble(system)
    whole, before = model.run(0.1), model.run(0.03)
    assert len(before.events) < len(whole.events)
    assert lost_by_stopping(whole, before, model.run(0.1, start=before.state)) == []


@final
@dataclass(frozen=True)
class _Above(Guard):
    """The ball is above a height."""

    height: float = parameter(0.02, doc="height", unit="m")
    ends_run = True

    @staticmethod
    def value(t: float, q: Floats, u: Floats, height: float) -> float:
        return q[2] - height


def test_a_run_that_a_guard_ended_goes_on_behind_it(build: Any) -> None:
    system = build.over(Ball(0.01))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.06))
    system.guard(_Above())
    model = ns.assemble(system)
    first = model.run(1.0)
    assert first.state.guards_spent.tolist() == [1]
    second = model.run(1.0, start=first.state)
    assert first.t_end < second.events.time[1] < second.t_end < 1.0
    assert second.events.causes() == ["start", "impact", "guard of the scenario"]


def test_a_start_is_continued_on_a_model_made_alike(build: Any) -> None:
    """Two models of two systems that were built alike; and one with other numbers, on which the state is a start."""

    def made(friction: float) -> ns.Model:
        system = build.over(Ball(0.01), friction=friction)
        system.place(system.bodies[1], position=(0.0, 0.0, 0.012), velocity=(0.3, 0.0, 0.0))
        return ns.assemble(system)

    one, alike, other = made(0.2), made(0.2), made(0.3)
    whole, before = one.run(0.3), one.run(0.1)
    assert lost_by_stopping(whole, before, alike.run(0.3, start=before.state)) == []
    after = other.run(0.3, start=before.state)
    assert after.energy.kinetic_start == pytest.approx(before.energy.kinetic_end, rel=1e-12)
    assert after.events.time[0] == 0.1


def test_a_state_that_was_changed_is_a_start(build: Any) -> None:
    """A sliding ball is pushed: it goes on from there, closed as it was, with the new velocity."""
    system = build.over(Ball(0.01))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.01), velocity=(0.5, 0.0, 0.0))
    model = ns.assemble(system)
    state = model.run(0.02).state
    assert state.modes.tolist() == [2]
    faster = state.u.copy()
    faster[0] += 1.0
    pushed = dataclasses.replace(state, u=faster)
    assert pushed.continuation is None
    after = model.run(0.03, start=pushed)
    assert len(after.events) == 1
    assert after.u_end[0] == pytest.approx(faster[0] - 0.2 * 9.81 * 0.01, rel=1e-9)
