"""How the separation of a pair changes: its rate, a prediction, and bounds of its speed and acceleration.

The separation is evaluated along a vector m that changes at a constant rate, the drift, along the axes of the first
frame. The normal of a face of the first body has no drift; that of a face of the second one, or of two edges, has. As m
is no unit vector, the separation is multiplied by its length, which is at least 1. Each point b of the second part has
a height over each point a of the first, m . (b - a), and the separation is the least of these heights. So it never
falls below the least of all heights that are predicted with the present rates, except by half the bound of their
acceleration times the square of the time.

The predicted heights are linear in a and b. With the relative velocity v of the origins, the relative angular velocity
w and the drift d, the height after the time t is (m + t d) . (b - a) + t m . v + t (m x w) . b. There b and a are the
offsets from the origins. So the least height is that of two support points. Velocities are seen from the first frame.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.support import known_direction, support_offset, turned
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.native.kernel import Carrier, Pair, Workspace, frame_at, kernel
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, minus, scaled


@kernel("v3(v3, f8, v3)")
def _sum(a: Vector, factor: float, b: Vector) -> Vector:
    """Sum of a vector and a multiple of another one, a + factor b."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@kernel("f8(v3)")
def _size(v: Vector) -> float:
    """Length of a vector."""
    return math.sqrt(dot(v, v))


@kernel("v3(ws, Pair)")
def _drift(ws: Workspace, pair: Pair) -> Vector:
    """Rate of the direction of a pair, seen from the first frame, in the world [1/s]."""
    return turned(frame_at(ws.floats, pair.frame_a).rotation, pair.drift)


@kernel("v3(ws, Pair, f8)")
def _direction_at(ws: Workspace, pair: Pair, elapsed: float) -> Vector:
    """Vector along which the separation is evaluated, a time ``elapsed`` [s] after the search of the direction."""
    return _sum(known_direction(ws, pair), elapsed, _drift(ws, pair))


@kernel("f8(ws, Pair, f8)")
def length_of_direction(ws: Workspace, pair: Pair, elapsed: float) -> float:
    """Length of the vector along which the separation is evaluated, a time ``elapsed`` [s] after the search."""
    return _size(_direction_at(ws, pair, elapsed))


@kernel("v3(ws, Pair)")
def _relative_velocity(ws: Workspace, pair: Pair) -> Vector:
    """Velocity of the origin of the second frame, seen from the first one, which may rotate [m/s]."""
    a, b = frame_at(ws.floats, pair.frame_a), frame_at(ws.floats, pair.frame_b)
    return minus(minus(b.velocity, a.velocity), cross(a.spin, minus(b.origin, a.origin)))


@kernel("v3(ws, Pair)")
def _relative_spin(ws: Workspace, pair: Pair) -> Vector:
    """Angular velocity of the second frame relative to the first one [rad/s]."""
    return minus(frame_at(ws.floats, pair.frame_b).spin, frame_at(ws.floats, pair.frame_a).spin)


@kernel("f8(ws, Pair, b1, v3)")
def _extreme(ws: Workspace, pair: Pair, is_second: bool, w: Vector) -> float:
    """Least w . b of the points of the second part, or largest w . a of those of the first, from its origin [m]."""
    size = _size(w)
    outward = scaled(-1.0 / size if is_second else 1.0 / size, w)
    return dot(w, support_offset(ws, pair, is_second, outward))


@kernel("f8(ws, Pair, f8, f8)")
def predicted_separation(ws: Workspace, pair: Pair, elapsed: float, later: float) -> float:
    """Separation times the length of m, predicted for a time ``later`` [s], which may be negative [m].

    At present a time ``elapsed`` [s] has passed since the search of the direction. Both bodies must be evaluated.
    """
    m = _direction_at(ws, pair, elapsed)
    m_later = _sum(m, later, _drift(ws, pair))
    between = minus(frame_at(ws.floats, pair.frame_b).origin, frame_at(ws.floats, pair.frame_a).origin)
    height = dot(m_later, between) + later * dot(m, _relative_velocity(ws, pair))
    least_b = _extreme(ws, pair, True, _sum(m_later, later, cross(m, _relative_spin(ws, pair))))
    return height + least_b - _extreme(ws, pair, False, m_later)


@kernel("f8(ws, Pair)")
def rate_of(ws: Workspace, pair: Pair) -> float:
    """Rate of the separation along a direction that is fixed to the first part, at the present support points [m/s]."""
    n = known_direction(ws, pair)
    offset = support_offset(ws, pair, True, scaled(-1.0, n))
    return dot(n, _relative_velocity(ws, pair)) + dot(n, cross(_relative_spin(ws, pair), offset))


@kernel("f8(ws, Pair)")
def speed_of(ws: Workspace, pair: Pair) -> float:
    """Bound of the speed of the points of the second part, seen from the first [m/s]."""
    radius = ws.carriers[pair.carrier_b].radius
    return _size(_relative_velocity(ws, pair)) + _size(_relative_spin(ws, pair)) * radius


@kernel("f8(ws, Pair)")
def speed_of_drift(ws: Workspace, pair: Pair) -> float:
    """Bound of the acceleration of heights by the drift of the direction [m/s^2]."""
    return 2.0 * _size(pair.drift) * speed_of(ws, pair)


@kernel("v3(ws, Pair, b1, b1, i8)")
def _acceleration(ws: Workspace, pair: Pair, is_second: bool, is_angular: bool, du: int) -> Vector:
    """Acceleration of the origin of the second or the first frame [m/s^2], or its angular acceleration [rad/s^2].

    ``du`` is the offset of the accelerations of all bodies.
    """
    start = pair.frame_b if is_second else pair.frame_a
    body = ws.bodies[ws.carriers[pair.carrier_b if is_second else pair.carrier_a].body]
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
    """Bound of the acceleration of the points of the second part, seen from the first [m/s^2].

    ``du`` is the offset of the accelerations of all bodies.
    """
    a, b = frame_at(ws.floats, pair.frame_a), frame_at(ws.floats, pair.frame_b)
    own, between, spin = a.spin, minus(b.origin, a.origin), _relative_spin(ws, pair)
    alpha = _acceleration(ws, pair, is_second=False, is_angular=True, du=du)
    linear = minus(
        _acceleration(ws, pair, is_second=True, is_angular=False, du=du),
        _acceleration(ws, pair, is_second=False, is_angular=False, du=du),
    )
    # terms of the rotating first frame: alpha x d, omega x (omega x d), and twice omega x velocity
    linear = minus(minus(linear, cross(alpha, between)), cross(own, cross(own, between)))
    linear = minus(linear, scaled(2.0, cross(own, _relative_velocity(ws, pair))))
    angular = minus(minus(_acceleration(ws, pair, is_second=True, is_angular=True, du=du), alpha), cross(own, spin))
    return _size(linear) + (_size(angular) + dot(spin, spin)) * ws.carriers[pair.carrier_b].radius


@kernel("f8(ws, Carrier)")
def speed_of_parts(ws: Workspace, carrier: Carrier) -> float:
    """Bound of the speed of all points of the parts of a carrier [m/s]. Its body must be evaluated."""
    frame = frame_at(ws.floats, carrier.frame)
    return _size(frame.velocity) + _size(frame.spin) * carrier.radius


@kernel()
def bound_carriers(ws: Workspace) -> None:
    """Write bounds of the speeds of all parts of each carrier at the end of a step [m/s]. Bodies must be evaluated."""
    for carrier in ws.carriers:
        carrier.speed_at_end = speed_of_parts(ws, carrier)
