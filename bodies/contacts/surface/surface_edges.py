"""Contact of convex edges of two bodies that cross each other, sharp or rounded; the bodies need not be convex."""

from __future__ import annotations

from typing import TypeAlias

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B, TANGENT
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, dot, norm, plus_scaled, vector_at, write_vector
from ..features.edge_crossing import CONE_MARGIN, Crossing, cross_edges, least_round_sine, least_sine, sine_off_cone
from ..features.edge_row import ALONG, INTO_FIRST, LENGTH
from ..features.ends import CLOSED, END, gap_past_end
from ..features.frames import point_in_body
from ..features.writing import write_principal
from .overlap_corners import common_direction, crossing_past_corner, part_of_overlap
from .surface_near import seen_from
from .surface_search import beyond_ends
from .surface_tables import IS_CONVEX, N_FACES, SWEEP
from .surface_vertex import past_depth, separation_of_faces

Edges: TypeAlias = tuple[Floats, int, Floats, int]
"""Surface of the first body and index of the row of its edge, then those of the second body."""
_FLUSH = 1e-5
"""Sine of the angle between the common normal of two edges and a face's normal, up to which they count as equal.

The face is adjacent to one of the edges.
"""


@compiled
def _past_surface(
    frame: Floats, other: Floats, surface: Floats, edges: Floats, row: int, depth: float, point: Vector3
) -> float:
    """Return how far an edge of the other body is from an overlap of this depth with a surface [m].

    See :func:`bodies.contacts.surface.surface_vertex.past_depth`.  A segment has no inside, and does not tell: the
    result is negative.

    Parameters
    ----------
    frame, other : Floats
        Frame blocks of the body with the surface, and of the body with the edge.
    surface, edges : Floats
        The surface, and that of the body with the edge.
    row : int
        Index at which the row of the edge begins.
    depth : float
        Depth of the overlap [m].
    point : Vector3
        Nearest point of the edge in the world [m].
    """
    if surface[N_FACES] == 0.0:
        return -depth
    start, along, length = vector_at(edges, row), vector_at(edges, row + ALONG), edges[row + LENGTH]
    before, behind = beyond_ends(edges, row)
    first, second = plus_scaled(start, -before, along), plus_scaled(start, length + behind, along)
    ends = seen_from(frame, other, first), seen_from(frame, other, second)
    into = block_at(edges, row + INTO_FIRST)
    return float(past_depth(frame, other, surface, 2.0, into, ends, depth, point_in_body(frame, point)))


@compiled
def _past_overlap(a: Floats, b: Floats, edges: Edges, crossing: Crossing, size: float) -> float:
    """Return how far two edges whose cores overlap are from touching [m]; negative if their contact is valid.

    The bodies separate on the shortest way.  Convex bodies do so along the direction of the largest separation: no
    plane of a face may separate them better than the common normal of the edges.  Of others only the faces next to the
    edges are known: either edge must be below them as deep as the overlap.
    """
    (p, _, _, n, gap, _, _), (surface_a, row_a, surface_b, row_b) = crossing, edges
    if surface_a[IS_CONVEX] * surface_b[IS_CONVEX] > 0.0:
        best = max(separation_of_faces(a, b, surface_a, surface_b), separation_of_faces(b, a, surface_b, surface_a))
        return float(best - gap - CLOSED * size)
    past = _past_surface(b, a, surface_b, surface_a, row_a, -gap, p)
    return max(past, _past_surface(a, b, surface_a, surface_b, row_b, -gap, plus_scaled(p, gap, n)))


@compiled
def _past_flush(a: Floats, b: Floats, edges: Edges, crossing: Crossing, size: float) -> float:
    """Return a positive distance if two sharp edges lie flush in faces that touch, else a negative one [m].

    Then the vertices over the faces touch, and not the edges: each corner of the overlap has one contact.  Edges are
    flush if they are so nearly parallel that the ends of the shorter one are within the margin ``CLOSED`` of the other,
    and if a face separates the bodies as well as their common normal, which is normal to a face of an edge within
    ``_FLUSH``.  Of surfaces that are not convex this is not known.
    """
    (_, e, f, n, gap, _, _), (surface_a, row_a, surface_b, row_b) = crossing, edges
    margin = CLOSED * size
    ends_apart = min(surface_a[row_a + LENGTH], surface_b[row_b + LENGTH]) * norm(cross(e, f))
    off_cone = max(sine_off_cone(a, surface_a, row_a, 1.0, n), sine_off_cone(b, surface_b, row_b, -1.0, n))
    are_convex = surface_a[IS_CONVEX] * surface_b[IS_CONVEX] > 0.0
    if not (are_convex and ends_apart < margin and off_cone > -_FLUSH):
        return -margin
    best = max(separation_of_faces(a, b, surface_a, surface_b), separation_of_faces(b, a, surface_b, surface_a))
    return margin - ends_apart if best >= gap - margin else -margin


@compiled
def _past_ends(a: Floats, b: Floats, edges: Edges, crossing: Crossing, size: float) -> float:
    """Return how far two edges that cross are past their ends [m]; negative if they may touch.

    Sharp edges touch up to a margin past their ends, rounded ones end before their corners.  Bodies on springs overlap:
    then the corners of the overlap touch.
    """
    (_, _, _, n, gap, past_ends, _), (surface_a, row_a, surface_b, row_b) = crossing, edges
    radius = surface_a[SWEEP] + surface_b[SWEEP]
    past = past_ends + (END if radius > 0.0 else -CLOSED) * size
    fraction = part_of_overlap(radius - gap, size)
    # rounded edges whose cores overlap are as deep as sharp ones never are
    if fraction > 0.0 and (gap >= 0.0 or radius == 0.0):
        u = common_direction(a, b, surface_a, surface_b, n)
        if dot(u, u) > 0.0:
            past_corner = crossing_past_corner(a, b, u, surface_a, row_a, surface_b, row_b, crossing, size)
            # a tilt moves the nearest points of nearly parallel edges far past the ends: farther than the margin and a
            # quarter of the gap of the lines, the contact ends
            past_limit = past_ends - CLOSED * size - CONE_MARGIN * abs(gap)
            past = (1.0 - fraction) * past + fraction * max(past_corner, past_limit)
    if past <= 0.0 and radius == 0.0:
        past = max(past, _past_flush(a, b, edges, crossing, size))
    return past


@compiled
def write_edges(
    a: Floats, b: Floats, out: Floats, surface_a: Floats, row_a: int, surface_b: Floats, row_b: int, size: float
) -> None:
    """Write the geometry block of two edges at the nearest points of their lines.

    Edges whose cores overlap touch only if no face of the other body is less deep below either edge: else that face is
    the contact.

    Parameters
    ----------
    a, b, out : Floats
        Frame blocks of both bodies, and the geometry block.
    surface_a, row_a, surface_b, row_b : Floats, int
        Surfaces (:mod:`bodies.contacts.surface.surface_tables`), and the indices at which the rows of the edges begin.
    size : float
        Size of the larger body [m].
    """
    radius_a, radius = surface_a[SWEEP], surface_a[SWEEP] + surface_b[SWEEP]
    parallel = least_sine(size) if radius == 0.0 else least_round_sine(radius, size)
    edges = surface_a, row_a, surface_b, row_b
    # the margin ``size`` skips the test of the ends of the edges, which follows
    crossing = cross_edges(a, b, surface_a, row_a, surface_b, row_b, parallel, size, size)
    p, e, f, n, gap, _, past = crossing
    if past <= 0.0:
        past = _past_ends(a, b, edges, crossing, size)
    if past <= 0.0 and gap < 0.0:
        past = max(past, _past_overlap(a, b, edges, crossing, size))
    gap = gap_past_end(gap - radius, past, surface_a[IS_CONVEX] * surface_b[IS_CONVEX] > 0.0)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    write_vector(out, NORMAL, n)
    write_vector(out, POINT_A, plus_scaled(p, radius_a, n))
    write_vector(out, POINT_B, plus_scaled(p, radius_a + gap, n))
    # the edge is the tangent: it is fixed to a body.  If both edges lie in a face, round-off turns the normal, and a
    # tangent that is computed from the normal would turn with it
    write_vector(out, TANGENT, e)
    write_principal(out, SIDE_A, e, 0.0, 1.0, 1.0, radius_a)
    write_principal(out, SIDE_B, f, 0.0, 1.0, 1.0, surface_b[SWEEP])
