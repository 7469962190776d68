"""A sharp corner of a surface over the caps and the side of a sharp cylinder, cone or disc."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import POSITION, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, HIGH_RADIUS, LOW, LOW_RADIUS, SIDE, SIN
from ...vectors import Vector3, dot, minus, plus, plus_scaled, scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.ends import CLOSED, REACH, gap_past_end
from ..features.frames import across, point_in_world, vector_in_body
from ..features.writing import write_round
from ..surface.surface_search import depth_inside
from ..surface.surface_tables import IS_CONVEX
from .frustum import (
    FLANK,
    HIGH_CAP,
    LOW_CAP,
    axis_in_world,
    center_in_world,
    part_number,
    tip_past_rim,
    write_part,
)
from .frustum_writing import write_contact


@compiled
def has_part(frustum: Floats, part: int) -> bool:
    """True if a frustum has a cap or a side: a disc has no side, a cone no upper cap."""
    return not ((part == FLANK and frustum[SIDE] == 0.0) or (part == HIGH_CAP and frustum[HIGH_RADIUS] == 0.0))


@compiled
def over_part(frustum: Floats, part: int, along: float, away: float) -> tuple[float, float, float, float]:
    """Return height of a point over a cap's plane or the side's cone, distance past its border [m], and the normal.

    The height is positive outside, the distance past the border is negative over the part.  The point has the
    coordinate ``along`` on the axis, from the frustum's centre, and the distance ``away`` from the axis [m].  The
    outward normal is returned as its radial and its axial component.
    """
    if part == LOW_CAP:
        return frustum[LOW] - along, away - frustum[LOW_RADIUS], 0.0, -1.0
    if part == HIGH_CAP:
        return along - frustum[HIGH], away - frustum[HIGH_RADIUS], 0.0, 1.0
    cosine, sine = frustum[COS], frustum[SIN]
    dr, dz = away - frustum[LOW_RADIUS], along - frustum[LOW]
    # coordinate of the point along the side, from the lower rim upwards
    up = cosine * dz - sine * dr
    return cosine * dr + sine * dz, max(-up, up - frustum[SIDE]), cosine, sine


@compiled
def normal_of_part(axis: Vector3, outward: Vector3, radial: float, axial: float) -> Vector3:
    """Return the normal with the components ``radial`` along the unit vector ``outward``, ``axial`` along the axis."""
    return plus(scaled(radial, outward), scaled(axial, axis))


@compiled
def _steepest(b: Floats, n_star: float, star: Floats, normal: Vector3) -> float:
    """Return the sine of the largest angle at which an edge of a corner leads below the plane with a given normal.

    It is negative if all edges lead above the plane.  ``normal`` is in the world; ``star`` holds ``n_star`` unit
    vectors along the edges, in the frame ``b``.
    """
    n, down = vector_in_body(b, normal), -1.0
    for i in range(int(n_star)):
        down = max(down, -dot(n, vector_at(star, 3 * i)))
    return down


@compiled
def write_corner(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    place: Vector3,
    n_star: float,
    star: Floats,
    lengths: Floats,
    surface: Floats,
    size: float,
) -> None:
    """Write the geometry block of a corner of the second body and the nearest part of the first, cap or side.

    A cap or the side touches the corner only if no edge of the corner leads below the cap's plane or the side's tangent
    plane; otherwise the edge touches it first.  The nearest part has the least sum of two squares, of the corner's
    height over the part and of its distance past the part's border.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    frustum : Floats
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    place : tuple of float
        The corner in its body frame [m].
    n_star, star, lengths : float and Floats
        Unit vectors along its edges, and, for a disc, their lengths [m].
    surface : Floats
        The surface (:mod:`bodies.contacts.surface.surface_tables`).
    size : float
        Size of the larger body [m].
    """
    axis, center = axis_in_world(a, frustum), center_in_world(a, frustum)
    point = point_in_world(b, place)
    along, away, outward = across(minus(point, center), axis)
    is_disc, margin, highest = frustum[SIDE] == 0.0, REACH * size, -math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if has_part(frustum, part):
            highest = max(highest, over_part(frustum, part, along, away)[0])
    least_key, nearest, gap, past = math.inf, LOW_CAP, 0.0, math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if not has_part(frustum, part):
            continue
        height, past_border, radial, axial = over_part(frustum, part, along, away)
        n = normal_of_part(axis, outward, radial, axial)
        if height < 0.0 and not is_disc:
            # a corner below a cap's plane or the side's cone touches it only if the corner is inside of the frustum
            past_border = max(past_border, highest)
        past_border = max(past_border - margin, size * (_steepest(b, n_star, star, n) - CONE_MARGIN))
        if is_disc and height < -CLOSED * size and past_border <= 0.0:
            # a corner behind a disc touches it only if its edges go through the disc, or if the corner's body encloses
            # the point of the disc nearest to the corner
            past_rim = tip_past_rim(b, n_star, star, lengths, minus(point, center), n, -height, frustum[LOW_RADIUS])
            foot = vector_in_body(b, minus(plus_scaled(point, -height, n), vector_at(b, POSITION)))
            if past_rim > 0.0 and depth_inside(surface, foot) == 0.0:
                past_border = min(-height, past_rim)
        key = height * height + max(past_border, 0.0) * max(past_border, 0.0)
        if key < least_key:
            least_key, nearest, gap, past = key, part, height, past_border
    gap = gap_past_end(gap, past, surface[IS_CONVEX] == 1.0)
    _, _, radial, axial = over_part(frustum, nearest, along, away)
    normal = normal_of_part(axis, outward, radial, axial)
    write_contact(a, out, gap, past, part_number(frustum, nearest), normal, point, True)
    write_part(out, SIDE_A, nearest, axis, outward, radial, max(away - gap * radial, 0.0))
    write_round(out, SIDE_B, 0.0)
