"""What an event is called: the cause that a guard or a state tells."""

from __future__ import annotations

from nonsmooth.engine.flow.guard_numbers import contact_of, first_end_guard, is_friction_guard, normal_guard
from nonsmooth.engine.memory.modes import (
    FEATURE_END,
    IMPACT,
    LIFT_OFF,
    OPEN,
    SLIP_TO_STICK,
    STICK,
    STICK_TO_SLIP,
    TOUCH,
)
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, guard_at, kernel


@kernel("i8(S, F, I, i8)")
def _closing(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return what it is when contact ``c`` closes."""
    return IMPACT if contact_at(S, w, k, c).normal_function == 0 else TOUCH


@kernel("i8(S, F, I, i8)")
def cause_of(S: Scalars, w: Floats, k: Integers, guard: int) -> int:
    """Return what it means that a guard of a contact has fired."""
    c = contact_of(S, guard)
    contact = contact_at(S, w, k, c)
    if is_friction_guard(S, guard) == 0:
        return _closing(S, w, k, c) if contact.mode == OPEN else LIFT_OFF
    if contact.mode != STICK:
        return SLIP_TO_STICK
    # the static bound vanishes with the normal force
    force = guard_at(S, w, k, normal_guard(c))
    return LIFT_OFF if force.value <= 1e-9 * force.first else STICK_TO_SLIP


@kernel("i8(S, F, I, i8)")
def cause_at_start(S: Scalars, w: Floats, k: Integers, which: int) -> int:
    """Return the cause of the event that is due of contact ``which`` before any step."""
    if contact_at(S, w, k, which).mode == OPEN:
        return _closing(S, w, k, which)
    if guard_at(S, w, k, first_end_guard(S) + which).end < 0.0:
        return FEATURE_END
    pulls = guard_at(S, w, k, normal_guard(which)).end < 0.0
    return LIFT_OFF if pulls else STICK_TO_SLIP
