"""Contacts of other bodies that a collision closes before it is over: they collide with it."""

from __future__ import annotations

from nonsmooth.engine.bodies.courses import end_own_steps_of, has_own_step
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_jacobian
from nonsmooth.engine.flow.self_check import ALLOWED
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("b1(ws, i8)")
def _has_touching_contact(ws: Workspace, c: int) -> bool:
    """Return 1 if a contact of the same two frames as contact ``c`` touches: their features follow one another."""
    contact = ws.contacts[c]
    for other in range(ws.island.n_contacts):
        another = ws.contacts[other]
        if another.is_touching and another.frame_a == contact.frame_a and another.frame_b == contact.frame_b:
            return True
    return False


@kernel("i8(ws, f8)")
def add_closing_contacts(ws: Workspace, speed: float) -> int:
    """Let contacts touch whose gaps a collision at a ``speed`` [m/s] may close within its contact time.

    What tolerances explain is the most of a gap over which friction may act, lest it turns the bodies.  Courses of
    bodies that touch so end; return how many: where some do, what touches is to be found anew.
    """
    ended = 0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        apart = not contact.is_touching and not contact.is_compliant and contact.past_feature <= 0.0
        near = min(contact.contact_time * speed, ALLOWED * ws.tolerance.gap)
        if apart and contact.gap <= near and not has_own_step(ws, c) and not _has_touching_contact(ws, c):
            contact.is_touching = True
            evaluate_jacobian(ws, c)
            evaluate_bias(ws, c, 3)
            ended += end_own_steps_of(ws, c)
    return ended
