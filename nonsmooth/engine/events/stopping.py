"""Slips that stop: the instant in which one does is an event."""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.flow.guard_numbers import friction_guard
from nonsmooth.engine.flow.self_check import NOUGHT
from nonsmooth.engine.flow.step import STIFF
from nonsmooth.engine.memory.modes import OPEN, SLIDE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, guard_at, kernel
from nonsmooth.engine.numerics.vectors import length

_BEYOND = 1.5
"""Of the way to a stop, as its deceleration foretells it, an explicit step goes so much, and the stop is located;"""
_ALMOST = 0.98
"""where none will do an implicit one goes so much, and all of it from within the tolerance of velocities on."""
_SHARES = 1e-3, 0.9
"""What a step may be cut to for that, so near its end being at it,"""
_BLIND = 0.25
"""and is where nothing is foretold."""


@kernel("f8(S, F, I, i8, f8)")
def _share(S: Scalars, w: Floats, k: Integers, c: int, h: float) -> float:
    """Return to what part the implicit step of ``h`` is cut in which the slip of contact ``c`` stops."""
    contact = contact_at(S, w, k, c)
    first = length(contact.slip_end)
    v1, v2 = contact.slip_end
    du = S.slopes + S.n_q
    a1, a2 = row(S, w, k, c, 1, du) + contact.bias[1], row(S, w, k, c, 2, du) + contact.bias[2]
    slowing = -h * (v1 * a1 + v2 * a2) / first
    part, least = _BLIND, 2.0 * S.time_tolerance
    if slowing > 0.0:
        part = first / slowing
        if _BEYOND * part * h * S.relaxation <= STIFF:
            part *= _BEYOND
        elif first > S.velocity_tolerance:
            part *= _ALMOST
        elif abs(part - 1.0) * h <= _SHARES[0] * h + least:
            S.halting = c
            return 1.0
    return float(max(_SHARES[0], least / h, min(_SHARES[1], part)))


@kernel("f8(S, F, I, f8)")
def share_before_stop(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Return to what part an implicit step of ``h`` is cut as it holds a slip at its end that moved at its start, or 1.

    When the slip stopped within the step is not told.  What stops where it ends is ``halting``.
    """
    share, none = 1.0, NOUGHT * S.velocity_tolerance
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        rubs = contact.mode == SLIDE and contact.traction_function == 0 and contact.averaged == OPEN
        if rubs and length(contact.slip) <= none and length(contact.slip_end) > none:
            share = min(share, _share(S, w, k, c, h))
    return share


@kernel("i8(S, F, I)")
def stopping(S: Scalars, w: Floats, k: Integers) -> int:
    """Return a contact whose slip has stopped where an implicit step ends, or -1.

    Where none can be made, one that has come next to rest and slows down: its direction is stiff, and what is left of
    it below the tolerance.
    """
    if S.relaxation > 0.0:
        return int(S.halting)
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode == SLIDE and contact.traction_function == 0 and contact.averaged == OPEN:
            speed = length(contact.slip_end)
            if speed <= S.velocity_tolerance and speed < guard_at(S, w, k, friction_guard(S, c)).first:
                return c
    return -1
