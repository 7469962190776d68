"""Which contacts touch at an instant, and how fast they slip."""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.compliance import evaluate_compliant_force, refresh_states
from nonsmooth.engine.bodies.courses import end_courses_of, has_own_step
from nonsmooth.engine.bodies.kinematics import (
    evaluate_bias,
    evaluate_jacobian,
    evaluate_kinematics,
)
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.vectors import length


@entry_point("b1(ws)")
def touch(ws: Workspace) -> bool:
    """Find and evaluate the touching contacts; true if one of them approaches.

    What bodies on their courses stand on is left out; the course of one that something else touches ends.
    """
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    refresh_states(ws, ws.island.y.start)
    is_approaching, has_ended = False, True
    while has_ended:
        is_approaching, has_ended = False, False
        for c in range(ws.island.n_contacts):
            is_approaching = _touch(ws, c) or is_approaching
            if ws.contacts[c].is_touching:
                has_ended = end_courses_of(ws, c) > 0 or has_ended
    return is_approaching


@kernel("b1(ws, i8)")
def _touch(ws: Workspace, c: int) -> bool:
    """Find whether contact ``c`` touches, and evaluate it then; true if it approaches."""
    contact = ws.contacts[c]
    contact.is_touching = False
    evaluate_kinematics(ws, c)
    rate = contact.rate[0]
    if has_own_step(ws, c) or (contact.past_feature > ws.tolerance.gap and contact.gap > 0.0):
        return False
    contact.is_touching = True
    if contact.is_compliant:
        _touch_compliant(ws, c)
        return False
    near = max(ws.tolerance.gap, ws.tolerance.time * abs(rate))
    if contact.mode == Mode.OPEN and contact.gap > near:
        contact.is_touching = False
        return False
    evaluate_jacobian(ws, c)
    evaluate_bias(ws, c, 3)
    return rate < -ws.tolerance.velocity


@kernel("void(ws, i8)")
def _touch_compliant(ws: Workspace, c: int) -> None:
    """Find whether the compliant contact ``c`` touches, and evaluate it; it does not collide."""
    contact = ws.contacts[c]
    gap, rate = contact.gap, contact.rate[0]
    end = 0.0 if contact.mode == Mode.OPEN else contact.reach
    slow = rate <= ws.tolerance.velocity
    if gap > end + ws.tolerance.gap or (gap > end - ws.tolerance.gap and not slow):
        contact.is_touching = False
        return
    evaluate_jacobian(ws, c)
    evaluate_bias(ws, c, 3)
    evaluate_compliant_force(ws, c)


@kernel("f8(ws, i8)")
def slip_speed(ws: Workspace, c: int) -> float:
    """Return the slip speed of contact ``c`` [m/s]."""
    return length(ws.contacts[c].slip)
