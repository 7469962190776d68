"""Slips that stop: the instant in which one does is an event."""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.flow.guard_numbers import friction_guard
from nonsmooth.engine.memory.modes import SLIDE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, guard_at, kernel
from nonsmooth.engine.numerics.vectors import length

_HELD = 1e-3
"""Part of the tolerance of velocities below which a slip is what solving leaves of none."""
_ALMOST = 0.98
"""Part of the way to its stop, as its deceleration foretells it, that a slip is followed,"""
_SHARES = 1e-3, 0.9
"""and what the step may be cut to for that,"""
_BLIND = 0.25
"""or is where nothing is foretold."""


@kernel("f8(S, F, I, f8)")
def share_before_stop(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Return to what part an implicit step of ``h`` is cut as it holds a slip at its end that moved at its start, or 1.

    When the slip stopped within the step is not told: from next to rest on steps are short, and tell it.
    """
    share = 1.0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode != SLIDE or contact.traction_function != 0:
            continue
        first = guard_at(S, w, k, friction_guard(S, c)).first
        if first <= S.velocity_tolerance or length(contact.slip) > _HELD * S.velocity_tolerance:
            continue
        d1, d2 = contact.direction
        du = S.slopes + S.n_q
        slowing = -h * (d1 * row(S, w, k, c, 1, du) + d2 * row(S, w, k, c, 2, du))
        way = _ALMOST * first / slowing if slowing > 0.0 else _BLIND
        share = min(share, max(_SHARES[0], min(_SHARES[1], way)))
    return share


@kernel("i8(S, F, I)")
def stopping(S: Scalars, w: Floats, k: Integers) -> int:
    """Return a contact whose slip has come next to rest in the step that ended and slows down, or -1.

    So close to rest the direction of the slip is stiff, and what is left of it below the tolerance.
    """
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode == SLIDE and contact.traction_function == 0:
            speed = length(contact.slip_end)
            if speed <= S.velocity_tolerance and speed < guard_at(S, w, k, friction_guard(S, c)).first:
                return c
    return -1
