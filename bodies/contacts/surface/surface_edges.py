"""Contact of convex edges of two bodies that cross each other, sharp or rounded; the bodies need not be convex."""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B, TANGENT
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, dot, norm, plus_scaled, vector_at, write_vector
from ..features.edge_crossing import CONE_MARGIN, Crossing, cross_edges, least_round_sine, least_sine, sine_off_cones
from ..features.edge_vertex import ALONG, INTO_FIRST, LENGTH, START, Edge, Vertex
from ..features.ends import CLOSED, END, gap_past_end
from ..features.frames import point_in_body, point_seen_from
from ..features.writing import write_principal
from .overlap_corners import common_direction, crossing_past_corner, part_of_overlap
from .surface_tables import EXTENSIONS, N_FACES, SWEEP, Solid, are_convex, edge_at
from .surface_vertex import past_depth, separation_of_faces

_FLUSH = 1e-5
"""Sine of the angle between the common normal of two edges and a face's normal, up to which they count as equal.

The face is adjacent to one of the edges.
"""


class _Edges(NamedTuple):
    """An edge of each body, with the bodies and their size."""

    first: Solid
    """The first body."""
    a: Edge
    """Its edge."""
    second: Solid
    """The second body."""
    b: Edge
    """Its edge."""
    size: float
    """Size of the larger body [m]."""


@compiled
def _past_surface(solid: Solid, edge: Edge, depth: float, point: Vector3) -> float:
    """Return how far an edge of the other body is from an overlap of a ``depth`` [m] with a solid [m].

    See :func:`bodies.contacts.surface.surface_vertex.past_depth`.  ``point`` is the nearest point of the edge in the
    world [m].  A segment has no inside: the result is negative.
    """
    if solid.surface[N_FACES] == 0.0:
        return -depth
    frame, row = solid.frame, edge.row
    start, along = vector_at(row, START), vector_at(row, ALONG)
    first = point_seen_from(frame, edge.frame, plus_scaled(start, -row[EXTENSIONS], along))
    second = point_seen_from(frame, edge.frame, plus_scaled(start, row[LENGTH] + row[EXTENSIONS + 1], along))
    into_faces = Vertex(start, 2.0, block_at(row, INTO_FIRST))
    return past_depth(solid, edge.frame, into_faces, (first, second), depth, point_in_body(frame, point))


@compiled
def _separation(edges: _Edges) -> float:
    """Return the largest separation of two convex bodies along the normals of their faces [m]."""
    first, second = edges.first, edges.second
    return max(separation_of_faces(first, second), separation_of_faces(second, first))


@compiled
def _past_overlap(edges: _Edges, crossing: Crossing) -> float:
    """Return how far two edges whose cores overlap are from touching [m]; negative if their contact is valid.

    The bodies separate on the shortest way.  Convex bodies do so along the direction of the largest separation: no
    plane of a face may separate them better than the common normal of the edges.  Of others only the faces next to the
    edges are known: either edge must be below them as deep as the overlap.
    """
    p, n, gap = crossing.point, crossing.normal, crossing.gap
    if are_convex(edges.first, edges.second):
        return _separation(edges) - gap - CLOSED * edges.size
    past = _past_surface(edges.second, edges.a, -gap, p)
    return max(past, _past_surface(edges.first, edges.b, -gap, plus_scaled(p, gap, n)))


@compiled
def _past_flush(edges: _Edges, crossing: Crossing) -> float:
    """Return a positive distance if two sharp edges lie flush in faces that touch, else a negative one [m].

    Then the vertices over the faces touch, and not the edges: each corner of the overlap has one contact.  Edges are
    flush if they are so nearly parallel that the ends of the shorter one are within the margin ``CLOSED`` of the other,
    and if a face separates the bodies as well as their common normal, which is normal to a face of an edge within
    ``_FLUSH``.  Of surfaces that are not convex this is not known.
    """
    a, b, margin = edges.a, edges.b, CLOSED * edges.size
    ends_apart = min(a.row[LENGTH], b.row[LENGTH]) * norm(cross(crossing.e, crossing.f))
    is_normal_of_face = sine_off_cones(a, b, crossing.normal) > -_FLUSH
    if not (are_convex(edges.first, edges.second) and ends_apart < margin and is_normal_of_face):
        return -margin
    return margin - ends_apart if _separation(edges) >= crossing.gap - margin else -margin


@compiled
def _past_ends(edges: _Edges, crossing: Crossing) -> float:
    """Return how far two edges that cross are past their ends [m]; negative if they may touch.

    Sharp edges touch up to a margin past their ends, rounded ones end before their corners.  Bodies on springs overlap:
    then the corners of the overlap touch.
    """
    first, second, size, gap = edges.first, edges.second, edges.size, crossing.gap
    radius = first.surface[SWEEP] + second.surface[SWEEP]
    past = crossing.past_ends + (END if radius > 0.0 else -CLOSED) * size
    fraction = part_of_overlap(radius - gap, size)
    # rounded edges whose cores overlap are as deep as sharp ones never are
    if fraction > 0.0 and (gap >= 0.0 or radius == 0.0):
        u = common_direction(first, second, crossing.normal)
        if dot(u, u) > 0.0:
            past_corner = crossing_past_corner(u, edges.a, edges.b, crossing, size)
            # a tilt moves the nearest points of nearly parallel edges far past the ends: farther than the margin and a
            # quarter of the gap of the lines, the contact ends
            past_limit = crossing.past_ends - CLOSED * size - CONE_MARGIN * abs(gap)
            past = (1.0 - fraction) * past + fraction * max(past_corner, past_limit)
    if past <= 0.0 and radius == 0.0:
        past = max(past, _past_flush(edges, crossing))
    return past


@compiled
def write_edges(out: Floats, first: Solid, i: int, second: Solid, j: int, size: float) -> None:
    """Write the geometry block of edge ``i`` of the first body and edge ``j`` of the second one.

    The contact points are the nearest points of the lines of the edges.  Edges whose cores overlap touch only if no
    face of the other body is less deep below either edge: else that face is the contact.  ``size`` is the size of the
    larger body [m].
    """
    radius_a, radius_b = first.surface[SWEEP], second.surface[SWEEP]
    a, b = Edge(first.frame, edge_at(first.surface, i)), Edge(second.frame, edge_at(second.surface, j))
    edges, radius = _Edges(first, a, second, b, size), radius_a + radius_b
    crossing = cross_edges(a, b, least_sine(size) if radius == 0.0 else least_round_sine(radius, size), size)
    p, e, f, n, gap, _, past = crossing
    if past <= 0.0:
        past = _past_ends(edges, crossing)
    if past <= 0.0 and gap < 0.0:
        past = max(past, _past_overlap(edges, crossing))
    gap = gap_past_end(gap - radius, past, are_convex(first, second))
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    write_vector(out, NORMAL, n)
    write_vector(out, POINT_A, plus_scaled(p, radius_a, n))
    write_vector(out, POINT_B, plus_scaled(p, radius_a + gap, n))
    # the edge is the tangent: it is fixed to a body.  If both edges lie in a face, round-off turns the normal, and a
    # tangent that is computed from the normal would turn with it
    write_vector(out, TANGENT, e)
    write_principal(out, SIDE_A, e, 0.0, 1.0, 1.0, radius_a)
    write_principal(out, SIDE_B, f, 0.0, 1.0, 1.0, radius_b)
