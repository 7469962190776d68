"""Contacts of two frustums where their sides cross, where a rim or apex lies over a side, and where rims cross.

Distances over a circle or a side are functions of an angle; :mod:`bodies.contacts.frustum.circle` minimises them.  The
search and the result are in the same axes, those of the second body: within a step the quaternion of a body is not
normalised, so that its axes and those of the world do not agree to the last digits.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...rotations import rotated, rotated_back
from ...shapes.frustum import COS, LOW, LOW_RADIUS, SIDE, SIN, SWEEP
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.edge_crossing import PARALLEL, least_round_sine
from ..features.ends import CLOSED, REACH
from ..features.frames import across
from ..smooth.smooth_core import axes_in_world
from .circle import least_sample, zero_of_slope
from .frustum import FLANK, along_side, rim_of
from .frustum_placed import Placed, placed
from .frustum_writing import Spot, off_cone_of_rim, off_side, past_border, past_depth, write_pair

_STEEP = math.pi / 6.0
"""Angle between the plane of the rim and the side [rad], above which the rim has one minimum of the height only."""
_SAMPLES = 12
"""Number of intervals into which the angles of a rim over a side are sampled."""
_RIM_SAMPLES, _LEVELS = 16, 3
"""Number of intervals into which half of a rim over a rim is sampled, and largest number of rounds of sampling."""
_EXTENSION = 3e-8
"""Length by which the contact of a rim extends past the end of a side if a body is rounded, relative to the size.

On this length the contact of both rims begins, so that one of the two contacts always exists.
"""
_LEAST_BEND = 1e-6
"""Least second derivative of the height by the angle at a minimum, relative to the rim's radius."""
_BOTH = 1e-9
"""Overlap of the two halves of the first rim at the line of centres [rad]; no crossing is missed between the halves."""
_ASIDE = 1e-11
"""Least offset of the common normal of two rounded rims from a side's normal, relative to the size of the bodies.

The offset [m] is the distance of the rims' cores, times the sine of the angle between their common normal and the
normal of a side, the smaller one of both sides.  At a smaller offset, the contact of a rim with a side replaces this
contact.
"""


class Side(NamedTuple):
    """The side of a frustum in the world, continued past its rims, or an edge, which is a side of radius 0."""

    low: Vector3
    """Centre of the lower rim, or first end of the edge [m]."""
    axis: Vector3
    """Unit axis, upwards."""
    radius: float
    """Radius of the lower rim [m]."""
    length: float
    """Length from rim to rim [m]."""
    cosine: float
    """Radial component of the outward normal."""
    sine: float
    """Axial component of the outward normal."""


class SideCrossing(NamedTuple):
    """Crossing of two sides: they have a common normal at the points where two straight lines of them cross."""

    gap: float
    """Distance of the sides along the normal [m]."""
    normal: Vector3
    """Normal from the first side to the second, in the world."""
    point: Vector3
    """Contact point of the first side in the world [m]."""
    away: float
    """Distance of this point from the axis of the first side [m]."""
    other_away: float
    """Distance of the other contact point from the axis of the second side [m]."""
    past_ends: float
    """Distance of the contact points past the ends of the sides [m]."""
    sine: float
    """Sine of the angle between both lines."""


@compiled
def side_of(frustum: Placed) -> Side:
    """Return the side of a frustum."""
    numbers, center, axis = frustum
    low = plus_scaled(center, numbers[LOW], axis)
    return Side(low, axis, numbers[LOW_RADIUS], numbers[SIDE], numbers[COS], numbers[SIN])


@compiled
def _line(side: Side, n: Vector3) -> tuple[Vector3, Vector3]:
    """Return the straight line of a side with the outward normal n: its lower end [m] and unit vector upwards.

    The axial component of n is the sine of the side.
    """
    outward = divided(plus_scaled(n, -side.sine, side.axis), side.cosine)
    return plus_scaled(side.low, side.radius, outward), plus_scaled(scaled(side.cosine, side.axis), -side.sine, outward)


@compiled
def cross_sides(one: Side, two: Side, least_sine: float, size: float) -> SideCrossing:
    """Return the crossing of two sides.

    The common normal n of both sides has a fixed angle to each axis.  This leaves two mirror images of n; bodies apart
    are separated along the one with the larger gap.  On each side the points with the normal n are a straight line.
    The contact points are those at which both lines cross.  If no such normal exists, or the sine of the angle between
    the lines is at most ``least_sine``, there is no crossing: the middle of a line is returned, past the end of the
    sides by ``size``, the size of the bodies [m].
    """
    # n = n_a a + n_e e + n_c c, with the axis a, the unit vector e along the part of axis b across a, and c = a x e.
    # The sines of the sides give n . a and -n . b, and |n| = 1 gives n_c
    _, sine, e = across(two.axis, one.axis)
    c, n_a = cross(one.axis, e), one.sine
    n_e = (-two.sine - dot(one.axis, two.axis) * n_a) / sine if sine > 0.0 else 0.0
    n_c_squared = 1.0 - n_a * n_a - n_e * n_e
    n_c = math.sqrt(max(n_c_squared, 0.0))
    gap, n = -math.inf, (1.0, 0.0, 0.0)
    for sign in (-1.0, 1.0):
        candidate = plus_scaled(plus(scaled(n_a, one.axis), scaled(n_e, e)), sign * n_c, c)
        candidate = divided(candidate, norm(candidate))
        separation = dot(candidate, minus(two.low, one.low)) - one.cosine * one.radius - two.cosine * two.radius
        if separation > gap:
            gap, n = separation, candidate
    (p, u), (q, v) = _line(one, n), _line(two, opposite(n))
    w, crossing = minus(q, p), dot(n, cross(u, v))
    # distances of the contact points along the lines, from their lower ends
    s, t, past_ends = 0.5 * one.length, 0.5 * two.length, size
    if n_c_squared >= 0.0 and abs(crossing) > least_sine:
        s, t = dot(n, cross(w, v)) / crossing, dot(n, cross(w, u)) / crossing
        past_ends = max(max(-s, s - one.length), max(-t, t - two.length))
        # the distance along n of the points that cross: an error of n hardly changes it
        gap = dot(n, plus_scaled(plus_scaled(w, t, v), -s, u))
    # past an apex a point lies on its axis
    away, other_away = max(one.radius - one.sine * s, 0.0), max(two.radius - two.sine * t, 0.0)
    return SideCrossing(gap, n, plus_scaled(p, s, u), away, other_away, past_ends, abs(crossing))


def evaluate_sides(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, size: float) -> None:
    """Write the geometry block of the crossing of the sides of two frustums, which must have no feet.

    ``size`` is the size of the bodies [m].
    """
    one, two = placed(a, first), placed(b, second)
    round_radius = first[LOW_RADIUS] + second[LOW_RADIUS] + first[SWEEP] + second[SWEEP]
    found = cross_sides(side_of(one), side_of(two), least_round_sine(round_radius, size), size)
    own = Spot(one, FLANK, minus(found.point, one.center), found.away)
    other_point = plus_scaled(found.point, found.gap, found.normal)
    other = Spot(two, FLANK, minus(other_point, two.center), found.other_away)
    past = max(past_border(found.past_ends, 0.0, size), past_depth(one, two, found.gap, size))
    write_pair(a, out, 0.0, found.gap, past, found.normal, found.point, own, other)


class _Circle(NamedTuple):
    """A rim of one frustum, in the axes of the other one and from its centre.

    Its point at an angle is ``middle`` + ``radius`` (g cos(angle) + h sin(angle)), with perpendicular unit vectors g
    and h; lengths in m.
    """

    radius: float
    middle: Vector3
    g: Vector3
    h: Vector3


@compiled
def _directions(g: Vector3, h: Vector3, angle: float) -> tuple[Vector3, Vector3]:
    """Return the unit vector g cos(angle) + h sin(angle), and its derivative by the angle."""
    c, s = math.cos(angle), math.sin(angle)
    return plus(scaled(c, g), scaled(s, h)), minus(scaled(c, h), scaled(s, g))


@compiled
def _about_axis(circle: _Circle, angle: float) -> tuple[Vector3, Vector3]:
    """Return distance from the third axis and third coordinate [m] of a circle's point at an angle.

    Each is followed by its first and second derivative by the angle.
    """
    radius, middle, g, h = circle
    (ux, uy, uz), (tx, ty, tz) = _directions(g, h, angle)
    x, y, z = middle[0] + radius * ux, middle[1] + radius * uy, middle[2] + radius * uz
    away = max(math.sqrt(x * x + y * y), 1e-300)
    slope = radius * (x * tx + y * ty) / away
    bend = (radius * radius * (tx * tx + ty * ty) - radius * (x * ux + y * uy) - slope * slope) / away
    return (away, slope, bend), (z, radius * tz, -radius * uz)


@compiled
def _height(given: tuple[_Circle, Floats], angle: float) -> tuple[float, float, float]:
    """Return the height of a circle's point over the side of a frustum, and two derivatives by the angle [m].

    ``given`` is the circle and the numbers of the frustum.  The side is continued past its rims; the height is positive
    outside.
    """
    circle, frustum = given
    (away, slope, bend), (z, rise, rise_bend) = _about_axis(circle, angle)
    height, _ = along_side(frustum, z, away)
    return height, frustum[COS] * slope + frustum[SIN] * rise, frustum[COS] * bend + frustum[SIN] * rise_bend


@compiled
def _squared_distance(given: tuple[_Circle, float], angle: float) -> tuple[float, float, float]:
    """Return the squared distance of a circle's point from another circle [m^2], and half of its two derivatives.

    The other circle lies round the origin in the plane of the first two axes; its radius [m] is given.
    """
    circle, radius = given
    (away, slope, bend), (z, rise, rise_bend) = _about_axis(circle, angle)
    past = away - radius
    square, second = past * past + z * z, slope * slope + past * bend + rise * rise + z * rise_bend
    return square, past * slope + z * rise, second


@compiled
def _lowest_angle(circle: _Circle, frustum: Floats, low: float, high: float) -> tuple[float, bool]:
    """Return the angle between ``low`` and ``high`` at a rim's lowest point over a side [rad], and a check.

    The check is True if the height has a minimum there, inside of the interval.
    """
    step = (high - low) / _SAMPLES
    angle, _ = least_sample(_height, (circle, frustum), low, step, _SAMPLES)
    angle = zero_of_slope(_height, (circle, frustum), angle, angle - step, angle + step)
    _, _, bend = _height((circle, frustum), angle)
    # if the interval covers the whole rim, it has no ends, so that any minimum is inside of it
    is_inside = low <= angle <= high or high - low > 1.5 * math.pi
    return angle, is_inside and bend > _LEAST_BEND * circle.radius


def evaluate_rim_over_side(
    a: Floats, b: Floats, out: Floats, swap: float, first: Floats, rim: float, half: float, second: Floats, size: float
) -> None:
    """Write the geometry block of one half of a rim, or of the apex, of a frustum and the side of another.

    A side that lies across a cap crosses its rim twice, so that there are two contacts, one on either half: ``half`` is
    1 for the half of the rim to which the other body's axis points, -1 for the other.  ``first`` is the body with the
    rim, the second body if ``swap`` is 1; ``second`` is the body with the side.  ``rim`` is 1 for the lower rim, 3 for
    the upper one or the apex.  ``size`` is the size of the bodies [m].

    The height of a point over a side is a convex function of the point.  It can have two minima round the rim only if
    a straight line of the side is nearly parallel to the plane of the rim; then each half is searched.  Each half is
    also searched if the axes are nearly perpendicular, even if it has no minimum.  In other poses, called steep, the
    whole rim is searched for its single minimum.
    """
    own, other = (b, a) if swap == 1.0 else (a, b)
    one, two, axes = placed(own, first), placed(other, second), axes_in_world(other, second)
    radius, height, _ = rim_of(first, rim)
    # in the axes of the side: axis and centre of the rim; unit vectors h, along the projection of the side's axis on
    # the plane of the rim, and g, perpendicular to h
    axis = rotated_back(axes, one.axis)
    middle = plus_scaled(rotated_back(axes, minus(one.center, two.center)), height, axis)
    _, _, h = across((0.0, 0.0, 1.0), axis)
    g, h = cross(h, axis), scaled(half, h)
    plane_to_axis = math.asin(min(abs(axis[2]), 1.0))
    is_steep = plane_to_axis > _STEEP and abs(plane_to_axis - math.asin(second[SIN])) > _STEEP
    # the apex, a rim of radius 0, needs no search
    angle, has_minimum = 0.0, True
    if radius > 0.0:
        low, high = 0.0, math.pi
        if is_steep:
            # search the whole rim; the interval begins at the point farthest from the side's axis
            low = math.atan2(middle[0] * h[0] + middle[1] * h[1], middle[0] * g[0] + middle[1] * g[1])
            high = low + 2.0 * math.pi
        angle, has_minimum = _lowest_angle(_Circle(radius, middle, g, h), second, low, high)
    outward, _ = _directions(g, h, angle)
    x, y, along = plus_scaled(middle, radius, outward)
    away = math.sqrt(x * x + y * y)
    ex, ey = (x / away, y / away) if away > 0.0 else (1.0, 0.0)
    gap, up_side = along_side(second, along, away)
    cosine, sine = second[COS], second[SIN]
    n, point = rotated(axes, (-cosine * ex, -cosine * ey, -sine)), rotated(axes, (x, y, along))
    of_rim = rotated(axes, outward)
    if radius == 0.0:
        # the normals of an apex are those of a rim in all directions
        _, _, of_rim = across(n, one.axis)
    own_spot, other_spot = Spot(one, int(rim), of_rim, radius), Spot(two, FLANK, point, max(away - gap * cosine, 0.0))
    past_ends = max(-up_side, up_side - second[SIDE])
    if first[SWEEP] + second[SWEEP] > 0.0:
        # extend the side past its end, until the contact of both rims is valid
        past_ends -= _EXTENSION * size
    if not has_minimum or (is_steep and half < 0.0):
        # a steep pose has one minimum: that contact belongs to one half only
        past_ends = size
    past = past_border(past_ends, off_cone_of_rim(own_spot, n), size)
    past = max(past, past_depth(one, two, gap, size))
    write_pair(a, out, swap, gap, past, n, plus(two.center, point), own_spot, other_spot)


@compiled
def _link_depth(circle: _Circle, other_radius: float) -> float:
    """Return how deep a circle lies inside of another one with which it is linked like the links of a chain [m].

    The circles are those of :func:`_squared_distance`.  The first one crosses the plane of the second at two points; if
    exactly one of them is inside the second, the result is its distance from the second circle, else 0.
    """
    radius, center, g, h = circle
    # the height of the first circle's point is center_z + amplitude cos(angle - highest); it is zero at two angles
    amplitude = radius * math.sqrt(g[2] * g[2] + h[2] * h[2])
    if abs(center[2]) >= amplitude:
        return 0.0
    highest, to_zero = math.atan2(h[2], g[2]), math.acos(-center[2] / amplitude)
    least, most = math.inf, -math.inf
    for sign in (-1.0, 1.0):
        (away, _, _), _ = _about_axis(circle, highest + sign * to_zero)
        depth = other_radius - away
        least, most = min(least, depth), max(most, depth)
    return most if least < 0.0 < most else 0.0


@compiled
def _nearest_angle(circle: _Circle, other_radius: float) -> float:
    """Return the angle round half of a circle at the least distance from another circle (:func:`_squared_distance`).

    The half begins at g, on the line of centres, and ends at -g.  The result may lie outside of the half, or may be no
    minimum: the caller checks it.
    """
    low, high = -_BOTH, math.pi + _BOTH
    begin, step, angle = low, (high - low) / _RIM_SAMPLES, low
    for _ in range(_LEVELS):
        angle, bend = least_sample(_squared_distance, (circle, other_radius), begin, step, _RIM_SAMPLES)
        # the least sample is next to a minimum, or well inside of the half
        if bend > 0.0 or low + 0.5 * step < angle < high - 0.5 * step:
            break
        # circles that cross close to the line of centres have a maximum of the distance on this line: refine next to it
        begin = low if angle < 1.0 else high - step
        step /= _RIM_SAMPLES
    return float(zero_of_slope(_squared_distance, (circle, other_radius), angle, angle - step, angle + step))


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
    (radius, height, _), (other_radius, other_height, _) = rim_of(first, rim_a), rim_of(second, rim_b)
    # in the axes of the second body: axis of the first rim, and its centre from that of the second; unit vectors g, in
    # the plane of the first rim towards the second rim's centre, and h, perpendicular to it
    axis = rotated_back(axes, one.axis)
    x, y, z = plus_scaled(rotated_back(axes, minus(one.center, two.center)), height, axis)
    middle = (x, y, z - other_height)
    _, _, g = across(opposite(middle), axis)
    h = scaled(half, cross(axis, g))
    circle = _Circle(radius, middle, g, h)
    angle = _nearest_angle(circle, other_radius)
    is_round = first[SWEEP] + second[SWEEP] > 0.0
    are_discs = not is_round and first[SIDE] == 0.0 and second[SIDE] == 0.0
    # discs in one plane touch on the line of centres, where their rims are parallel; other discs cross or pass by
    is_parallel = axis[0] * axis[0] + axis[1] * axis[1] <= CLOSED
    is_edge_to_edge = are_discs and is_parallel and abs(middle[2] + radius * g[2]) <= CLOSED * size
    if is_edge_to_edge:
        angle = 0.0
    # u and t: outward radius and tangent of the first rim at the crossing; e: outward radius of the second rim there;
    # w: vector from the first rim's point to the second's
    u, t = _directions(g, h, angle)
    x, y, z = plus_scaled(middle, radius, u)
    away = math.sqrt(x * x + y * y)
    e = (x / away, y / away, 0.0) if away > 0.0 else (1.0, 0.0, 0.0)
    w = (other_radius * e[0] - x, other_radius * e[1] - y, -z)
    # of two discs edge to edge, the second rim has the curvature of a cylinder's side, so that the normal stays radial
    # while one edge slips over the other
    own = Spot(one, int(rim_a), rotated(axes, u), radius)
    other = Spot(two, FLANK if is_edge_to_edge else int(rim_b), rotated(axes, e), other_radius)
    # normal: cross product of both tangents; that of the second rim is (-ey, ex, 0)
    n = (-t[2] * e[0], -t[2] * e[1], t[0] * e[0] + t[1] * e[1])
    sine, apart = norm(n), norm(w)
    # rounded rims that lie on each other along the whole circle are left to the contacts of rims over caps
    is_ring = is_round and sine <= PARALLEL and math.hypot(w[0], w[1]) < REACH * apart
    are_cores_apart = is_round and apart > 1e-9 * size
    if are_cores_apart:
        # the line between the points, also for parallel tangents
        n, sine = divided(w, apart), 1.0
    elif is_edge_to_edge or sine <= PARALLEL:
        n, sine = u, 1.0 if is_edge_to_edge else 0.0
    else:
        n = divided(n, sine)
    normal = rotated(axes, n)
    off_cone = max(off_cone_of_rim(own, normal), off_cone_of_rim(other, opposite(normal)))
    off_reversed = max(off_cone_of_rim(own, opposite(normal)), off_cone_of_rim(other, normal))
    if off_reversed <= off_cone and not are_cores_apart:
        # the sign for which the normal is nearer to the normal cones of both rims
        n, normal, off_cone = opposite(n), opposite(normal), off_reversed
    gap = dot(n, w)
    past = past_border(-size, off_cone, size)
    off_side_a, off_side_b = off_side(own, normal), off_side(other, opposite(normal))
    if is_round:
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
        past = max(past, sine * (-0.5 * gap - REACH * size) - _link_depth(circle, other_radius))
    point = plus(two.center, rotated(axes, (x, y, z + other_height)))
    write_pair(a, out, 0.0, gap, past, normal, point, own, other)
