"""A piece of a run from one state to another, and the events that it passed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.engine.memory.modes import CAUSES, Cause
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State

Signature = tuple[tuple[int, int], ...]
"""Cause and contact of each event."""


@final
@dataclass(frozen=True)
class Passage:
    """Where a piece of a run ended.

    Attributes
    ----------
    state : State
        Its end.
    signature : Signature
        The events behind the start, in order.
    times : tuple of float
        When they were [s].
    """

    state: State
    signature: Signature
    times: tuple[float, ...]


def passage(model: Model, start: State, t_end: float) -> Passage:
    """Run a model from a state to a time [s].

    Raises
    ------
    RunFailed
        If it cannot go on.
    KeyboardInterrupt
        If it was interrupted: half a piece is none.
    """
    run = model.run(t_end, start=start, sample_interval=t_end - start.time)
    if run.status == "interrupted":
        raise KeyboardInterrupt
    events = run.events
    kept = events.cause != Cause.START
    told = zip(events.cause[kept].tolist(), events.contact[kept].tolist(), strict=True)
    return Passage(run.state, tuple(told), tuple(events.time[kept].tolist()))


def named(signature: Signature, model: Model, most: int = 4) -> str:
    """Return the words for some events."""
    names = model.system.names
    words = []
    for cause, i in signature[:most]:
        known = names.guards if cause == Cause.GUARD else names.contacts
        words.append(f"{CAUSES[cause]} of {known[i]!r}" if i >= 0 else CAUSES[cause])
    more = [f"{len(signature) - most} more"] if len(signature) > most else []
    return ", ".join([*words, *more]) or "none"
