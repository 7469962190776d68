"""Touching contacts at an instant: which contacts take part in an event.

A closed contact touches. An open contact touches if its gap is within the gap tolerance, or within the distance that
the gap changes in the time tolerance at its present rate. Two kinds of open contacts take no part: all but one of
several contacts at one point, and contacts of shapes that are apart along another direction. Only touching contacts
have Jacobians.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.compliance import copy_inner_states, evaluate_compliant_force
from nonsmooth.engine.bodies.courses import end_own_steps_of, has_own_step
from nonsmooth.engine.bodies.kinematics import (
    NOT_EVALUATED,
    evaluate_bias,
    evaluate_jacobian,
    evaluate_kinematics,
    velocity_at,
)
from nonsmooth.engine.bodies.same_point import leave_out_coincident
from nonsmooth.engine.bodies.support import along_pair, is_of_one_part_each, separation_along, store_direction
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.tolerances import ADJACENT
from nonsmooth.engine.numerics.vectors import are_alike, dot, opposite


@entry_point("b1(ws)")
def find_touching(ws: Workspace) -> bool:
    """Evaluate all bodies, and find and evaluate the contacts that touch. True if one of them approaches.

    Touching contacts take part in an event: ``is_touching``, Jacobians, bias and compliant force are written. Closed
    contacts of bodies with an own step (multirate) take no part. If anything else touches such a body, its own step
    ends, and all contacts are tested again.
    """
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    copy_inner_states(ws, ws.island.y.start)
    is_approaching, has_ended = False, True
    # each pass ends the own step of another body, so that the loop ends
    while has_ended:
        is_approaching = has_ended = may_leave_out = False
        for contact in ws.contacts:
            evaluate_kinematics(ws, contact.index)
            contact.is_touching = _does_touch(ws, contact)
            is_of_pair = contact.mode == Mode.OPEN and contact.pair != NO_PAIR
            may_leave_out = may_leave_out or (contact.is_touching and is_of_pair)
        if may_leave_out:
            leave_out_coincident(ws)
            _leave_out_blocked(ws)
        for contact in ws.contacts:
            if contact.is_touching:
                is_approaching = _approaches(ws, contact) or is_approaching
                has_ended = end_own_steps_of(ws, contact.index) > 0 or has_ended
    return is_approaching


@kernel()
def _leave_out_blocked(ws: Workspace) -> None:
    """Let an open contact that approaches take no part if its shapes are apart along the normal of another contact.

    Convex shapes that are apart along a direction, and do not approach along it, do not meet. So a body that slides
    from one box onto a flush box does not collide with the side of the second box.
    """
    for contact in ws.contacts:
        is_rigid = contact.is_touching and contact.mode == Mode.OPEN and not contact.is_compliant
        collides = is_rigid and contact.normal_rate < -ws.tolerance.velocity
        is_of_parts = collides and contact.pair != NO_PAIR and is_of_one_part_each(ws, contact.pair)
        # feet extend beyond the parts, so these do not decide
        if is_of_parts and ws.pairs[contact.pair].clearance == 0.0 and _is_blocked(ws, contact):
            # the direction of its pair has changed: evaluate the contact again
            contact.version_a = NOT_EVALUATED
            evaluate_kinematics(ws, contact.index)
            contact.is_touching = _does_touch(ws, contact)


@kernel("b1(ws, ContactRecord)")
def _is_blocked(ws: Workspace, contact: ContactRecord) -> bool:
    """True if the shapes of a contact are apart along the normal of another contact, and do not approach along it.

    Shapes that are apart by more than the gap tolerance may approach: they do not meet now. The normal of the other
    contact becomes the direction of the pair.
    """
    pair, near, v = ws.pairs[contact.pair], ADJACENT * ws.tolerance.gap, velocity_at(ws, contact)
    for other in ws.contacts:
        if other.pair != contact.pair or other.past_feature > 0.0 or are_alike(contact.normal, other.normal):
            continue
        # a contact with the opposite normal is on the other face of a thin disc, and does not block this one
        if are_alike(opposite(contact.normal), other.normal):
            continue
        is_resting = dot(other.normal, v) >= -ws.tolerance.velocity and not _closes_along(ws, other)
        along = along_pair(pair, other.normal)
        apart = separation_along(ws, pair.index, along)
        if apart > ws.tolerance.gap or (apart >= -near and is_resting):
            store_direction(ws, pair, along)
            return True
    return False


@kernel("b1(ws, ContactRecord)")
def _closes_along(ws: Workspace, contact: ContactRecord) -> bool:
    """True if a touching contact between the same shapes, with the normal of ``contact``, approaches."""
    for other in ws.contacts:
        is_along = other.pair == contact.pair and other.is_touching and are_alike(contact.normal, other.normal)
        if is_along and other.normal_rate < -ws.tolerance.velocity:
            return True
    return False


@kernel("b1(ws, ContactRecord)")
def _approaches(ws: Workspace, contact: ContactRecord) -> bool:
    """Evaluate a contact that touches. True if it is rigid and approaches.

    A compliant contact has no impact, so its approach does not count.
    """
    evaluate_jacobian(ws, contact.index)
    evaluate_bias(ws, contact.index, rows=3)
    if contact.is_compliant:
        contact.gap, contact.overlap = _depth_or_gap(contact), 0.0
        evaluate_compliant_force(ws, contact.index)
    return not contact.is_compliant and contact.normal_rate < -ws.tolerance.velocity


@kernel("f8(ContactRecord)")
def _depth_or_gap(contact: ContactRecord) -> float:
    """Gap of a contact along its normal [m]: past the end of its features its overlap, not the substitute."""
    return float(contact.overlap if contact.overlap < 0.0 else contact.gap)


@kernel("b1(ws, ContactRecord)")
def _does_touch(ws: Workspace, contact: ContactRecord) -> bool:
    """True if a contact touches, by its gap and gap rate.

    A closed rigid contact touches. An open one touches if its gap is within the gap tolerance, or within the
    distance that it changes in the time tolerance. A compliant contact touches up to its reach, the gap up to which its
    law acts, if it is closed, and up to a gap of zero if it is open. Within the gap tolerance of this end it must not
    separate. False in any case past the end of features, and for a closed contact of a body with an own step.
    """
    gap, rate = contact.gap, contact.normal_rate
    # a body with an own step (multirate) takes no part in events of the rest; past the end of its features (a face,
    # an edge) the gap is a distance to them, no gap that can close
    if has_own_step(ws, contact.index) or contact.past_feature > ws.tolerance.gap:
        return False
    if contact.is_compliant:
        end = 0.0 if contact.mode == Mode.OPEN else contact.reach
        gap = _depth_or_gap(contact)
        # a rate that is not a number counts as separating
        separates = not rate <= ws.tolerance.velocity
        return not (gap > end + ws.tolerance.gap or (gap > end - ws.tolerance.gap and separates))
    near = max(ws.tolerance.gap, ws.tolerance.time * abs(rate))
    return not (contact.mode == Mode.OPEN and gap > near)
