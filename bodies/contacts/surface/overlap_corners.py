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
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, dot, minus, opposite, plus_scaled, scaled
from ..features.edge_crossing import CONE_MARGIN, Crossing
from ..features.edge_vertex import LENGTH, Edge, Vertex, start_of, steepest
from ..features.ends import CLOSED
from ..features.frames import point_seen_from, vector_in_body, vector_in_world, vector_seen_from
from .surface_search import FAR, distance_from_ends, nearest_in_patch
from .surface_tables import IS_CONVEX, N_FACES, SWEEP, Solid, face_height, normal_of

_COSINE = math.sqrt(1.0 - CONE_MARGIN * CONE_MARGIN)
"""Cosine of the largest angle between a contact normal and the normal of a face next to it."""
FLUSH = 0.02
"""Sine of the largest angle between two faces that are next to each other.

Springs have depths of a hundredth of the size. At a larger angle faces overlap along an edge only.
"""
_FLUSH_COSINE = math.sqrt(1.0 - FLUSH * FLUSH)
"""Cosine of the angle ``FLUSH``."""


class Over(NamedTuple):
    """A corner of one body over a patch of the surface of the other one."""

    solid: Solid
    """The body with the patch."""
    patch: float
    """Number of the patch."""
    other: Solid
    """The body with the corner."""
    vertex: Vertex
    """The corner, in the axes of its body."""
    is_first: bool
    """Whether the corner belongs to the first body."""
    size: float
    """Size of the larger body [m]."""


@compiled
def _nearest_normal(surface: Floats, n: Vector3) -> tuple[int, float]:
    """Return the face whose normal is nearest to a unit vector, and the cosine of the angle between them.

    The unit vector n is in the axes of the surface.  The cosine is -1 if the surface has no faces or is not convex.
    """
    nearest, largest = 0, -1.0
    for face in range(int(surface[N_FACES] * surface[IS_CONVEX])):
        cosine = dot(n, normal_of(surface, face))
        if cosine > largest:
            nearest, largest = face, cosine
    return nearest, largest


@compiled
def _normal_near(solid: Solid, n: Vector3) -> Vector3:
    """Return the normal of the face that is nearest to a unit vector; zero if the angle between them is too large.

    Both vectors are in world axes.  The largest angle has the cosine ``_COSINE``.
    """
    face, cosine = _nearest_normal(solid.surface, vector_in_body(solid.frame, n))
    if cosine < _COSINE:
        return 0.0, 0.0, 0.0
    return vector_in_world(solid.frame, normal_of(solid.surface, face))


@compiled
def common_direction(first: Solid, second: Solid, n: Vector3) -> Vector3:
    """Return the common direction of projection, a unit vector from the first body to the second.

    It is the outward normal of the face of the first body that is nearest to the contact normal n, which points from
    the first body to the second, in world axes.  It is zero if the faces of the two bodies that are nearest to n do not
    face each other, if a body has no faces, or if it is not convex.
    """
    u, v = _normal_near(first, n), _normal_near(second, opposite(n))
    return u if dot(u, v) <= -_FLUSH_COSINE else (0.0, 0.0, 0.0)


@compiled
def _past_face(surface: Floats, face: int, height: float, point: Vector3) -> float:
    """Return the distance of a point's projection on a face of a convex surface past the face's borders [m].

    It is the largest height of the projection over the planes of the other faces, negative inside.  ``height`` is the
    height of the point over the face [m], ``point`` is in the axes of the surface.
    """
    foot, past = plus_scaled(point, -height, normal_of(surface, face)), -math.inf
    for i in range(int(surface[N_FACES])):
        if i != face:
            past = max(past, face_height(surface, i, foot))
    return past


@compiled
def part_of_overlap(depth: float, size: float) -> float:
    """Return the weight of the corner test, from 0 at zero depth to 1 at the depth ``CLOSED`` times the size.

    Without an overlap, as between rigid bodies, the nearest features touch.  The weight is continuous in the ``depth``
    [m], so that the distance past the end of a feature is continuous and its root can be located.
    """
    return min(max(depth / (CLOSED * size), 0.0), 1.0)


@compiled
def _past_corner(over: Over, direction: Vector3) -> tuple[float, float]:
    """Return the distance by which a vertex misses a corner of the overlap [m]; zero or negative for a corner.

    The vertex is a corner if its projection lies on the face of the other body.  If its projection lies outside of the
    face, a rounded vertex is a corner if none of its edges leads towards the face: the bodies then touch with two
    edges.  The second result is the distance [m] of the projected vertex from the nearer end of the nearest edge,
    infinite on the face.

    ``direction`` is the common direction, from the body with the patch to that with the vertex, in world axes.
    """
    solid, other, surface = over.solid, over.other, over.solid.surface
    margin, past, point = CLOSED * over.size, math.inf, point_seen_from(solid.frame, other.frame, over.vertex.place)
    u = vector_in_body(solid.frame, direction)
    normal = u
    face, cosine = _nearest_normal(surface, u)
    if cosine >= _COSINE:
        normal = normal_of(surface, face)
        height = face_height(surface, face, point)
        # move the vertex parallel to the face, so that its foot point becomes its projection along the direction
        point = plus_scaled(point, height, minus(normal, divided(u, cosine)))
        past = _past_face(surface, face, height, point)
    # the outline of the first body is enlarged: its vertices are corners only if they are inside by the margin
    border = -margin if over.is_first else margin
    if past <= margin or surface[SWEEP] + other.surface[SWEEP] == 0.0:
        return past - border, math.inf
    found = nearest_in_patch(surface, 0.0, point, FAR)
    # from the nearest point to the vertex, and its part in the plane of the face
    way = minus(point, found.nearest)
    way = vector_seen_from(other.frame, solid.frame, minus(way, scaled(dot(way, normal), normal)))
    towards = max(-over.size, steepest(over.vertex, opposite(way)))
    return min(towards, past) - margin, distance_from_ends(surface, found)


@compiled
def corner_of_overlap(over: Over, n: Vector3) -> tuple[bool, float, float]:
    """Return whether two bodies overlap with flush faces, and by how much a vertex misses a corner of their overlap.

    The last two numbers are the distance by which the vertex misses the corner [m], not positive for a corner, and the
    distance of its projection from the nearer end of the nearest edge [m].  n is the contact normal out of the body
    with the patch, in world axes.
    """
    if over.is_first:
        u = opposite(common_direction(over.other, over.solid, opposite(n)))
    else:
        u = common_direction(over.solid, over.other, n)
    if dot(u, u) == 0.0:
        return False, 0.0, math.inf
    past, within = _past_corner(over, u)
    return True, past, within


@compiled
def crossing_past_corner(direction: Vector3, a: Edge, b: Edge, crossing: Crossing, size: float) -> float:
    """Return the distance by which two edges miss a corner of the overlap [m]; zero or negative for a corner.

    They form a corner if their projections along the common ``direction`` [world axes] cross within both edges.
    ``size`` is the size of the larger body [m].
    """
    p, e, f, n, gap, _, _ = crossing
    sine, margin = dot(direction, cross(e, f)), CLOSED * size
    # the projections of both edges are parallel
    if sine == 0.0:
        return size
    # the nearest points differ by gap n; the points whose projections coincide differ along the direction only
    s = dot(minus(p, start_of(a)), e) + gap * dot(direction, cross(n, f)) / sine
    t = dot(minus(plus_scaled(p, gap, n), start_of(b)), f) + gap * dot(direction, cross(n, e)) / sine
    past_a, past_b = max(-s, s - a.row[LENGTH]), max(-t, t - b.row[LENGTH])
    # times the sine, a length along one edge becomes a distance from the line of the other edge
    return float(max(past_a * abs(sine) - margin, past_b * abs(sine) + margin))
