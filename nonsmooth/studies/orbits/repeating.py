"""Whether what drives a system repeats after a period."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.passage import passage

_SAME = 1e-6
"""Largest difference of the same motion a period later, in units of scales: tolerances of runs leave less."""
_TRIES = 3
"""Periods of which one must agree: rounding may decide the order of simultaneous impacts in one of them."""

Period = float | Callable[[float], float]
"""A period [s], or a function that returns it for a value of the parameter."""


def period_at(period: Period, value: float) -> float:
    """Return the period at a value of the parameter [s]."""
    return float(period(value)) if callable(period) else period


def check_period(model: Model, state: State, period: float, thing: str) -> None:
    """Check that a motion from a state is the same if it begins a period later.

    A period that stays while a parameter changes the frequency of the drive fails this.  The state is one of a motion,
    so that closed contacts stay closed a period later.

    Raises
    ------
    InvalidInput
        If the motions differ.
    """
    scales = np.concatenate([body.scales[i] for i in (0, 1) for body in model.system.bodies])
    for _ in range(_TRIES):
        end = passage(model, state, state.time + period).state
        try:
            later = passage(model, replace(state, time=end.time), end.time + period).state
        except (InvalidInput, RunFailed):
            # the bodies overlap, or the closed contacts are open there
            off = np.inf
        else:
            off = float(np.max(np.abs(np.concatenate([later.q - end.q, later.u - end.u]) / scales), initial=0.0))
        if off <= _SAME:
            return
        state = end
    rule = f"must be one of the system, but the same motion begun a period later differs by {off:.2g} of its size"
    remedy = "If the parameter changes the frequency, give a function: period=lambda value: ... [s]."
    raise InvalidInput(thing, rule, f"{period:.9g}", remedy)
