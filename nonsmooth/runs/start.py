"""A model is put where a run starts: at the beginning of one, or in the midst of one that goes on."""

from __future__ import annotations

import numpy as np

from nonsmooth.checks import is_finite
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.modes import OPEN, SLIDE, STICK
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import CompliantNormalLaw
from nonsmooth.model.candidates import check_candidates
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.solution.state import Integers, State
from nonsmooth.system.given import check_quaternion

_COUNTERS = (
    owners.Totals.n_steps,
    owners.Totals.n_rejected,
    owners.Totals.n_impacts,
    owners.Totals.n_impact_steps,
    owners.Totals.n_gap_evaluations,
    owners.Totals.n_listings,
    owners.Totals.n_steps_limited,
)
_WHOLE = ("modes", "guards_spent")
_NUMBERS = ("q", "u", "slip_directions", "closing_rates", "features", "law_states")
_REMEDY = "Take a state of this system: solution.state of a run of it, or State.at(system, ...)."
_NOT_CLOSED = 1e3
"""A contact that is closed may have a gap of so many gap tolerances."""


def check_arrays(model: LaidOut, state: State) -> None:
    """Look whether a state has the arrays of the model.

    Raises
    ------
    InvalidInput
        If it has other numbers of anything, or a mode or a mark that is none.
    """
    n = len(model.system.contacts)
    shapes = {
        "q": (model.n_q,),
        "u": (model.n_u,),
        "modes": (n,),
        "slip_directions": (n, 2),
        "closing_rates": (n,),
        "features": (n, CANDIDATE),
        "law_states": (model.n_states,),
        "guards_spent": (len(model.system.guards),),
    }
    if not is_finite(state.time):
        raise InvalidInput("State.time", "must be finite", state.time, "Give it in [s].")
    for name, shape in shapes.items():
        value, kinds = getattr(state, name), "biu" if name in _WHOLE else "biuf"
        if value.dtype.kind not in kinds:
            rule = f"must be {'whole ' if name in _WHOLE else ''}numbers"
            raise InvalidInput(f"State.{name}", rule, f"an array of {value.dtype}", _REMEDY)
        if value.shape != shape:
            raise InvalidInput(f"State.{name}", f"must have the shape {shape} of this model", value.shape, _REMEDY)
    if not {*state.modes.tolist()} <= {OPEN, STICK, SLIDE}:
        raise InvalidInput("State.modes", "must be 0 (open), 1 (stick) or 2 (slide)", state.modes.tolist(), _REMEDY)
    if not {*state.guards_spent.tolist()} <= {0, 1}:
        raise InvalidInput("State.guards_spent", "must be 0 or 1", state.guards_spent.tolist(), _REMEDY)


def check_start_numbers(model: LaidOut, state: State) -> None:
    """Look whether a run may begin with the numbers of a state.

    Raises
    ------
    InvalidInput
        If one is not finite, or a quaternion not unit.
    """
    values = [getattr(state, name).ravel() for name in _NUMBERS]
    if not np.isfinite(np.concatenate(values)).all():
        wrong = [not np.isfinite(value).all() for value in values].index(True)
        name, value = _NUMBERS[wrong], values[wrong]
        number = int(np.flatnonzero(~np.isfinite(value))[0])
        remedy = f"Look at entry {number}; a run that failed may leave such a state."
        raise InvalidInput(f"State.{name}", "must be finite numbers", float(value[number]), remedy)
    first = 0
    for body in model.system.bodies:
        check_quaternion(f"State.q of {model.system.name_of(body)!r}", body, state.q[first : first + body.n_q])
        first += body.n_q


def begin(model: LaidOut, blank: Checkpoint, state: State) -> None:
    """Put a model where a run begins, and list the contacts that are near each other there.

    Raises
    ------
    InvalidInput
        If these are too many, or a closed contact has features that are not near each other.
    """
    if model.memory[owners.Model.n_searches] > 0 and np.any(state.modes):
        _check_features(model, blank, state)
    _place(model, blank, state, state.modes)


def _check_features(model: LaidOut, blank: Checkpoint, state: State) -> None:
    """Raise InvalidInput if a search does not find the features of a closed contact: nobody else knows them."""
    _place(model, blank, state, np.full(len(state.modes), OPEN))
    places = model.memory.declared(owners.Contact.features)
    for number in np.flatnonzero((places > 0) & (state.modes != OPEN)).tolist():
        if not np.array_equal(model.memory.floats[places[number] :][:CANDIDATE], state.features[number]):
            raise InvalidInput(
                f"State.features[{number}], of the closed {model.system.contacts[number]},",
                "must be features that are near each other",
                state.features[number].tolist(),
                "Where q has been changed, begin with State.at(system, time, q, u).",
            )


def _place(model: LaidOut, blank: Checkpoint, state: State, modes: Integers) -> None:
    """Put a model where a state is, with such modes, and list the contacts that are near each other there."""
    blank.put(model.memory)
    memory = model.memory
    memory[owners.Island.time] = state.time
    y = memory[owners.Island.y][: model.n_y]
    y[: model.n_q], y[model.n_q : model.n_q + model.n_u] = state.q, state.u
    y[model.n_q + model.n_u + N_ACCOUNTS :] = state.law_states
    memory.declared(owners.Contact.mode)[:] = modes
    memory.declared(owners.Contact.closing_rate)[:] = state.closing_rates
    memory.declared(owners.Contact.direction)[:] = state.slip_directions
    places = memory.declared(owners.Contact.features)
    for number in np.flatnonzero((places > 0) & (state.features[:, 0] != 0.0)).tolist():
        memory.floats[places[number] :][:CANDIDATE] = state.features[number]
    memory[owners.OwnGuard.has_just_fired][: len(model.system.guards)] = state.guards_spent
    model.list_contacts()


def check_closed(model: LaidOut, state: State) -> None:
    """Look whether the contacts that a start calls closed are.

    Raises
    ------
    InvalidInput
        If one is not.
    """
    if not np.any(state.modes):
        return
    gaps = model.gaps()
    allowed = _NOT_CLOSED * float(model.memory[owners.Tolerance.gap])
    for number in np.flatnonzero(state.modes).tolist():
        normal = model.system.contacts[number].normal
        reach = normal.reach if isinstance(normal, CompliantNormalLaw) else 0.0
        if not gaps[number] <= reach + allowed:
            raise InvalidInput(
                f"State.modes[{number}], the {model.system.contacts[number]},",
                f"must be 0, open, where there is a gap of {gaps[number]:.3g} m",
                int(state.modes[number]),
                "Where q has been changed, begin with State.at(system, time, q, u).",
            )


def go_on(model: LaidOut, blank: Checkpoint, state: State) -> None:
    """Put a model in the midst of the run that left a state, and goes on; its counters begin anew.

    Raises
    ------
    InvalidInput
        If what comes from a file cannot be of such a run.
    """
    restore(model, blank, state)
    for one in _COUNTERS:
        model.memory[one] = 0
    assert state.continuation is not None
    model.memory[owners.Request.n_known_events] = state.continuation.told


def restore(model: LaidOut, blank: Checkpoint, state: State) -> None:
    """Put a model where a run was cut off; errors as :func:`go_on`."""
    continuation, memory = state.continuation, model.memory
    assert continuation is not None
    blank.put(memory)
    continuation.difference.put(memory)
    check_candidates(model)
    t, told = float(memory[owners.Island.time]), continuation.told
    if not t <= state.time or told < 0:
        raise InvalidInput(
            "State.continuation", f"must begin before {state.time:.9g} s", (t, told), "It is damaged: take another."
        )
    memory[owners.Request.is_resumed] = memory[owners.Run.has_started]
