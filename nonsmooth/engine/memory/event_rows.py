"""Where the numbers of an event are in the buffers that Python reads: a row of floats, and a row of integers."""

from __future__ import annotations

from nonsmooth.engine.memory.blocks import CANDIDATE

TIME, DRIVEN_WORK, RESTITUTION_LOSS, FRICTION_LOSS, CLOSING_LOSS = range(5)
"""Offsets of the floats at the head of an event: its time [s] and its energies [J]."""
EVENT_HEAD = 5
"""Number of floats at the head of an event.

Coordinates follow, velocities before and after, the energy accounts and inner states, the totals of energies, and
:data:`LISTED` floats of each contact that takes part.
"""
IMPULSES, SLIP_DIRECTION, CLOSED_WITH, FACING, AVERAGED, FEATURES = 0, 3, 5, 6, 7, 8
"""Offsets of the parts of a contact's floats in an event."""
LISTED = FEATURES + CANDIDATE
"""Number of floats of a contact in an event."""
CAUSE, CONTACT, PHASES, TRUNCATED, N_LISTED = range(5)
"""Offsets of the integers at the head of an event. An impact that was cut short is truncated."""
CODE_HEAD = 5
"""Number of integers at the head of an event. Number and code of each contact that takes part follow."""
MOST_EVENTS = 204
"""Most events that one instant may record: one for every attempt to settle it, and those before and after."""
