"""Positions of the numbers of an event in the buffers that Python reads: a row of floats and a row of integers."""

from __future__ import annotations

from nonsmooth.engine.memory.blocks import CANDIDATE

TIME, DRIVEN_WORK, RESTITUTION_LOSS, FRICTION_LOSS, CLOSING_LOSS = range(5)
"""Offsets of the floats at the head of an event: its time [s] and its energies [J]."""
EVENT_HEAD = 5
"""Number of floats at the head of an event.

Behind the head are the coordinates, the velocities before and after, the energy accounts and inner states, the totals
of energies, and :data:`LISTED` floats of each contact that is closed before, during or after the event.
"""
IMPULSES, SLIP_DIRECTION, CLOSED_WITH, FACING, AVERAGED, FEATURES = 0, 3, 5, 6, 7, 8
"""Offsets in the floats that an event stores for one contact, from which a run can resume.

``IMPULSES``: normal and two tangential impulses [N s]. ``SLIP_DIRECTION``: unit vector, 2 floats. ``CLOSED_WITH``: rate
at which the contact last closed [m/s]. ``FACING``: 1 or -1, the sense of slip, forward or backward along the axis of an
anisotropic friction law, whose friction ratio applies. ``AVERAGED``: mode of the contact after the time-stepping
fallback. ``FEATURES``: pair of features of the contact, if a search chose it.
"""
LISTED = FEATURES + CANDIDATE
"""Number of floats that an event stores for one contact."""
CAUSE, CONTACT, PHASES, TRUNCATED, N_LISTED = range(5)
"""Offsets of the integers at the head of an event.

In this order: cause, contact or guard that caused it, number of phases of its impact (0 for other events), whether the
impact was cut short, number of contacts that follow.
"""
CODE_HEAD = 5
"""Number of integers at the head of an event. Number and mode bits of each stored contact follow."""
MOST_EVENTS = 204
"""Largest number of events that one instant may record, for which the buffers must have space.

There are 200 attempts to find the modes after the instant, one event each, and up to 4 events before and after them.
"""
