"""Contact of a vertex of a polyhedron with the cap or side of a cylinder, cone or disc, both with sharp edges."""

from __future__ import annotations

import math

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, HIGH_RADIUS, LOW, LOW_RADIUS, SIDE, SIN
from ...vectors import Vector3, minus, plus, plus_scaled, scaled, vector_at
from ..features.frames import across, point_in_world
from ..features.polytope_tables import N_STAR, STAR, faces_of, vertex_at
from ..features.vertex_face import CLOSED, height_over
from ..features.writing import write_round
from .frustum import (
    FLANK,
    HIGH_CAP,
    LOW_CAP,
    axis_in_world,
    center_in_world,
    least_over,
    part_number,
    tip_past_rim,
    write_part,
)
from .frustum_writing import gap_past_end, write_contact


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
def write_vertex_over_part(
    a: Floats,
    out: Floats,
    frustum: Floats,
    part: int,
    gap: float,
    past: float,
    axis: Vector3,
    around: tuple[float, float, Vector3],
    point: Vector3,
) -> None:
    """Write the geometry block of a vertex of the second body over a cap or the side.

    ``around`` holds the coordinate of the vertex along the axis from the frustum's centre, its distance from the axis
    [m], and the unit vector from the axis to the vertex.  ``axis`` is the unit axis, ``point`` the vertex, both in the
    world.  ``past`` is the distance past the part's border [m].
    """
    along, away, outward = around
    _, _, radial, axial = over_part(frustum, part, along, away)
    normal = normal_of_part(axis, outward, radial, axial)
    write_contact(a, out, gap, past, part_number(frustum, part), normal, point, True)
    write_part(out, SIDE_A, part, axis, outward, radial, max(away - gap * radial, 0.0))
    write_round(out, SIDE_B, 0.0)


def evaluate_vertex_over_frustum(
    a: Floats, b: Floats, out: Floats, frustum: Floats, core: Floats, vertex: float, lengths: Floats, size: float
) -> None:
    """Write the geometry block of a vertex of the second body and the cap or side that best separates the bodies.

    The part is the one over which the lowest vertex of the second body is highest.  If several parts are equal in this,
    the vertex gets the one past whose border it is least.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    frustum : Floats
        The first body, with its rims set back by its feet (:func:`bodies.contacts.frustum.frustum.set_back`).
    core, vertex : Floats, float
        The second body (:func:`bodies.contacts.features.polytope_tables.core_numbers`), and the number of the vertex.
    lengths : Floats
        Lengths of its edges [m].
    size : float
        Size of the bodies [m].
    """
    axis, center = axis_in_world(a, frustum), center_in_world(a, frustum)
    row = vertex_at(core, vertex)
    point, n_star, star = (
        point_in_world(b, vector_at(core, row)),
        core[row + N_STAR],
        block_at(core, int(core[row + STAR])),
    )
    around = across(minus(point, center), axis)
    along, away, outward = around
    margin = CLOSED * size
    best_separation, highest = -math.inf, -math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if has_part(frustum, part):
            height, _, radial, axial = over_part(frustum, part, along, away)
            n = normal_of_part(axis, outward, radial, axial)
            best_separation = max(best_separation, least_over(b, core, n, plus_scaled(point, -height, n)))
            highest = max(highest, height)
    chosen, gap, past = LOW_CAP, 0.0, math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if not has_part(frustum, part):
            continue
        height, past_border, radial, axial = over_part(frustum, part, along, away)
        n = normal_of_part(axis, outward, radial, axial)
        # the point of the part's plane or cone that is nearest to the vertex
        foot = plus_scaled(point, -height, n)
        if least_over(b, core, n, foot) < best_separation - margin:
            continue
        if height < 0.0:
            # a vertex below a part touches it only if the vertex is inside of the frustum. A disc has no inside: its
            # point above the vertex must be inside of the polyhedron, or the edges of the vertex must go through the
            # disc
            outside = highest
            if frustum[SIDE] == 0.0:
                outside = tip_past_rim(b, n_star, star, lengths, minus(point, center), n, -height, frustum[LOW_RADIUS])
                outside = min(outside, height_over(b, *faces_of(core), foot))
            past_border = max(past_border, outside)
        if past_border - margin < past:
            chosen, gap, past = part, height, past_border - margin
    write_vertex_over_part(a, out, frustum, chosen, gap_past_end(gap, past), past, axis, around, point)
