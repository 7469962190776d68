"""Sensitivities: derivatives of states at given times by parameters, through flow, impacts, stick and slip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import InvalidInput
from nonsmooth.runs.model import Model
from nonsmooth.studies.derivatives.coordinates import values_of
from nonsmooth.studies.derivatives.differences import BACKWARD, CENTRAL, FORWARD, OrderOfEvents, slope, steady
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.flow import Signature, flow, named
from nonsmooth.studies.inputs import rising_times
from nonsmooth.types import Array

_STEPS = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6)
"""Steps of the differences, relative to the value of the parameter; in the unit of the parameter if the value is 0."""


class NotDifferentiable(InvalidInput):
    """A state has no derivative by a parameter: the smallest change reorders events."""


@final
@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of a motion by parameters.

    Attributes
    ----------
    family : Family
        The systems, at the values of the parameters.
    t : array
        Times [s], shape [n].
    parameters : tuple of str
        Names of the parameters.
    q, u : array
        Coordinates and velocities at these times, shapes [n, n_q] and [n, n_u].
    q_by, u_by : array
        Derivatives of q and u by the parameters, shapes [n, n_q, p] and [n, n_u, p], in the unit of the coordinate or
        velocity over the unit of the parameter.
    error : array
        Estimated error for each parameter, relative to its largest derivative: the difference from the next smaller
        step; nan if only one step keeps the order of events; shape [p].
    events : array
        Times of all events up to the last time [s], at which derivatives jump.
    """

    family: Family
    t: Array
    parameters: tuple[str, ...]
    q: Array
    u: Array
    q_by: Array
    u_by: Array
    error: Array
    events: Array


def sensitivity(what: Varied, parameters: Sequence[str], *, at: ArrayLike) -> Sensitivity:
    """Differentiate the states at given times by parameters.

    A changed parameter shifts the times of events, and with them the jumps of velocities.  The derivatives are
    differences of fourth order between complete runs.  Each run locates its own events, so the differences contain this
    shift.  If a change reorders, adds or removes events, a smaller change is taken.

    Parameters
    ----------
    what : Scenario, System or Family
        The system.
    parameters : sequence of str
        Names of parameters.
    at : array
        Times, rising [s], shape [n].  At the instant of a jump a velocity has no derivative.

    Raises
    ------
    UnknownName
        If the system has no parameter of this name.
    InvalidInput
        If `parameters` is a single string, or the times are not positive or do not rise.
    NotDifferentiable
        If the smallest change of a parameter reorders events; the message names them.
    """
    if isinstance(parameters, str):
        remedy = f'For example ("{parameters}",).'
        raise InvalidInput("sensitivity: parameters", "must be a list of names", parameters, remedy)
    times = rising_times("sensitivity: at", at)
    family = Family.of(what)
    states, expected, events = _states(family.model(), times)
    found = [_steady(family, name, times, expected) for name in parameters]
    n_q = len(family.model().start.q)
    by = np.stack([column for column, _ in found], axis=-1) if found else np.zeros((*states.shape, 0))
    parts = states[:, :n_q], states[:, n_q:], by[:, :n_q], by[:, n_q:]
    errors = np.array([error for _, error in found])
    return Sensitivity(family, times, tuple(parameters), *parts, errors, events)


def _states(model: Model, times: Array) -> tuple[Array, Signature, Array]:
    """Run a model through rising times [s], shape [n].

    Returns the states at these times, shape [n, n_q + n_u], the causes and contacts of all events, and the times of the
    events [s], shape [n_events].
    """
    state, rows, passed, when = model.start, list[Array](), list[tuple[int, int]](), list[float]()
    for time in times.tolist():
        piece = flow(model, state, time)
        state = piece.state
        rows.append(values_of(state))
        # (-1, -1) marks each of the given times: an event that moves across one of them changes the sequence
        passed += [*piece.signature, (-1, -1)]
        when += piece.times
    return np.array(rows), tuple(passed), np.array(when)


def _steady(family: Family, name: str, times: Array, expected: Signature) -> tuple[Array, float]:
    value = family[name]
    unit = abs(value) if value else 1.0
    try:
        found, _, differs = steady(lambda step: _slope(family, name, times, expected, step * unit), _STEPS)
    except OrderOfEvents as trouble:
        raise _refused(family, name, value, trouble) from trouble
    return found, differs


def _slope(family: Family, name: str, times: Array, expected: Signature, step: float) -> Array:
    """Return the derivatives of the states by a parameter.

    They are differences with one step, one-sided if the parameter has values on one side only.
    """

    def sampled(change: float) -> tuple[Array, Signature]:
        return _states(family.model(**{name: family[name] + change}), times)[:2]

    trouble: InvalidInput | None = None
    for stencil in (CENTRAL, FORWARD, BACKWARD):
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
