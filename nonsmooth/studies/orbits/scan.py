"""Runs of a driven system over the values of a parameter, and the period of its drive."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.interfaces import Motion
from nonsmooth.progress import Display, RunsDone
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import scales_of
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.flow import flow
from nonsmooth.studies.inputs import check_positive, meter
from nonsmooth.system.system import System

Found = TypeVar("Found")
Period = float | Callable[[float], float]
"""A period [s], or a function from the value of the parameter to the period."""
FREQUENCY_REMEDY = (
    "If the parameter changes the frequency, give period=lambda value: ... [s]; on the command line --period 1/NAME."
)
_SAME = 1e-6
"""Two motions from one state, which begin a period apart, are equal if they differ by at most this.

It is relative to the scales of the coordinates, and larger than the errors of runs.
"""
_TRIES = 3
"""Number of periods with different motions at which the check of a period fails.

In each period, two motions from one state are compared that begin one period apart.  The check passes if they agree in
one period, because in a single period rounding may decide the order of simultaneous impacts.
"""
_MOST = 8
"""Largest number of periods in which the check of a period compares two motions.

A period without contact does not count, because the drive may act on a body through contacts only.
"""


def scan(
    family: Family,
    name: str,
    values: Sequence[float],
    find: Callable[[Model, float], Found],
    nothing: Found,
    display: Display | None,
) -> tuple[list[Found], tuple[str, ...]]:
    """Return the results for all values of a parameter, and the reasons of failures, "" for a run that succeeds.

    Parameters
    ----------
    family : Family
        The systems.
    name : str
        The parameter.
    values : sequence of float
        Its values.
    find : callable
        ``find(model, value)`` runs the model of a value; it may raise RunFailed or InvalidInput.
    nothing : object
        The result of a run that fails.
    display : Display, optional
        Where progress is shown; on standard error by default.

    Raises
    ------
    UnknownName
        If the family has no parameter of this name.
    InvalidInput
        If `values` is empty, or the runs at all values are refused.
    """
    _ = family[name]
    if not len(values):
        raise InvalidInput(f"values of {name}", "must be some", list(values), "Give at least one.")
    found, failures, refused = list[Found](), list[str](), list[InvalidInput]()
    with meter(display) as shown:
        counted = RunsDone(shown, len(values))
        for value in values:
            try:
                found.append(find(family.model(**{name: value}), value))
                failures.append("")
            except (RunFailed, InvalidInput) as error:
                found.append(nothing)
                failures.append(str(error))
                refused += [error] if isinstance(error, InvalidInput) else []
            counted.add(1, bool(failures[-1]))
    if len(refused) == len(values):
        raise refused[0]
    return found, tuple(failures)


def period_at(period: Period, value: float, thing: str) -> float:
    """Return the period at a value of the parameter [s].

    Raises
    ------
    InvalidInput
        If the period there is zero, negative or not a finite number.
    """
    found = period(value) if callable(period) else period
    there = f" at the value {value:.9g}" if callable(period) else ""
    check_positive(thing, found, "Give it in [s].", f"must be positive and finite{there}")
    return float(found)


def drive_periods(system: System) -> set[float]:
    """Return the periods of the driven bodies of a system [s], as far as their motions tell them."""
    motions = (getattr(body, "motion", None) for body in system.bodies)
    return {one.period for one in motions if isinstance(one, Motion) and one.period is not None}


def check_period(model: Model, state: State, period: float, thing: str, remedy: str = FREQUENCY_REMEDY) -> None:
    """Check that a system has a given period: a motion from a state must be the same if it begins a period later.

    The check fails if a parameter has changed the frequency of the drive, but not the period.  It also fails if no
    motion can begin a period later, because a driven body has moved away or overlaps.  A motion that cannot continue
    for a period passes the check.

    Parameters
    ----------
    model : Model
        The model.
    state : State
        State in which the motion begins.
    period : float
        The period [s].
    thing, remedy : str
        Subject and remedy of the error.

    Raises
    ------
    InvalidInput
        If the motions differ.
    """
    scales, misses = scales_of(model.system), list[float]()
    for _ in range(_MOST):
        try:
            one = flow(model, state, state.time + period)
        except (InvalidInput, RunFailed):
            return
        end = one.state
        try:
            later = flow(model, replace(state, time=end.time), end.time + period).state
        except (InvalidInput, RunFailed):
            # the motion cannot begin a period later, as bodies overlap or closed contacts open: an infinite difference
            off = np.inf
        else:
            off = float(np.max(np.abs(np.concatenate([later.q - end.q, later.u - end.u]) / scales), initial=0.0))
        acts = not len(state.modes) or bool(one.signature) or bool(np.any(state.modes != Mode.OPEN))
        if off <= _SAME and acts:
            return
        misses += [off] if off > _SAME else []
        if len(misses) == _TRIES:
            break
        state = end
    if misses:
        known = [off for off in misses if off < np.inf]
        how = f"differs by {max(known):.2g} of its size" if known else "cannot begin, as a closed contact moves away"
        rule = f"must be one of the system, where the same motion a period later {how}"
        raise InvalidInput(thing, rule, float(f"{period:.9g}"), remedy)
