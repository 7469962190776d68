"""Contacts at one place: features of two bodies that hold together for a moment while one gives way to the other.

Where a body rolls from an edge onto a face, both are touched as long as the margins about their border overlap, and the
rates of their gaps differ by the turning over the way between the points.  No impulse tells such contacts apart: they
are one, and the one that approaches more stands for it.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.compliance import start_inner_states
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import dot, minus

_LARGEST_DIFFERENCE = 1e-5
"""Difference of normals, and of places in units of the smaller body, up to which contacts are one: the share of an
approach that its square is of an energy is less than what is promised of one."""


@kernel("b1(ws, i8, i8)")
def _coincide(ws: Workspace, c: int, other: int) -> bool:
    """Return 1 if two rigid contacts of the same frames are at one place."""
    one, two = ws.contacts[c], ws.contacts[other]
    if c == other or one.frame_a != two.frame_a or one.frame_b != two.frame_b:
        return False
    if one.is_compliant or two.is_compliant:
        return False
    turned, moved = minus(one.normal, two.normal), minus(one.point_b, two.point_b)
    return dot(turned, turned) <= _LARGEST_DIFFERENCE**2 and dot(moved, moved) <= (_LARGEST_DIFFERENCE * one.size) ** 2


@kernel("i8(ws, i8)")
def closed_coincident(ws: Workspace, c: int) -> int:
    """Return a closed contact at the place of ``c`` that does not approach, or -1."""
    for other in range(ws.island.n_contacts):
        contact = ws.contacts[other]
        closed = contact.mode != Mode.OPEN and contact.rate[0] >= -ws.tolerance.velocity
        if closed and _coincide(ws, c, other):
            return other
    return -1


@kernel("b1(ws, i8)")
def has_replaced(ws: Workspace, c: int) -> bool:
    """True if ``c``, or another at its place, is closed where one was before, without a collision.

    That one may stand on: where margins overlap, both do for a moment.
    """
    stood, stands = False, False
    for other in range(ws.island.n_contacts):
        contact = ws.contacts[other]
        if other == c or _coincide(ws, c, other):
            stands = stands or contact.mode != Mode.OPEN
            stood = stood or contact.code_before != 0
    return stood and stands


@kernel("b1(ws, i8)")
def replace_coincident(ws: Workspace, c: int) -> bool:
    """Close a contact in place of those at its place; return 1, or 0 if there are none."""
    contact = ws.contacts[c]
    twin, taken = closed_coincident(ws, c), False
    while twin >= 0:
        if not taken:
            if contact.mode == Mode.OPEN:
                start_inner_states(ws, c)
            contact.mode = ws.contacts[twin].mode
            taken = True
        ws.contacts[twin].mode = Mode.OPEN
        ws.contacts[twin].is_in_problem = False
        twin = closed_coincident(ws, c)
    return taken
