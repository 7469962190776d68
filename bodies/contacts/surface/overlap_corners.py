"""Selects the contacts of two rounded bodies whose faces are pressed flush into each other, as on springs.

Two flush faces overlap in an area.  Its corners are vertices of one body over the face of the other, and crossings of
edges.  Each corner must be exactly one contact, also while the bodies tilt or shift: otherwise the force of a spring
jumps.  The pairs of nearest features do not have this property.  So all vertices and crossings are projected along one
common direction, and the projected outlines of the two faces are compared:

1. The direction is the normal of a face of the first body.  With a separate normal for each feature, a tilt would move
   the projections by the tilt times the distance of the cores.  A corner could then become two contacts or none.
2. The outline of the first body is enlarged by a margin.  Two outlines that are equal within round-off then have the
   vertices of the second body as corners.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, dot, minus, opposite, plus_scaled, scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN, Crossing
from ..features.edge_row import LENGTH
from ..features.ends import CLOSED
from ..features.frames import point_in_body, point_in_world, vector_in_body, vector_in_world
from .surface_search import FAR, distance_from_ends, face_at, face_height, nearest_in_patch
from .surface_tables import IS_CONVEX, N_FACES, SWEEP

_COSINE = math.sqrt(1.0 - CONE_MARGIN * CONE_MARGIN)
"""Cosine of the largest angle between a contact normal and the normal of a face next to it."""
FLUSH = 0.02
"""Sine of the largest angle between two faces that are next to each other.

Springs have depths of a hundredth of the size. At a larger angle faces overlap along an edge only.
"""
_FLUSH_COSINE = math.sqrt(1.0 - FLUSH * FLUSH)
"""Cosine of the angle ``FLUSH``."""


@compiled
def _nearest_normal(surface: Floats, n: Vector3) -> tuple[int, float]:
    """Return the row of the face whose normal is nearest to a unit vector, and the cosine of the angle between them.

    The unit vector n is in the axes of the surface.  The cosine is -1 if the surface has no faces or is not convex.
    """
    nearest, largest = face_at(surface, 0), -1.0
    for i in range(int(surface[N_FACES] * surface[IS_CONVEX])):
        row = face_at(surface, i)
        cosine = dot(n, vector_at(surface, row))
        if cosine > largest:
            nearest, largest = row, cosine
    return nearest, largest


@compiled
def _normal_near(frame: Floats, surface: Floats, n: Vector3) -> Vector3:
    """Return the normal of the face that is nearest to a unit vector; zero if the angle between them is too large.

    Both vectors are in world axes.  The largest angle has the cosine ``_COSINE``.
    """
    row, cosine = _nearest_normal(surface, vector_in_body(frame, n))
    if cosine < _COSINE:
        return 0.0, 0.0, 0.0
    return vector_in_world(frame, vector_at(surface, row))


@compiled
def common_direction(a: Floats, b: Floats, surface_a: Floats, surface_b: Floats, n: Vector3) -> Vector3:
    """Return the common direction of projection, a unit vector from the first body to the second.

    It is the outward normal of the face of the first body that is nearest to the contact normal n, which points from
    the first body to the second, in world axes.  It is zero if the faces of the two bodies that are nearest to n do not
    face each other, if a body has no faces, or if it is not convex.
    """
    u, v = _normal_near(a, surface_a, n), _normal_near(b, surface_b, opposite(n))
    return u if dot(u, v) <= -_FLUSH_COSINE else (0.0, 0.0, 0.0)


@compiled
def _past_face(surface: Floats, row: int, height: float, point: Vector3) -> float:
    """Return the distance of a point's projection on a face of a convex surface past the face's borders [m].

    It is the largest height of the projection over the planes of the other faces, negative inside.  The row of the face
    begins at index ``row``; ``height`` is the height of the point over it [m], ``point`` is in the axes of the surface.
    """
    foot, past = minus(point, scaled(height, vector_at(surface, row))), -math.inf
    for i in range(int(surface[N_FACES])):
        if face_at(surface, i) != row:
            past = max(past, face_height(surface, face_at(surface, i), foot))
    return past


@compiled
def part_of_overlap(depth: float, size: float) -> float:
    """Return the weight of the corner test, from 0 at zero depth to 1 at the depth ``CLOSED`` times the size.

    Without an overlap, as between rigid bodies, the nearest features touch.  The weight is continuous in the ``depth``
    [m], so that the distance past the end of a feature is continuous and its root can be located.
    """
    return min(max(depth / (CLOSED * size), 0.0), 1.0)


@compiled
def vertex_past_corner(
    own: Floats,
    other: Floats,
    is_of_first: bool,
    direction: Vector3,
    surface: Floats,
    n_star: float,
    star: Floats,
    point: Vector3,
    size: float,
    is_sharp: bool,
) -> tuple[float, float]:
    """Return the distance by which a vertex misses a corner of the overlap [m]; zero or negative for a corner.

    The vertex is a corner if its projection lies on the face of the other body.  If its projection lies outside of the
    face, a rounded vertex is a corner if none of its edges leads towards the face: the bodies then touch with two
    edges.  The second result is the distance [m] of the projected vertex from the nearer end of the nearest edge,
    infinite on the face.

    Parameters
    ----------
    own, other : Floats
        Frame blocks of the body with the vertex and of the other body.
    is_of_first : bool
        Whether the vertex belongs to the first body.
    direction : tuple of float
        Common direction from the other body to the body with the vertex, in world axes.
    surface : Floats
        Surface of the other body (:mod:`bodies.contacts.surface.surface_tables`).
    n_star, star : float and Floats
        Unit vectors along the edges of the vertex, in the axes of its body.
    point : Vector3
        The vertex in the frame of the other body [m].
    size : float
        Size of the larger body [m].
    is_sharp : bool
        Whether both bodies are sharp.
    """
    margin, past = CLOSED * size, math.inf
    u = vector_in_body(other, direction)
    normal = u
    row, cosine = _nearest_normal(surface, u)
    if cosine >= _COSINE:
        normal = vector_at(surface, row)
        height = face_height(surface, row, point)
        # move the vertex parallel to the face, so that its foot point becomes its projection along the direction
        point = plus_scaled(point, height, minus(normal, divided(u, cosine)))
        past = _past_face(surface, row, height, point)
    # the outline of the first body is enlarged: its vertices are corners only if they are inside by the margin
    border = -margin if is_of_first else margin
    if past <= margin or is_sharp:
        return past - border, math.inf
    found = nearest_in_patch(surface, 0.0, point, FAR)
    _, _, _, _, x, y, z = found
    # from the nearest point to the vertex, and its part in the plane of the face
    way = minus(point, (x, y, z))
    way = vector_in_body(own, vector_in_world(other, minus(way, scaled(dot(way, normal), normal))))
    towards = -size
    for i in range(int(n_star)):
        towards = max(towards, -dot(way, vector_at(star, 3 * i)))
    return min(towards, past) - margin, distance_from_ends(surface, found)


@compiled
def corner_of_overlap(
    a: Floats,
    b: Floats,
    swap: float,
    surface: Floats,
    own: Floats,
    place: Vector3,
    n_star: float,
    star: Floats,
    n: Vector3,
    size: float,
) -> tuple[bool, float, float]:
    """Return whether two bodies overlap with flush faces, and by how much a vertex misses a corner of their overlap.

    The last two numbers are those of :func:`vertex_past_corner` [m].  The vertex at ``place`` belongs to the body with
    the surface ``own``, the first one if ``swap`` is 1; ``surface`` is that of the other body.  The contact normal n
    points from the first body to the second, in world axes.
    """
    own_frame, other = (a, b) if swap == 1.0 else (b, a)
    first, second = (own, surface) if swap == 1.0 else (surface, own)
    u = common_direction(a, b, first, second, n)
    if dot(u, u) == 0.0:
        return False, 0.0, math.inf
    point = point_in_body(other, point_in_world(own_frame, place))
    # from the other body to that of the vertex
    u = scaled(1.0 - 2.0 * swap, u)
    is_sharp = surface[SWEEP] + own[SWEEP] == 0.0
    past, within = vertex_past_corner(own_frame, other, swap == 1.0, u, surface, n_star, star, point, size, is_sharp)
    return True, past, within


@compiled
def crossing_past_corner(
    a: Floats,
    b: Floats,
    direction: Vector3,
    edges_a: Floats,
    at_a: int,
    edges_b: Floats,
    at_b: int,
    crossing: Crossing,
    size: float,
) -> float:
    """Return the distance by which two edges miss a corner of the overlap [m]; zero or negative for a corner.

    They form a corner if their projections along the common direction cross within both edges.

    Parameters
    ----------
    a, b : Floats
        Frame blocks of the two bodies.
    direction : tuple of float
        Common direction from the first body to the second, in world axes.
    edges_a, at_a, edges_b, at_b : Floats and int
        Tables with the two edges, and the indices at which their rows begin.
    crossing : tuple
        The crossing of the two edges (:func:`bodies.contacts.features.edge_crossing.cross_edges`).
    size : float
        Size of the larger body [m].
    """
    p, e, f, n, gap, _, _ = crossing
    start_a, start_b = point_in_world(a, vector_at(edges_a, at_a)), point_in_world(b, vector_at(edges_b, at_b))
    sine = dot(direction, cross(e, f))
    margin = CLOSED * size
    # the projections of both edges are parallel
    if sine == 0.0:
        return size
    # the nearest points differ by gap n; the points whose projections coincide differ along the direction only
    s = dot(minus(p, start_a), e) + gap * dot(direction, cross(n, f)) / sine
    t = dot(minus(plus_scaled(p, gap, n), start_b), f) + gap * dot(direction, cross(n, e)) / sine
    past_a, past_b = max(-s, s - edges_a[at_a + LENGTH]), max(-t, t - edges_b[at_b + LENGTH])
    # times the sine, a length along one edge becomes a distance from the line of the other edge
    return float(max(past_a * abs(sine) - margin, past_b * abs(sine) + margin))
