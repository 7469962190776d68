"""Contacts of other bodies that a collision closes before it is over: they collide with it."""

from __future__ import annotations

from nonsmooth.engine.bodies.courses import end_courses_of, is_on_course
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_jacobian
from nonsmooth.engine.flow.self_check import EXPLAINED
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("i8(ws, i8)")
def _touches_already(ws: Workspace, c: int) -> int:
    """Return 1 if a contact of the same two frames as contact ``c`` touches: their features follow one another."""
    contact = ws.contacts[c]
    for other in range(ws.n_contacts):
        another = ws.contacts[other]
        if another.touching == 1 and another.frame_a == contact.frame_a and another.frame_b == contact.frame_b:
            return 1
    return 0


@kernel("i8(ws, f8)")
def join_near(ws: Workspace, speed: float) -> int:
    """Let contacts touch whose gaps a collision at a ``speed`` [m/s] may close within its contact time.

    What tolerances explain is the most of a gap over which friction may act, lest it turns the bodies.  Courses of
    bodies that touch so end; return how many: where some do, what touches is to be found anew.
    """
    ended = 0
    for c in range(ws.n_contacts):
        contact = ws.contacts[c]
        apart = contact.touching == 0 and contact.normal_function == 0 and contact.beyond <= 0.0
        near = min(contact.contact_time * speed, EXPLAINED * ws.gap_tolerance)
        if apart and contact.gap <= near and is_on_course(ws, c) == 0 and _touches_already(ws, c) == 0:
            contact.touching = 1
            evaluate_jacobian(ws, c)
            evaluate_bias(ws, c, 3)
            ended += end_courses_of(ws, c)
    return ended
