"""A rim of a cylinder, cone or disc over a face of a surface, convex or not."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import AXIS, LOW, LOW_RADIUS, SIDE
from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...vectors import Vector3, opposite, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.frames import across, point_in_body, vector_in_body, vector_in_world
from ..features.vertex_face import CLOSED, REACH
from ..features.writing import write_flat, write_sweep
from ..surface.surface_search import (
    ON_FACE,
    box_square,
    face_at,
    face_height,
    feature_of,
    first_leaf,
    member_of,
    node_at,
    outward_of,
)
from ..surface.surface_tables import N_MEMBERS, N_NODES, SIZE, SKIP, SWEEP
from ..surface.surface_vertex import over_triangle
from .frustum import LOW_RIM, axis_in_world, on_axis_in_world, past_of_rim, write_part
from .frustum_writing import off_cone_of_rim, write_contact

_FLAT = 1e-12
"""Sine of the angle between the planes of rim and face below which the lowest point of the rim is round-off."""
RimPose: TypeAlias = tuple[Vector3, Vector3, Vector3]
"""Centre of a rim [m], its unit axis, and the unit vector to its contact point if the rim is parallel to a face."""


@compiled
def lowest_on_rim(n: Vector3, axis: Vector3, otherwise: Vector3) -> tuple[float, float, Vector3]:
    """Return axial and radial component of the unit normal n, and the unit vector of its radial part.

    The rim's farthest point along n lies in the direction of this unit vector from its centre.  It is ``otherwise`` if
    n is along the axis within round-off: all points of the rim are then equally far.
    """
    axial, radial, outward = across(n, axis)
    return axial, radial, otherwise if radial < _FLAT else outward


@compiled
def _past_depth(surface: Floats, frustum: Floats, upper: int, pose: RimPose, depth: float, point: Vector3) -> float:
    """Return by how much the depth of a rim's point exceeds what a surface allows [m]; not positive for a real overlap.

    The overlap at the point is no deeper than the least deep face that the rim may touch: through that face the bodies
    separate on a shorter way.  A face has the depth of its own lowest point of the rim, or the distance of ``point`` if
    this is larger.  A point outside of the body overlaps nothing.

    ``pose`` is the pose of the rim, ``point`` its lowest point over the face, both in the axes of the surface [m].
    Depths within the margin ``CLOSED`` are allowed without a search: the point may be on a border of faces.
    """
    if depth <= CLOSED * surface[SIZE]:
        return 0.0
    center, axis, otherwise = pose
    radius, up = frustum[LOW_RADIUS + upper], 2.0 * upper - 1.0
    least, side, least_deep = math.inf, 0.0, depth * (1.0 + REACH)
    first = first_leaf(surface, -1.0, point)
    node = -1
    while node < int(surface[N_NODES]):
        at = node_at(surface, first if node < 0 else node)
        if node >= 0 and box_square(surface, at, point) > max(least, least_deep * least_deep):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            kind, face, triangle_row = feature_of(surface, member_of(surface, at, i))
            if kind != ON_FACE:
                continue
            square, outward = outward_of(surface, face, triangle_row, point)
            if square < least:
                least, side = square, outward
            row = face_at(surface, face)
            axial, radial, _ = lowest_on_rim(opposite(vector_at(surface, row)), axis, otherwise)
            deep = max(math.sqrt(square), radius * radial - face_height(surface, row, center))
            if deep < least_deep and off_cone_of_rim(frustum, up, radial, axial, frustum[SIDE] == 0.0) <= CONE_MARGIN:
                least_deep = deep
        node += 1
    return depth if side >= 0.0 else depth - (1.0 + REACH) * least_deep


@compiled
def _rim_over(
    surface: Floats, face: int, frustum: Floats, upper: int, pose: RimPose, reach: float
) -> tuple[float, float]:
    """Return gap and distance past the border [m] of a rim over a face; the gap includes the sweeps of both bodies.

    The gap is measured at the point of the rim that is lowest over the face.  A point past the border of the face, at
    the distance ``past``, has the gap hypot(height, past).  If no part of the face is within ``reach`` [m] of the
    point, both results are at least ``reach``, less the sweeps.

    The lowest point of a rim nearly parallel to the face moves far while the bodies hardly move.  Above the face the
    distance past the border is therefore reduced (:func:`bodies.contacts.frustum.frustum.past_of_rim`).
    """
    center, axis, otherwise = pose
    radius, up, sweep = frustum[LOW_RADIUS + upper], 2.0 * upper - 1.0, frustum[FRUSTUM_SWEEP] + surface[SWEEP]
    size, face_row = surface[SIZE], face_at(surface, face)
    axial, radial, outward = lowest_on_rim(opposite(vector_at(surface, face_row)), axis, otherwise)
    point = plus_scaled(center, radius, outward)
    height = face_height(surface, face_row, point)
    past_cone = size * (off_cone_of_rim(frustum, up, radial, axial, frustum[SIDE] == 0.0) - CONE_MARGIN)
    least_key, apart, past = reach * reach, reach, reach
    is_under, past_under = False, 0.0
    node = 0
    while node < int(surface[N_NODES]):
        at = node_at(surface, node)
        if box_square(surface, at, point) > least_key:
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            kind, number, triangle_row = feature_of(surface, member_of(surface, at, i))
            if kind != ON_FACE or number != face:
                continue
            past_triangle, past_border, past_part, square = over_triangle(
                surface, triangle_row, height, past_cone, REACH * size, point
            )
            if past_triangle <= 0.0 and height < 0.0:
                is_under, past_under = True, past_border
            key = square + max(past_part, 0.0) * max(past_part, 0.0)
            if key < least_key:
                least_key, apart, past = key, math.sqrt(square), past_part
        node += 1
    if is_under and _past_depth(surface, frustum, upper, pose, -height, point) <= 0.0:
        return height - sweep, past_under
    if past <= 0.0:
        return height - sweep, past
    if height > sweep:
        past, apart = past_of_rim(past, radius, radial), height
    return math.hypot(max(apart - sweep, 0.0), past), past


@compiled
def write_rim(
    a: Floats, b: Floats, out: Floats, frustum: Floats, upper: int, surface: Floats, face: int, reach: float
) -> None:
    """Write the geometry block of a rim of the first body, at its lowest point, over a face of the second body.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    frustum, upper : Floats, int
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`), and 1 for its upper rim, 0 for the lower one.
    surface, face : Floats, int
        The second body (:mod:`bodies.contacts.surface.surface_tables`), and the number of the face.
    reach : float
        Distance of the rim from the face up to which the contact is evaluated [m].
    """
    axis, center = axis_in_world(a, frustum), on_axis_in_world(a, frustum, frustum[LOW + upper])
    # the frustum's first axis, perpendicular to its own
    otherwise = vector_in_world(a, (frustum[AXIS - 2], frustum[AXIS + 1], frustum[AXIS + 4]))
    pose = point_in_body(b, center), vector_in_body(b, axis), vector_in_body(b, otherwise)
    radius, sweep = frustum[LOW_RADIUS + upper], frustum[FRUSTUM_SWEEP]
    # any point of the rim may become the lowest one
    gap, past = _rim_over(surface, face, frustum, upper, pose, reach + 2.0 * radius)
    n = vector_in_world(b, opposite(vector_at(surface, face_at(surface, face))))
    _, radial, outward = lowest_on_rim(n, axis, otherwise)
    point = plus_scaled(plus_scaled(center, radius, outward), sweep, n)
    write_contact(a, out, gap, past, float(face), n, point, False)
    write_part(out, SIDE_A, LOW_RIM, axis, outward, radial, radius)
    write_sweep(out, SIDE_A, sweep)
    write_flat(out, SIDE_B)
