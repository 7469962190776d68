"""The feature of a polyhedron or a segment that is nearest to a point."""

from __future__ import annotations

import math

from bodies.contacts.features.polytope_tables import EDGE, FACE
from bodies.contacts.features.tangents import tangent_of
from bodies.contacts.features.vertex_face import past_face, plane_height
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

Nearest = tuple[int, float, float, float, float, float]
"""Number of the feature (faces first, then edges, then vertices), distance, unit vector to the point, and how far the
nearest point is from the nearer end of its edge; 0 at a vertex, infinite on a face."""
_SAME = 1e-14
"""Squares of distances that differ by this part are the same."""


@compiled
def _face(faces: Floats, n_faces: float, x: float, y: float, z: float) -> tuple[int, float]:
    """Return the face that is nearest to a point and its height over it, or -1 where an edge or a vertex is."""
    highest, best = -math.inf, -1
    for i in range(int(n_faces)):
        height = plane_height(faces, FACE * i, x, y, z)
        if height > highest:
            best, highest = i, height
    if highest <= 0.0:
        return best, highest
    for i in range(int(n_faces)):
        height = plane_height(faces, FACE * i, x, y, z)
        if height > 0.0 and past_face(faces, n_faces, FACE * i, height, x, y, z) <= 0.0:
            return i, height
    return -1, 0.0


@compiled
def _edge(edges: Floats, n_edges: float, x: float, y: float, z: float) -> tuple[int, float]:
    """Return the edge that is nearest to a point, and where on it the nearest point is [m].

    Next to a vertex the distances of its edges are the same to round-off: the one with the point inside is taken.
    """
    least, best, place, inside = math.inf, 0, 0.0, 0.0
    for i in range(int(n_edges)):
        e = EDGE * i
        wx, wy, wz = x - edges[e], y - edges[e + 1], z - edges[e + 2]
        along = min(max(wx * edges[e + 3] + wy * edges[e + 4] + wz * edges[e + 5], 0.0), edges[e + 6])
        wx, wy, wz = wx - along * edges[e + 3], wy - along * edges[e + 4], wz - along * edges[e + 5]
        square = wx * wx + wy * wy + wz * wz
        within = min(along, edges[e + 6] - along)
        if square < least * (1.0 - _SAME) or (square <= least * (1.0 + _SAME) and within > inside):
            least, best, place, inside = square, i, along, within
    return best, place


@compiled
def nearest_feature(
    n_faces: float, faces: Floats, n_edges: float, edges: Floats, ends: Floats, x: float, y: float, z: float
) -> Nearest:
    """Return what is nearest to the point (x, y, z) of the body frame; inside, the nearest face, the distance negative.

    A point on an edge has no direction from it; one across it is taken.
    """
    face, distance = _face(faces, n_faces, x, y, z)
    if face >= 0:
        f = FACE * face
        return face, distance, faces[f], faces[f + 1], faces[f + 2], math.inf
    edge, along = _edge(edges, n_edges, x, y, z)
    e = EDGE * edge
    nx = x - edges[e] - along * edges[e + 3]
    ny = y - edges[e + 1] - along * edges[e + 4]
    nz = z - edges[e + 2] - along * edges[e + 5]
    distance = math.sqrt(nx * nx + ny * ny + nz * nz)
    if distance > 0.0:
        nx, ny, nz = nx / distance, ny / distance, nz / distance
    else:
        nx, ny, nz = tangent_of(edges[e + 3], edges[e + 4], edges[e + 5])
    within = min(along, edges[e + 6] - along)
    if within > 0.0:
        return int(n_faces) + edge, distance, nx, ny, nz, within
    number = int(n_faces) + int(n_edges) + int(ends[2 * edge] if along == 0.0 else ends[2 * edge + 1])
    return number, distance, nx, ny, nz, 0.0
