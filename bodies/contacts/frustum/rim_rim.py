"""Contact of two frustums where their rims cross each other.

The line from a point of the first circle to the nearest point of the second circle is perpendicular to the second.  If
it is perpendicular to the first as well, its ends are the nearest points.  Samples of the first circle bracket such a
point, then Newton's method between bounds finds it.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import COS, SIDE, SIN, SWEEP
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.edge_crossing import PARALLEL
from ..features.ends import CLOSED, REACH
from ..features.frames import across
from ..smooth.smooth_core import axes_in_world, rotated, rotated_back
from .frustum import FLANK, LOW_RIM, center_in_world, rim_of
from .frustum_writing import off_cone_of_rim, past_border, past_depth, write_rounded_part, write_two

_BOTH = 1e-9
"""Overlap of the two halves of the first rim at the line of centres [rad]; no crossing is missed between the halves."""
_ASIDE = 1e-11
"""Least offset of the common normal of two rounded rims from a side's normal, relative to the size of the bodies.

The offset [m] is the distance of the rims' cores, times the sine of the angle between their common normal and the
normal of a side, the smaller one of both sides.  At a smaller offset, the contact of a rim with a side replaces this
contact.
"""
_SAMPLES, _LEVELS, _STEPS = 16, 3, 60
"""Number of intervals into which half of a rim is sampled; largest numbers of rounds of sampling and Newton steps."""


@compiled
def _on_circle(g: Vector3, h: Vector3, angle: float) -> tuple[Vector3, Vector3]:
    """Return the unit vector g cos(angle) + h sin(angle), and its derivative by the angle."""
    c, s = math.cos(angle), math.sin(angle)
    return plus(scaled(c, g), scaled(s, h)), minus(scaled(c, h), scaled(s, g))


@compiled
def _squared_distance(
    other_radius: float, radius: float, middle: Vector3, g: Vector3, h: Vector3, angle: float
) -> tuple[float, float, float]:
    """Return the squared distance of a point of one circle from another circle [m^2], a slope [m], and its derivative.

    The first circle has the centre ``middle`` [m]; its point at ``angle`` [rad] is middle + radius (g cos(angle) + h
    sin(angle)), with the ``radius`` [m] and the perpendicular unit vectors ``g`` and ``h``.  The other circle lies
    round the origin in the plane z = 0, with the radius ``other_radius`` [m].  The slope is the derivative of the
    squared distance by the angle, over 2 ``radius``.  The last number is the derivative of the slope by the angle [m].
    """
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
def _link_depth(other_radius: float, radius: float, center: Vector3, g: Vector3, h: Vector3) -> float:
    """Return how deep one circle lies inside of another one with which it is linked like the links of a chain [m].

    The first circle then crosses the plane of the second at two points, and exactly one of them is inside the second.
    The result is the distance of this point from the second circle, or 0 if the circles are not linked.  The second
    circle has the radius ``other_radius`` [m], about the origin in the plane z = 0.  The first has the given centre [m]
    and ``radius`` [m] in the plane of the perpendicular unit vectors g and h.
    """
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
def _nearest_angle(other_radius: float, radius: float, middle: Vector3, g: Vector3, h: Vector3) -> float:
    """Return the angle round half of the first circle at the least distance from the other circle [rad].

    The arguments are those of :func:`_squared_distance`.  The half begins at g, on the line of centres, and ends at
    -g.  The result may lie outside of the half, or may be no minimum: the caller checks it.
    """
    low, high = -_BOTH, math.pi + _BOTH
    begin, step, angle = low, (high - low) / _SAMPLES, low
    for _ in range(_LEVELS):
        least_square, least_bend, chosen = math.inf, 0.0, 0
        for i in range(_SAMPLES + 1):
            square, _, bend = _squared_distance(other_radius, radius, middle, g, h, begin + i * step)
            if square < least_square:
                least_square, least_bend, chosen = square, bend, i
        angle = begin + chosen * step
        # the least sample is next to a minimum, or well inside of the half
        if least_bend > 0.0 or low + 0.5 * step < angle < high - 0.5 * step:
            break
        # circles that cross close to the line of centres have a maximum of the distance on this line: refine next to it
        begin = low if angle < 1.0 else high - step
        step /= _SAMPLES
    least, most = angle - step, angle + step
    for _ in range(_STEPS):
        _, slope, bend = _squared_distance(other_radius, radius, middle, g, h, angle)
        if slope > 0.0:
            most = angle
        else:
            least = angle
        # without a positive bend, or out of bounds, halve the interval
        after = angle - slope / bend if bend > 0.0 else math.inf
        if after < least or after > most:
            after = 0.5 * (least + most)
        if abs(after - angle) <= 2e-16 * max(abs(angle), 0.1):
            break
        angle = after
    return angle


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

    Two rims may cross twice, once on either side of this line.  The contact points are the nearest points of the rims,
    and the normal is perpendicular to both.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    first, second : Floats
        The bodies (:func:`bodies.shapes.frustum.frustum_numbers`).
    rim_a, rim_b : float
        1 for the lower rim, 3 for the upper one.
    half : float
        1 or -1, for the half circle of the first rim on one side or the other of the line of centres.
    size : float
        Size of the bodies [m].
    """
    axes_a, axes = axes_in_world(a, first), axes_in_world(b, second)
    axis_a, center_b = (axes_a[2], axes_a[5], axes_a[8]), center_in_world(b, second)
    (radius, height, up_a), (other_radius, height_b, up_b) = rim_of(first, rim_a), rim_of(second, rim_b)
    # centre of the first rim, from the centre of the second rim, and axis of the first, in the axes of the second body
    axis = rotated_back(axes, axis_a)
    cx, cy, cz = plus_scaled(rotated_back(axes, minus(center_in_world(a, first), center_b)), height, axis)
    middle = (cx, cy, cz - height_b)
    # g: unit vector in the plane of the first rim, towards the second rim's centre; h: perpendicular to it
    _, _, g = across(opposite(middle), axis)
    h = scaled(half, cross(axis, g))
    angle = _nearest_angle(other_radius, radius, middle, g, h)
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
        off_both = off_cone_of_rim(first, up_a, sign * dot(n, u), sign * dot(n, axis), first[SIDE] == 0.0)
        radial = -sign * (n[0] * e[0] + n[1] * e[1])
        off_both = max(off_both, off_cone_of_rim(second, up_b, radial, -sign * n[2], second[SIDE] == 0.0))
        if off_both < off_cone:
            off_cone, chosen_sign = off_both, sign
    n = scaled(chosen_sign, n)
    gap = dot(n, w)
    past = past_border(-size, off_cone, size)
    # sines of the angles between the contact normal and the normals of the two sides; a disc has no side
    off_side_a = up_a * (first[COS] * dot(n, axis) - first[SIN] * dot(n, u)) if first[SIDE] > 0.0 else 1.0
    radial = n[0] * e[0] + n[1] * e[1]
    off_side_b = -up_b * (second[COS] * n[2] - second[SIN] * radial) if second[SIDE] > 0.0 else 1.0
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
        past = max(past, past_depth(a, first, b, second, gap, size))
    if are_discs and gap < 0.0 and not is_edge_to_edge:
        # discs overlap at a crossing only if they are linked there; one lies at least so deep inside of the other
        past = max(past, sine * (-0.5 * gap - REACH * size) - _link_depth(other_radius, radius, middle, g, h))
    normal, from_center = rotated(axes, n), rotated(axes, (point[0], point[1], point[2] + height_b))
    write_two(a, out, 0.0, first, second, gap, past, normal, plus(center_b, from_center))
    write_rounded_part(out, 0.0, first, LOW_RIM, axis_a, rotated(axes, u), normal, radius)
    # of two discs edge to edge, the second rim has the curvature of a cylinder's side, so that the normal stays radial
    # while one edge slips over the other
    part = FLANK if is_edge_to_edge else LOW_RIM
    write_rounded_part(
        out, 1.0, second, part, (axes[2], axes[5], axes[8]), rotated(axes, e), opposite(normal), other_radius
    )
