"""The span of time in which most of what an energy account lacks came about, and the bodies in contact there."""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.errors import InvalidInput
from nonsmooth.histories.energies import Energies
from nonsmooth.solution.solution import Solution

_SMALL = 0.1
"""Part of the largest change of what the account lacks that each end of the span leaves out."""
_AVERAGED = 4
"""Column of ``Events.listed_memory`` with the mode in which averaged forces end."""
_NAMED = 4
"""Bodies that are named; the others are counted."""


def imbalance_span(solution: Solution) -> str:
    """Return when an energy account went out of balance, and at which bodies, as a sentence.

    What the account lacks is a function of time.  The span lies between its least and its greatest value.  Bodies are
    those of contacts with averaged forces in that span, or else those of all contacts of its events.
    """
    events = solution.events
    times = np.unique(np.concatenate([solution.t, events.time, [solution.t_end]]))
    try:
        lacking = Energies.of(solution, times).unexplained
    except InvalidInput:
        # contacts were declared since the run
        return ""
    first, last = sorted((int(np.argmin(lacking)), int(np.argmax(lacking))))
    if first == last:
        return ""
    within, small = lacking[first : last + 1], _SMALL * float(np.ptp(lacking))
    last = first + int(np.argmax(np.abs(within - within[-1]) <= small))
    first += int(np.flatnonzero(np.abs(within - within[0]) <= small)[-1])
    span = f"Most of it came about from t = {times[first]:.9g} s to {times[last]:.9g} s"
    begin = max(0, int(np.searchsorted(events.time, times[first], side="right")) - 1)
    end = int(np.searchsorted(events.time, times[last], side="right"))
    entries = slice(*events.first[[begin, max(begin, end)]].tolist()) if len(events) else slice(0)
    contacts = events.listed[entries]
    averaged = contacts[events.listed_memory[entries, _AVERAGED] != OPEN]
    found = averaged if len(averaged) else contacts
    if len(found) == 0:
        return f"{span}."
    pairs = [solution.system.contacts[number] for number in np.unique(found).tolist()]
    bodies = {id(body): body for one in pairs for body in (one.first, one.second) if body.n_u > 0}
    names = [repr(solution.system.name_of(body)) for body in bodies.values()]
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    why = "with averaged forces" if len(averaged) else "in contacts"
    return f"{span}, {why} of {', '.join(names[:_NAMED])}{more}."
