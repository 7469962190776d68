"""Contact of a rim of one frustum, or of its apex, with the side of another frustum.

The height of a point over a side is a convex function of the point, which has up to two minima round a rim.  Samples of
the rim bracket a minimum, then Newton's method between bounds finds it.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, LOW_RADIUS, SIDE, SIN, SWEEP
from ...vectors import Vector3, cross, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.frames import across
from ..smooth.smooth_core import axes_in_world, rotated, rotated_back
from .frustum import FLANK, center_in_world, rim_of
from .frustum_writing import off_cone_of_rim, past_border, past_depth, write_rounded_part, write_two

_STEEP = math.pi / 6.0
"""Angle between the plane of the rim and the side [rad], above which the rim has one minimum of the height only."""
_SAMPLES, _STEPS = 12, 60
"""Number of intervals into which the range of the angle is sampled; largest number of Newton steps."""
_EXTENSION = 3e-8
"""Length by which the contact of a rim extends past the end of a side if a body is rounded, relative to the size.

On this length the contact of both rims begins, so that one of the two contacts always exists.
"""
_LEAST_BEND = 1e-6
"""Least second derivative of the height by the angle at a minimum, relative to the rim's radius."""


@compiled
def _height(second: Floats, middle: Vector3, g: Vector3, h: Vector3, angle: float) -> tuple[float, float, float]:
    """Return the height of a rim's point over the side, and its first and second derivative by ``angle`` [m].

    The point is middle + g cos(angle) + h sin(angle), with the rim's centre ``middle`` and two perpendicular vectors of
    the length of its radius [m].  All vectors are in the axes of the frustum ``second``, which has the side.  The side
    is continued past its rims; the height is positive outside.
    """
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = plus_scaled(plus_scaled(middle, c, g), s, h)
    dx, dy, dz = plus_scaled(scaled(c, h), -s, g)
    # slope and bend: derivatives of the distance from the side's axis
    away = max(math.sqrt(x * x + y * y), 1e-300)
    slope = (x * dx + y * dy) / away
    bend = (dx * dx + dy * dy - x * (x - middle[0]) - y * (y - middle[1]) - slope * slope) / away
    cosine, sine = second[COS], second[SIN]
    value = cosine * (away - second[LOW_RADIUS]) + sine * (z - second[LOW])
    return value, cosine * slope + sine * dz, cosine * bend - sine * (z - middle[2])


@compiled
def least_round(second: Floats, middle: Vector3, g: Vector3, h: Vector3, low: float, high: float) -> tuple[float, bool]:
    """Return the angle round a rim [rad] at its lowest point over the side of ``second``, and a check.

    The angle lies between ``low`` and ``high`` [rad].  The check is True if the height has a minimum there, inside of
    the interval.  ``middle``, ``g`` and ``h`` give the point of the rim at an angle, as in :func:`_height`.
    """
    step = (high - low) / _SAMPLES
    least_height, angle = math.inf, low
    for i in range(_SAMPLES + 1):
        value, _, _ = _height(second, middle, g, h, low + i * step)
        if value < least_height:
            least_height, angle = value, low + i * step
    # the minimum is within one step of the least sample: Newton's method, or halvings if a step leaves the bounds
    least, most = angle - step, angle + step
    for _ in range(_STEPS):
        _, slope, bend = _height(second, middle, g, h, angle)
        if slope > 0.0:
            most = angle
        else:
            least = angle
        after = angle - slope / bend if bend > 0.0 else math.inf
        if after < least or after > most:
            after = 0.5 * (least + most)
        if abs(after - angle) <= 2e-16 * max(abs(angle), 0.1):
            break
        angle = after
    _, _, bend = _height(second, middle, g, h, angle)
    # if the interval covers the whole rim, it has no ends, so that any minimum is inside of it
    is_inside = low <= angle <= high or high - low > 1.5 * math.pi
    return angle, is_inside and bend > _LEAST_BEND * norm(g)


def evaluate_rim_over_side(
    a: Floats, b: Floats, out: Floats, swap: float, first: Floats, rim: float, half: float, second: Floats, size: float
) -> None:
    """Write the geometry block of one half of a rim, or of the apex, of a frustum and the side of another.

    A side that lies across a cap crosses its rim twice, so that there are two contacts, one on either half.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    swap : float
        1 if the rim belongs to the second body, else 0.
    first, second : Floats
        The body with the rim, and the body with the side.
    rim : float
        1 for the lower rim, 3 for the upper one or the apex.
    half : float
        1 for the half of the rim to which the other body's axis points, -1 for the other.
    size : float
        Size of the bodies [m].
    """
    own, other = (b, a) if swap == 1.0 else (a, b)
    rim_axes, axes = axes_in_world(own, first), axes_in_world(other, second)
    center, other_center = center_in_world(own, first), center_in_world(other, second)
    radius, height, up = rim_of(first, rim)
    # the centre of the rim and its axis, in the axes of the side
    axis = rotated_back(axes, (rim_axes[2], rim_axes[5], rim_axes[8]))
    middle = plus_scaled(rotated_back(axes, minus(center, other_center)), height, axis)
    # h: unit vector along the projection of the side's axis on the plane of the rim; g: perpendicular to h in this
    # plane. Below both get the length of the rim's radius
    _, _, h = across((0.0, 0.0, 1.0), axis)
    # the height can have two minima round the rim only if a straight line of the side is nearly parallel to the plane
    # of the rim; then each half is searched. Each half is also searched if the axes are nearly perpendicular, even if
    # it has no minimum. In other poses, called steep, the whole rim is searched for its single minimum
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
        angle, has_minimum = least_round(second, middle, g, h, low, high)
    offset = plus(scaled(math.cos(angle), g), scaled(math.sin(angle), h))
    point = plus(middle, offset)
    away = math.sqrt(point[0] * point[0] + point[1] * point[1])
    ex, ey = (point[0] / away, point[1] / away) if away > 0.0 else (1.0, 0.0)
    cosine, sine = second[COS], second[SIN]
    # height of the point over the side, and its coordinate along the side from the lower rim
    gap = cosine * (away - second[LOW_RADIUS]) + sine * (point[2] - second[LOW])
    along = cosine * (point[2] - second[LOW]) - sine * (away - second[LOW_RADIUS])
    n = (-cosine * ex, -cosine * ey, -sine)
    # check that the contact normal is a normal of the rim
    axial = dot(n, axis)
    radial = dot(n, offset) / radius if radius > 0.0 else math.sqrt(max(1.0 - axial * axial, 0.0))
    off_cone = off_cone_of_rim(first, up, radial, axial, first[SIDE] == 0.0)
    past_ends = max(-along, along - second[SIDE])
    if first[SWEEP] + second[SWEEP] > 0.0:
        # extend the side past its end, until the contact of both rims is valid
        past_ends -= _EXTENSION * size
    if not has_minimum or (is_steep and half < 0.0):
        # a steep pose has one minimum: that contact belongs to one half only
        past_ends = size
    normal, from_axis = rotated(axes, n), rotated(axes, point)
    past = max(past_border(past_ends, off_cone, size), past_depth(own, first, other, second, gap, size))
    write_two(a, out, swap, first, second, gap, past, normal, plus(other_center, from_axis))
    rim_axis, outward = (rim_axes[2], rim_axes[5], rim_axes[8]), rotated(axes, offset)
    write_rounded_part(out, swap, first, int(rim), rim_axis, outward, normal, radius)
    # distance from the axis of the point on the side
    away = max(away - gap * cosine, 0.0)
    write_rounded_part(out, 1.0 - swap, second, FLANK, (axes[2], axes[5], axes[8]), from_axis, opposite(normal), away)
