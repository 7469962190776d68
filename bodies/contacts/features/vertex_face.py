"""Finds the face of a polyhedron that a vertex of another body touches, and the feature nearest to a point."""

from __future__ import annotations

import math

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import POSITION
from nonsmooth.types import Floats

from ...vectors import Vector3, divided, dot, minus, norm, scaled, vector_at
from .frames import point_in_body, tangent_of, vector_in_body, vector_in_world
from .polytope_tables import (
    ALONG,
    EDGE,
    ENDS,
    FACE,
    FACES,
    LENGTH,
    N_FACES,
    N_VERTICES,
    OFFSET,
    VERTEX,
    VERTICES,
    edges_of,
    faces_of,
)

REACH = 1e-9
"""Length by which features are extended at their ends, relative to the size of the bodies.

So round-off does not open the contact of features that are aligned.
"""
CLOSED = 1e-7
"""Distance beyond a face's border up to which a vertex touches the face, relative to the size of the bodies.

Equal faces that are almost aligned then have contacts of their vertices.  Edges that cross touch up to the same
distance past their ends.
"""


@compiled
def plane_height(faces: Floats, row: int, point: Vector3) -> float:
    """Return the height of a point over the plane of a face [m], positive outside of the body.

    ``point`` is in the axes of the body [m].  The row of the face begins at index ``row`` of ``faces``.
    """
    return float(dot(vector_at(faces, row), point) - faces[row + OFFSET])


@compiled
def _least_height(frame: Floats, other: Floats, core: Floats, row: int, own: Floats, enough: float) -> float:
    """Return the least height of the other body's vertices over a face [m], or any height below ``enough`` [m].

    The row of the face begins at index ``row`` of ``core``, the core in ``frame``; ``own`` is the core of the body
    ``other``.
    """
    n = vector_in_body(other, vector_in_world(frame, vector_at(core, row)))
    # height of the origin of the other body
    base, least = plane_height(core, row, point_in_body(frame, vector_at(other, POSITION))), math.inf
    for i in range(int(own[N_VERTICES])):
        v = int(own[VERTICES]) + VERTEX * i
        height = base + n[0] * own[v] + n[1] * own[v + 1] + n[2] * own[v + 2]
        if height < least:
            least = height
            if least < enough:
                break
    return least


@compiled
def separation_of_faces(frame: Floats, other: Floats, core: Floats, own: Floats) -> float:
    """Return the largest separation of two bodies along the normals of the first body's faces [m].

    It is negative if none of the planes of the faces separates the bodies.  The faces belong to the core in ``frame``,
    ``own`` is the core of the body ``other``.
    """
    best = -math.inf
    for i in range(int(core[N_FACES])):
        best = max(best, _least_height(frame, other, core, int(core[FACES]) + FACE * i, own, best))
    return best


@compiled
def past_face(faces: Floats, n_faces: float, row: int, height: float, point: Vector3) -> float:
    """Return the distance of a point's projection on a face past the face's borders [m]; negative inside them.

    It is the largest height of the projection over the planes of the other faces, -inf if there are none.  The row of
    the face begins at index ``row``; ``height`` is the height of the point over it [m], ``point`` is in the axes of the
    body [m].
    """
    foot, past = minus(point, scaled(height, vector_at(faces, row))), -math.inf
    for i in range(int(n_faces)):
        if FACE * i != row:
            past = max(past, plane_height(faces, FACE * i, foot))
    return past


@compiled
def height_over(frame: Floats, n_faces: float, faces: Floats, point: Vector3) -> float:
    """Return the largest height of a world point over the planes of the faces [m]: negative inside the polyhedron."""
    x, y, z = point
    point, highest = point_in_body(frame, (x, y, z)), -math.inf
    for i in range(int(n_faces)):
        highest = max(highest, plane_height(faces, FACE * i, point))
    return highest


@compiled
def nearest_face(
    frame: Floats, other: Floats, core: Floats, own: Floats, point: Vector3, size: float
) -> tuple[float, float, float]:
    """Return the number of the face paired with a vertex of the body ``other``, gap, and distance past its border [m].

    The face is the one that best separates the bodies: the least height of all vertices over it is the largest.  So all
    vertices get the same face.  If several faces are equal in this, as in contact at an edge, the vertex gets the face
    on which it projects, and of several the one over which it is highest.  A vertex below its face does not touch it if
    a face of its own body separates the bodies better.  Past the border of its face, a gap that is not negative becomes
    hypot(gap, past); a negative gap is kept.

    ``point`` is the vertex in the world [m].  The face belongs to the core in ``frame``; ``own`` is the core of body
    ``other``, ``size`` the size of the bodies [m].
    """
    n_faces, faces = faces_of(core)
    place = point_in_body(frame, point)
    # a point by itself has no edges beside it
    margin = (CLOSED if own[N_VERTICES] > 1.0 else REACH) * size
    enough = separation_of_faces(frame, other, core, own) - margin
    highest = height_over(frame, n_faces, faces, point)
    found, gap, past = 0, 0.0, math.inf
    for i in range(int(n_faces)):
        height = plane_height(faces, FACE * i, place)
        if height < enough or _least_height(frame, other, core, int(core[FACES]) + FACE * i, own, enough) < enough:
            continue
        past_border = past_face(faces, n_faces, FACE * i, height, place)
        if height < 0.0:
            # a vertex below the plane of a face touches it from inside of the polyhedron only
            past_border = max(past_border, highest)
        past_border -= margin
        # between the borders of both faces the height decides, else the distance past the border
        if height > gap if max(past, past_border) <= 0.0 else past_border < past:
            found, gap, past = i, height, past_border
    if past <= 0.0 and gap < -margin:
        past = max(past, separation_of_faces(other, frame, own, core) - gap - margin)
    if past > 0.0 and gap >= 0.0:
        gap = math.hypot(gap, past)
    return float(found), gap, past


Nearest = tuple[int, float, float, float, float, float]
"""Number of the feature (faces first, then edges, then vertices), distance [m], unit vector to the point, and margin.

The margin is the distance of the nearest point from the nearer end of its edge [m]: 0 at a vertex, infinite on a face.
"""
_SAME = 1e-14
"""Largest relative difference of squared distances that are treated as equal: round-off."""


@compiled
def _nearest_face(core: Floats, point: Vector3) -> tuple[int, float]:
    """Return the face nearest to a point and the point's height over it [m]; -1 if an edge or a vertex is nearest."""
    highest, best = -math.inf, -1
    n_faces, faces = faces_of(core)
    for i in range(int(n_faces)):
        height = plane_height(faces, FACE * i, point)
        if height > highest:
            best, highest = i, height
    # a point inside is nearest to the face whose plane is nearest
    if highest <= 0.0:
        return best, highest
    for i in range(int(n_faces)):
        height = plane_height(faces, FACE * i, point)
        if height > 0.0 and past_face(faces, n_faces, FACE * i, height, point) <= 0.0:
            return i, height
    return -1, 0.0


@compiled
def _nearest_edge(core: Floats, point: Vector3) -> tuple[int, float]:
    """Return the edge nearest to a point, and the distance of the nearest point from the start of the edge [m].

    Near a vertex, the distances of several edges may be equal within round-off.  Then the edge is taken whose nearest
    point is farthest from its ends.
    """
    least, best, best_along, best_within = math.inf, 0, 0.0, 0.0
    n_edges, edges = edges_of(core)
    for i in range(int(n_edges)):
        row = EDGE * i
        w, direction = minus(point, vector_at(edges, row)), vector_at(edges, row + ALONG)
        length = edges[row + LENGTH]
        along = min(max(dot(w, direction), 0.0), length)
        w = minus(w, scaled(along, direction))
        square, within = dot(w, w), min(along, length - along)
        if square < least * (1.0 - _SAME) or (square <= least * (1.0 + _SAME) and within > best_within):
            least, best, best_along, best_within = square, i, along, within
    return best, best_along


@compiled
def nearest_of_core(core: Floats, point: Vector3) -> Nearest:
    """Return the feature of a core that is nearest to a ``point`` in the axes of its body [m].

    For a point inside, this is the nearest face, with a negative distance.  The direction from an edge to a point on
    it is undefined; a unit vector perpendicular to the edge is returned.
    """
    face, distance = _nearest_face(core, point)
    n_faces, faces = faces_of(core)
    if face >= 0:
        return face, distance, *vector_at(faces, FACE * face), math.inf
    edge, along = _nearest_edge(core, point)
    n_edges, edges = edges_of(core)
    row, ends = EDGE * edge, block_at(core, int(core[ENDS]))
    n = minus(minus(point, vector_at(edges, row)), scaled(along, vector_at(edges, row + ALONG)))
    distance = norm(n)
    n = divided(n, distance) if distance > 0.0 else tangent_of(vector_at(edges, row + ALONG))
    within = min(along, edges[row + LENGTH] - along)
    if within > 0.0:
        return int(n_faces) + edge, distance, *n, within
    # the vertex at the nearer end
    number = int(n_faces) + int(n_edges) + int(ends[2 * edge] if along == 0.0 else ends[2 * edge + 1])
    return number, distance, *n, 0.0
