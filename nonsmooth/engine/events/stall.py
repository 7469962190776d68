"""Whether time goes on passing: how many events a contact has within what part of its contact time."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Workspace, kernel

_EVENTS = 100
"""More events of one contact than these"""
_TIME = 1e-2
"""within this part of its contact time are a stall: bounces close where they become as short as twice that time."""


@kernel("b1(ws, i8)")
def is_stalled(ws: Workspace, c: int) -> bool:
    """Count an event of contact ``c``; return 1 if it has so many that time hardly passes.

    Counted are those of each contact for itself, so that what happens elsewhere tells nothing of it.
    """
    contact = ws.contacts[c]
    if abs(ws.island.time - contact.burst_start) > max(ws.tolerance.time, _TIME * contact.contact_time):
        contact.burst_start, contact.burst_events = ws.island.time, 0
    contact.burst_events += 1
    return contact.burst_events > _EVENTS
