"""Contacts of the side of a cylinder or a cone with the side, a rim or the apex of another frustum."""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, LOW_RADIUS, SIDE, SIN, SWEEP
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.edge_crossing import least_round_sine
from ..features.frames import across, tangent_of
from ..smooth.smooth_core import axes_in_world, rotated, rotated_back
from .circle import least_sample, zero_of_slope
from .frustum import (
    FLANK,
    Placed,
    Spot,
    along_side,
    off_cone_of_rim,
    past_border,
    past_depth,
    placed,
    rim_of,
    write_pair,
)

_STEEP = math.pi / 6.0
"""Angle between the plane of the rim and the side [rad], above which the rim has one minimum of the height only."""
_SAMPLES = 12
"""Number of intervals into which the range of the angle is sampled."""
_EXTENSION = 3e-8
"""Length by which the contact of a rim extends past the end of a side if a body is rounded, relative to the size.

On this length the contact of both rims begins, so that one of the two contacts always exists.
"""
_LEAST_BEND = 1e-6
"""Least second derivative of the height by the angle at a minimum, relative to the rim's radius."""


@compiled
def _across_both(a: Vector3, b: Vector3) -> tuple[Vector3, float]:
    """Return the unit vector along the product a x b of two unit vectors, and the sine of the angle between a and b.

    If they are parallel, the sine is 0, and the vector is any unit vector perpendicular to them.
    """
    v = cross(a, b)
    # the components of a small product along a are round-off
    v = plus_scaled(v, -dot(v, a), a)
    size = norm(v)
    return (divided(v, size), size) if size > 0.0 else (tangent_of(a), 0.0)


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
    up: float
    """Coordinate of this point up the first side, from its lower rim [m]."""
    other_up: float
    """Coordinate of the other contact point up the second side [m]."""
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
    """Return the straight line of a side with the outward normal n: its lower end [m] and unit vector upwards."""
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
    # n = n_a a + n_e e + n_c c, with the axis a, and unit vectors c along a x b and e = c x a. The sines of the sides
    # give n . a and -n . b, and |n| = 1 gives n_c
    c, sine = _across_both(one.axis, two.axis)
    e, n_a = cross(c, one.axis), one.sine
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
    return SideCrossing(gap, n, plus_scaled(p, s, u), s, t, past_ends, abs(crossing))


def evaluate_sides(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, size: float) -> None:
    """Write the geometry block of the crossing of the sides of two frustums, which must have no feet.

    ``size`` is the size of the bodies [m].
    """
    one, two = placed(a, first), placed(b, second)
    round_radius = first[LOW_RADIUS] + second[LOW_RADIUS] + first[SWEEP] + second[SWEEP]
    found = cross_sides(side_of(one), side_of(two), least_round_sine(round_radius, size), size)
    # distances of the contact points from the axes are not negative past an apex
    own = Spot(one, FLANK, minus(found.point, one.center), max(first[LOW_RADIUS] - first[SIN] * found.up, 0.0))
    offset = minus(plus_scaled(found.point, found.gap, found.normal), two.center)
    other = Spot(two, FLANK, offset, max(second[LOW_RADIUS] - second[SIN] * found.other_up, 0.0))
    past = max(past_border(found.past_ends, 0.0, size), past_depth(one, two, found.gap, size))
    write_pair(a, out, 0.0, found.gap, past, found.normal, found.point, own, other)


class _Rim(NamedTuple):
    """A rim over the side of the frustum ``second``: its point at an angle is middle + g cos(angle) + h sin(angle).

    ``middle`` is its centre; ``g`` and ``h`` are perpendicular, of the length of its radius [m].  All vectors are in
    the axes of the frustum with the side.
    """

    second: Floats
    middle: Vector3
    g: Vector3
    h: Vector3


@compiled
def _height(rim: _Rim, angle: float) -> tuple[float, float, float]:
    """Return the height of a rim's point over the side, and its first and second derivative by ``angle`` [m].

    The side is continued past its rims; the height is positive outside.
    """
    second, middle, g, h = rim
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = plus_scaled(plus_scaled(middle, c, g), s, h)
    dx, dy, dz = plus_scaled(scaled(c, h), -s, g)
    # slope and bend: derivatives of the distance from the side's axis
    away = max(math.sqrt(x * x + y * y), 1e-300)
    slope = (x * dx + y * dy) / away
    bend = (dx * dx + dy * dy - x * (x - middle[0]) - y * (y - middle[1]) - slope * slope) / away
    cosine, sine = second[COS], second[SIN]
    value, _ = along_side(second, z, away)
    return value, cosine * slope + sine * dz, cosine * bend - sine * (z - middle[2])


@compiled
def _lowest_angle(rim: _Rim, low: float, high: float) -> tuple[float, bool]:
    """Return the angle between ``low`` and ``high`` at a rim's lowest point over the side [rad], and a check.

    The check is True if the height has a minimum there, inside of the interval.
    """
    step = (high - low) / _SAMPLES
    angle, _ = least_sample(_height, rim, low, step, _SAMPLES)
    angle = zero_of_slope(_height, rim, angle, angle - step, angle + step)
    _, _, bend = _height(rim, angle)
    # if the interval covers the whole rim, it has no ends, so that any minimum is inside of it
    is_inside = low <= angle <= high or high - low > 1.5 * math.pi
    return angle, is_inside and bend > _LEAST_BEND * norm(rim.g)


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
    radius, height, up = rim_of(first, rim)
    # the centre of the rim and its axis, in the axes of the side
    axis = rotated_back(axes, one.axis)
    middle = plus_scaled(rotated_back(axes, minus(one.center, two.center)), height, axis)
    # h: unit vector along the projection of the side's axis on the plane of the rim; g: perpendicular to h in this
    # plane. Below both get the length of the rim's radius
    _, _, h = across((0.0, 0.0, 1.0), axis)
    plane_to_axis = math.asin(min(abs(axis[2]), 1.0))
    is_steep = plane_to_axis > _STEEP and abs(plane_to_axis - math.asin(second[SIN])) > _STEEP
    g, h = scaled(radius, cross(h, axis)), scaled(radius * half, h)
    # the apex, a rim of radius 0, needs no search
    angle, has_minimum = 0.0, True
    if radius > 0.0:
        low, high = 0.0, math.pi
        if is_steep:
            # search the whole rim; the interval begins at the point farthest from the side's axis
            low = math.atan2(middle[0] * h[0] + middle[1] * h[1], middle[0] * g[0] + middle[1] * g[1])
            high = low + 2.0 * math.pi
        angle, has_minimum = _lowest_angle(_Rim(second, middle, g, h), low, high)
    offset = plus(scaled(math.cos(angle), g), scaled(math.sin(angle), h))
    point = plus(middle, offset)
    away = math.sqrt(point[0] * point[0] + point[1] * point[1])
    ex, ey = (point[0] / away, point[1] / away) if away > 0.0 else (1.0, 0.0)
    cosine, sine = second[COS], second[SIN]
    gap, up_side = along_side(second, point[2], away)
    n = (-cosine * ex, -cosine * ey, -sine)
    # check that the contact normal is a normal of the rim
    axial = dot(n, axis)
    radial = dot(n, offset) / radius if radius > 0.0 else math.sqrt(max(1.0 - axial * axial, 0.0))
    past_ends = max(-up_side, up_side - second[SIDE])
    if first[SWEEP] + second[SWEEP] > 0.0:
        # extend the side past its end, until the contact of both rims is valid
        past_ends -= _EXTENSION * size
    if not has_minimum or (is_steep and half < 0.0):
        # a steep pose has one minimum: that contact belongs to one half only
        past_ends = size
    normal, to_point = rotated(axes, n), rotated(axes, point)
    past = past_border(past_ends, off_cone_of_rim(first, up, radial, axial), size)
    past = max(past, past_depth(one, two, gap, size))
    of_rim = Spot(one, int(rim), rotated(axes, offset), radius)
    of_side = Spot(two, FLANK, to_point, max(away - gap * cosine, 0.0))
    write_pair(a, out, swap, gap, past, normal, plus(two.center, to_point), of_rim, of_side)
