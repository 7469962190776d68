"""Causes of events, from the guard or the contact that an event belongs to."""

from __future__ import annotations

from nonsmooth.engine.contact.trial import NO_FORCE
from nonsmooth.engine.flow.guard_numbers import contact_at, end_of, is_friction_guard, normal_of
from nonsmooth.engine.memory.modes import Cause, Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, kernel


@kernel("Cause(ContactRecord)")
def cause_of_closing(contact: ContactRecord) -> Cause:
    """Cause of the event in which a contact closes: a rigid one collides, a compliant one only touches."""
    return Cause.TOUCH if contact.is_compliant else Cause.IMPACT


@kernel("Cause(ws, i8)")
def cause_of(ws: Workspace, guard: int) -> Cause:
    """Cause of the event in which guard ``guard``, a normal or friction guard, fires.

    The static bound vanishes with the normal force. So friction that reaches the bound at zero force is a lift-off.
    """
    contact = contact_at(ws, guard)
    # the normal guard is the gap of an open contact, and the force of a closed one
    if not is_friction_guard(ws, guard):
        return cause_of_closing(contact) if contact.mode == Mode.OPEN else Cause.LIFT_OFF
    if contact.mode != Mode.STICK:
        return Cause.SLIP_TO_STICK
    normal = normal_of(ws, contact)
    return Cause.LIFT_OFF if normal.value <= NO_FORCE * normal.initial else Cause.STICK_TO_SLIP


@kernel("Cause(ws, i8)")
def cause_at_start(ws: Workspace, which: int) -> Cause:
    """Cause of an event of contact ``which`` at the start of a step: its gap is closed, or a guard is negative."""
    contact = ws.contacts[which]
    # the only guard of an open contact is its gap
    if contact.mode == Mode.OPEN:
        return cause_of_closing(contact)
    # each guard's at_end is its value at the end of the last step, which is the start of this one.
    # a negative end guard means that the contact point is past the end of an edge or a face
    if end_of(ws, contact).at_end < 0.0:
        return Cause.FEATURE_END
    # two causes remain: a negative normal guard (the contact pulls), or a negative friction guard (beyond the bound)
    pulls = normal_of(ws, contact).at_end < 0.0
    return Cause.LIFT_OFF if pulls else Cause.STICK_TO_SLIP
