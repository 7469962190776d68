"""Gap of a rim of a cylinder, cone or disc over a patch of the surface of another body, convex or not."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import AXIS, SIDE, SWEEP
from ...vectors import Vector3, opposite, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.frames import across, point_in_body, point_in_world, vector_in_body, vector_in_world
from ..features.vertex_face import CLOSED, REACH
from ..features.writing import gap_at_distance, write_flat, write_sweep
from ..frustum.frustum import LOW_RIM, axis_in_world, write_part
from ..frustum.frustum_writing import off_cone_of_rim, write_contact
from ..surface.surface_search import (
    ON_FACE,
    box_square,
    depth_inside,
    face_at,
    face_height,
    feature_of,
    has_patch,
    member_of,
    node_at,
)
from ..surface.surface_tables import FACE_PATCH, N_MEMBERS, N_NODES, SIZE, SKIP
from ..surface.surface_vertex import over_triangle

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
def rim_in_surface(a: Floats, b: Floats, frustum: Floats, place: Vector3) -> RimPose:
    """Return the pose of a rim in the axes of the second body; its centre is at ``place`` in the first body [m]."""
    axis = vector_in_body(b, axis_in_world(a, frustum))
    # the frustum's first axis, perpendicular to its own
    otherwise = vector_in_world(a, (frustum[AXIS - 2], frustum[AXIS + 1], frustum[AXIS + 4]))
    return point_in_body(b, point_in_world(a, place)), axis, vector_in_body(b, otherwise)


@compiled
def _is_nearest(surface: Floats, depth: float, point: Vector3) -> bool:
    """Return whether a face at a depth [m] above a point inside the body is the surface's nearest part to the point.

    Depths within the margin ``CLOSED`` pass without a search: the point may be on a border of faces.
    """
    return bool(depth <= CLOSED * surface[SIZE] or depth <= (1.0 + REACH) * depth_inside(surface, point))


@compiled
def rim_under(
    surface: Floats, patch: float, frustum: Floats, radius: float, up: float, pose: RimPose
) -> tuple[int, float, float]:
    """Return the face of a patch to which a rim is nearest, the gap [m], and the distance past the face's border [m].

    For each face, the gap is measured at the point of the rim that is lowest over this face.  The chosen face has the
    least key: the sum of two squares, of the point's distance from a triangle and of its distance past the face's
    border.  A point inside of the body, below a face, belongs to the face above it that is least high, if this is the
    nearest part of the surface.  If the point lies past the border of the face, the gap is hypot(distance, past).

    Parameters
    ----------
    surface, patch : Floats, float
        The surface, and the number of the patch.
    frustum : Floats
        The body with the rim.
    radius : float
        Radius of the rim [m].
    up : float
        1 for the upper rim, else -1.
    pose : tuple of float
        Pose of the rim in the axes of the surface (:func:`rim_in_surface`).
    """
    center, axis, otherwise = pose
    size = surface[SIZE]
    margin = REACH * size
    # the nearest face: key, height over it, distance from it, distance past its border, number
    least_key, height_best, apart, past, nearest = math.inf, 0.0, 0.0, math.inf, 0
    # the face above a point inside of the body: depth, distance past its border, number
    depth, depth_past, face_above = math.inf, 0.0, -1
    point_below = center
    node = 0
    while node < int(surface[N_NODES]):
        at = node_at(surface, node)
        least_distance = math.sqrt(box_square(surface, at, center)) - radius
        if least_distance > math.sqrt(least_key) or not has_patch(surface, at, patch):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            kind, face, triangle_row = feature_of(surface, member_of(surface, at, i))
            face_row = face_at(surface, face)
            if kind != ON_FACE or surface[face_row + FACE_PATCH] != patch:
                continue
            axial, radial, outward = lowest_on_rim(opposite(vector_at(surface, face_row)), axis, otherwise)
            p = plus_scaled(center, radius, outward)
            height = face_height(surface, face_row, p)
            if height * height > least_key:
                continue
            past_cone = size * (off_cone_of_rim(frustum, up, radial, axial, frustum[SIDE] == 0.0) - CONE_MARGIN)
            past_triangle, past_border, past_part, square = over_triangle(
                surface, triangle_row, height, past_cone, margin, p
            )
            if past_triangle <= 0.0 and height < 0.0 and -height < depth:
                depth, depth_past, face_above, point_below = -height, past_border, face, p
            key = square + max(past_part, 0.0) * max(past_part, 0.0)
            if key < least_key:
                least_key, height_best, apart, past, nearest = key, height, math.sqrt(square), past_part, face
        node += 1
    if face_above >= 0 and depth * depth < least_key and _is_nearest(surface, depth, point_below):
        return face_above, -depth, depth_past
    return nearest, height_best if past <= 0.0 else math.hypot(apart, past), past


@compiled
def rim_over(
    surface: Floats, face: int, frustum: Floats, radius: float, up: float, pose: RimPose, reach: float
) -> tuple[float, float]:
    """Return gap and distance past the border [m] of a rim over the face with the number ``face``, of any patch.

    The rule is that of :func:`rim_under` for one face.  If no part of the face is within ``reach`` [m], both results
    are ``reach``.
    """
    center, axis, otherwise = pose
    size, face_row = surface[SIZE], face_at(surface, face)
    axial, radial, outward = lowest_on_rim(opposite(vector_at(surface, face_row)), axis, otherwise)
    point = plus_scaled(center, radius, outward)
    height = face_height(surface, face_row, point)
    past_cone = size * (off_cone_of_rim(frustum, up, radial, axial, frustum[SIDE] == 0.0) - CONE_MARGIN)
    least_key, height_best, apart, past = reach * reach, 0.0, reach, reach
    depth, depth_past = math.inf, 0.0
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
            if past_triangle <= 0.0 and height < 0.0 and -height < depth:
                depth, depth_past = -height, past_border
            key = square + max(past_part, 0.0) * max(past_part, 0.0)
            if key < least_key:
                least_key, height_best, apart, past = key, height, math.sqrt(square), past_part
        node += 1
    if depth * depth < least_key and _is_nearest(surface, depth, point):
        return -depth, depth_past
    return height_best if past <= 0.0 else math.hypot(apart, past), past


@compiled
def write_rim(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    radius: float,
    place: Vector3,
    surface: Floats,
    face: int,
    gap: float,
    past: float,
) -> None:
    """Write the geometry block of a rim, with its centre at ``place`` in the first body [m], over the face ``face``.

    ``gap`` and ``past``, the distance past the border of the face [m], are results of :func:`rim_under` or
    :func:`rim_over`; the gap is that of the core.
    """
    axis, sweep = axis_in_world(a, frustum), frustum[SWEEP]
    otherwise = vector_in_world(a, (frustum[AXIS - 2], frustum[AXIS + 1], frustum[AXIS + 4]))
    n = vector_in_world(b, opposite(vector_at(surface, face_at(surface, face))))
    _, radial, outward = lowest_on_rim(n, axis, otherwise)
    point = plus_scaled(plus_scaled(point_in_world(a, place), radius, outward), sweep, n)
    write_contact(a, out, gap_at_distance(gap, past, sweep), past, float(face), n, point, False)
    write_part(out, SIDE_A, LOW_RIM, axis, outward, radial, radius)
    write_sweep(out, SIDE_A, sweep)
    write_flat(out, SIDE_B)
