"""The times at which a run is looked at, as a user gives them."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import InvalidInput
from nonsmooth.histories.arrays import Floats

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    from nonsmooth.solution.solution import Solution

_History = TypeVar("_History", bound="DataclassInstance")


def read_times(where: str, solution: Solution, times: ArrayLike | None) -> Floats:
    """Return the times, of shape [n] or, of a single one, []; those of the samples if none are given.

    Raises
    ------
    InvalidInput
        If they are not numbers, or the run was not there.
    """
    if times is None:
        return solution.t
    try:
        found = np.array(times, dtype=float)
    except (TypeError, ValueError):
        found = np.full((0, 0), np.nan)
    if found.ndim > 1:
        raise InvalidInput(f"{where}: times", "must be a time or a row of times", times, "Give them in [s].")
    start = min(solution.track.time[0], solution.events.time.min(initial=np.inf))
    outside = found[~((found >= start) & (found <= solution.t_end))]
    if outside.size > 0:
        rule = f"must be within the run, which lasts from {float(start)!r} to {solution.t_end!r} s"
        raise InvalidInput(f"{where}: times", rule, float(outside.flat[0]), "Run longer, or ask for times of this run.")
    return found


def spoken(time: Floats) -> str:
    """Return in words how many times there are."""
    if time.ndim == 0:
        return f"t = {time:.9g} s"
    return f"{len(time)} times, {time.min():.9g} to {time.max():.9g} s" if len(time) > 0 else "no times"


def of_one(history: _History) -> _History:
    """Return a history of one time without the axis of times."""
    arrays = {field.name: getattr(history, field.name) for field in dataclasses.fields(history)}
    return dataclasses.replace(history, **{n: a[0] for n, a in arrays.items() if isinstance(a, np.ndarray)})
