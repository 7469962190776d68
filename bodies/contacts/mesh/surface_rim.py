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
from ..surface.surface_search import box_square, depth_inside, face_height, has_patch
from ..surface.surface_tables import (
    FACE,
    FACE_NUMBER,
    FACE_PATCH,
    FACES,
    FIRST_MEMBER,
    MEMBERS,
    N_MEMBERS,
    N_NODES,
    N_TRIANGLES,
    NODE,
    NODES,
    SIZE,
    SKIP,
    TRIANGLE,
    TRIANGLES,
)
from ..surface.surface_vertex import over_face

_FLAT = 1e-12
"""Sine of the angle between rim and face below which the lowest point of the rim is round-off."""
RimPose: TypeAlias = tuple[Vector3, Vector3, Vector3]
"""Centre of a rim [m], its unit axis, and the direction to its contact point if the rim is parallel to a face."""


@compiled
def lowest_on_rim(n: Vector3, axis: Vector3, otherwise: Vector3) -> tuple[float, float, Vector3]:
    """Return axial and radial component of the unit normal n, and the unit vector of its radial part.

    The vector ``otherwise`` is returned as this unit vector if n is along the axis within round-off, without a radial
    part.
    """
    axial, radial, outward = across(n, axis)
    return axial, radial, otherwise if radial < _FLAT else outward


@compiled
def rim_in_surface(a: Floats, b: Floats, frustum: Floats, place: Vector3) -> RimPose:
    """Return the pose of a rim in the axes of the second body; its centre is at ``place`` in the first body [m]."""
    axis = vector_in_body(b, axis_in_world(a, frustum))
    otherwise = vector_in_world(a, (frustum[AXIS - 2], frustum[AXIS + 1], frustum[AXIS + 4]))
    return point_in_body(b, point_in_world(a, place)), axis, vector_in_body(b, otherwise)


@compiled
def _is_nearest(surface: Floats, depth: float, point: Vector3) -> bool:
    """Return whether a face at a depth [m] above a point is the nearest part of the surface to the point.

    Depths within the margin ``CLOSED`` are round-off: the point may be on a border.
    """
    return bool(depth <= CLOSED * surface[SIZE] or depth <= (1.0 + REACH) * depth_inside(surface, point))


@compiled
def rim_under(
    surface: Floats,
    patch: float,
    frustum: Floats,
    radius: float,
    up: float,
    pose: RimPose,
) -> tuple[int, float, float]:
    """Return the face of a patch that a rim faces, the gap, and the distance past the border of the face [m].

    For each face, the gap is measured at the point of the rim that is lowest over this face.  From these gaps, the face
    is chosen as for a vertex (:func:`bodies.contacts.surface.surface_vertex.face_under`), but a point inside of the
    body belongs to the nearest face.  If the point lies past the border of the face, the gap is positive.

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
    nodes, members, n_triangles = int(surface[NODES]), int(surface[MEMBERS]), int(surface[N_TRIANGLES])
    size = surface[SIZE]
    margin = REACH * size
    best, height_best, apart, past, found = math.inf, 0.0, 0.0, math.inf, 0
    under, under_past, under_face = math.inf, 0.0, -1
    point_under = center
    node = 0
    while node < int(surface[N_NODES]):
        at = nodes + NODE * node
        apart_at_least = math.sqrt(box_square(surface, at, center)) - radius
        if apart_at_least > math.sqrt(best) or not has_patch(surface, at, patch):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            member = int(surface[members + int(surface[at + FIRST_MEMBER]) + i])
            if member >= n_triangles:
                continue
            t = int(surface[TRIANGLES]) + TRIANGLE * member
            face = int(surface[t + FACE_NUMBER])
            f = int(surface[FACES]) + FACE * face
            if surface[f + FACE_PATCH] != patch:
                continue
            axial, radial, outward = lowest_on_rim(opposite(vector_at(surface, f)), axis, otherwise)
            p = plus_scaled(center, radius, outward)
            height = face_height(surface, f, p)
            if height * height > best:
                continue
            lean = size * (off_cone_of_rim(frustum, up, radial, axial, frustum[SIDE] == 0.0) - CONE_MARGIN)
            over, inside, ends, square = over_face(surface, t, height, lean, margin, p)
            if over <= 0.0 and height < 0.0 and -height < under:
                under, under_past, under_face, point_under = -height, inside, face, p
            key = square + max(ends, 0.0) * max(ends, 0.0)
            if key < best:
                best, height_best, apart, past, found = key, height, math.sqrt(square), ends, face
        node += 1
    if under_face >= 0 and under * under < best and _is_nearest(surface, under, point_under):
        return under_face, -under, under_past
    return found, height_best if past <= 0.0 else math.hypot(apart, past), past


@compiled
def rim_over(
    surface: Floats, face: int, frustum: Floats, radius: float, up: float, pose: RimPose, reach: float
) -> tuple[float, float]:
    """Return gap and distance past the border of a face [m], for a rim over one face, whatever the patch of the face.

    If no part of the face is within ``reach`` [m], both are ``reach``.
    """
    center, axis, otherwise = pose
    nodes, members, n_triangles = int(surface[NODES]), int(surface[MEMBERS]), int(surface[N_TRIANGLES])
    size, f = surface[SIZE], int(surface[FACES]) + FACE * face
    axial, radial, outward = lowest_on_rim(opposite(vector_at(surface, f)), axis, otherwise)
    point = plus_scaled(center, radius, outward)
    height = face_height(surface, f, point)
    lean = size * (off_cone_of_rim(frustum, up, radial, axial, frustum[SIDE] == 0.0) - CONE_MARGIN)
    best, height_best, apart, past = reach * reach, 0.0, reach, reach
    under, under_past = math.inf, 0.0
    node = 0
    while node < int(surface[N_NODES]):
        at = nodes + NODE * node
        if box_square(surface, at, point) > best:
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            member = int(surface[members + int(surface[at + FIRST_MEMBER]) + i])
            t = int(surface[TRIANGLES]) + TRIANGLE * member
            if member >= n_triangles or int(surface[t + FACE_NUMBER]) != face:
                continue
            over, inside, ends, square = over_face(surface, t, height, lean, REACH * size, point)
            if over <= 0.0 and height < 0.0 and -height < under:
                under, under_past = -height, inside
            key = square + max(ends, 0.0) * max(ends, 0.0)
            if key < best:
                best, height_best, apart, past = key, height, math.sqrt(square), ends
        node += 1
    if under * under < best and _is_nearest(surface, under, point):
        return -under, under_past
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
    """Write the geometry block of a rim with its centre at ``place`` in the first body [m] over a face.

    ``gap`` and ``past``, the distance past the border of the face [m], are results of :func:`rim_under` or
    :func:`rim_over`.
    """
    axis, sweep = axis_in_world(a, frustum), frustum[SWEEP]
    otherwise = vector_in_world(a, (frustum[AXIS - 2], frustum[AXIS + 1], frustum[AXIS + 4]))
    n = vector_in_world(b, opposite(vector_at(surface, int(surface[FACES]) + FACE * face)))
    _, sine, outward = lowest_on_rim(n, axis, otherwise)
    point = plus_scaled(plus_scaled(point_in_world(a, place), radius, outward), sweep, n)
    write_contact(a, out, gap_at_distance(gap, past, sweep), past, float(face), n, point, False)
    write_part(out, SIDE_A, LOW_RIM, axis, outward, sine, radius)
    write_sweep(out, SIDE_A, sweep)
    write_flat(out, SIDE_B)
