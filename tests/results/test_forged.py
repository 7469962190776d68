"""States with random changes are refused or run, and leave the model as it was."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.tables import FLOAT_ARRAYS, INTEGER_ARRAYS, SCALARS
from nonsmooth.model.declared import DeclaredContacts
from nonsmooth.results.description import state_bytes
from nonsmooth.solution.state import State
from tests.results.forged import T_END, forged, refused_or_runs
from tests.results.runs import balls, on_hills

_SCALARS, _BLOCKS = 0, 3
"""Parts of a checkpoint that hold the scalars, and the blocks."""


@pytest.fixture(scope="module")
def model() -> ns.Model:
    return ns.assemble(balls())


@pytest.fixture(scope="module")
def hilly() -> ns.Model:
    return ns.assemble(on_hills())


@pytest.mark.slow
@pytest.mark.parametrize("which", ["model", "hilly"])
def test_a_state_with_random_changes_is_refused_or_runs(which: str, request: pytest.FixtureRequest) -> None:
    model = request.getfixturevalue(which)
    state = model.run(T_END - 1e-3).state
    content, whole = state_bytes(state), model.run(T_END)
    told = [refused_or_runs(model, forged(content, np.random.default_rng(seed))) for seed in range(60)]
    assert set(told) <= {"InvalidInput", "RunFailed", "done", "suspect"}
    assert told.count("InvalidInput") >= 10
    assert told.count("done") >= 10
    np.testing.assert_array_equal(model.run(T_END, start=state).q_end, whole.q_end)


def _starts(memory: Memory, place: Any) -> np.ndarray:
    """Return where something of each declared contact begins, counted from the blocks."""
    numbers = range(int(memory[owners.ModelNumbers.n_declared]))
    return np.asarray(DeclaredContacts.of(memory, numbers)[place] - memory.blocks)


def _with(state: State, place: int, value: float, part: int = _BLOCKS) -> State:
    """State that a file would give with another number at a place of a part of its checkpoint."""
    continuation = state.continuation
    assert continuation is not None
    difference, number = continuation.difference, np.array([value]).view(np.int64)
    kept = difference.places[part] != place
    places, bits = [*difference.places], [*difference.bits]
    places[part], bits[part] = np.append(places[part][kept], place), np.append(bits[part][kept], number)
    forged = replace(difference, places=tuple(places), bits=tuple(bits))
    return replace(state).with_continuation(replace(continuation, difference=forged))


@pytest.mark.parametrize("value", [np.nan, -1.0, 1e300])
def test_a_parameter_is_no_part_of_a_checkpoint(model: ns.Model, value: float) -> None:
    """No run changes one."""
    place = int(_starts(model._laid.memory, owners.ContactRecord.friction_parameters)[1]) + 1
    state = _with(model.run(T_END - 1e-3).state, place, value)
    with pytest.raises(ns.InvalidInput, match=rf"places must be places of \d+ numbers that a run may change.* {place}"):
        model.run(T_END, start=state)


def test_the_offset_of_an_array_is_no_part_of_a_checkpoint(model: ns.Model) -> None:
    """A wrong offset would let the engine read and write outside of the memory."""
    state, names = model.run(1e-3).state, SCALARS.names or ()
    for key in (*FLOAT_ARRAYS, *INTEGER_ARRAYS):
        place = names.index(key)
        rule = rf"places must be places of \d+ numbers that a run may change.* {place}"
        with pytest.raises(ns.InvalidInput, match=rule):
            model.run(T_END, start=_with(state, place, 0.0, _SCALARS))


@pytest.mark.parametrize(
    ("which", "value"), [(0, 2.0), (0, np.nan), (1, 1e9), (1, 0.5), (1, -1.0), (2, 1.0), (3, np.nan)]
)
def test_features_that_there_are_not_are_named(hilly: ns.Model, which: int, value: float) -> None:
    """A search left them in a contact; the evaluator goes by them through the tables of the mesh."""
    state = hilly.run(T_END).state
    memory = hilly._laid.memory
    held = [
        start for start in _starts(memory, owners.ContactRecord.features) if memory.floats[memory.blocks + start] != 0.0
    ]
    said = r"the features of the contact '.*' must be one of \(1, below \d+, below 1\)"
    with pytest.raises(ns.InvalidInput, match=said):
        hilly.run(2.0 * T_END, start=_with(state, int(held[0]) + which, value))
    assert hilly.run(2.0 * T_END, start=state).status == "done"
