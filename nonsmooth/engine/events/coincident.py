"""Coincident contacts: two pairs of features of the same bodies at one place, while one replaces the other.

A body that rolls from an edge onto a face touches with both as long as their margins overlap. A collision of one
against the other would be an artefact. So they are treated as one contact: the one that approaches replaces the other.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.compliance import start_inner_states
from nonsmooth.engine.bodies.same_point import coincide
from nonsmooth.engine.memory.modes import NO_CONTACT, Mode
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("i8(ws, i8)")
def closed_coincident(ws: Workspace, c: int) -> int:
    """First closed contact that coincides with contact ``c`` and does not approach, or ``NO_CONTACT``.

    Contact ``c`` may take its place, as when a body rolls from an edge onto a face. It is never ``c`` itself.
    """
    for other in ws.contacts:
        is_closed = other.mode != Mode.OPEN and other.normal_rate >= -ws.tolerance.velocity
        if is_closed and coincide(ws.contacts[c], other):
            return other.index
    return NO_CONTACT


@kernel("b1(ws, i8)")
def has_replaced(ws: Workspace, c: int) -> bool:
    """True if contact ``c`` has only changed its features in the event, such as an edge for a face, and not closed.

    So it is if, of ``c`` and the contacts that coincide with it, one was closed before the event and one is closed now.
    """
    was_closed, is_closed = False, False
    for other in ws.contacts:
        if other.index == c or coincide(ws.contacts[c], other):
            is_closed = is_closed or other.mode != Mode.OPEN
            # the code of an open contact is 0
            was_closed = was_closed or other.code_before != 0
    return was_closed and is_closed


@kernel("b1(ws, i8)")
def replace_coincident(ws: Workspace, c: int) -> bool:
    """Close contact ``c`` in place of the closed contacts that coincide with it. True if there are any.

    It takes the mode of the first of them, and they open. Nothing collides, because no impulse can distinguish them.
    """
    contact = ws.contacts[c]
    replaced, has_taken_over = closed_coincident(ws, c), False
    while replaced != NO_CONTACT:
        if not has_taken_over:
            if contact.mode == Mode.OPEN:
                start_inner_states(ws, c)
            contact.mode = ws.contacts[replaced].mode
            has_taken_over = True
        ws.contacts[replaced].mode = Mode.OPEN
        # it leaves its island, too
        ws.contacts[replaced].is_in_problem = False
        # the next one: an open contact is not found again
        replaced = closed_coincident(ws, c)
    return has_taken_over
