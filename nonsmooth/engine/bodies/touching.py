"""Touching contacts at an instant: which contacts take part in an event, and how fast they slip.

A closed contact touches. An open contact touches if its gap is within the gap tolerance, or if it closes within the
time tolerance at its present rate. Only touching contacts have Jacobians.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.compliance import copy_inner_states, evaluate_compliant_force
from nonsmooth.engine.bodies.courses import end_own_steps_of, has_own_step
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_jacobian, evaluate_kinematics
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Contact, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.vectors import length


@entry_point("b1(ws)")
def touch(ws: Workspace) -> bool:
    """Find and evaluate the touching contacts. True if one of them approaches.

    Closed contacts of bodies with a step of their own take no part. If anything else touches such a body, its own step
    ends, and the search begins anew.
    """
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    copy_inner_states(ws, ws.island.y.start)
    is_approaching, has_ended = False, True
    while has_ended:
        is_approaching, has_ended = False, False
        for contact in ws.contacts:
            is_approaching = _touches_and_approaches(ws, contact) or is_approaching
            if contact.is_touching:
                has_ended = end_own_steps_of(ws, contact.index) > 0 or has_ended
    return is_approaching


@kernel("b1(ws, Contact)")
def _touches_and_approaches(ws: Workspace, contact: Contact) -> bool:
    """Write whether a contact touches, and evaluate it in that case. True if it also approaches."""
    c = contact.index
    contact.is_touching = False
    evaluate_kinematics(ws, c)
    rate = contact.normal_rate
    if has_own_step(ws, c) or (contact.past_feature > ws.tolerance.gap and contact.gap > 0.0):
        return False
    contact.is_touching = True
    if contact.is_compliant:
        _evaluate_compliant(ws, contact)
        return False
    near = max(ws.tolerance.gap, ws.tolerance.time * abs(rate))
    if contact.mode == Mode.OPEN and contact.gap > near:
        contact.is_touching = False
        return False
    evaluate_jacobian(ws, c)
    evaluate_bias(ws, c, 3)
    return rate < -ws.tolerance.velocity


@kernel("void(ws, Contact)")
def _evaluate_compliant(ws: Workspace, contact: Contact) -> None:
    """Write whether a compliant contact touches, and evaluate it in that case. It has no impacts.

    A closed one touches up to its reach, an open one up to a gap of zero. At that gap it must not separate.
    """
    gap = contact.gap
    end = 0.0 if contact.mode == Mode.OPEN else contact.reach
    separates = not contact.normal_rate <= ws.tolerance.velocity
    if gap > end + ws.tolerance.gap or (gap > end - ws.tolerance.gap and separates):
        contact.is_touching = False
        return
    evaluate_jacobian(ws, contact.index)
    evaluate_bias(ws, contact.index, 3)
    evaluate_compliant_force(ws, contact.index)


@kernel("f8(ws, i8)")
def slip_speed(ws: Workspace, c: int) -> float:
    """Slip speed of contact ``c`` [m/s]."""
    return length(ws.contacts[c].slip)
