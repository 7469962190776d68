"""Bounds on open gaps within a step: which of them speeds alone keep open.

What is known of a gap are its values and rates at both ends of a part of a step, how fast it can change at most, from
the relative velocity and turning of the bodies and the levers of their shapes, and how fast its rate can fall, from
their relative accelerations.  Where these do not show that a gap stays open, it is looked at within the step
(:mod:`nonsmooth.engine.flow.gap_search`).

The bounds hold if within a step no speed exceeds the sum of those at its ends, as the error control of the step sees
to.  Features that do not face each other have no rate: theirs are sampled (:mod:`nonsmooth.engine.flow.location`).
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_body, evaluate_driven_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_geometry, evaluate_rates
from nonsmooth.engine.flow.arming import NO_BOUND
from nonsmooth.engine.flow.flight import fly
from nonsmooth.engine.flow.guard_numbers import normal_of
from nonsmooth.engine.flow.self_check import NEGLIGIBLE
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.memory.layout import LAST_STAGE
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, Floats, Workspace, entry_point, frame_at, kernel
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, minus, scaled

_CURVED = 4.0
"""By so much a curved surface or an edge may turn the normal faster than its body turns."""
_CLOSINGS = 8
"""Steps of Newton's method to where a gap between bodies that fly is closed,"""
ABOUT = 1.1
"""and of gaps that are due within this factor of the first one: so well is known when."""


@kernel("f8(F, i8, i8)")
def _speed_seen(floats: Floats, frame_a: int, frame_b: int) -> float:
    """Return the speed of the origin of the second frame as seen from the first [m/s]."""
    a, b = frame_at(floats, frame_a), frame_at(floats, frame_b)
    x, y, z = minus(b.origin, a.origin)
    ox, oy, oz = a.spin
    vx, vy, vz = minus(b.velocity, a.velocity)
    seen = vx - oy * z + oz * y, vy - oz * x + ox * z, vz - ox * y + oy * x
    return math.sqrt(dot(seen, seen))


@kernel("v3(ws, i8)")
def _axis(ws: Workspace, c: int) -> Vector:
    """Return the axis in space about which the shape with the smaller lever may spin unseen, or zero."""
    contact = ws.contacts[c]
    is_second = contact.support_radius_b <= contact.support_radius_a
    r, v = frame_at(ws.floats, contact.frame_b if is_second else contact.frame_a).rotation, contact.spin_axis
    return dot((r[0], r[1], r[2]), v), dot((r[3], r[4], r[5]), v), dot((r[6], r[7], r[8]), v)


@kernel("v3(v3, v3)")
def _across(v: Vector, axis: Vector) -> Vector:
    """Return what a vector has across a unit axis; all of it, if that is zero."""
    return minus(v, scaled(dot(v, axis), axis))


@kernel()
def bound_speeds(ws: Workspace) -> None:
    """Write how fast the gaps of the open contacts can change where the bodies stand, to ``speed_end``.

    Seen from one body the other's surface moves along a normal no faster than its origin, and its lever by turning.
    Where one of them flies, the fastest turning, also that of the body from which it is seen, counts for the length of
    the step: a top that precesses looks at its end as at its start, whatever it came by.
    """
    last_a = last_b = -1
    speed, spin, whole, own = 0.0, (0.0, 0.0, 0.0), 0.0, 0.0
    ws.island.fastest_turn = 0.0
    for contact in ws.contacts:
        if contact.mode != Mode.OPEN:
            continue
        a, b, lever, larger = contact.frame_a, contact.frame_b, contact.support_radius_b, contact.support_radius_a
        if lever > larger:
            a, b, lever, larger = b, a, larger, lever
        # the contacts of two bodies follow one another
        if a != last_a or b != last_b:
            seen_from = frame_at(ws.floats, a).spin
            speed, spin = _speed_seen(ws.floats, a, b), minus(frame_at(ws.floats, b).spin, seen_from)
            whole, own = math.sqrt(dot(spin, spin)), math.sqrt(dot(seen_from, seen_from))
            last_a, last_b = a, b
        contact.speed_at_end = speed
        flies = ws.bodies[contact.body_a].is_ballistic + ws.bodies[contact.body_b].is_ballistic > 0
        if flies and larger > 0.0:
            ws.island.fastest_turn = max(ws.island.fastest_turn, own)
        if lever > 0.0:
            turning = whole
            if dot(contact.spin_axis, contact.spin_axis) > 0.0:
                across = _across(spin, _axis(ws, contact.index))
                turning = math.sqrt(dot(across, across))
            if flies:
                ws.island.fastest_turn = max(ws.island.fastest_turn, turning)
            contact.speed_at_end = speed + turning * lever
            contact.offset_at_end = arm_of(ws, contact.index)


@kernel("v3(ws, i8)")
def arm_of(ws: Workspace, c: int) -> Vector:
    """Return where the witness point of the body with the smaller lever is from its origin; its geometry is known."""
    contact = ws.contacts[c]
    if contact.support_radius_b <= contact.support_radius_a:
        return minus(contact.point_b, frame_at(ws.floats, contact.frame_b).origin)
    return minus(contact.point_a, frame_at(ws.floats, contact.frame_a).origin)


@kernel("v3(ws, i8, i8, b1, i8)")
def _acceleration(ws: Workspace, c: int, side: int, is_angular: bool, du: int) -> Vector:
    """The acceleration of the origin of a frame, or its angular acceleration."""
    contact = ws.contacts[c]
    frame = contact.frame_a if side == 0 else contact.frame_b
    n_u = contact.n_u_a if side == 0 else contact.n_u_b
    first = du + ws.bodies[contact.body_a if side == 0 else contact.body_b].u
    x, y, z = frame_at(ws.floats, frame).spin_acceleration if is_angular else frame_at(ws.floats, frame).acceleration
    row = frame + FRAME + (3 * n_u if is_angular else 0)
    for j in range(n_u):
        x += ws.floats[row + j] * ws.floats[first + j]
        y += ws.floats[row + n_u + j] * ws.floats[first + j]
        z += ws.floats[row + 2 * n_u + j] * ws.floats[first + j]
    return x, y, z


@kernel("v3(ws, i8, i8)")
def fall_of(ws: Workspace, c: int, du: int) -> Vector:
    """Return how fast the rate of the gap of ``c`` can fall, where the bodies stand and ``du`` are their accelerations.

    The second number is by how much more for every second of a step, the third how fast the bodies turn; what spins
    about an axis of revolution does not.  With the normal fixed to the first body a convex second one is no nearer
    than along this normal, whatever the normal does; the terms of the turning bodies hold for all points of its
    surface.
    """
    contact = ws.contacts[c]
    second = contact.support_radius_b <= contact.support_radius_a
    one, other = (0, 1) if second else (1, 0)
    a = frame_at(ws.floats, contact.frame_a if second else contact.frame_b)
    b = frame_at(ws.floats, contact.frame_b if second else contact.frame_a)
    spin, way, turning = a.spin, minus(b.origin, a.origin), minus(b.spin, a.spin)
    velocity = minus(minus(b.velocity, a.velocity), cross(spin, way))
    linear = minus(
        _acceleration(ws, c, other, is_angular=False, du=du), _acceleration(ws, c, one, is_angular=False, du=du)
    )
    alpha = _acceleration(ws, c, one, is_angular=True, du=du)
    angular = minus(minus(_acceleration(ws, c, other, is_angular=True, du=du), alpha), cross(spin, turning))
    axis = _axis(ws, c)
    own, turning = dot(turning, axis), _across(turning, axis)
    # what is across the axis changes as that turns, too
    angular = minus(_across(angular, axis), scaled(own, cross(turning, axis)))
    # what the turning of the first body takes away: alpha x d, omega x (omega x d), twice omega x velocity
    linear = minus(minus(linear, cross(alpha, way)), cross(spin, cross(spin, way)))
    linear = minus(linear, scaled(2.0, cross(spin, velocity)))
    along = dot(contact.normal, linear)
    speed, rate = math.sqrt(dot(velocity, velocity)), math.sqrt(dot(turning, turning))
    lever = min(contact.support_radius_a, contact.support_radius_b)
    fall = max(0.0, -along if second else along)
    fall += (math.sqrt(dot(angular, angular)) + rate * rate) * lever
    grows = 0.0
    if lever > 0.0:
        fall += _CURVED * rate * rate * lever
        grows = _CURVED * rate * math.sqrt(dot(linear, linear))
        if max(contact.support_radius_a, contact.support_radius_b) < math.inf:
            fall += _CURVED * rate * speed
    return fall, grows, rate


@kernel("f8(ws, i8, i8)")
def _expected_closing(ws: Workspace, c: int, du: int) -> float:
    """Return after what time the gap of ``c`` closes if its bodies go on as they accelerate now [s].

    That is for balls to tell: where the surfaces turn with the bodies, gaps that do not close would shorten steps.
    """
    contact = ws.contacts[c]
    if min(contact.support_radius_a, contact.support_radius_b) > 0.0:
        return math.inf
    gap, rate = contact.gap_at_end, contact.gap_rate_at_end
    one, other = _acceleration(ws, c, 0, is_angular=False, du=du), _acceleration(ws, c, 1, is_angular=False, du=du)
    square = rate * rate - 2.0 * dot(contact.normal, minus(other, one)) * gap
    if gap <= ws.tolerance.gap or square < 0.0 or math.sqrt(square) <= rate:
        return math.inf
    return float(2.0 * gap / (math.sqrt(square) - rate))


@kernel("b1(ws, ContactRecord, f8)")
def _will_be_doubtful(ws: Workspace, contact: ContactRecord, h: float) -> bool:
    """True if the gap of a contact may close within the time ``h`` [s], by the speeds at its start."""
    faces = contact.mode == Mode.OPEN and contact.past_feature_at_start <= 0.0
    return faces and normal_of(ws, contact).at_end <= 2.0 * h * contact.speed_at_start


@kernel("f8(ws, f8)")
def foresee(ws: Workspace, h: float) -> float:
    """Return when the first of the gaps that will be doubtful after a step of ``h`` is expected to close [s].

    When each of them is stays with it.
    """
    soonest = math.inf
    for contact in ws.contacts:
        contact.closing_time = math.inf
        if _will_be_doubtful(ws, contact, min(h, soonest)):
            contact.closing_time = _expected_closing(ws, contact.index, ws.island.slopes.start + ws.model.n_q)
            soonest = min(soonest, contact.closing_time)
    return soonest


@kernel("b1(ws, i8)")
def _flies(ws: Workspace, number: int) -> bool:
    """Return 1 if it is known without a step where a body will be."""
    body = ws.bodies[number]
    return body.n_u == 0 or body.is_ballistic


@kernel("f8(ws, i8)")
def _closing_of_flying(ws: Workspace, c: int) -> float:
    """Return when the gap of ``c`` is next to none, but open, if its bodies fly on [s]; infinite if that is not found.

    Newton's method, from when it is due.
    """
    contact = ws.contacts[c]
    elapsed = contact.closing_time
    for _iteration in range(_CLOSINGS):
        for side in range(2):
            number = contact.body_a if side == 0 else contact.body_b
            if ws.bodies[number].n_u == 0:
                evaluate_driven_bodies(ws, ws.island.time + elapsed, ws.island.y.start)
            else:
                fly(ws, elapsed, number, ws.step.y_stage.start)
                evaluate_body(ws, ws.island.time + elapsed, ws.step.y_stage.start, number)
        evaluate_geometry(ws, c)
        evaluate_rates(ws, c)
        rate = contact.rate[0]
        # a step that ends at the closing leaves so little of the gap
        aim = NEGLIGIBLE * min(ws.tolerance.gap, ws.tolerance.time * abs(rate))
        left = contact.gap - aim
        if abs(left) <= 0.5 * aim:
            return float(elapsed)
        if not rate < -ws.tolerance.velocity or contact.past_feature > 0.0 or not elapsed > left / rate:
            return math.inf
        elapsed -= left / rate
    return math.inf


@kernel("f8(ws, f8)")
def first_of_flying(ws: Workspace, soonest: float) -> float:
    """Return when the first gap between bodies that fly is closed, those being due that are due about ``soonest`` [s].

    The bodies do not stand at the start any more.
    """
    first = math.inf
    for contact in ws.contacts:
        fly_both = _flies(ws, contact.body_a) and _flies(ws, contact.body_b)
        if contact.closing_time <= min(ABOUT * soonest, first) and fly_both:
            first = min(first, _closing_of_flying(ws, contact.index))
    return first


@kernel("void(ws, f8)")
def keep_falls(ws: Workspace, h: float) -> None:
    """Keep how fast the rates of gaps that will be doubtful after a step of ``h`` can fall where it starts.

    The bodies stand there; later they would have to be put there.
    """
    for contact in ws.contacts:
        if _will_be_doubtful(ws, contact, h):
            accelerations = ws.island.slopes.start + ws.model.n_q
            contact.acceleration_bound_at_start = fall_of(ws, contact.index, accelerations)


@kernel("b1(f8, f8, f8, f8, f8)")
def too_far(g0: float, past0: float, g1: float, past1: float, way: float) -> bool:
    """Return 1 if a gap does not close by speed alone, the surfaces moving by ``way`` at most between its two ends.

    Only what faces each other says how far it is apart; of what does so at neither end the smaller number stands in.
    """
    if past0 > 0.0:
        return (min(g0, g1) if past1 > 0.0 else g1) > way
    return (g0 if past1 > 0.0 else g0 + g1) > way


@entry_point("void(ws, f8)")
def find_doubtful(ws: Workspace, h: float) -> None:
    """List the open contacts whose gaps may close within the step by the speeds alone; the bodies stand at its end.

    Those whose features do not face each other at an end of the step are a list of their own.  How fast the rates of
    the others can fall there is kept, for this step and the next one.
    """
    ws.step.n_may_close = ws.step.n_not_facing = 0
    accelerations = ws.island.slopes.start + LAST_STAGE * ws.model.n_y + ws.model.n_q
    for contact in ws.contacts:
        c, normal = contact.index, normal_of(ws, contact)
        contact.acceleration_bound_at_end = NO_BOUND
        if contact.mode != Mode.OPEN:
            continue
        start = 0.0 if normal.is_deflated else normal.initial
        way = h * (contact.speed_at_start + contact.speed_at_end)
        if too_far(start, contact.past_feature_at_start, contact.gap_at_end, contact.past_feature_at_end, way):
            continue
        if contact.past_feature_at_start > 0.0 or contact.past_feature_at_end > 0.0:
            ws.step.not_facing[ws.step.n_not_facing] = c
            ws.step.n_not_facing += 1
            continue
        contact.acceleration_bound_at_end = fall_of(ws, c, accelerations)
        ws.step.may_close[ws.step.n_may_close] = c
        ws.step.n_may_close += 1
