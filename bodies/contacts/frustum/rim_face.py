"""Contact of a rim, a foot or the apex of a cylinder, cone or disc with the faces of a polyhedron."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import SWEEP
from ...vectors import Vector3, ahead, cross, opposite, plus, times, vector_at
from ..features.flat_rim import FLATTEST, Touching, touching_point, write_rim
from ..features.frames import across, point_in_body, point_in_world, vector_in_body, vector_in_world
from ..features.polytope_tables import FACE, faces_of
from ..features.vertex_face import REACH, past_face, plane_height
from ..features.writing import write_flat, write_round
from .frustum import axis_in_world, center_in_world, least_height, separation_over_faces
from .frustum_writing import gap_past_end, write_contact


@compiled
def _touching(
    a: Floats, b: Floats, radius: float, place: Vector3, axis: Vector3, normal: Vector3
) -> tuple[Vector3, Touching]:
    """Return the point of a rim at which its gap over a plane is measured [m], and the touching point of the rim.

    The touching point is explained in :data:`bodies.contacts.features.flat_rim.Touching`.

    Parameters
    ----------
    a, b : Floats
        Frame blocks of the body with the rim, and of the body with the plane.
    radius : float
        Radius of the rim [m].
    place : tuple of float
        Centre of the rim in the world [m].
    axis, normal : tuple of float
        Unit axis of the rim, and unit normal of the plane towards the rim, in world axes.
    """
    at = touching_point(a, b, normal, axis, radius)
    reach, outward, lift, _, _, _ = at
    return ahead(ahead(place, reach, outward), -lift, normal), at


@compiled
def _past_flat(faces: Floats, n_faces: float, face: int, center: Vector3, radius: float) -> float:
    """Return the distance of a flat rim that touches as a crown past the border of a face [m]; negative if valid.

    The centre of the rim, in the frame of the polyhedron [m], must be over the face.  So must a part of the rim of
    ``radius`` [m]: it lies within the face, or it crosses the border of the face.  If the whole face lies inside of the
    rim, the vertices and edges of the face carry the load instead.
    """
    over = past_face(faces, n_faces, face, plane_height(faces, face, center), center)
    if over <= -radius:
        return float(over)
    n, least = vector_at(faces, face), radius
    for i in range(int(n_faces)):
        f = FACE * i
        # distance and direction, in the plane of this face, from the centre to the line of another face
        along, sine, e = across(vector_at(faces, f), n)
        away = along * plane_height(faces, face, center) - plane_height(faces, f, center)
        if f == face or abs(away) >= radius * sine:
            continue
        away /= sine
        half = math.sqrt(radius * radius - away * away)
        for sign in (-half, half):
            p = plus(ahead(center, away, e), times(sign, cross(n, e)))
            least = min(least, past_face(faces, n_faces, face, plane_height(faces, face, p), p))
    return float(max(over, least))


def evaluate_rim_over_faces(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    radius: float,
    center: Floats,
    core: Floats,
    sweep: float,
    size: float,
) -> None:
    """Write the geometry block of a rim and a face of the second body, at the rim's point that is lowest over the face.

    The face is the one over which the least height of the whole frustum is the largest, so that it best separates the
    bodies.  Feet and the apex are treated as rims of radius 0.  A frustum whose axis is parallel to the face has
    contacts of its two rims.  A frustum that stands on a cap has contacts of its feet.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    frustum : Floats
        The first body, with its rims set back by its feet (:func:`bodies.contacts.frustum.frustum.set_back`).
    radius : float
        Radius of the rim [m].
    center : Floats
        Centre of the rim in the body frame [m].
    core : Floats
        Core of the second body (:func:`bodies.contacts.features.polytope_tables.core_numbers`).
    sweep : float
        Radius about the core of the second body [m].
    size : float
        Size of the bodies [m].
    """
    axis, place = axis_in_world(a, frustum), point_in_world(a, vector_at(center, 0))
    own_axis, middle = vector_in_body(b, axis), point_in_body(b, center_in_world(a, frustum))
    margin, best = REACH * size, separation_over_faces(a, b, frustum, core)
    n_faces, faces = faces_of(core)
    found, gap, past = 0, 0.0, math.inf
    for i in range(int(n_faces)):
        f = FACE * i
        if least_height(frustum, plane_height(faces, f, middle), own_axis, vector_at(faces, f)) < best - margin:
            continue
        point, at = _touching(a, b, radius, place, axis, vector_in_world(b, vector_at(faces, f)))
        p = point_in_body(b, point)
        height = plane_height(faces, f, p)
        beyond = past_face(faces, n_faces, f, height, p)
        if radius > 0.0 and at[4] == FLATTEST:
            p = point_in_body(b, place)
            beyond = _past_flat(faces, n_faces, f, p, radius)
        if height < 0.0:
            # a rim's point below the plane of a face touches the face only if it is inside of the polyhedron
            for j in range(int(n_faces)):
                beyond = max(beyond, plane_height(faces, FACE * j, p))
        if beyond - margin < past:
            found, gap, past = i, height, beyond - margin
    own = frustum[SWEEP]
    gap = gap_past_end(gap - (own + sweep), past)
    n = vector_in_world(b, vector_at(faces, FACE * found))
    point, at = _touching(a, b, radius, place, axis, n)
    write_contact(a, out, gap, past, float(found), opposite(n), ahead(point, -own, n), False)
    write_flat(out, SIDE_B)
    if radius > 0.0:
        write_rim(out, SIDE_A, axis, radius, at, own)
    else:
        write_round(out, SIDE_A, own)
