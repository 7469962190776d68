"""A corner of a mesh over the caps and the side of a cylinder, a cone or a disc."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import POSITION
from nonsmooth.types import Floats

from ...shapes.frustum import LOW_RADIUS, SIDE
from ...vectors import Vector3, dot, minus, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.frames import across, point_in_world, vector_in_body
from ..features.vertex_face import CLOSED, REACH
from ..frustum.frustum import FLANK, HIGH_CAP, LOW_CAP, axis_in_world, center_in_world, tip_past_rim
from ..frustum.frustum_polyhedron import has_part, normal_of_part, over_part, write_vertex_over_part
from ..surface.surface_search import depth_inside


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


def evaluate_corner_over_frustum(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    place: Floats,
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
    place : Floats
        The corner in its body frame [m].
    n_star, star, lengths : float and Floats
        Unit vectors along its edges, and, for a disc, their lengths [m].
    surface : Floats
        The surface (:mod:`bodies.contacts.surface.surface_tables`).
    size : float
        Size of the larger body [m].
    """
    axis, center = axis_in_world(a, frustum), center_in_world(a, frustum)
    point = point_in_world(b, vector_at(place, 0))
    around = across(minus(point, center), axis)
    along, away, outward = around
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
    if past > 0.0:
        gap = math.hypot(gap, past)
    write_vertex_over_part(a, out, frustum, nearest, gap, past, axis, around, point)


write_corner = compiled(evaluate_corner_over_frustum)
"""Compiled function that writes the geometry block of a corner and a frustum; other contacts call it, too."""
