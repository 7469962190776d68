"""Positions of the numbers of an event in the buffers that Python reads: a row of floats and a row of integers."""

from __future__ import annotations

from nonsmooth.engine.memory.blocks import CANDIDATE

TIME, DRIVEN_WORK, RESTITUTION_LOSS, FRICTION_LOSS, CLOSING_LOSS = range(5)
"""Offsets of the floats at the head of an event: its time [s] and its energies [J]."""
EVENT_HEAD = 5
"""Number of floats at the head of an event.

Behind the head are the coordinates, the velocities before and after, the energy accounts and inner states, the totals
of energies, and :data:`LISTED` floats of each contact that takes part.
"""
IMPULSES, SLIP_DIRECTION, CLOSED_WITH, FACING, AVERAGED, FEATURES = 0, 3, 5, 6, 7, 8
"""Offsets of the parts in the row of floats that an event stores for one contact that takes part."""
LISTED = FEATURES + CANDIDATE
"""Number of floats that an event stores for one contact."""
CAUSE, CONTACT, PHASES, TRUNCATED, N_LISTED = range(5)
"""Offsets of the integers at the head of an event. ``TRUNCATED`` is set if its impact was cut short."""
CODE_HEAD = 5
"""Number of integers at the head of an event. Behind it are number and code of each contact that takes part."""
MOST_EVENTS = 204
"""Most events that one instant may record: one for each attempt to find its modes, and the events before and after."""
