"""Writing samples and events to the buffers that Python empties between calls."""

from __future__ import annotations

from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.engine.memory.modes import AFTER, BEFORE, DURING, Cause, Mode, Truncation
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.vectors import length

TIME, DRIVEN_WORK, RESTITUTION_LOSS, FRICTION_LOSS, CLOSING_LOSS = range(5)
"""Which float at the head of an event is which."""
EVENT_HEAD = 5
"""Floats at the head of an event.

Coordinates follow, velocities before and after, what else is integrated, what is booked, and :data:`LISTED` floats of
each contact listed.
"""
IMPULSES, SLIP_DIRECTION, CLOSED_WITH, FACING, AVERAGED, FEATURES = 0, 3, 5, 6, 7, 8
"""Where what is kept of a contact begins among its floats with an event,"""
LISTED = FEATURES + CANDIDATE
"""which are so many."""
CAUSE, CONTACT, PHASES, TRUNCATED, N_LISTED = range(5)
"""Which integer at the head of an event is which; truncated is a cascade that was cut short."""
CODE_HEAD = 5
"""Integers at the head of an event.

Contact and code of each of these follow, and their impulses at the end of the floats.
"""
MOST_EVENTS = 204
"""Events that one instant may record: one for every attempt to settle it, and those before and after."""


@kernel("i8(ws, i8)")
def mode_code(ws: Workspace, c: int) -> int:
    """Return the bits a + 2 b + 4 c of Eq. (29) of contact ``c`` in its present mode."""
    mode = ws.contacts[c].mode
    if mode == Mode.OPEN:
        return 0
    return 5 if mode == Mode.SLIDE else 1


@kernel("i8(ws, i8)")
def impact_code(ws: Workspace, c: int) -> int:
    """Return the bits of contact ``c`` at the start of an impact, from its rates."""
    contact = ws.contacts[c]
    if not contact.is_touching:
        return 0
    bits = 1
    if contact.rate[0] < -ws.tolerance.velocity:
        bits += 2
    if length(contact.slip) > ws.tolerance.velocity:
        bits += 4
    return bits


@entry_point()
def remember(ws: Workspace) -> None:
    """Keep modes and velocities as they are before an event, and clear its account."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        contact.code_before = mode_code(ws, c)
        contact.code_during = contact.code_before
        contact.was_averaged = contact.is_averaged
        for r in range(3):
            contact.event_impulse[r] = 0.0
    for i in range(ws.model.n_u):
        ws.event.u_before[i] = ws.island.y[ws.model.n_q + i]
    for i in range(1, EVENT_HEAD):
        ws.event.head[i] = 0.0


@kernel("i8(ws, i8)")
def _list_contacts(ws: Workspace, which: int) -> int:
    """List the contacts that an event is about: all that are or were closed, and the one that caused it."""
    n = 0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if c == which or contact.code_before + contact.code_during + mode_code(ws, c) > 0:
            ws.event.listed[n] = c
            n += 1
    return n


@kernel("void(ws, i8)")
def _write_accounts(ws: Workspace, out: int) -> None:
    """Write the energies booked so far that are not integrated with the state."""
    ws.floats[out], ws.floats[out + 1] = ws.totals.driven_work, ws.totals.restitution_loss
    ws.floats[out + 2], ws.floats[out + 3] = ws.totals.friction_loss, ws.totals.closing_loss


@kernel("void(ws, i8, i8)")
def _write_contact(ws: Workspace, c: int, out: int) -> None:
    """Write the impulses of contact ``c`` and what it needs to go on from here."""
    contact = ws.contacts[c]
    for r in range(3):
        ws.floats[out + IMPULSES + r] = contact.event_impulse[r]
    ws.floats[out + SLIP_DIRECTION], ws.floats[out + SLIP_DIRECTION + 1] = contact.direction
    ws.floats[out + CLOSED_WITH], ws.floats[out + FACING] = contact.closing_rate, float(contact.facing)
    ws.floats[out + AVERAGED] = float(contact.mode_after_averaging.value)
    candidate = contact.features
    for r in range(CANDIDATE):
        ws.floats[out + FEATURES + r] = ws.floats[candidate + r] if candidate > 0 else 0.0


@entry_point("void(ws, Cause, i8, i8)")
def record_event(ws: Workspace, cause: Cause, which: int, phases: int) -> None:
    """Append an event with what was remembered before it and the modes after it."""
    ws.event.n_recorded += 1
    n = _list_contacts(ws, -1 if cause == Cause.GUARD else which)
    width = EVENT_HEAD + ws.model.n_u + ws.model.n_y + BOOKED + LISTED * n
    ws.output.last_floats, ws.output.last_integers = ws.output.floats_used, ws.output.integers_used
    row = ws.output.event_numbers.start + ws.output.floats_used
    ws.event.head[TIME] = ws.island.time
    for i in range(EVENT_HEAD):
        ws.floats[row + i] = ws.event.head[i]
    row += EVENT_HEAD
    for i in range(ws.model.n_q):
        ws.floats[row + i] = ws.island.y[i]
    row += ws.model.n_q
    for i in range(ws.model.n_u):
        ws.floats[row + i] = ws.event.u_before[i]
        ws.floats[row + ws.model.n_u + i] = ws.island.y[ws.model.n_q + i]
    row += 2 * ws.model.n_u
    for i in range(ws.model.n_q + ws.model.n_u, ws.model.n_y):
        ws.floats[row] = ws.island.y[i]
        row += 1
    _write_accounts(ws, row)
    row += BOOKED
    codes = ws.output.event_codes.start + ws.output.integers_used
    ws.integers[codes + CAUSE], ws.integers[codes + CONTACT], ws.integers[codes + PHASES] = cause, which, phases
    if which >= 0 and cause != Cause.GUARD:
        ws.integers[codes + CONTACT] = ws.contacts[which].declared
    ws.integers[codes + TRUNCATED] = 1 if ws.event.truncation != Truncation.NONE and phases > 0 else 0
    ws.integers[codes + N_LISTED] = n
    for i in range(n):
        c = ws.event.listed[i]
        contact = ws.contacts[c]
        _write_contact(ws, c, row + LISTED * i)
        ws.integers[codes + CODE_HEAD + 2 * i] = contact.declared
        before, during, after = contact.code_before << BEFORE, contact.code_during << DURING, mode_code(ws, c) << AFTER
        ws.integers[codes + CODE_HEAD + 2 * i + 1] = before | during | after
    ws.output.last_cause, ws.output.last_contact, ws.output.last_phases = cause, which, phases
    if ws.request.n_known_events > 0:
        # a run that is continued repeats what led to its state, and has told of it
        ws.request.n_known_events -= 1
        return
    ws.output.floats_used += width
    ws.output.integers_used += CODE_HEAD + 2 * n
    ws.output.n_events += 1


@kernel()
def amend_last(ws: Workspace) -> None:
    """Write the last event anew, with the modes that the instant ended in and its final velocities."""
    if ws.output.n_events == 0 or ws.output.floats_used == ws.output.last_floats:
        return
    ws.output.floats_used, ws.output.integers_used = ws.output.last_floats, ws.output.last_integers
    ws.output.n_events -= 1
    ws.event.n_recorded -= 1
    record_event(ws, ws.output.last_cause, ws.output.last_contact, ws.output.last_phases)


@entry_point("i8(ws)")
def begin_sample(ws: Workspace) -> int:
    """Append a sample of the time ``next_sample``, and set the next; return where in ``w`` its state is to be put."""
    row = ws.output.samples.start + ws.output.n_samples * (1 + ws.model.n_y + BOOKED)
    ws.floats[row] = ws.output.next_sample
    _write_accounts(ws, row + 1 + ws.model.n_y)
    ws.output.n_samples += 1
    ws.output.sample_index += 1
    ws.output.next_sample = ws.request.sample_start + ws.output.sample_index * ws.request.sample_interval
    return int(row + 1)


@kernel("void(ws, f8)")
def record_samples(ws: Workspace, h: float) -> None:
    """Append the samples that fall into the part ``h`` of the step from ``t`` whose slopes are at hand."""
    while ws.output.next_sample <= ws.island.time + h and ws.output.n_samples < ws.model.sample_capacity:
        theta = (ws.output.next_sample - ws.island.time) / ws.step.h
        state_within(ws, ws.step.h, min(1.0, max(0.0, theta)), begin_sample(ws))
