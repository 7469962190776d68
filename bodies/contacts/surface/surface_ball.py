"""Writes the geometry block of a ball against a patch of a surface.

It also writes the curvature matrices of the feature in contact: a face, an edge or a corner.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, NORMAL, PAST_END, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...vectors import Vector3, divided, minus, vector_at, write_vector
from ..features.frames import point_in_body, point_in_world, vector_in_world
from ..features.polytope_tables import ALONG
from ..features.swept_vertex import END, NEAR, past_star
from ..features.writing import place_sphere, write_flat, write_principal, write_round
from .surface_search import ON_EDGE, ON_FACE, Found, edge_at, face_at, nearest_in_patch
from .surface_tables import N_EDGES, N_FACES, N_PATCHES


@compiled
def out_of_surface(frame: Floats, surface: Floats, found: Found, past: float, point: Vector3) -> Vector3:
    """Return the unit normal, in world axes, at a surface's nearest point to a point of the body frame.

    On a face it is the normal of the face; else it points from the nearest point to ``point``.  ``found`` is the result
    of :func:`nearest_in_patch`, and ``past`` the distance past the end of the feature [m].
    """
    distance, _, kind, number, px, py, pz = found
    n = vector_at(surface, face_at(surface, number))
    if not (kind == ON_FACE and (past <= 0.0 or distance == 0.0)):
        n = divided(minus(point, (px, py, pz)), distance)
    return vector_in_world(frame, n)


@compiled
def write_feature(frame: Floats, out: Floats, side: int, surface: Floats, kind: int, number: int) -> None:
    """Write the curvature matrices and the number of a face, an edge or a corner (faces first, then edges, corners).

    The geometry block ``out`` must already hold the normal and the first tangent.
    """
    out[FEATURE] = float(number)
    if kind == ON_FACE:
        write_flat(out, side)
    elif kind == ON_EDGE:
        along = vector_in_world(frame, vector_at(surface, edge_at(surface, number) + ALONG))
        write_principal(out, side, along, 0.0, 1.0, 1.0, 0.0)
        out[FEATURE] += surface[N_FACES]
    else:
        write_round(out, side, 0.0)
        out[FEATURE] += surface[N_FACES] + surface[N_EDGES]


@compiled
def write_ball(
    a: Floats,
    b: Floats,
    out: Floats,
    surface: Floats,
    patch: float,
    radius: float,
    place: Vector3,
    n_star: float,
    star: Floats,
    size: float,
    reach: float,
) -> None:
    """Write the geometry block of a ball about a ``place`` of the second body [m] and a patch of the first body.

    Features of the patch are searched up to the distance ``reach`` from the ball's centre [m].  A ball about a vertex
    has its ``n_star`` edges: ``star`` holds unit vectors along them, in the axes of the second body.  ``radius`` is
    that of the ball, ``size`` that of the bodies [m].
    """
    center = point_in_world(b, place)
    in_surface = point_in_body(a, center)
    found = nearest_in_patch(surface, patch, in_surface, reach)
    distance, kind, number = found[0], found[2], found[3]
    # if there is one patch only, it is the whole surface: the contact point can never be past its end
    past = found[1] if surface[N_PATCHES] > 1.0 else 0.0
    n = out_of_surface(a, surface, found, past, in_surface)
    # over a face the contact does not end at the vertex: an edge over the face touches with both ends, also if it tilts
    if n_star > 0.0 and kind != ON_FACE:
        past_vertex = past_star(b, star, n_star, distance, n, size)
        past = max(past, min(past_vertex, -END * size) if distance - radius > NEAR * size else past_vertex)
    write_vector(out, NORMAL, n)
    if past > 0.0:
        apart = max(distance - radius, 0.0)
        distance = math.sqrt(apart * apart + past * past) + radius
    place_sphere(a, out, center, distance, radius)
    out[PAST_END] = past
    write_feature(a, out, SIDE_A, surface, kind, number)
    write_round(out, SIDE_B, radius)
