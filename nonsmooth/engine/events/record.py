"""Writing samples and events to the buffers that Python empties between calls."""

from __future__ import annotations

from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.engine.memory.modes import AFTER, BEFORE, DURING, GUARD, OPEN, SLIDE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, entry_point, kernel
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


@kernel("i8(S, F, I, i8)")
def code(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return the bits a + 2 b + 4 c of Eq. (29) of contact ``c`` in its present mode."""
    mode = contact_at(S, w, k, c).mode
    if mode == OPEN:
        return 0
    return 5 if mode == SLIDE else 1


@kernel("i8(S, F, I, i8)")
def impact_code(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return the bits of contact ``c`` at the start of an impact, from its rates."""
    contact = contact_at(S, w, k, c)
    if contact.touching == 0:
        return 0
    bits = 1
    if contact.rate[0] < -S.velocity_tolerance:
        bits += 2
    if length(contact.slip) > S.velocity_tolerance:
        bits += 4
    return bits


@entry_point()
def remember(S: Scalars, w: Floats, k: Integers) -> None:
    """Keep modes and velocities as they are before an event, and clear its account."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.code_before = code(S, w, k, c)
        contact.code_during = contact.code_before
        contact.averaged_before = contact.averaged
        for r in range(3):
            contact.event_impulse[r] = 0.0
    for i in range(S.n_u):
        w[S.u_before + i] = w[S.y + S.n_q + i]
    for i in range(1, EVENT_HEAD):
        w[S.event_head + i] = 0.0


@kernel("i8(S, F, I, i8)")
def _list_event(S: Scalars, w: Floats, k: Integers, which: int) -> int:
    """List the contacts that an event is about: all that are or were closed, and the one that caused it."""
    n = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if c == which or contact.code_before + contact.code_during + code(S, w, k, c) > 0:
            k[S.listed + n] = c
            n += 1
    return n


@kernel("void(S, F, i8)")
def _write_booked(S: Scalars, w: Floats, out: int) -> None:
    """Write the energies booked so far that are not integrated with the state."""
    w[out], w[out + 1] = S.driven_work, S.restitution_loss
    w[out + 2], w[out + 3] = S.friction_loss, S.closing_loss


@kernel("void(S, F, I, i8, i8)")
def _list_contact(S: Scalars, w: Floats, k: Integers, c: int, out: int) -> None:
    """Write the impulses of contact ``c`` and what it needs to go on from here."""
    contact = contact_at(S, w, k, c)
    for r in range(3):
        w[out + IMPULSES + r] = contact.event_impulse[r]
    w[out + SLIP_DIRECTION], w[out + SLIP_DIRECTION + 1] = contact.direction
    w[out + CLOSED_WITH], w[out + FACING] = contact.closing_rate, float(contact.facing)
    w[out + AVERAGED] = float(contact.averaged)
    candidate = contact.candidate
    for r in range(CANDIDATE):
        w[out + FEATURES + r] = w[candidate + r] if candidate > 0 else 0.0


@entry_point("void(S, F, I, i8, i8, i8)")
def record_event(S: Scalars, w: Floats, k: Integers, cause: int, which: int, phases: int) -> None:
    """Append an event with what was remembered before it and the modes after it."""
    S.recorded += 1
    n = _list_event(S, w, k, -1 if cause == GUARD else which)
    width = EVENT_HEAD + S.n_u + S.n_y + BOOKED + LISTED * n
    S.last_floats, S.last_integers = S.floats_used, S.integers_used
    row = S.events + S.floats_used
    w[S.event_head + TIME] = S.t
    for i in range(EVENT_HEAD):
        w[row + i] = w[S.event_head + i]
    row += EVENT_HEAD
    for i in range(S.n_q):
        w[row + i] = w[S.y + i]
    row += S.n_q
    for i in range(S.n_u):
        w[row + i] = w[S.u_before + i]
        w[row + S.n_u + i] = w[S.y + S.n_q + i]
    row += 2 * S.n_u
    for i in range(S.n_q + S.n_u, S.n_y):
        w[row] = w[S.y + i]
        row += 1
    _write_booked(S, w, row)
    row += BOOKED
    codes = S.event_codes + S.integers_used
    k[codes + CAUSE], k[codes + CONTACT], k[codes + PHASES] = cause, which, phases
    if which >= 0 and cause != GUARD:
        k[codes + CONTACT] = contact_at(S, w, k, which).identity
    k[codes + TRUNCATED] = 1 if S.truncated > 0 and phases > 0 else 0
    k[codes + N_LISTED] = n
    for i in range(n):
        c = k[S.listed + i]
        contact = contact_at(S, w, k, c)
        _list_contact(S, w, k, c, row + LISTED * i)
        k[codes + CODE_HEAD + 2 * i] = contact.identity
        before, during, after = contact.code_before << BEFORE, contact.code_during << DURING, code(S, w, k, c) << AFTER
        k[codes + CODE_HEAD + 2 * i + 1] = before | during | after
    S.last_contact = which
    if S.told > 0:
        # a run that is continued repeats what led to its state, and has told of it
        S.told -= 1
        return
    S.floats_used += width
    S.integers_used += CODE_HEAD + 2 * n
    S.n_events += 1


@kernel()
def amend_last(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the last event anew, with the modes that the instant ended in and its final velocities."""
    if S.n_events == 0 or S.floats_used == S.last_floats:
        return
    S.floats_used, S.integers_used = S.last_floats, S.last_integers
    S.n_events -= 1
    S.recorded -= 1
    codes = S.event_codes + S.last_integers
    record_event(S, w, k, k[codes + CAUSE], S.last_contact, k[codes + PHASES])


@entry_point("i8(S, F, I)")
def begin_sample(S: Scalars, w: Floats, k: Integers) -> int:
    """Append a sample of the time ``next_sample``, and set the next; return where in ``w`` its state is to be put."""
    row = S.samples + S.n_samples * (1 + S.n_y + BOOKED)
    w[row] = S.next_sample
    _write_booked(S, w, row + 1 + S.n_y)
    S.n_samples += 1
    S.sample_index += 1
    S.next_sample = S.sample_start + S.sample_index * S.sample_interval
    return int(row + 1)


@kernel("void(S, F, I, f8)")
def record_samples(S: Scalars, w: Floats, k: Integers, h: float) -> None:
    """Append the samples that fall into the part ``h`` of the step from ``t`` whose slopes are at hand."""
    while S.next_sample <= S.t + h and S.n_samples < S.sample_capacity:
        theta = (S.next_sample - S.t) / S.h
        state_within(S, w, k, S.h, min(1.0, max(0.0, theta)), begin_sample(S, w, k))
