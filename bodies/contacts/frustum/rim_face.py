"""A rim of a cylinder, cone or disc over a face of a surface, convex or not."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import AXIS, LOW, LOW_RADIUS, SIDE
from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...vectors import Vector3, minus, norm, opposite, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.ends import CLOSED, REACH, gap_past_end
from ..features.frames import across, point_in_body, vector_in_body, vector_in_world
from ..features.writing import write_flat, write_sweep
from ..surface.overlap_corners import FLUSH
from ..surface.surface_search import (
    ON_FACE,
    box_square,
    face_at,
    face_height,
    feature_of,
    in_triangle,
    member_of,
    node_at,
    signed_distance,
)
from ..surface.surface_tables import IS_CONVEX, N_MEMBERS, N_NODES, SIZE, SKIP, SWEEP
from ..surface.surface_vertex import over_triangle
from .frustum import LOW_RIM, axis_in_world, center_in_world, least_height, on_axis_in_world, past_of_rim, write_part
from .frustum_writing import off_cone_of_rim, write_contact

_FLAT = 1e-12
"""Sine of the angle between the planes of rim and face below which the lowest point of the rim is round-off."""
FrustumPose: TypeAlias = tuple[Vector3, Vector3]
"""Centre [m] and axis of a frustum in the axes of a surface."""


@compiled
def frustum_in_surface(a: Floats, b: Floats, frustum: Floats) -> FrustumPose:
    """Return centre [m] and axis of the first body's frustum in the axes of the second body."""
    return point_in_body(b, center_in_world(a, frustum)), vector_in_body(b, axis_in_world(a, frustum))


@compiled
def lowest_on_rim(n: Vector3, axis: Vector3, otherwise: Vector3) -> tuple[float, float, Vector3]:
    """Return axial and radial component of the unit normal n, and the unit vector of its radial part.

    The rim's farthest point along n lies in the direction of this unit vector from its centre.  It is ``otherwise`` if
    n is along the axis within round-off: all points of the rim are then equally far.
    """
    axial, radial, outward = across(n, axis)
    return axial, radial, otherwise if radial < _FLAT else outward


@compiled
def past_faces(surface: Floats, frustum: Floats, pose: FrustumPose, depth: float, point: Vector3) -> float:
    """Return by how much the depth of an overlap exceeds that of the least deep face [m]; not positive for a real one.

    Through the least deep face the bodies separate on a shorter way.  A face is as deep as the frustum is below its
    plane, or as the ``point`` of the overlap is distant from it, if this is more: faces far away do not count.
    ``pose`` and ``point`` are in the axes of the surface.
    """
    center, axis = pose
    margin = REACH * (surface[SIZE] + depth)
    least_deep, node = depth + margin, 0
    while node < int(surface[N_NODES]):
        at = node_at(surface, node)
        if box_square(surface, at, point) > least_deep * least_deep:
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            kind, face, triangle_row = feature_of(surface, member_of(surface, at, i))
            if kind != ON_FACE:
                continue
            row = face_at(surface, face)
            deep = -least_height(frustum, face_height(surface, row, center), axis, vector_at(surface, row))
            if deep < least_deep:
                x, y, z, _ = in_triangle(surface, triangle_row, point)
                least_deep = min(least_deep, max(deep, norm(minus(point, (x, y, z)))))
        node += 1
    return float(depth - least_deep - margin)


@compiled
def _is_real(surface: Floats, frustum: Floats, pose: FrustumPose, depth: float, point: Vector3) -> bool:
    """Return whether a rim's point at a depth below a face [m] is inside of the body, and no other face is less deep.

    Depths within the margin ``CLOSED`` are real without a search.  Outside of the body the point has a margin, too: it
    may be on a border of faces.
    """
    margin = CLOSED * surface[SIZE]
    if depth <= margin:
        return True
    if signed_distance(surface, point) > margin + FLUSH * depth:
        return False
    return past_faces(surface, frustum, pose, depth, point) <= 0.0


@compiled
def _rim_over(
    surface: Floats, face: int, frustum: Floats, upper: int, pose: FrustumPose, otherwise: Vector3, reach: float
) -> tuple[float, float]:
    """Return gap and distance past the border [m] of a rim over a face; the gap includes the sweeps of both bodies.

    The gap is measured at the point of the rim that is lowest over the face.  A point past the border of the face, at
    the distance ``past``, has the gap hypot(height, past).  If no part of the face is within ``reach`` [m] of the
    point, both results are at least ``reach``, less the sweeps.

    The lowest point of a rim nearly parallel to the face moves far while the bodies hardly move.  Above the face the
    distance past the border is therefore reduced (:func:`bodies.contacts.frustum.frustum.past_of_rim`).

    ``pose`` is that of the frustum in the axes of the surface; ``otherwise`` is the unit vector to the contact point of
    a rim parallel to the face.
    """
    middle, axis = pose
    center, radius = plus_scaled(middle, frustum[LOW + upper], axis), frustum[LOW_RADIUS + upper]
    up, sweep = 2.0 * upper - 1.0, frustum[FRUSTUM_SWEEP] + surface[SWEEP]
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
    if is_under and _is_real(surface, frustum, pose, -height, point):
        return height - sweep, past_under
    if past <= 0.0:
        return height - sweep, past
    if height > sweep:
        past = past_of_rim(past, radius, radial)
    is_convex = surface[IS_CONVEX] == 1.0
    return gap_past_end((height if height >= 0.0 or is_convex else apart) - sweep, past, is_convex), past


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
    radius, sweep = frustum[LOW_RADIUS + upper], frustum[FRUSTUM_SWEEP]
    # any point of the rim may become the lowest one
    pose, reach = frustum_in_surface(a, b, frustum), reach + 2.0 * radius
    gap, past = _rim_over(surface, face, frustum, upper, pose, vector_in_body(b, otherwise), reach)
    n = vector_in_world(b, opposite(vector_at(surface, face_at(surface, face))))
    _, radial, outward = lowest_on_rim(n, axis, otherwise)
    point = plus_scaled(plus_scaled(center, radius, outward), sweep, n)
    write_contact(a, out, gap, past, float(face), n, point, False)
    write_part(out, SIDE_A, LOW_RIM, axis, outward, radial, radius)
    write_sweep(out, SIDE_A, sweep)
    write_flat(out, SIDE_B)
