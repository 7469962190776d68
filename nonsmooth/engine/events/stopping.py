"""Slips that stop: the instant in which one does is an event."""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.flow.guard_numbers import friction_guard
from nonsmooth.engine.flow.self_check import NEGLIGIBLE
from nonsmooth.engine.flow.step import LARGEST_EXPLICIT
from nonsmooth.engine.memory.layout import FIRST_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import length

_BEYOND = 1.5
"""Of the way to a stop, as its deceleration foretells it, an explicit step goes so much, and the stop is located;"""
_ALMOST = 0.98
"""where none will do an implicit one goes so much, and all of it from within the tolerance of velocities on."""
_SHARES = 1e-3, 0.9
"""What a step may be cut to for that, so near its end being at it,"""
_BLIND = 0.25
"""and is where nothing is foretold."""


@kernel("f8(ws, i8, f8)")
def _part_before_stop_of(ws: Workspace, c: int, h: float) -> float:
    """Return to what part the implicit step of ``h`` is cut in which the slip of contact ``c`` stops."""
    contact = ws.contacts[c]
    first = length(contact.slip_at_end)
    v1, v2 = contact.slip_at_end
    du = ws.island.slopes.start + ws.model.n_q
    a1, a2 = row(ws, c, FIRST_ROW, du) + contact.bias[1], row(ws, c, SECOND_ROW, du) + contact.bias[2]
    slowing = -h * (v1 * a1 + v2 * a2) / first
    part, least = _BLIND, 2.0 * ws.tolerance.time
    if slowing > 0.0:
        part = first / slowing
        if _BEYOND * part * h * ws.step.relaxation <= LARGEST_EXPLICIT:
            part *= _BEYOND
        elif first > ws.tolerance.velocity:
            part *= _ALMOST
        elif abs(part - 1.0) * h <= _SHARES[0] * h + least:
            ws.step.halting_contact = c
            return 1.0
    return float(max(_SHARES[0], least / h, min(_SHARES[1], part)))


@kernel("f8(ws, f8)")
def part_before_stop(ws: Workspace, h: float) -> float:
    """Return to what part an implicit step of ``h`` is cut as it holds a slip at its end that moved at its start, or 1.

    When the slip stopped within the step is not told.  What stops where it ends is ``halting``.
    """
    share, none = 1.0, NEGLIGIBLE * ws.tolerance.velocity
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        rubs = contact.mode == Mode.SLIDE and not contact.has_traction_law and not contact.is_averaged
        if rubs and length(contact.slip) <= none and length(contact.slip_at_end) > none:
            share = min(share, _part_before_stop_of(ws, c, h))
    return share


@kernel("i8(ws)")
def stopped_contact(ws: Workspace) -> int:
    """Return a contact whose slip has stopped where an implicit step ends, or -1.

    Where none can be made, one that has come next to rest and slows down: its direction is stiff, and what is left of
    it below the tolerance.
    """
    if ws.step.relaxation > 0.0:
        return int(ws.step.halting_contact)
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.mode == Mode.SLIDE and not contact.has_traction_law and not contact.is_averaged:
            speed = length(contact.slip_at_end)
            if speed <= ws.tolerance.velocity and speed < ws.guards[friction_guard(ws, c)].initial:
                return c
    return -1
