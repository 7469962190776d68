"""Sensitivities: how the state at given times changes with parameters, through flow, impacts, stick and slip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import floats
from nonsmooth.errors import InvalidInput
from nonsmooth.runs.model import Model
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.passage import Signature, named, passage
from nonsmooth.studies.derivatives.slope import BACKWARD, CENTRAL, FORWARD, OrderOfEvents, Stencil, slope, steady

Floats = NDArray[np.float64]
_STEPS = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6)
"""Changes of a parameter that derivatives are tried with, over its value; of a parameter that is 0, in its unit."""


class NotDifferentiable(InvalidInput):
    """A state has no derivative with respect to a parameter: the smallest change reorders events."""


@final
@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of a motion with respect to parameters.

    Attributes
    ----------
    family : Family
        What was differentiated, at its values.
    t : array
        Times [s], shape [n].
    parameters : tuple of str
        With respect to what.
    q, u : array
        Coordinates and velocities there, shapes [n, n_q] and [n, n_u].
    q_by, u_by : array
        Their derivatives, shapes [n, n_q, p] and [n, n_u, p], in units of q and u over that of the parameter.
    error : array
        By how much those of the next smaller step differ, relative to the largest one, per parameter; nan where only
        one step keeps the order of events; shape [p].
    events : array
        Times of the events up to the last of the times [s], where derivatives jump.
    """

    family: Family
    t: Floats
    parameters: tuple[str, ...]
    q: Floats
    u: Floats
    q_by: Floats
    u_by: Floats
    error: Floats
    events: Floats


def sensitivity(what: Varied, parameters: Sequence[str], *, at: ArrayLike) -> Sensitivity:
    """Return how the states at given times change with parameters.

    Runs with parameters a little changed pass the same events at other times, to which the derivative is due where a
    velocity jumps; differences of fourth order of whole runs, each with its events located, hold all of it.  A change
    that reorders events, adds some or takes some away is made smaller; where that does not help there is none.

    Parameters
    ----------
    what : Scenario, System or Family
        The system.
    parameters : sequence of str
        Names of parameters.
    at : array
        Times, rising [s], shape [n].  Just where a velocity jumps it has no derivative.

    Raises
    ------
    UnknownName
        If there is no such parameter.
    InvalidInput
        If times do not rise from 0.
    NotDifferentiable
        If the smallest change of a parameter reorders events; it says which.
    """
    if isinstance(parameters, str):
        remedy = f'For example ("{parameters}",).'
        raise InvalidInput("sensitivity: parameters", "must be a list of names", parameters, remedy)
    times = np.atleast_1d(floats("sensitivity: at", at))
    if not (len(times) and times[0] > 0.0 and np.all(np.diff(times) > 0.0)):
        raise InvalidInput("sensitivity: at", "must be positive, rising times", times.tolist(), "Give them in [s].")
    family = Family.of(what)
    states, expected, events = _course(family.model(), times)
    columns, errors = list[Floats](), list[float]()
    for name in parameters:
        column, error = _steady(family, name, times, expected)
        columns.append(column)
        errors.append(error)
    n_q = len(family.model().start.q)
    by = np.stack(columns, axis=-1) if columns else np.zeros((*states.shape, 0))
    return Sensitivity(
        family,
        times,
        tuple(parameters),
        states[:, :n_q],
        states[:, n_q:],
        by[:, :n_q],
        by[:, n_q:],
        np.array(errors),
        events,
    )


def _course(model: Model, times: Floats) -> tuple[Floats, Signature, Floats]:
    """Return the states at times, shape [n, n_q + n_u], all events, between which the times are marks, and when."""
    state, rows, told, when = model.start, list[Floats](), list[tuple[int, int]](), list[float]()
    for time in times.tolist():
        piece = passage(model, state, time)
        state = piece.state
        rows.append(np.concatenate([state.q, state.u]))
        told += [*piece.signature, (-1, -1)]
        when += piece.times
    return np.array(rows), tuple(told), np.array(when)


def _steady(family: Family, name: str, times: Floats, expected: Signature) -> tuple[Floats, float]:
    value = family[name]
    unit = abs(value) if value else 1.0
    try:
        found, _, differs = steady(lambda step: _slope(family, name, times, expected, step * unit), _STEPS)
    except OrderOfEvents as trouble:
        raise _refused(family, name, value, trouble) from trouble
    return found, differs


def _slope(family: Family, name: str, times: Floats, expected: Signature, step: float) -> Floats:
    """Return the derivatives with a step; from one side where the parameter has no other."""

    def sampled(change: float) -> tuple[Floats, Signature]:
        return _course(family.model(**{name: family[name] + change}), times)[:2]

    trouble: InvalidInput | None = None
    stencils: tuple[Stencil, ...] = (CENTRAL, FORWARD, BACKWARD)
    for stencil in stencils:
        try:
            return slope(sampled, step, expected, stencil)
        except InvalidInput as error:
            trouble = error
    assert trouble is not None
    raise trouble


def _refused(family: Family, name: str, value: float, trouble: OrderOfEvents) -> NotDifferentiable:
    one, two = ([event for event in events if event[0] >= 0] for events in (trouble.one, trouble.two))
    first = next((i for i, (a, b) in enumerate(zip(one, two, strict=False)) if a != b), min(len(one), len(two)))
    model = family.model()
    without, with_it = (named(tuple(events[first : first + 2]), model) for events in (one, two))
    return NotDifferentiable(
        f"sensitivity: {name}",
        f"must not reorder events; event {first + 1} is {without}, and with the least change {with_it}",
        value,
        "There is no derivative here, or one on each side: move the parameter, or end before this event.",
    )
