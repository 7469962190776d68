"""Where in a period a motion is looked at: while no contact is closed, or as few as can be."""

from __future__ import annotations

import numpy as np

from nonsmooth.runs.model import Model
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.passage import passage

_LOOKED_AT = 200
"""Times of a period among which one is chosen."""
_CLOSED, _SLIDES = 1, 4
"""Bits of Eq. (29)."""


def chosen(model: Model, begin: State, period: float) -> State:
    """Return a state in the period behind a state, far from all events.

    That is where the least gap of all contacts is largest; where something is closed all the time, where least is held,
    and of that in the middle between events.
    """
    times = begin.time + period * (np.arange(_LOOKED_AT) + 0.5) / _LOOKED_AT
    run = model.run(begin.time + period, start=begin, sample_interval=period)
    which = np.searchsorted(run.events.time, times, side="right") - 1
    codes = run.events.after[which]
    closed = codes & _CLOSED
    held = np.sum(closed * np.where(codes & _SLIDES, 1, 2), axis=1)
    if np.any(held == 0):
        gaps = run.history("gap", times=times)["gap"].reshape(_LOOKED_AT, -1)
        room = np.where(held > 0, -np.inf, np.min(gaps, axis=1, initial=np.inf))
    else:
        room = np.where(held > np.min(held), -np.inf, _from_events(run, times, period))
    return seen(model, begin, float(times[np.argmax(room)]))


def seen(model: Model, begin: State, time: float) -> State:
    """Return the state of a motion at a time [s]."""
    return passage(model, begin, time).state if time > begin.time else begin


def at_phase(model: Model, begin: State, period: float, at: float) -> State:
    """Return the first state of a motion at a time within each period [s]."""
    return seen(model, begin, begin.time + (at - begin.time) % period)


def _from_events(run: Solution, times: np.ndarray, period: float) -> np.ndarray:
    """Return how far times are from the events of a motion that repeats [s]."""
    apart = np.abs(times[:, None] - run.events.time[1:])
    return np.asarray(np.min(np.minimum(apart, np.abs(period - apart)), axis=1, initial=np.inf))
