"""How the separation of a pair changes: its rate, a prediction, and bounds of its speed and acceleration.

The separation s(n) is evaluated along a direction n that is fixed to one of the parts. The support point of that part
rests in its frame. Each point of the other part, the moving one, has a height along n over it, and s(n) is the least of
these heights. So s(n) never falls below the least of all heights that are predicted with the present rates, except by
half the bound of the acceleration times the square of the time. The least predicted height is that of one support
point: with the unit vector u that points from the fixed to the moving part, the relative velocity v of the origins and
the relative angular velocity w, the point at the offset r has the height u . r + t (u . v + (u x w) . r), and that is
linear in r. All velocities are those that an observer on the fixed part sees.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.native.kernel import Pair, Workspace, frame_at, kernel
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, minus, opposite, scaled
from nonsmooth.engine.pairs.support import known_direction, separation_along, store_direction, support_offset


@kernel("i8(Pair, b1)")
def _frame(pair: Pair, is_moving: bool) -> int:
    """Offset of the frame of the moving part, or of the part to which the direction is fixed."""
    return int(pair.frame_b if pair.is_fixed_to_second != is_moving else pair.frame_a)


@kernel("i8(Pair, b1)")
def _carrier(pair: Pair, is_moving: bool) -> int:
    """Carrier of the moving part, or of the part to which the direction is fixed."""
    return int(pair.carrier_b if pair.is_fixed_to_second != is_moving else pair.carrier_a)


@kernel("v3(ws, Pair)")
def _outward(ws: Workspace, pair: Pair) -> Vector:
    """Direction of a pair, from the part to which it is fixed to the moving part."""
    n = known_direction(ws, pair)
    return opposite(n) if pair.is_fixed_to_second else n


@kernel("v3(ws, Pair)")
def _relative_velocity(ws: Workspace, pair: Pair) -> Vector:
    """Velocity of the origin of the moving frame, seen from the fixed one, which may rotate [m/s]."""
    fixed, moving = (
        frame_at(ws.floats, _frame(pair, is_moving=False)),
        frame_at(ws.floats, _frame(pair, is_moving=True)),
    )
    return minus(minus(moving.velocity, fixed.velocity), cross(fixed.spin, minus(moving.origin, fixed.origin)))


@kernel("v3(ws, Pair)")
def _relative_spin(ws: Workspace, pair: Pair) -> Vector:
    """Angular velocity of the moving frame relative to the fixed one [rad/s]."""
    fixed, moving = (
        frame_at(ws.floats, _frame(pair, is_moving=False)),
        frame_at(ws.floats, _frame(pair, is_moving=True)),
    )
    return minus(moving.spin, fixed.spin)


@kernel("f8(ws, Pair)")
def separation_of(ws: Workspace, pair: Pair) -> float:
    """Separation of a pair along its direction [m]. Both bodies must be evaluated."""
    return float(separation_along(ws, pair.index, known_direction(ws, pair)))


@kernel("f8(ws, Pair)")
def rate_of(ws: Workspace, pair: Pair) -> float:
    """Rate of the separation of a pair along its direction at its present support points [m/s]."""
    u = _outward(ws, pair)
    offset = support_offset(ws, pair, not pair.is_fixed_to_second, opposite(u))
    return dot(u, _relative_velocity(ws, pair)) + dot(u, cross(_relative_spin(ws, pair), offset))


@kernel("f8(ws, Pair)")
def speed_of(ws: Workspace, pair: Pair) -> float:
    """Bound of the rate of the separation along any direction that is fixed to the same part [m/s]."""
    v, spin = _relative_velocity(ws, pair), _relative_spin(ws, pair)
    return math.sqrt(dot(v, v)) + math.sqrt(dot(spin, spin)) * ws.carriers[_carrier(pair, is_moving=True)].radius


@kernel("f8(ws, Pair, f8)")
def predicted_separation(ws: Workspace, pair: Pair, elapsed: float) -> float:
    """Least height after the time ``elapsed`` [s], which may be negative, with the present rates [m]."""
    u, is_second = _outward(ws, pair), not pair.is_fixed_to_second
    turned = cross(u, _relative_spin(ws, pair))
    w = u[0] + elapsed * turned[0], u[1] + elapsed * turned[1], u[2] + elapsed * turned[2]
    now = dot(u, support_offset(ws, pair, is_second, opposite(u)))
    # the length of w is at least 1: the change of u is perpendicular to it
    later = dot(w, support_offset(ws, pair, is_second, scaled(-1.0 / math.sqrt(dot(w, w)), w)))
    return separation_of(ws, pair) + elapsed * dot(u, _relative_velocity(ws, pair)) + later - now


@kernel("void(ws, Pair, f8)")
def fix_direction(ws: Workspace, pair: Pair, elapsed: float) -> None:
    """Fix the direction of a pair to the part for which the separation predicted after ``elapsed`` [s] is larger.

    The normal of a face, for example, is best fixed to the body of the face.
    """
    n, one = known_direction(ws, pair), predicted_separation(ws, pair, elapsed)
    _fix_to_other(ws, pair, n)
    if predicted_separation(ws, pair, elapsed) < one:
        _fix_to_other(ws, pair, n)


@kernel("void(ws, Pair, v3)")
def _fix_to_other(ws: Workspace, pair: Pair, n: Vector) -> None:
    """Fix the direction ``n`` of a pair to the other part."""
    pair.is_fixed_to_second = not pair.is_fixed_to_second
    store_direction(ws, pair, n)


@kernel("v3(ws, Pair, b1, b1, i8)")
def _acceleration(ws: Workspace, pair: Pair, is_moving: bool, is_angular: bool, du: int) -> Vector:
    """Acceleration of the origin of the moving or the fixed frame [m/s^2], or its angular acceleration [rad/s^2].

    ``du`` is the offset of the accelerations of all bodies.
    """
    body, start = ws.bodies[ws.carriers[_carrier(pair, is_moving)].body], _frame(pair, is_moving)
    n_u, first = body.n_u, du + body.u
    frame = frame_at(ws.floats, start)
    x, y, z = frame.spin_acceleration if is_angular else frame.acceleration
    # the Jacobian has three rows for the origin, then three for the rotation
    row = start + FRAME + (3 * n_u if is_angular else 0)
    for j in range(n_u):
        x += ws.floats[row + j] * ws.floats[first + j]
        y += ws.floats[row + n_u + j] * ws.floats[first + j]
        z += ws.floats[row + 2 * n_u + j] * ws.floats[first + j]
    return x, y, z


@kernel("f8(ws, Pair, i8)")
def acceleration_bound(ws: Workspace, pair: Pair, du: int) -> float:
    """Bound of the acceleration of all points of the moving part, seen from the fixed one [m/s^2].

    ``du`` is the offset of the accelerations of all bodies.
    """
    fixed, moving = (
        frame_at(ws.floats, _frame(pair, is_moving=False)),
        frame_at(ws.floats, _frame(pair, is_moving=True)),
    )
    own, between, spin = fixed.spin, minus(moving.origin, fixed.origin), _relative_spin(ws, pair)
    alpha = _acceleration(ws, pair, is_moving=False, is_angular=True, du=du)
    linear = minus(
        _acceleration(ws, pair, is_moving=True, is_angular=False, du=du),
        _acceleration(ws, pair, is_moving=False, is_angular=False, du=du),
    )
    # terms of the rotating fixed frame: alpha x d, omega x (omega x d), and twice omega x velocity
    linear = minus(minus(linear, cross(alpha, between)), cross(own, cross(own, between)))
    linear = minus(linear, scaled(2.0, cross(own, _relative_velocity(ws, pair))))
    angular = minus(minus(_acceleration(ws, pair, is_moving=True, is_angular=True, du=du), alpha), cross(own, spin))
    radius = ws.carriers[_carrier(pair, is_moving=True)].radius
    return math.sqrt(dot(linear, linear)) + (math.sqrt(dot(angular, angular)) + dot(spin, spin)) * radius


@kernel()
def bound_carriers(ws: Workspace) -> None:
    """Write bounds of the speeds of all parts of each carrier at the end of a step [m/s]. Bodies must be evaluated."""
    for carrier in ws.carriers:
        frame = frame_at(ws.floats, carrier.frame)
        turning = math.sqrt(dot(frame.spin, frame.spin)) * carrier.radius
        carrier.speed_at_end = math.sqrt(dot(frame.velocity, frame.velocity)) + turning
