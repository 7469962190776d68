"""The flow of a model from one state to a later one, and the events on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.engine.memory.modes import CAUSES, Cause
from nonsmooth.runs.model import Model
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State
from nonsmooth.types import Array

Signature = tuple[tuple[int, int], ...]
"""Cause of each event, and number of its contact (or of its guard), in the order of the events."""


@final
@dataclass(frozen=True)
class FlowSegment:
    """A run from one state to another.

    Attributes
    ----------
    state : State
        State at the end of the run.
    signature : Signature
        The events after the start, in order.
    times : tuple of float
        Times of these events [s].
    """

    state: State
    signature: Signature
    times: tuple[float, ...]


def flow(model: Model, start: State, t_end: float) -> FlowSegment:
    """Run a model from a state to a time [s].

    Raises
    ------
    RunFailed
        If the run cannot continue.
    KeyboardInterrupt
        If the run was interrupted before its end.
    """
    run = completed(model.run(t_end, start=start, sample_interval=t_end - start.time))
    times, signature = events_of(run)
    return FlowSegment(run.state, signature, tuple(times.tolist()))


def completed(run: Solution) -> Solution:
    """Return a run unchanged; raise KeyboardInterrupt if it was interrupted."""
    if run.status == "interrupted":
        raise KeyboardInterrupt
    return run


def events_of(run: Solution) -> tuple[Array, Signature]:
    """Return the times [s], shape [n], and the causes and contacts of all events of a run except its start."""
    events = run.events
    kept = events.cause != Cause.START
    signature = zip(events.cause[kept].tolist(), events.contact[kept].tolist(), strict=True)
    return events.time[kept], tuple(signature)


def named(signature: Signature, model: Model, most: int = 4) -> str:
    """Return the first ``most`` events of a signature in words, and the number of further events."""
    names = model.system.names
    words = []
    for cause, i in signature[:most]:
        known = names.guards if cause == Cause.GUARD else names.contacts
        words.append(f"{CAUSES[cause]} of {known[i]!r}" if i >= 0 else CAUSES[cause])
    more = [f"{len(signature) - most} more"] if len(signature) > most else []
    return ", ".join([*words, *more]) or "none"
