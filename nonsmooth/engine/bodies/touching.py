"""Which contacts touch at an instant, and how fast they slip."""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.compliance import evaluate_compliant_force, refresh_states
from nonsmooth.engine.bodies.courses import end_courses_of, is_on_course
from nonsmooth.engine.bodies.kinematics import (
    evaluate_bias,
    evaluate_jacobian,
    evaluate_kinematics,
)
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, entry_point, kernel
from nonsmooth.engine.numerics.vectors import length


@entry_point("i8(S, F, I)")
def touch(S: Scalars, w: Floats, k: Integers) -> int:
    """Find and evaluate the touching contacts; return 1 if one of them approaches.

    What bodies on their courses stand on is left out; the course of one that something else touches ends.
    """
    evaluate_bodies(S, w, k, S.t, S.y)
    refresh_states(S, w, k, S.y)
    approaching, ended = 0, 1
    while ended > 0:
        approaching = ended = 0
        for c in range(S.n_contacts):
            approaching = max(approaching, _touch(S, w, k, c))
            if contact_at(S, w, k, c).touching == 1:
                ended += end_courses_of(S, w, k, c)
    return approaching


@kernel("i8(S, F, I, i8)")
def _touch(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Find whether contact ``c`` touches, and evaluate it then; return 1 if it approaches."""
    contact = contact_at(S, w, k, c)
    contact.touching = 0
    evaluate_kinematics(S, w, k, c)
    rate = contact.rate[0]
    if is_on_course(S, w, k, c) == 1 or (contact.beyond > S.gap_tolerance and contact.gap > 0.0):
        return 0
    contact.touching = 1
    if contact.normal_function != 0:
        _touch_compliant(S, w, k, c)
        return 0
    near = max(S.gap_tolerance, S.time_tolerance * abs(rate))
    if contact.mode == OPEN and contact.gap > near:
        contact.touching = 0
        return 0
    evaluate_jacobian(S, w, k, c)
    evaluate_bias(S, w, k, c, 3)
    return 1 if rate < -S.velocity_tolerance else 0


@kernel("void(S, F, I, i8)")
def _touch_compliant(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Find whether the compliant contact ``c`` touches, and evaluate it; it does not collide."""
    contact = contact_at(S, w, k, c)
    gap, rate = contact.gap, contact.rate[0]
    end = 0.0 if contact.mode == OPEN else contact.reach
    slow = rate <= S.velocity_tolerance
    if gap > end + S.gap_tolerance or (gap > end - S.gap_tolerance and not slow):
        contact.touching = 0
        return
    evaluate_jacobian(S, w, k, c)
    evaluate_bias(S, w, k, c, 3)
    evaluate_compliant_force(S, w, k, c)


@kernel("f8(S, F, I, i8)")
def slip_speed(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return the slip speed of contact ``c`` [m/s]."""
    return length(contact_at(S, w, k, c).slip)
