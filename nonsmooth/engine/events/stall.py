"""Event accumulation at a contact: whether so many events come in so little time that the run is stalled.

Bounces end as soon as they are twice as short as the contact time, so a contact should not have many events within a
part of it. Events are counted per contact. Many events elsewhere in a large system are no accumulation.
"""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, kernel

_MOST_EVENTS = 100
"""Most events of one contact within a burst that are no accumulation."""
_BURST = 1e-2
"""Length of a burst of events, relative to the contact time."""


@kernel("b1(ws, i8)")
def is_stalled(ws: Workspace, c: int) -> bool:
    """Count an event of contact ``c``. True if it has so many within a burst that time hardly passes."""
    contact = ws.contacts[c]
    if abs(ws.island.time - contact.burst_start) > max(ws.tolerance.time, _BURST * contact.contact_time):
        contact.burst_start, contact.burst_events = ws.island.time, 0
    contact.burst_events += 1
    return contact.burst_events > _MOST_EVENTS
