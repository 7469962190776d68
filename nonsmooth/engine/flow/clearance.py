"""Bounds of the speed and the acceleration of open gaps within a step, which prove that most of them stay open.

The bound of a gap's speed follows from the relative velocity and rotation of the bodies and the radius of the smaller
shape about its origin. The bound of its acceleration towards closing follows from their relative accelerations. With
the gap and its rate at both ends of a step, these bounds prove that most gaps stay open. The others are searched within
the step (:mod:`nonsmooth.engine.flow.gap_search`).

The bounds hold if within a step no speed exceeds the sum of the speeds at its ends, which the error control of the step
ensures. Features that do not face each other have a gap without a rate, of which nothing is proved.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_body, evaluate_driven_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_geometry, evaluate_rates
from nonsmooth.engine.flow.arming import NO_BOUND
from nonsmooth.engine.flow.flight import fly
from nonsmooth.engine.flow.guard_numbers import is_of_watched_pair, normal_of
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.memory.layout import LAST_STAGE, NO_PAIR
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, Floats, Workspace, entry_point, frame_at, kernel
from nonsmooth.engine.numerics.tolerances import NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, minus, scaled

_CURVED = 4.0
"""Assumed largest angular velocity of a contact normal on a curved surface or an edge, relative to that of the bodies.

The bound of a gap's acceleration uses it.
"""
_CLOSINGS = 8
"""Largest number of Newton steps to the closing time of a gap between ballistic bodies.

If more were needed, the closing time is taken as unknown, and does not limit the step.
"""
ABOUT = 1.1
"""Gaps are searched up to this multiple of the first expected closing time, because expected times are inaccurate."""


@kernel("f8(F, i8, i8)")
def _speed_seen(floats: Floats, frame_a: int, frame_b: int) -> float:
    """Speed of the origin of the second frame relative to the first frame, which may rotate [m/s]."""
    a, b = frame_at(floats, frame_a), frame_at(floats, frame_b)
    x, y, z = minus(b.origin, a.origin)
    ox, oy, oz = a.spin
    vx, vy, vz = minus(b.velocity, a.velocity)
    seen = vx - oy * z + oz * y, vy - oz * x + ox * z, vz - ox * y + oy * x
    return math.sqrt(dot(seen, seen))


@kernel("v3(ws, i8)")
def _axis(ws: Workspace, c: int) -> Vector:
    """Axis of revolution, in space, of the shape with the smaller radius about its origin; zero if it has none.

    A rotation about this axis does not move the surface of the shape.
    """
    contact = ws.contacts[c]
    is_second = contact.support_radius_b <= contact.support_radius_a
    r, v = frame_at(ws.floats, contact.frame_b if is_second else contact.frame_a).rotation, contact.spin_axis
    return dot((r[0], r[1], r[2]), v), dot((r[3], r[4], r[5]), v), dot((r[6], r[7], r[8]), v)


@kernel("v3(v3, v3)")
def _across(v: Vector, axis: Vector) -> Vector:
    """Component of a vector perpendicular to a unit axis; the whole vector if ``axis`` is zero."""
    return minus(v, scaled(dot(v, axis), axis))


@kernel()
def bound_speeds(ws: Workspace) -> None:
    """Write upper bounds of the speeds of the open gaps at the present state to ``speed_at_end`` [m/s].

    Relative to one body, the other body's surface moves along a normal at most with the speed of its origin, plus its
    angular velocity times its radius about the origin. ``fastest_turn`` [rad/s] becomes the fastest rotation in pairs
    with a ballistic body, also the rotation of the other body.  It limits the step, because a precessing top may look
    the same at both ends of a long step.
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
        # contacts of the same two bodies are adjacent in the list, so their speeds are evaluated once
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
    """Vector from the frame's origin to the witness point of the body with the smaller support radius [m].

    The witness point is that of the last evaluation of contact ``c``.
    """
    contact = ws.contacts[c]
    if contact.support_radius_b <= contact.support_radius_a:
        return minus(contact.point_b, frame_at(ws.floats, contact.frame_b).origin)
    return minus(contact.point_a, frame_at(ws.floats, contact.frame_a).origin)


@kernel("v3(ws, i8, i8, b1, i8)")
def _acceleration(ws: Workspace, c: int, side: int, is_angular: bool, du: int) -> Vector:
    """Acceleration of a body frame's origin [m/s^2], or its angular acceleration [rad/s^2], on one side of a contact.

    ``du`` is the offset of the accelerations of all bodies.
    """
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
    """Bound of the acceleration with which the gap of contact ``c`` closes, as three numbers.

    1. Bound at the present state [m/s^2].
    2. Increase of the bound per second after this state [m/s^3].
    3. Relative angular velocity of the bodies [rad/s], without rotation about an axis of revolution.

    ``du`` is the offset of the accelerations of all bodies. The normal is fixed to the body with the larger support
    radius. The distance of a convex body along a fixed normal is at most the gap, and so bounds the gap from below.
    Rotation enters with the support radius of the smaller shape, so the bound holds for all points of this shape.
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
    # the component perpendicular to the axis also changes because the axis turns
    angular = minus(_across(angular, axis), scaled(own, cross(turning, axis)))
    # terms of the rotating first frame: alpha x d, omega x (omega x d), and twice omega x velocity
    linear = minus(minus(linear, cross(alpha, way)), cross(spin, cross(spin, way)))
    linear = minus(linear, scaled(2.0, cross(spin, velocity)))
    along = dot(contact.normal, linear)
    speed, rate = math.sqrt(dot(velocity, velocity)), math.sqrt(dot(turning, turning))
    lever = min(contact.support_radius_a, contact.support_radius_b)
    # features that do not face each other have no normal along which their gap closes
    faces = contact.past_feature <= 0.0
    fall = max(0.0, -along if second else along) if faces else math.sqrt(dot(linear, linear))
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
    """Time after which the gap of contact ``c`` closes at constant accelerations [s]; infinite if it does not close.

    It is also infinite if neither shape is a ball about its frame's origin. Rotation then moves both surfaces, and the
    estimate is poor: it would shorten steps because of gaps that do not close.
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
    """Time until the first expected closing of a gap that may close in a step of ``h`` [s]; infinite if none [s].

    The expected time of each such gap is stored in its ``closing_time``.
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
    """True if a body is driven or in ballistic motion, so that its motion is known without integration."""
    body = ws.bodies[number]
    return body.n_u == 0 or body.is_ballistic


@kernel("f8(ws, i8)")
def _closing_of_flying(ws: Workspace, c: int) -> float:
    """Time until the gap of ``c``, between ballistic or driven bodies, is nearly closed [s]; infinite if not found.

    Newton's method starts at the expected time. The gap that remains is positive and far below the tolerance.
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
        # gap that remains at the end of the step: negligible against the tolerances of gap and time
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
    """Time after which the first gap between ballistic or driven bodies closes [s]; infinite if none is found.

    The search covers the gaps that are expected to close by about ``soonest`` [s]. It overwrites the evaluation of the
    bodies at the start of the step.
    """
    first = math.inf
    for contact in ws.contacts:
        fly_both = _flies(ws, contact.body_a) and _flies(ws, contact.body_b)
        if contact.closing_time <= min(ABOUT * soonest, first) and fly_both:
            first = min(first, _closing_of_flying(ws, contact.index))
    return first


@kernel("void(ws, f8)")
def keep_falls(ws: Workspace, h: float) -> None:
    """Store the acceleration bound, at the start of a step of ``h`` [s], of each gap that may close within the step.

    This is done before the step, because the bodies are still evaluated at its start.
    """
    for contact in ws.contacts:
        if _will_be_doubtful(ws, contact, h):
            accelerations = ws.island.slopes.start + ws.model.n_q
            contact.acceleration_bound_at_start = fall_of(ws, contact.index, accelerations)


@kernel("b1(f8, f8, f8, f8, f8)")
def too_far(g0: float, past0: float, g1: float, past1: float, way: float) -> bool:
    """True if a gap cannot close between two times, because its surfaces move by at most ``way`` [m] in between.

    ``g0`` and ``g1`` are the gaps at both times [m], ``past0`` and ``past1`` the distances past the ends of the
    features [m].  Past an end, the gap is no true distance.  If this holds at one time, only the gap at the other time
    is used.  If it holds at both times, only the smaller gap is used.
    """
    if past0 > 0.0:
        return (min(g0, g1) if past1 > 0.0 else g1) > way
    return (g0 if past1 > 0.0 else g0 + g1) > way


@entry_point("void(ws, f8)")
def find_doubtful(ws: Workspace, h: float) -> None:
    """List the open contacts whose gaps may close within the step of ``h`` [s], by the bounds of their speeds.

    The bodies must be evaluated at the end of the step. The acceleration bound of each listed contact at the end is
    stored, for this step and the next.
    """
    ws.step.n_may_close = 0
    accelerations = ws.island.slopes.start + LAST_STAGE * ws.model.n_y + ws.model.n_q
    for contact in ws.contacts:
        c, normal = contact.index, normal_of(ws, contact)
        contact.acceleration_bound_at_end = NO_BOUND
        if contact.mode != Mode.OPEN or is_of_watched_pair(ws, contact):
            continue
        # springs carry shapes that touch, so those of features that do not face each other wait for the end of the step
        touches = contact.pair != NO_PAIR and ws.pairs[contact.pair].is_guarded
        if contact.is_compliant and touches and contact.past_feature_at_start > 0.0:
            continue
        start = 0.0 if normal.is_deflated else normal.initial
        way = h * (contact.speed_at_start + contact.speed_at_end)
        if too_far(start, contact.past_feature_at_start, contact.gap_at_end, contact.past_feature_at_end, way):
            continue
        contact.acceleration_bound_at_end = fall_of(ws, c, accelerations)
        ws.step.may_close[ws.step.n_may_close] = c
        ws.step.n_may_close += 1
