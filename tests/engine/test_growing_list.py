"""Memory for the contacts that are near: it grows in a run, and the run does not depend on how large it was."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from bodies import BoxBody, MeshBody, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.model import broad_phase
from nonsmooth.runs.so_far import RunSoFar
from tests.bodies.meshes.parts import bracket
from tests.runs.continued import differences, lost_by_stopping

T_END = 0.4


def _boxes() -> ns.System:
    """Four boxes far apart that fly together and collide, with 960 potential contacts."""
    random = np.random.default_rng(3)
    boxes = [BoxBody(0.02, 0.02, 0.02, density=1000.0) for _ in range(4)]
    system = ns.System(boxes, gravity=0.0)
    for box, place in zip(
        boxes, ((0.15, 0.0, 0.0), (-0.15, 0.0, 0.0), (0.0, 0.2, 0.0), (0.0, -0.25, 0.0)), strict=True
    ):
        turn = random.normal(size=4)
        velocity, spin = -4.0 * np.array(place), random.normal(size=3)
        system.place(
            box,
            position=place,
            orientation=tuple(turn / np.linalg.norm(turn)),
            velocity=tuple(velocity),
            angular_velocity=tuple(spin),
        )
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.5)))
    return system


@pytest.fixture(autouse=True)
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a memory begin with few slots."""
    monkeypatch.setattr(broad_phase, "LEAST_SLOTS", 0)
    monkeypatch.setattr(broad_phase, "CONTACTS_PER_SPHERE", 1)


@pytest.fixture
def grown() -> ns.Solution:
    return ns.simulate(_boxes(), T_END)


def _brackets() -> ns.System:
    """Three brackets far apart that fly together; the functions of their contacts read the mesh from a table."""
    bodies = [MeshBody(Triangles(*bracket()), density=1000.0) for _ in range(3)]
    system = ns.System(bodies, gravity=0.0)
    for body, x in zip(bodies, (-0.1, 0.0, 0.1), strict=True):
        system.place(body, position=(x, 0.1 * x, 0.0), velocity=(-10.0 * x, 0.0, 0.0), angular_velocity=(1.0, 2.0, 3.0))
    system.contact_all(ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.5)))
    return system


def _n_slots(model: ns.Model) -> int:
    return int(model._laid.memory[owners.ModelNumbers.n_slots])


def test_a_run_does_not_depend_on_the_slots_at_its_start(grown: ns.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    model = ns.assemble(_boxes())
    before = model._blank.n_slots
    assert before < 100
    assert differences(grown, model.run(T_END)) == []
    assert _n_slots(model) > 2 * before
    assert len(grown.events) > 5
    monkeypatch.setattr(broad_phase, "CONTACTS_PER_SPHERE", 1000)
    large = ns.assemble(_boxes())
    assert _n_slots(large) == len(large.system.contacts)
    found = large.run(T_END)
    assert differences(grown, found) == []
    assert found.counters.listings == grown.counters.listings


@pytest.mark.parametrize("part", [0.3, 0.7, 0.9])
def test_a_state_of_a_grown_memory_continues_in_a_small_one(grown: ns.Solution, part: float) -> None:
    before = ns.simulate(_boxes(), part * T_END)
    state = pickle.loads(pickle.dumps(before.state))
    model = ns.assemble(_boxes())
    assert lost_by_stopping(grown, before, model.run(T_END, start=state)) == []
    # the same memory, and a copy of it, run again from the start
    assert differences(grown, model.run(T_END)) == []
    assert differences(grown, model.copy().run(T_END)) == []


def test_a_run_cut_off_after_its_memory_grew_is_resumed(grown: ns.Solution, tmp_path: Path) -> None:
    def stop(run: RunSoFar) -> bool:
        if run.time > 0.8 * T_END:
            raise RuntimeError("cut off")
        return False

    with pytest.raises(RuntimeError, match="cut off"):
        ns.assemble(_boxes()).run(T_END, output=tmp_path / "run", until=stop)
    resumed = ns.assemble(_boxes()).resume(tmp_path / "run", until=lambda run: False)
    np.testing.assert_array_equal(resumed.q_end, grown.q_end)


def test_a_grown_memory_finds_the_tables_of_meshes() -> None:
    """The same memory, and a copy of it, run again from the start; each function finds its table by a distance."""
    model = ns.assemble(_brackets())
    other, before, t_end = model.copy(), model._blank.n_slots, 0.15
    first = model.run(t_end)
    assert _n_slots(model) > before
    assert len(first.events) > 1
    for again in (model, other, other):
        assert differences(first, again.run(t_end)) == []
        # the references of the blank memory and of the grown one are to the same numbers
        memory = again._laid.memory
        for place, start, number in memory.references:
            distance = int(memory.floats[place])
            address = memory.floats.ctypes.data + 8 * (start + distance)
            assert address == memory.table_numbers.ctypes.data + 8 * number


def test_histories_of_a_grown_run_are_read_in_a_small_memory(grown: ns.Solution) -> None:
    """At each event the contact that caused it touches."""
    events = grown.events
    hits = np.flatnonzero(events.contact >= 0)
    gaps = grown.history("gap", times=events.time[hits])["gap"]
    assert len(hits) > 3
    assert np.max(np.abs(gaps[np.arange(len(hits)), events.contact[hits]])) < 1e-9
