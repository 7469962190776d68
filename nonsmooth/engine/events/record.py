"""Recording of events and samples in the buffers that Python reads and empties between calls.

An event is a row of floats and a row of integers. The floats are its head, the state, what was accounted for, and the
numbers of each contact that takes part. The integers are its head, and number and code of each of these contacts. The
code holds the bits of Eq. (29) before, during and after the event. An instant may change its modes several times, so
its last record is written anew when it is settled.
"""

from __future__ import annotations

from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.event_rows import (
    AVERAGED,
    CAUSE,
    CLOSED_WITH,
    CODE_HEAD,
    CONTACT,
    EVENT_HEAD,
    FACING,
    FEATURES,
    IMPULSES,
    LISTED,
    N_LISTED,
    PHASES,
    SLIP_DIRECTION,
    TIME,
    TRUNCATED,
)
from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.engine.memory.modes import AFTER, BEFORE, DURING, NO_CONTACT, Cause, Mode, Truncation
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.vectors import length

NO_PHASES = 0
"""Number of phases of an event that is no impact."""
_CLOSED, _APPROACHES, _SLIPS = 1, 2, 4
"""Bits of the code of a contact in an event, Eq. (29): closed, approaching, slipping."""


@kernel("i8(ContactRecord)")
def mode_code(contact: ContactRecord) -> int:
    """Bits of Eq. (29) of a contact in its present mode (closed, approaches, slips): 0 if it is open."""
    if contact.mode == Mode.OPEN:
        return 0
    return _CLOSED + _SLIPS if contact.mode == Mode.SLIDE else _CLOSED


@kernel("i8(ws, i8)")
def impact_code(ws: Workspace, c: int) -> int:
    """Bits of Eq. (29) of contact ``c`` at the start of an impact (closed, approaches, slips), from its rates."""
    contact = ws.contacts[c]
    if not contact.is_touching:
        return 0
    code = _CLOSED
    if contact.normal_rate < -ws.tolerance.velocity:
        code += _APPROACHES
    if length(contact.slip) > ws.tolerance.velocity:
        code += _SLIPS
    return code


@entry_point()
def begin_event(ws: Workspace) -> None:
    """Store modes and velocities before an event, and set the energies and impulses of the event to zero."""
    for contact in ws.contacts:
        contact.code_before = mode_code(contact)
        contact.code_during = contact.code_before
        contact.was_averaged = contact.is_averaged
        for r in range(3):
            contact.event_impulse[r] = 0.0
    for i in range(ws.model.n_u):
        ws.event.u_before[i] = ws.island.y[ws.model.n_q + i]
    # the first number of the head is the time, which is written with the record
    for i in range(1, EVENT_HEAD):
        ws.event.head[i] = 0.0


@kernel("i8(ws, i8)")
def _list_contacts(ws: Workspace, which: int) -> int:
    """List the contacts that take part in an event: all that are or were closed, and ``which``. Number of contacts.

    ``which`` is ``NO_CONTACT`` if there is none to add.
    """
    n = 0
    for contact in ws.contacts:
        # the code of an open contact is 0
        if contact.index == which or contact.code_before + contact.code_during + mode_code(contact) > 0:
            ws.event.listed[n] = contact.index
            n += 1
    return n


@kernel("void(ws, i8)")
def _write_accounts(ws: Workspace, out: int) -> None:
    """Write the totals of the energies of instants to offset ``out`` [J]: driven work, and the three losses."""
    ws.floats[out], ws.floats[out + 1] = ws.totals.driven_work, ws.totals.restitution_loss
    ws.floats[out + 2], ws.floats[out + 3] = ws.totals.friction_loss, ws.totals.closing_loss


@kernel("void(ws, ContactRecord, i8)")
def _write_contact(ws: Workspace, contact: ContactRecord, out: int) -> None:
    """Write the impulses of a contact in an event, and its state from which a run can resume, to offset ``out``."""
    for r in range(3):
        ws.floats[out + IMPULSES + r] = contact.event_impulse[r]
    ws.floats[out + SLIP_DIRECTION], ws.floats[out + SLIP_DIRECTION + 1] = contact.direction
    ws.floats[out + CLOSED_WITH], ws.floats[out + FACING] = contact.closing_rate, float(contact.facing)
    # OPEN if its forces are not averaged
    ws.floats[out + AVERAGED] = float(contact.mode_after_averaging.value)
    # features: offset of the pair of features of a contact that is chosen among many, 0 if it has no choice
    for r in range(CANDIDATE):
        ws.floats[out + FEATURES + r] = ws.floats[contact.features + r] if contact.features > 0 else 0.0


@entry_point("void(ws, Cause, i8, i8)")
def record_event(ws: Workspace, cause: Cause, which: int, phases: int) -> None:
    """Append an event of contact or user's guard ``which``: what was stored before it, and the state after it.

    ``phases`` is the number of phases of an impact, 0 of other events. A resumed run repeats events that the earlier
    run has recorded already: ``n_known_events`` of them are not kept.
    """
    ws.event.n_recorded += 1
    # all contacts that are or were closed are listed, too; the number of a user's guard is no contact's
    n_listed = _list_contacts(ws, NO_CONTACT if cause == Cause.GUARD else which)
    ws.output.last_floats, ws.output.last_integers = ws.output.floats_used, ws.output.integers_used
    ws.output.last_cause, ws.output.last_contact, ws.output.last_phases = cause, which, phases
    end = _write_event_state(ws, ws.output.event_numbers.start + ws.output.floats_used)
    codes = ws.output.event_codes.start + ws.output.integers_used
    _write_event_codes(ws, codes, cause, which, phases)
    ws.integers[codes + N_LISTED] = n_listed
    for i in range(n_listed):
        _write_contact(ws, ws.contacts[ws.event.listed[i]], end + LISTED * i)
        _write_contact_codes(ws, ws.contacts[ws.event.listed[i]], codes + CODE_HEAD + 2 * i)
    # written, but not counted: the next event overwrites it
    if ws.request.n_known_events > 0:
        ws.request.n_known_events -= 1
        return
    ws.output.floats_used = end + LISTED * n_listed - ws.output.event_numbers.start
    ws.output.integers_used += CODE_HEAD + 2 * n_listed
    ws.output.n_events += 1


@kernel("i8(ws, i8)")
def _write_event_state(ws: Workspace, row: int) -> int:
    """Write head, state and totals of an event to offset ``row``. Offset at which they end.

    The state has the velocities both before and after the event.
    """
    n_q, n_u, n_y = ws.model.n_q, ws.model.n_u, ws.model.n_y
    ws.event.head[TIME] = ws.island.time
    for i in range(EVENT_HEAD):
        ws.floats[row + i] = ws.event.head[i]
    row += EVENT_HEAD
    for i in range(n_q):
        ws.floats[row + i] = ws.island.y[i]
    row += n_q
    for i in range(n_u):
        ws.floats[row + i] = ws.event.u_before[i]
        ws.floats[row + n_u + i] = ws.island.y[n_q + i]
    row += 2 * n_u
    for i in range(n_q + n_u, n_y):
        ws.floats[row] = ws.island.y[i]
        row += 1
    _write_accounts(ws, row)
    return row + BOOKED


@kernel("void(ws, i8, Cause, i8, i8)")
def _write_event_codes(ws: Workspace, codes: int, cause: Cause, which: int, phases: int) -> None:
    """Write cause, contact or guard, phases, and whether the impact was cut short, of an event to offset ``codes``.

    A contact is written by its number among the declared ones, since the number in the list changes.
    """
    ws.integers[codes + CAUSE], ws.integers[codes + CONTACT], ws.integers[codes + PHASES] = cause, which, phases
    if which >= 0 and cause != Cause.GUARD:
        ws.integers[codes + CONTACT] = ws.contacts[which].declared
    ws.integers[codes + TRUNCATED] = 1 if ws.event.truncation != Truncation.NONE and phases > 0 else 0


@kernel("void(ws, ContactRecord, i8)")
def _write_contact_codes(ws: Workspace, contact: ContactRecord, codes: int) -> None:
    """Write the declared number of a contact and its code in an event, Eq. (29), to offset ``codes``."""
    before, during, after = contact.code_before << BEFORE, contact.code_during << DURING, mode_code(contact) << AFTER
    ws.integers[codes] = contact.declared
    ws.integers[codes + 1] = before | during | after


@kernel()
def amend_last(ws: Workspace) -> None:
    """Write the last event anew, with the modes and velocities at the end of the instant.

    Nothing is done if the event is in no buffer, as it was known from an earlier run.
    """
    # an event that is not kept has used no floats
    if ws.output.n_events == 0 or ws.output.floats_used == ws.output.last_floats:
        return
    ws.output.floats_used, ws.output.integers_used = ws.output.last_floats, ws.output.last_integers
    ws.output.n_events -= 1
    ws.event.n_recorded -= 1
    record_event(ws, ws.output.last_cause, ws.output.last_contact, ws.output.last_phases)


@entry_point("i8(ws)")
def begin_sample(ws: Workspace) -> int:
    """Append a sample at the time ``next_sample``, and advance that time. Offset of the state of the sample.

    There the caller writes q, u and the rest of the integrated state, in the floats of the workspace.
    """
    # a sample is its time, the state, and the energies accounted for at instants
    row = ws.output.samples.start + ws.output.n_samples * (1 + ws.model.n_y + BOOKED)
    ws.floats[row] = ws.output.next_sample
    _write_accounts(ws, row + 1 + ws.model.n_y)
    ws.output.n_samples += 1
    ws.output.sample_index += 1
    ws.output.next_sample = ws.request.sample_start + ws.output.sample_index * ws.request.sample_interval
    return int(row + 1)


@kernel("void(ws, f8)")
def record_samples(ws: Workspace, h: float) -> None:
    """Append the samples within the first ``h`` [s] of the step that was taken, from its interpolant.

    The buffer is emptied early enough to hold the samples of any step. Its end is a safeguard only.
    """
    while ws.output.next_sample <= ws.island.time + h and ws.output.n_samples < ws.model.sample_capacity:
        theta = (ws.output.next_sample - ws.island.time) / ws.step.h
        # round-off may put the fraction of the step just outside of it
        state_within(ws, ws.step.h, min(1.0, max(0.0, theta)), begin_sample(ws))
