"""Contacts of other bodies that a collision closes before it is over: they collide with it."""

from __future__ import annotations

from nonsmooth.engine.bodies.courses import end_courses_of, is_on_course
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_jacobian
from nonsmooth.engine.flow.self_check import EXPLAINED
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, kernel


@kernel("i8(S, F, I, i8)")
def _touches_already(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return 1 if a contact of the same two frames as contact ``c`` touches: their features follow one another."""
    contact = contact_at(S, w, k, c)
    for other in range(S.n_contacts):
        another = contact_at(S, w, k, other)
        if another.touching == 1 and another.frame_a == contact.frame_a and another.frame_b == contact.frame_b:
            return 1
    return 0


@kernel("i8(S, F, I, f8)")
def join_near(S: Scalars, w: Floats, k: Integers, speed: float) -> int:
    """Let contacts touch whose gaps a collision at a ``speed`` [m/s] may close within its contact time.

    What tolerances explain is the most of a gap over which friction may act, lest it turns the bodies.  Courses of
    bodies that touch so end; return how many: where some do, what touches is to be found anew.
    """
    ended = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        apart = contact.touching == 0 and contact.normal_function == 0 and contact.beyond <= 0.0
        near = min(contact.contact_time * speed, EXPLAINED * S.gap_tolerance)
        if apart and contact.gap <= near and is_on_course(S, w, k, c) == 0 and _touches_already(S, w, k, c) == 0:
            contact.touching = 1
            evaluate_jacobian(S, w, k, c)
            evaluate_bias(S, w, k, c, 3)
            ended += end_courses_of(S, w, k, c)
    return ended
