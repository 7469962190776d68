"""Contact of a rim, a foot or the apex of a cylinder, cone or disc with the faces of a polyhedron."""

from __future__ import annotations

import math

from nonsmooth.engine.memory.blocks import SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import SWEEP
from ...vectors import opposite, plus_scaled, vector_at
from ..features.frames import across, point_in_body, point_in_world, vector_in_body, vector_in_world
from ..features.polytope_tables import FACE, faces_of
from ..features.vertex_face import REACH, past_face, plane_height
from ..features.writing import write_flat
from .frustum import LOW_RIM, axis_in_world, center_in_world, least_height, past_of_rim, separation_over_faces
from .frustum_writing import gap_past_end, write_contact, write_rounded_part


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
    # centre and axis of the rim, and centre of the frustum, in the axes of the second body
    center_in_b = point_in_body(b, place)
    axis_in_b, middle = vector_in_body(b, axis), point_in_body(b, center_in_world(a, frustum))
    margin, best, own = REACH * size, separation_over_faces(a, b, frustum, core), frustum[SWEEP]
    n_faces, faces = faces_of(core)
    # of the faces that separate the bodies equally well, take the one whose border the rim's point is least past
    nearest, distance, past = 0, 0.0, math.inf
    for i in range(int(n_faces)):
        row = FACE * i
        face_normal = vector_at(faces, row)
        if least_height(frustum, plane_height(faces, row, middle), axis_in_b, face_normal) < best - margin:
            continue
        _, sine, outward = across(opposite(face_normal), axis_in_b)
        p = plus_scaled(center_in_b, radius, outward)
        height = plane_height(faces, row, p)
        past_border = past_face(faces, n_faces, row, height, p)
        if height < 0.0:
            # a rim's point below the plane of a face touches the face only if it is inside of the polyhedron
            for j in range(int(n_faces)):
                past_border = max(past_border, plane_height(faces, FACE * j, p))
        past_border -= margin
        if height > own + sweep:
            past_border = past_of_rim(past_border, radius, sine)
        if past_border < past:
            nearest, distance, past = i, height, past_border
    gap = gap_past_end(distance - (own + sweep), past)
    n = vector_in_world(b, vector_at(faces, FACE * nearest))
    _, _, outward = across(opposite(n), axis)
    point = plus_scaled(plus_scaled(place, radius, outward), -own, n)
    write_contact(a, out, gap, past, float(nearest), opposite(n), point, False)
    write_flat(out, SIDE_B)
    write_rounded_part(out, 0.0, frustum, LOW_RIM, axis, outward, opposite(n), radius)
