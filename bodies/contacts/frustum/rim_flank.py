"""Contact of a rim of one frustum, or of its apex, with the side of another frustum.

The height of a point over a side is a convex function of the point, which has up to two minima round a rim.  Samples of
the rim bracket a minimum, then Newton's method between bounds finds it.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, SIDE, SIN, SWEEP
from ...vectors import Vector3, cross, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.frames import across
from ..smooth.smooth_core import axes_in_world, rotated, rotated_back
from .frustum import FLANK, center_in_world, rim_of
from .frustum_writing import off_cone_of_rim, past_border, past_depth, write_side, write_two

_STEEP = math.pi / 6.0
"""Angle between the plane of the rim and the side [rad], above which the rim has one minimum of the height only."""
_SAMPLES, _STEPS = 12, 60
_BEYOND = 3e-8
"""Length by which the contact of a rim extends past the end of a side if a body is rounded, relative to the size.

On this length the contact of both rims begins, so that one of the two contacts always exists.
"""
_BENT = 1e-6
"""Least second derivative of the height by the angle at a minimum, over the rim's radius; if less, there is none."""


@compiled
def _height(second: Floats, middle: Vector3, g: Vector3, h: Vector3, angle: float) -> tuple[float, float, float]:
    """Return the height of a rim's point over the side, and its first and second derivative by ``angle`` [m].

    The point is middle + g cos(angle) + h sin(angle), with the rim's centre ``middle``.  All vectors are in the axes of
    the side's body ``second``.
    """
    c, s = math.cos(angle), math.sin(angle)
    x, y, wide = plus_scaled(plus_scaled(middle, c, g), s, h)
    dx, dy, dz = plus_scaled(scaled(c, h), -s, g)
    away = max(math.sqrt(x * x + y * y), 1e-300)
    slope = (x * dx + y * dy) / away
    bend = (dx * dx + dy * dy - x * (x - middle[0]) - y * (y - middle[1]) - slope * slope) / away
    cosine, sine = second[COS], second[SIN]
    value = cosine * (away - second[0]) + sine * (wide - second[LOW])
    return value, cosine * slope + sine * dz, cosine * bend - sine * (wide - middle[2])


@compiled
def least_round(second: Floats, middle: Vector3, g: Vector3, h: Vector3, low: float, high: float) -> tuple[float, bool]:
    """Return the angle round a rim [rad] at its lowest point over the side of ``second``, and a check.

    The angle lies between ``low`` and ``high``.  The check is True if the height has a minimum there, inside of the
    interval.  ``middle``, ``g`` and ``h`` give the point of the rim at an angle, as in :func:`_height`.
    """
    step = (high - low) / _SAMPLES
    best, angle = math.inf, low
    for i in range(_SAMPLES + 1):
        value, _, _ = _height(second, middle, g, h, low + i * step)
        if value < best:
            best, angle = value, low + i * step
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
    within = low <= angle <= high or high - low > 1.5 * math.pi
    return angle, within and bend > _BENT * norm(g)


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
    own_axes, axes = axes_in_world(own, first), axes_in_world(other, second)
    center, place = center_in_world(own, first), center_in_world(other, second)
    radius, height, up = rim_of(first, rim)
    # the centre of the rim and its axis, in the axes of the side
    axis = rotated_back(axes, (own_axes[2], own_axes[5], own_axes[8]))
    middle = plus_scaled(rotated_back(axes, minus(center, place)), height, axis)
    # h: projection of the side's axis on the plane of the rim; g: perpendicular to h in this plane
    _, _, h = across((0.0, 0.0, 1.0), axis)
    # the height can have two minima round the rim only if a straight line of the side is nearly parallel to the plane
    # of the rim; then each half is searched. Each half is also searched if the axes are nearly perpendicular, even if
    # it has no minimum. In other poses, called steep, the whole rim is searched for its single minimum
    lean = math.asin(min(abs(axis[2]), 1.0))
    steep = lean > _STEEP and abs(lean - math.asin(second[SIN])) > _STEEP
    g, h = scaled(radius, cross(h, axis)), scaled(radius * half, h)
    angle, found = 0.0, True
    if radius > 0.0:
        low, high = 0.0, math.pi
        if steep:
            # search the whole rim; the interval begins at the point farthest from the side's axis
            low = math.atan2(middle[0] * h[0] + middle[1] * h[1], middle[0] * g[0] + middle[1] * g[1])
            high = low + 2.0 * math.pi
        angle, found = least_round(second, middle, g, h, low, high)
    offset = plus(scaled(math.cos(angle), g), scaled(math.sin(angle), h))
    point = plus(middle, offset)
    away = math.sqrt(point[0] * point[0] + point[1] * point[1])
    ex, ey = (point[0] / away, point[1] / away) if away > 0.0 else (1.0, 0.0)
    cosine, sine = second[COS], second[SIN]
    gap = cosine * (away - second[0]) + sine * (point[2] - second[LOW])
    along = cosine * (point[2] - second[LOW]) - sine * (away - second[0])
    n = (-cosine * ex, -cosine * ey, -sine)
    # check that the contact normal is a normal of the rim
    axial = dot(n, axis)
    radial = dot(n, offset) / radius if radius > 0.0 else math.sqrt(max(1.0 - axial * axial, 0.0))
    off_cone = off_cone_of_rim(first, up, radial, axial, first[SIDE] == 0.0)
    over = max(-along, along - second[SIDE])
    if first[SWEEP] + second[SWEEP] > 0.0:
        # extend the side past its end, until the contact of both rims is valid
        over -= _BEYOND * size
    if not found or (steep and half < 0.0):
        over = size
    normal, from_axis = rotated(axes, n), rotated(axes, point)
    past = max(past_border(over, off_cone, size), past_depth(own, first, other, second, gap, size))
    write_two(a, out, swap, first, second, gap, past, normal, plus(place, from_axis))
    own_axis, outward = (own_axes[2], own_axes[5], own_axes[8]), rotated(axes, offset)
    write_side(out, swap, first, int(rim), own_axis, outward, normal, radius)
    away = max(away - gap * cosine, 0.0)
    write_side(out, 1.0 - swap, second, FLANK, (axes[2], axes[5], axes[8]), from_axis, opposite(normal), away)
