"""Finds the face of a polyhedron that a vertex of another body touches, and the feature nearest to a point."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import POSITION
from nonsmooth.types import Floats

from ...vectors import vector_at
from .frames import point_in_body, point_in_world, tangent_of, vector_in_body, vector_in_world
from .polytope_tables import EDGE, FACE

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
def _normal_in(frame: Floats, other: Floats, faces: Floats, face: int) -> tuple[float, float, float]:
    """Return the normal of a face in the axes of the other body."""
    x, y, z = vector_in_world(frame, vector_at(faces, face))
    x, y, z = vector_in_body(other, (x, y, z))
    return x, y, z


@compiled
def plane_height(faces: Floats, face: int, x: float, y: float, z: float) -> float:
    """Return the height of a point (x, y, z) over the plane of a face [m], in the frame of the face's body."""
    return faces[face] * x + faces[face + 1] * y + faces[face + 2] * z - faces[face + 3]


@compiled
def _least(
    frame: Floats, other: Floats, faces: Floats, face: int, n_vertices: float, vertices: Floats, enough: float
) -> float:
    """Return the least height of the other body's vertices over a face [m]; stop at a height below ``enough``."""
    nx, ny, nz = _normal_in(frame, other, faces, face)
    x, y, z = point_in_body(frame, (other[POSITION], other[POSITION + 1], other[POSITION + 2]))
    base, least = plane_height(faces, face, x, y, z), math.inf
    for i in range(int(n_vertices)):
        height = base + nx * vertices[3 * i] + ny * vertices[3 * i + 1] + nz * vertices[3 * i + 2]
        if height < least:
            least = height
            if least < enough:
                break
    return least


@compiled
def separation_of_faces(
    frame: Floats, other: Floats, n_faces: float, faces: Floats, n_vertices: float, vertices: Floats
) -> float:
    """Return the largest separation of two bodies along the normals of the first body's faces [m].

    It is negative if none of the planes of the faces separates the bodies.
    """
    best = -math.inf
    for i in range(int(n_faces)):
        best = max(best, _least(frame, other, faces, FACE * i, n_vertices, vertices, best))
    return best


@compiled
def past_face(faces: Floats, n_faces: float, face: int, height: float, x: float, y: float, z: float) -> float:
    """Return the distance of a point's projection on a face beyond the face's borders [m]; negative inside them.

    It is the largest height of the projection over the planes of the other faces.
    """
    x, y, z = x - height * faces[face], y - height * faces[face + 1], z - height * faces[face + 2]
    past = -math.inf
    for i in range(int(n_faces)):
        if FACE * i != face:
            past = max(past, plane_height(faces, FACE * i, x, y, z))
    return past


@compiled
def height_over(frame: Floats, n_faces: float, faces: Floats, x: float, y: float, z: float) -> float:
    """Return the largest height of a world point over the planes of the faces [m]: negative inside the polyhedron."""
    x, y, z = point_in_body(frame, (x, y, z))
    highest = -math.inf
    for i in range(int(n_faces)):
        highest = max(highest, plane_height(faces, FACE * i, x, y, z))
    return highest


@compiled
def nearest_face(
    frame: Floats,
    other: Floats,
    n_faces: float,
    faces: Floats,
    n_vertices: float,
    vertices: Floats,
    vertex: float,
    n_faces_other: float,
    faces_other: Floats,
    n_vertices_own: float,
    vertices_own: Floats,
    size: float,
) -> tuple[float, float, float]:
    """Return face paired with a vertex of the body ``other``, gap, and distance past the face's border [m].

    The face belongs to the polyhedron in ``frame``.  It is the face over which the least height of all vertices is the
    largest, so that all vertices get the same face.  If several faces are equal in this, as in contact at an edge, the
    vertex gets the face on which it projects.  If it projects on several faces, it gets the face over which it is
    highest.  A vertex below its face does not touch it if a face of its own body separates the bodies better.  Past the
    border of its face, a gap that is not negative becomes hypot(gap, past); a negative gap is kept.
    """
    v = 3 * int(vertex)
    px, py, pz = point_in_world(other, vector_at(vertices, v))
    x, y, z = point_in_body(frame, (px, py, pz))
    # a point by itself has no edges beside it
    margin = (CLOSED if n_vertices > 1.0 else REACH) * size
    enough = separation_of_faces(frame, other, n_faces, faces, n_vertices, vertices) - margin
    highest = -math.inf
    for i in range(int(n_faces)):
        highest = max(highest, plane_height(faces, FACE * i, x, y, z))
    found, gap, past = 0, 0.0, math.inf
    for i in range(int(n_faces)):
        height = plane_height(faces, FACE * i, x, y, z)
        if height < enough or _least(frame, other, faces, FACE * i, n_vertices, vertices, enough) < enough:
            continue
        beyond = past_face(faces, n_faces, FACE * i, height, x, y, z)
        if height < 0.0:
            # a vertex below the plane of a face touches it from inside of the polyhedron only
            beyond = max(beyond, highest)
        beyond -= margin
        if height > gap if max(past, beyond) <= 0.0 else beyond < past:
            found, gap, past = i, height, beyond
    if past <= 0.0 and gap < -margin:
        best = separation_of_faces(other, frame, n_faces_other, faces_other, n_vertices_own, vertices_own)
        past = max(past, best - gap - margin)
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
def _face(faces: Floats, n_faces: float, x: float, y: float, z: float) -> tuple[int, float]:
    """Return the face nearest to a point and the point's height over it [m]; -1 if an edge or a vertex is nearest."""
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
    """Return the edge nearest to a point, and the distance of the nearest point from the start of the edge [m].

    Near a vertex, the distances of several edges may be equal within round-off.  Then the edge is taken whose nearest
    point is farthest from its ends.
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
    """Return the feature nearest to the point (x, y, z) of the body frame.

    For a point inside, this is the nearest face, with a negative distance.  The direction from an edge to a point on
    it is undefined; a unit vector perpendicular to the edge is returned.
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
        nx, ny, nz = tangent_of(vector_at(edges, e + 3))
    within = min(along, edges[e + 6] - along)
    if within > 0.0:
        return int(n_faces) + edge, distance, nx, ny, nz, within
    number = int(n_faces) + int(n_edges) + int(ends[2 * edge] if along == 0.0 else ends[2 * edge + 1])
    return number, distance, nx, ny, nz, 0.0
