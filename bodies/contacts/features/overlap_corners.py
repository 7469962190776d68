"""Which features of two rounded bodies touch if they overlap with faces next to each other, as on springs.

Two faces next to each other touch over the overlap of their outlines. Its corners are vertices of one body over the
face of the other, and edges that cross. Each corner must be one contact, and it must stay one when the bodies tilt or
shift. Otherwise the force of a spring jumps. The nearest features do not have this property. So vertices and crossings
are all projected along one direction, and one outline is slightly larger than given:

1. The direction is the normal of a face of the first body. If each feature were projected along a normal of its own, a
   tilt by an angle would move the projections by this angle times the distance of the cores. A corner would then be two
   contacts, or none.
2. The outline of the first body is larger by a margin. So outlines that are equal, but for round-off, have the vertices
   of the second body as corners.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...blocks import Vector3
from .edge_crossing import ASTRAY
from .frames import point_in_world, vector_in_body, vector_in_world
from .polytope_tables import FACE, LENGTH
from .vertex_face import CLOSED, nearest_feature, past_face, plane_height

_COSINE = math.sqrt(1.0 - ASTRAY * ASTRAY)
"""Cosine of the largest angle between the normals of a contact and a face at which the face is next to the contact."""


@compiled
def _nearest_normal(n_faces: float, faces: Floats, x: float, y: float, z: float) -> tuple[int, float]:
    """Return the face whose normal is nearest to the unit vector (x, y, z) of the body frame, and the cosine."""
    found, most = 0, -1.0
    for i in range(int(n_faces)):
        f = FACE * i
        cosine = x * faces[f] + y * faces[f + 1] + z * faces[f + 2]
        if cosine > most:
            found, most = i, cosine
    return found, most


@compiled
def _normal_near(frame: Floats, n_faces: float, faces: Floats, x: float, y: float, z: float) -> Vector3:
    """Return the normal of a face next to the unit vector (x, y, z), in world axes; zero if none is."""
    x, y, z = vector_in_body(frame, x, y, z)
    face, cosine = _nearest_normal(n_faces, faces, x, y, z)
    if cosine < _COSINE:
        return 0.0, 0.0, 0.0
    f = FACE * face
    x, y, z = vector_in_world(frame, faces[f], faces[f + 1], faces[f + 2])
    return x, y, z


@compiled
def common_direction(
    a: Floats,
    b: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    x: float,
    y: float,
    z: float,
) -> Vector3:
    """Return the direction of projection next to a contact normal (x, y, z) from the first to the second body.

    Both are in world axes.  The direction is the normal of a face of the first body, or of the second one if the first
    has no faces.  It is zero if no face is next to the contact.
    """
    if n_faces_a > 0.0:
        x, y, z = _normal_near(a, n_faces_a, faces_a, x, y, z)
        return x, y, z
    x, y, z = _normal_near(b, n_faces_b, faces_b, -x, -y, -z)
    return -x, -y, -z


@compiled
def part_of_overlap(depth: float, size: float) -> float:
    """Return by which part the corners of the overlap decide, from 0 without a depth [m] to 1 at the margin.

    Rigid bodies touch with their nearest features.  The part is continuous, so that the ends of features have roots.
    """
    return min(max(depth / (CLOSED * size), 0.0), 1.0)


@compiled
def vertex_past_corner(
    own: Floats,
    other: Floats,
    is_of_first: bool,
    direction: Vector3,
    n_faces: float,
    faces: Floats,
    n_edges: float,
    edges: Floats,
    ends: Floats,
    n_star: float,
    star: Floats,
    x: float,
    y: float,
    z: float,
    size: float,
) -> tuple[float, float]:
    """Return how far a vertex is from being a corner of the overlap [m], not positive if it is one.

    The second result is the distance of the projected vertex from the nearer end of the nearest edge, as in
    :data:`bodies.contacts.features.vertex_face.Nearest`.  The vertex (x, y, z), in the frame ``other``, is a corner if
    it is projected on the face of the other body.  If it is projected beside the face, it is a corner if none of its
    edges leads towards the face: the bodies then touch with two edges.

    Parameters
    ----------
    own, other : Floats
        Frame blocks of the vertex's body and of the other body.
    is_of_first : bool
        Whether the vertex belongs to the first body.
    direction : tuple of float
        Common direction, in the world, from the other body to the vertex's body.
    n_faces, faces, n_edges, edges, ends : float and Floats
        Core of the other body.
    n_star, star : float and Floats
        Unit vectors along the edges of the vertex, in the frame ``own``.
    size : float
        Size of the bodies [m].
    """
    margin, past = CLOSED * size, math.inf
    ux, uy, uz = vector_in_body(other, *direction)
    fx, fy, fz = ux, uy, uz
    face, cosine = _nearest_normal(n_faces, faces, ux, uy, uz)
    if cosine >= _COSINE:
        f = FACE * face
        fx, fy, fz = faces[f], faces[f + 1], faces[f + 2]
        height = plane_height(faces, f, x, y, z)
        # where the projection along the direction meets the plane of the face, at the same height
        x, y, z = x + height * (fx - ux / cosine), y + height * (fy - uy / cosine), z + height * (fz - uz / cosine)
        past = past_face(faces, n_faces, f, height, x, y, z)
    edge = -margin if is_of_first else margin
    if past <= edge:
        return past - edge, math.inf
    if past <= margin:
        return past + margin, math.inf
    _, distance, nx, ny, nz, within = nearest_feature(n_faces, faces, n_edges, edges, ends, x, y, z)
    along = nx * fx + ny * fy + nz * fz
    nx, ny, nz = vector_in_world(other, nx - along * fx, ny - along * fy, nz - along * fz)
    nx, ny, nz = vector_in_body(own, nx, ny, nz)
    leads = -size
    for i in range(int(n_star)):
        leads = max(leads, -distance * (nx * star[3 * i] + ny * star[3 * i + 1] + nz * star[3 * i + 2]))
    return min(leads, past) - margin, within


@compiled
def _triple(u: Vector3, v: Vector3, w: Vector3) -> float:
    """Return the scalar triple product u . (v x w)."""
    x, y, z = v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]
    return float(u[0] * x + u[1] * y + u[2] * z)


@compiled
def crossing_past_corner(
    a: Floats,
    b: Floats,
    direction: Vector3,
    edges_a: Floats,
    at_a: int,
    edges_b: Floats,
    at_b: int,
    p: Vector3,
    e: Vector3,
    f: Vector3,
    n: Vector3,
    gap: float,
    size: float,
) -> float:
    """Return how far two edges are from crossing at a corner of the overlap [m], not positive if they do.

    ``p`` is the nearest point of the first edge, ``e`` and ``f`` are the unit vectors along both, ``n`` and ``gap`` the
    normal and the gap of the cores along it.  The rows of the edges begin at ``at_a`` and ``at_b``.
    """
    ax, ay, az = point_in_world(a, edges_a[at_a], edges_a[at_a + 1], edges_a[at_a + 2])
    bx, by, bz = point_in_world(b, edges_b[at_b], edges_b[at_b + 1], edges_b[at_b + 2])
    sine = _triple(direction, e, f)
    margin = CLOSED * size
    if sine == 0.0:
        return size
    # the points are gap n apart; where the projections cross, they are apart along the direction only
    s = (p[0] - ax) * e[0] + (p[1] - ay) * e[1] + (p[2] - az) * e[2] + gap * _triple(direction, n, f) / sine
    x, y, z = p[0] + gap * n[0] - bx, p[1] + gap * n[1] - by, p[2] + gap * n[2] - bz
    t = x * f[0] + y * f[1] + z * f[2] + gap * _triple(direction, n, e) / sine
    over_a, over_b = max(-s, s - edges_a[at_a + LENGTH]), max(-t, t - edges_b[at_b + LENGTH])
    return float(max(over_a * abs(sine) - margin, over_b * abs(sine) + margin))
