"""Finds the face of a polyhedron that a vertex of another body touches, and the feature nearest to a point."""

from __future__ import annotations

import math

from nonsmooth.compiled import block_at, compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, divided, dot, minus, norm, scaled, vector_at
from .frames import point_in_body, tangent_of
from .polytope_tables import (
    ALONG,
    EDGE,
    ENDS,
    FACE,
    LENGTH,
    OFFSET,
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
