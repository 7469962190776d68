"""Contact of two frustums where their rims cross each other.

The line from a point of the first circle to the nearest point of the second circle is perpendicular to the second.  If
it is perpendicular to the first as well, its ends are the nearest points.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import SIDE, SWEEP
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.edge_crossing import PARALLEL
from ..features.ends import CLOSED, REACH
from ..features.frames import across
from ..smooth.smooth_core import axes_in_world, rotated, rotated_back
from .circle import least_sample, zero_of_slope
from .frustum import (
    FLANK,
    LOW_RIM,
    Spot,
    off_cone_of_rim,
    off_side,
    past_border,
    past_depth,
    placed,
    rim_of,
    write_pair,
)

_BOTH = 1e-9
"""Overlap of the two halves of the first rim at the line of centres [rad]; no crossing is missed between the halves."""
_ASIDE = 1e-11
"""Least offset of the common normal of two rounded rims from a side's normal, relative to the size of the bodies.

The offset [m] is the distance of the rims' cores, times the sine of the angle between their common normal and the
normal of a side, the smaller one of both sides.  At a smaller offset, the contact of a rim with a side replaces this
contact.
"""
_SAMPLES, _LEVELS = 16, 3
"""Number of intervals into which half of a rim is sampled, and largest number of rounds of sampling."""


class _Circles(NamedTuple):
    """Two circles: the second one lies round the origin in the plane z = 0.

    The first has the point ``middle`` + ``radius`` (g cos(angle) + h sin(angle)) at an angle, with the perpendicular
    unit vectors ``g`` and ``h``; lengths in m.
    """

    other_radius: float
    radius: float
    middle: Vector3
    g: Vector3
    h: Vector3


@compiled
def _on_circle(g: Vector3, h: Vector3, angle: float) -> tuple[Vector3, Vector3]:
    """Return the unit vector g cos(angle) + h sin(angle), and its derivative by the angle."""
    c, s = math.cos(angle), math.sin(angle)
    return plus(scaled(c, g), scaled(s, h)), minus(scaled(c, h), scaled(s, g))


@compiled
def _squared_distance(circles: _Circles, angle: float) -> tuple[float, float, float]:
    """Return the squared distance of the first circle's point from the second [m^2], a slope [m], and its derivative.

    The slope is the derivative of the squared distance by the angle, over 2 ``radius``.  The last number is the
    derivative of the slope by the angle [m].
    """
    other_radius, radius, middle, g, h = circles
    u, (tx, ty, tz) = _on_circle(g, h, angle)
    x, y, z = plus_scaled(middle, radius, u)
    away = max(math.sqrt(x * x + y * y), 1e-300)
    square = (away - other_radius) * (away - other_radius) + z * z
    # the derivative of away by the angle is radius along / away
    factor = 1.0 - other_radius / away
    along = x * tx + y * ty
    slope = factor * along + z * tz
    bend = factor * (radius * (tx * tx + ty * ty) - x * u[0] - y * u[1]) + radius * tz * tz - z * u[2]
    return square, slope, bend + other_radius / (away * away * away) * radius * along * along


@compiled
def _link_depth(circles: _Circles) -> float:
    """Return how deep one circle lies inside of another one with which it is linked like the links of a chain [m].

    The first circle then crosses the plane of the second at two points, and exactly one of them is inside the second.
    The result is the distance of this point from the second circle, or 0 if the circles are not linked.
    """
    other_radius, radius, center, g, h = circles
    # the height of the first circle's point is center_z + amplitude cos(angle - highest); it is zero at two angles
    amplitude = radius * math.sqrt(g[2] * g[2] + h[2] * h[2])
    if abs(center[2]) >= amplitude:
        return 0.0
    highest, to_zero = math.atan2(h[2], g[2]), math.acos(-center[2] / amplitude)
    least, most = math.inf, -math.inf
    for sign in (-1.0, 1.0):
        c, s = radius * math.cos(highest + sign * to_zero), radius * math.sin(highest + sign * to_zero)
        x, y, _ = plus_scaled(plus_scaled(center, c, g), s, h)
        depth = other_radius - math.hypot(x, y)
        least, most = min(least, depth), max(most, depth)
    return most if least < 0.0 < most else 0.0


@compiled
def _nearest_angle(circles: _Circles) -> float:
    """Return the angle round half of the first circle at the least distance from the other circle [rad].

    The half begins at g, on the line of centres, and ends at -g.  The result may lie outside of the half, or may be no
    minimum: the caller checks it.
    """
    low, high = -_BOTH, math.pi + _BOTH
    begin, step, angle = low, (high - low) / _SAMPLES, low
    for _ in range(_LEVELS):
        angle, bend = least_sample(_squared_distance, circles, begin, step, _SAMPLES)
        # the least sample is next to a minimum, or well inside of the half
        if bend > 0.0 or low + 0.5 * step < angle < high - 0.5 * step:
            break
        # circles that cross close to the line of centres have a maximum of the distance on this line: refine next to it
        begin = low if angle < 1.0 else high - step
        step /= _SAMPLES
    return float(zero_of_slope(_squared_distance, circles, angle, angle - step, angle + step))


def evaluate_rims(
    a: Floats,
    b: Floats,
    out: Floats,
    first: Floats,
    rim_a: float,
    second: Floats,
    rim_b: float,
    half: float,
    size: float,
) -> None:
    """Write the geometry block of a rim of each body that cross, on one side of the line of the rims' centres.

    Two rims may cross twice, once on either side of this line: ``half`` is 1 or -1, for the half circle of the first
    rim on one side or the other.  The contact points are the nearest points of the rims, and the normal is
    perpendicular to both.  ``rim_a`` and ``rim_b`` are 1 for the lower rim, 3 for the upper one.  ``size`` is the size
    of the bodies [m].
    """
    one, two, axes = placed(a, first), placed(b, second), axes_in_world(b, second)
    (radius, height, up_a), (other_radius, height_b, up_b) = rim_of(first, rim_a), rim_of(second, rim_b)
    # centre of the first rim, from the centre of the second rim, and axis of the first, in the axes of the second body
    axis = rotated_back(axes, one.axis)
    cx, cy, cz = plus_scaled(rotated_back(axes, minus(one.center, two.center)), height, axis)
    middle = (cx, cy, cz - height_b)
    # g: unit vector in the plane of the first rim, towards the second rim's centre; h: perpendicular to it
    _, _, g = across(opposite(middle), axis)
    h = scaled(half, cross(axis, g))
    circles = _Circles(other_radius, radius, middle, g, h)
    angle = _nearest_angle(circles)
    total = first[SWEEP] + second[SWEEP]
    are_discs = total == 0.0 and first[SIDE] == 0.0 and second[SIDE] == 0.0
    # discs in one plane touch on the line of centres, where their rims are parallel; other discs cross or pass by
    is_parallel = axis[0] * axis[0] + axis[1] * axis[1] <= CLOSED
    is_edge_to_edge = are_discs and is_parallel and abs(middle[2] + radius * g[2]) <= CLOSED * size
    if is_edge_to_edge:
        angle = 0.0
    # u and t: outward radius and tangent of the first rim at the crossing; e: outward radius of the second rim there;
    # w: vector from the first rim's point to the second's
    u, t = _on_circle(g, h, angle)
    point = plus_scaled(middle, radius, u)
    away = math.sqrt(point[0] * point[0] + point[1] * point[1])
    e = (point[0] / away, point[1] / away, 0.0) if away > 0.0 else (1.0, 0.0, 0.0)
    w = (other_radius * e[0] - point[0], other_radius * e[1] - point[1], -point[2])
    # normal: cross product of both tangents; the tangent of the second circle is (-ey, ex, 0)
    n = (-t[2] * e[0], -t[2] * e[1], t[0] * e[0] + t[1] * e[1])
    sine, apart = norm(n), norm(w)
    # rounded rims that lie on each other along the whole circle are left to the contacts of rims over caps
    is_ring = total > 0.0 and sine <= PARALLEL and math.sqrt(w[0] * w[0] + w[1] * w[1]) < REACH * apart
    if total > 0.0 and apart > 1e-9 * size:
        # the normal of cores that are apart is the line between their points, also for parallel tangents
        n, sine = divided(w, apart), 1.0
    elif is_edge_to_edge or sine <= PARALLEL:
        n, sine = u, 1.0 if is_edge_to_edge else 0.0
    else:
        n = divided(n, sine)
    # take the sign of the normal that is nearer to the normal cones of both rims; 3 exceeds all sines
    off_cone, chosen_sign = 3.0, 1.0
    for sign in (-1.0, 1.0):
        if total > 0.0 and sign * dot(n, w) < 0.0:
            # rounded bodies: the normal must point from the first rim to the second
            continue
        off_both = off_cone_of_rim(first, up_a, sign * dot(n, u), sign * dot(n, axis))
        radial = -sign * (n[0] * e[0] + n[1] * e[1])
        off_both = max(off_both, off_cone_of_rim(second, up_b, radial, -sign * n[2]))
        if off_both < off_cone:
            off_cone, chosen_sign = off_both, sign
    n = scaled(chosen_sign, n)
    gap = dot(n, w)
    past = past_border(-size, off_cone, size)
    off_side_a = off_side(first, up_a, dot(n, u), dot(n, axis))
    off_side_b = off_side(second, up_b, -(n[0] * e[0] + n[1] * e[1]), -n[2])
    if total > 0.0:
        # if the normal is close to a side's normal, the contact of a rim over the side applies
        past = max(past, _ASIDE * size - apart * min(off_side_a, off_side_b))
    elif sine * sine <= REACH and sine * max(abs(off_side_a), abs(off_side_b)) <= PARALLEL:
        # the normal of nearly parallel rims has an error; if it may be the normal of both sides, the sides touch
        past = max(past, size)
    # there is no minimum within this half of the rim, or Newton's method did not find it
    is_outside = angle < -_BOTH or angle > math.pi + _BOTH or abs(dot(w, t)) > 1e-12 * size
    if is_outside or sine <= PARALLEL or is_ring or (is_edge_to_edge and half < 0.0):
        past = max(past, size)
    if gap < 0.0:
        # at an overlap, a normal outside of the normal cones has no margin
        past = max(past, size * (off_cone - PARALLEL))
    if not is_edge_to_edge:
        past = max(past, past_depth(one, two, gap, size))
    if are_discs and gap < 0.0 and not is_edge_to_edge:
        # discs overlap at a crossing only if they are linked there; one lies at least so deep inside of the other
        past = max(past, sine * (-0.5 * gap - REACH * size) - _link_depth(circles))
    normal, from_center = rotated(axes, n), rotated(axes, (point[0], point[1], point[2] + height_b))
    # of two discs edge to edge, the second rim has the curvature of a cylinder's side, so that the normal stays radial
    # while one edge slips over the other
    own = Spot(one, LOW_RIM, rotated(axes, u), radius)
    other = Spot(two, FLANK if is_edge_to_edge else LOW_RIM, rotated(axes, e), other_radius)
    write_pair(a, out, 0.0, gap, past, normal, plus(two.center, from_center), own, other)
