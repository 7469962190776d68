"""Parts of a frustum, and where a point lies over them.

A frustum is the tuple of :func:`bodies.shapes.frustum.frustum_numbers`.  Its parts are numbered along the axis: lower
cap, lower rim, side, upper rim, upper cap.  The functions here use its core: callers add the rounding radius.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats, ReadFloats

from ...shapes.frustum import COS, HIGH, HIGH_RADIUS, LOW, LOW_RADIUS, SIDE, SIN
from ...vectors import Vector3, plus, scaled

LOW_CAP, LOW_RIM, FLANK, HIGH_RIM, HIGH_CAP = 0, 1, 2, 3, 4
"""Part numbers of a frustum, in the direction of its axis: lower cap, lower rim, side, upper rim, upper cap."""


@compiled
def part_number(frustum: Floats, part: int) -> float:
    """Return the index of a part in :func:`part_names`; the upper face of a disc, which has one rim, is 2, not 4."""
    return 2.0 if frustum[SIDE] == 0.0 and part == HIGH_CAP else float(part)


@compiled
def rim_of(frustum: ReadFloats, part: float) -> tuple[float, float, float]:
    """Return radius [m], height over the centre [m] and side, 1 or -1 for an upper or a lower one, of a rim or cap."""
    if part > FLANK:
        return frustum[HIGH_RADIUS], frustum[HIGH], 1.0
    return frustum[LOW_RADIUS], frustum[LOW], -1.0


@compiled
def along_side(frustum: ReadFloats, along: float, away: float) -> tuple[float, float]:
    """Return the height of a point over the side, continued past its rims, and its coordinate up the side [m].

    The height is positive outside; the coordinate is 0 at the lower rim.  ``along`` is the coordinate of the point
    along the axis from the centre, ``away`` its distance from the axis [m].
    """
    dr, dz = away - frustum[LOW_RADIUS], along - frustum[LOW]
    return frustum[COS] * dr + frustum[SIN] * dz, frustum[COS] * dz - frustum[SIN] * dr


@compiled
def over_part(frustum: ReadFloats, part: int, along: float, away: float) -> tuple[float, float, float, float]:
    """Return height of a point over a cap's plane or the side's cone, distance past its border [m], and the normal.

    The height is positive outside, the distance past the border is negative over the part.  The normal is given by two
    components: radial, away from the axis, and axial.  The point is given as for :func:`along_side`.  A part that the
    frustum does not have, the side of a disc or the upper cap of a cone, is infinitely far above the point.
    """
    if part == LOW_CAP:
        return frustum[LOW] - along, away - frustum[LOW_RADIUS], 0.0, -1.0
    if (frustum[SIDE] if part == FLANK else frustum[HIGH_RADIUS]) == 0.0:
        return -math.inf, math.inf, 0.0, 1.0
    if part == HIGH_CAP:
        return along - frustum[HIGH], away - frustum[HIGH_RADIUS], 0.0, 1.0
    height, up = along_side(frustum, along, away)
    return height, max(-up, up - frustum[SIDE]), frustum[COS], frustum[SIN]


@compiled
def nearest_part(frustum: ReadFloats, along: float, away: float) -> tuple[float, float, float, int]:
    """Return the part of a frustum nearest to a point: signed distance [m], outward normal there, and part.

    The distance is negative inside.  The arguments and the components of the normal are those of :func:`over_part`.  In
    the plane through the axis and the point, the frustum is a trapezium, whose sides and corners are the parts.
    """
    best, radial, axial, nearest = -math.inf, 0.0, 0.0, FLANK
    for part in (FLANK, HIGH_CAP, LOW_CAP):
        height, past, n_radial, n_axial = over_part(frustum, part, along, away)
        if height > 0.0 and past < 0.0:
            return height, n_radial, n_axial, part
        if height > best:
            best, radial, axial, nearest = height, n_radial, n_axial, part
    over_side, up_side = along_side(frustum, along, away)
    if best <= 0.0 and over_side <= 0.0:
        # inside, the largest, least negative height counts
        return best, radial, axial, nearest
    # a disc has one rim, the lower one
    part = LOW_RIM if up_side <= 0.0 or frustum[SIDE] == 0.0 else HIGH_RIM
    radius, height, _ = rim_of(frustum, part)
    dr, dz = away - radius, along - height
    distance = math.sqrt(dr * dr + dz * dz)
    return distance, dr / distance, dz / distance, part


@compiled
def normal_of_part(axis: Vector3, outward: Vector3, radial: float, axial: float) -> Vector3:
    """Return the normal with the components ``radial`` along the unit vector ``outward``, ``axial`` along the axis."""
    return plus(scaled(radial, outward), scaled(axial, axis))
