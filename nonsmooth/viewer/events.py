"""Events of a run for the player: mode words, and arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import AFTER, BEFORE, CODE, DURING
from nonsmooth.histories.impulses import Impulses
from nonsmooth.histories.request import Request

if TYPE_CHECKING:
    from nonsmooth.solution.events import Events
    from nonsmooth.solution.solution import Solution

_MOST_LETTERS = 12
"""Largest number of contacts with a mode word; modes of more contacts are listed by contact."""
_MOST_NUMBERS = 6
"""Largest number of contacts that are listed by their numbers."""
_STICKS, _SLIDES, _HITS = 1, 5, 2
"""Codes of Eq. (29) of a sticking and a sliding contact, and the bit of a contact that takes part in an impact."""


def event_words(events: Events) -> tuple[list[str], NDArray[np.int64]]:
    """Words for modes, and the index of the word before, during and after each event, shape [n, 3].

    With many contacts, a word lists the closed contacts only.
    """
    rows = [_words(events, which, shift) for which, shift in (("before", BEFORE), ("during", DURING), ("after", AFTER))]
    spelled, numbers = np.unique([word for row in rows for word in row], return_inverse=True)
    return spelled.tolist(), np.asarray(numbers).reshape(3, len(events)).T


def _words(events: Events, which: str, shift: int) -> list[str]:
    if events.n_contacts <= _MOST_LETTERS:
        return events.words(which)
    bits = events.codes >> shift & CODE
    return [_spoken(events.listed[a:b], bits[a:b]) for a, b in zip(events.first[:-1], events.first[1:], strict=True)]


def _spoken(contacts: NDArray[np.int64], bits: NDArray[np.int64]) -> str:
    groups = (
        ("sticking", contacts[bits == _STICKS]),
        ("sliding", contacts[bits == _SLIDES]),
        ("colliding", contacts[bits & _HITS > 0]),
    )
    return "; ".join(f"{word} {_counted(group)}" for word, group in groups if len(group)) or "all open"


def _counted(group: NDArray[np.int64]) -> str:
    """Numbers of contacts, from 1; the first ones if there are many."""
    said = " ".join(str(i + 1) for i in sorted(group.tolist())[:_MOST_NUMBERS])
    return said if len(group) <= _MOST_NUMBERS else f"{said} and {len(group) - _MOST_NUMBERS} more"


def event_arrays(
    solution: Solution, times: NDArray[np.float64], side: NDArray[np.float64]
) -> dict[str, tuple[str, NDArray[Any]]]:
    """Arrays of events; ``times`` are the knots [s], which contain all instants of events."""
    # an engine that records no contacts has no events, and no impulses
    events, impulses = solution.events, Impulses.recorded(Request(solution, times))
    sign = side[impulses.impulse_contact][:, None]
    push, rub = sign * impulses.normal_impulse[:, None] * impulses.impulse_normal, sign * impulses.friction_impulse
    return {
        "event_time": ("f8", events.time),
        "event_knot": ("i4", np.searchsorted(times, events.time)),
        "event_cause": ("u1", events.cause),
        "event_trigger": ("i4", events.contact),
        "event_first": ("i4", events.first),
        "event_contact": ("i4", events.listed),
        "event_codes": ("i2", events.codes),
        "event_point": ("f4", np.nan_to_num(impulses.impulse_point.mean(axis=1))),
        "event_push": ("f4", np.nan_to_num(push)),
        "event_rub": ("f4", np.nan_to_num(rub)),
    }
