"""Writes a state into the memory of a model: as a new start, or to continue the run that left the state.

A new start writes what a :class:`State` holds, and the engine finds everything else in the first instant. To continue
a run, the memory gets the content of a checkpoint, and the engine repeats the last steps of the run from there.
"""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.declared import remember, searched
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.runs.checks import check_candidates
from nonsmooth.solution.end import RunRequest
from nonsmooth.solution.state import Integers, State

_COUNTERS = (
    owners.Totals.n_steps,
    owners.Totals.n_rejected,
    owners.Totals.n_impacts,
    owners.Totals.n_impact_steps,
    owners.Totals.n_gap_evaluations,
    owners.Totals.n_listings,
    owners.Totals.n_steps_limited,
)
_BUFFER_PART = 0.5
"""Part of the buffer of samples that one step may fill. The engine pauses if the other half is full."""


def begin(model: LaidOut, blank: Checkpoint, state: State) -> None:
    """Write a state into the memory as a new start, and make the neighbour list.

    ``blank`` is the content of the memory before any run. The features of closed contacts are checked if a search found
    them, as they would be kept even if they are far apart.

    Raises
    ------
    InvalidInput
        If too many contacts are near each other, or a closed contact has features that are not near each other.
    """
    if model.memory[owners.ModelNumbers.n_searches] > 0 and np.any(state.modes):
        _check_features(model, blank, state)
    _write(model, blank, state, state.modes)


def continue_run(model: LaidOut, blank: Checkpoint, state: State) -> None:
    """Put the memory where the run that left a state continues, with the counters at zero.

    The engine repeats the events after the checkpoint, and must not record them again: the memory holds their number.
    Energies are not set to zero, because the energy account includes the earlier run.

    Raises
    ------
    InvalidInput
        If the state comes from a damaged file.
    """
    resume_run(model, blank, state)
    for one in _COUNTERS:
        model.memory[one] = 0
    assert state.continuation is not None
    model.memory[owners.Request.n_known_events] = state.continuation.n_known_events


def resume_run(model: LaidOut, blank: Checkpoint, state: State) -> None:
    """Put the memory at the checkpoint from which the run that left a state continues, with the counters of that run.

    Raises
    ------
    InvalidInput
        If the state comes from a damaged file.
    """
    continuation, memory = state.continuation, model.memory
    assert continuation is not None
    # a state has the difference of the checkpoint from the blank memory
    n_slots, most = continuation.difference.n_slots, len(model.system.contacts)
    if not 0 <= n_slots <= most:
        rule = f"must be from 0 to {most}, the number of contacts"
        raise InvalidInput("State.continuation: n_slots", rule, n_slots, "It is damaged: take another.")
    blank.put(memory)
    model.resize(n_slots)
    continuation.difference.put(memory)
    check_candidates(model)
    t, n_known_events = float(memory[owners.Island.time]), continuation.n_known_events
    if not t <= state.time or n_known_events < 0:
        rule = f"must begin before {state.time:.9g} s"
        raise InvalidInput("State.continuation", rule, (t, n_known_events), "It is damaged: take another.")
    # a resumed run evaluates again what follows from the state and no checkpoint holds, such as the groups of contacts;
    # one that was cut off before its first instant starts anew
    memory[owners.Request.is_resumed] = memory[owners.Run.has_started]


def _check_features(model: LaidOut, blank: Checkpoint, state: State) -> None:
    """Check that a search finds the features of each closed contact.

    It writes the state into the memory with all contacts open. The search empties an open contact whose features it
    does not find; a closed one would keep them in any case.

    Raises
    ------
    InvalidInput
        If the search finds other features.
    """
    _write(model, blank, state, np.full(len(state.modes), Mode.OPEN))
    for number, place in zip(*(part.tolist() for part in searched(model.memory)), strict=True):
        features = model.memory.floats[place:][:CANDIDATE]
        if state.modes[number] != Mode.OPEN and not np.array_equal(features, state.features[number]):
            raise InvalidInput(
                f"State.features[{number}], of the closed {model.system.contacts[number]},",
                "must be features that are near each other",
                state.features[number].tolist(),
                "If you changed q, begin with State.at(system, time, q, u).",
            )


def _write(model: LaidOut, blank: Checkpoint, state: State, modes: Integers) -> None:
    """Write a state into the blank memory, but with these modes of the contacts, and make the neighbour list."""
    blank.put(model.memory)
    memory = model.memory
    memory[owners.Island.time] = state.time
    y = memory[owners.Island.y]
    # the energy accounts between u and the inner states of laws begin at zero
    y[: model.n_q], y[model.n_q : model.n_q + model.n_u] = state.q, state.u
    y[model.n_q + model.n_u + N_ACCOUNTS :] = state.law_states
    # only contacts with a search have features in the memory; a first number of 0 means that none were found
    numbers, places = searched(memory)
    has_pair = state.features[numbers, 0] != 0.0
    memory.floats[places[has_pair, None] + np.arange(CANDIDATE)] = state.features[numbers[has_pair]]
    # these guards of the user do not fire at the start again
    memory[owners.OwnGuard.has_just_fired] = state.guards_spent
    contact = owners.ContactRecord
    states = {contact.mode: modes, contact.closing_rate: state.closing_rates, contact.direction: state.slip_directions}
    turns = np.any(state.slip_directions != (1.0, 0.0), axis=1)
    remembered = np.flatnonzero((modes != Mode.OPEN) | (state.closing_rates != 0.0) | turns)
    model.reserve(len(remembered))
    remember(memory, remembered, {one: values[remembered] for one, values in states.items()})
    model.list_contacts(of_all=False)


def write_request(memory: Memory, request: RunRequest) -> None:
    """Write the end time and the times of samples [s], and the longest step whose samples fit their buffer."""
    memory[owners.Request.t_end] = request.t_end
    memory[owners.Request.sample_start] = request.sample_start
    memory[owners.Request.sample_interval] = request.sample_interval
    longest_step = _BUFFER_PART * memory[owners.ModelNumbers.sample_capacity] * request.sample_interval
    # the default interval depends on the end time, which must not change the steps; its few samples fit in any case
    memory[owners.Request.sample_span] = math.inf if request.has_default_samples else longest_step


def write_first_sample(memory: Memory, request: RunRequest) -> None:
    """Set time [s] and number of the next sample to those of the first one of a request, for a run from its start."""
    memory[owners.OutputNumbers.next_sample], memory[owners.OutputNumbers.sample_index] = request.sample_start, 0
