"""When most of the imbalance of an energy account arose, and at which bodies.

The imbalance is a function of time. Most of it arises between its least and its greatest value. The bodies named are
those of contacts of the time-stepping fallback in that span, because it solves for mean forces only. Without such
contacts they are the bodies of all contacts of the events.
"""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput
from nonsmooth.solution.events import Events
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import Floats, Integers

_NEGLIGIBLE = 0.1
"""Part of the largest change of the imbalance that may lie outside of the span at each end. It shortens the span."""
_MODE_AFTER_FALLBACK = 4
"""Column of ``Events.listed_memory`` with the mode after the time-stepping fallback, open without it."""
_N_NAMED = 4
"""Largest number of bodies that the message names."""


def imbalance_span(solution: Solution) -> str:
    """Sentence with the span of time in which most of the imbalance arose, and the bodies in contact, or "".

    The imbalance [J] is the change of energy that no work and no loss explains, a function of time.
    """
    events = solution.events
    times = np.unique(np.concatenate([solution.t, events.time, [solution.t_end]]))
    try:
        imbalance = solution.history("unexplained_energy", times=times)["unexplained_energy"]
    except InvalidInput:
        # contacts were declared since the run
        return ""
    first, last = _span(imbalance)
    if first == last:
        # the imbalance is constant
        return ""
    span = f"Most of it came about from t = {times[first]:.9g} s to {times[last]:.9g} s"
    contacts, has_fallback = _contacts_within(events, times[first], times[last])
    if len(contacts) == 0:
        return f"{span}."
    pairs = [solution.system.contacts[number] for number in np.unique(contacts).tolist()]
    # the free bodies, each of them once
    bodies = {id(body): body for one in pairs for body in (one.first, one.second) if body.n_u > 0}
    names = [repr(solution.system.name_of(body)) for body in bodies.values()]
    more = f" and {len(names) - _N_NAMED} more" if len(names) > _N_NAMED else ""
    where = "in the time-stepping fallback" if has_fallback else "in contacts"
    return f"{span}, {where} of {', '.join(names[:_N_NAMED])}{more}."


def _span(imbalance: Floats) -> tuple[int, int]:
    """First and last index of the span between the least and the largest value of an imbalance [J].

    Both ends move inward as long as the value there is within a tenth of the whole change.
    """
    first, last = sorted((int(np.argmin(imbalance)), int(np.argmax(imbalance))))
    if first == last:
        return first, last
    # the span begins at the last index near its first value, and ends at the first index near its last value
    within, negligible = imbalance[first : last + 1], _NEGLIGIBLE * float(np.ptp(imbalance))
    last = first + int(np.argmax(np.abs(within - within[-1]) <= negligible))
    first += int(np.flatnonzero(np.abs(within - within[0]) <= negligible)[-1])
    return first, last


def _contacts_within(events: Events, begin: float, end: float) -> tuple[Integers, bool]:
    """Contacts of the events from ``begin`` to ``end`` [s], and whether they are those of the fallback.

    If any is in the time-stepping fallback, which solves for mean forces, only those are in the result.
    """
    # the last event before the span shows the contacts at its beginning
    first = max(0, int(np.searchsorted(events.time, begin, side="right")) - 1)
    last = int(np.searchsorted(events.time, end, side="right"))
    # events.first has the first entry of each event in the list of contacts, then the end of the list; without events
    # the range is empty
    entries = slice(*events.first[[first, max(first, last)]].tolist()) if len(events) else slice(0)
    contacts = events.listed[entries]
    in_fallback = contacts[events.listed_memory[entries, _MODE_AFTER_FALLBACK] != Mode.OPEN]
    return (in_fallback, True) if len(in_fallback) else (contacts, False)
