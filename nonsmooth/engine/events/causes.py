"""What an event is called: the cause that a guard or a state tells."""

from __future__ import annotations

from nonsmooth.engine.flow.guard_numbers import contact_of, first_end_guard, is_friction_guard, normal_guard
from nonsmooth.engine.memory.modes import Cause, Mode
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("Cause(ws, i8)")
def _cause_of_closing(ws: Workspace, c: int) -> Cause:
    """Return what it is when contact ``c`` closes."""
    return Cause.IMPACT if not ws.contacts[c].is_compliant else Cause.TOUCH


@kernel("Cause(ws, i8)")
def cause_of(ws: Workspace, guard: int) -> Cause:
    """Return what it means that a guard of a contact has fired."""
    c = contact_of(ws, guard)
    contact = ws.contacts[c]
    if not is_friction_guard(ws, guard):
        return _cause_of_closing(ws, c) if contact.mode == Mode.OPEN else Cause.LIFT_OFF
    if contact.mode != Mode.STICK:
        return Cause.SLIP_TO_STICK
    # the static bound vanishes with the normal force
    force = ws.guards[normal_guard(c)]
    return Cause.LIFT_OFF if force.value <= 1e-9 * force.initial else Cause.STICK_TO_SLIP


@kernel("Cause(ws, i8)")
def cause_at_start(ws: Workspace, which: int) -> Cause:
    """Return the cause of the event that is due of contact ``which`` before any step."""
    if ws.contacts[which].mode == Mode.OPEN:
        return _cause_of_closing(ws, which)
    if ws.guards[first_end_guard(ws) + which].at_end < 0.0:
        return Cause.FEATURE_END
    pulls = ws.guards[normal_guard(which)].at_end < 0.0
    return Cause.LIFT_OFF if pulls else Cause.STICK_TO_SLIP
