"""Whether what drives a system repeats after a period."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from nonsmooth.checks import is_finite
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.passage import passage

_SAME = 1e-6
"""Largest difference of the same motion a period later, in units of scales: tolerances of runs leave less."""
_TRIES = 3
"""Periods of which one must agree: rounding may decide the order of simultaneous impacts in one of them."""
_MOST = 8
"""Periods at most until one has a contact: the drive may act on a body through contacts only."""

Period = float | Callable[[float], float]
"""A period [s], or a function that returns it for a value of the parameter."""


FUNCTION = (
    "If the parameter changes the frequency, give period=lambda value: ... [s]; on the command line --period 1/NAME."
)
"""What to do about a period that does not fit."""


def period_at(period: Period, value: float, thing: str) -> float:
    """Return the period at a value of the parameter [s].

    Raises
    ------
    InvalidInput
        If the period there is zero, negative or not a finite number.
    """
    found = period(value) if callable(period) else period
    if not (is_finite(found) and found > 0.0):
        there = f" at the value {value:.9g}" if callable(period) else ""
        raise InvalidInput(thing, f"must be positive and finite{there}", found, "Give it in [s].")
    return float(found)


def check_counts(thing: str, **counts: int) -> None:
    """Check numbers of periods.

    Raises
    ------
    InvalidInput
        If one is not a positive whole number.
    """
    for word, count in counts.items():
        if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 1:
            rule = "must be positive and a whole number of periods"
            raise InvalidInput(f"{thing}: {word}", rule, count, f"For example {word}=64.")


def check_period(model: Model, state: State, period: float, thing: str, remedy: str = FUNCTION) -> None:
    """Check that a motion from a state is the same if it begins a period later.

    A period that stays while a parameter changes the frequency of the drive fails this.  The state is one of a motion,
    so that closed contacts stay closed a period later.  A motion that cannot continue for a period passes.

    Parameters
    ----------
    model : Model
        The model.
    state : State
        Where the motion begins.
    period : float
        [s].
    thing, remedy : str
        What the error names, and what to do about it.

    Raises
    ------
    InvalidInput
        If the motions differ.
    """
    scales = np.concatenate([body.scales[i] for i in (0, 1) for body in model.system.bodies])
    misses = list[float]()
    for _ in range(_MOST):
        try:
            one = passage(model, state, state.time + period)
        except (InvalidInput, RunFailed):
            return
        end = one.state
        try:
            later = passage(model, replace(state, time=end.time), end.time + period).state
        except (InvalidInput, RunFailed):
            # the bodies overlap, or the closed contacts are open there
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
