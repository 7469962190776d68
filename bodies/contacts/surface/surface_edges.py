"""Contact of convex edges of two bodies that cross each other; the bodies need not be convex."""

from __future__ import annotations

import math

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...vectors import Vector3, plus_scaled, vector_at, write_vector
from ..features.edge_crossing import PARALLEL, Crossing, cross_edges, least_sine
from ..features.frames import point_in_body, write_tangent
from ..features.polytope_tables import ALONG, INTO_FIRST, LENGTH
from ..features.vertex_face import CLOSED
from ..features.writing import write_principal
from .surface_near import seen_from
from .surface_vertex import past_depth


@compiled
def crossing_of(
    a: Floats, b: Floats, edge_a: Floats, at_a: int, edge_b: Floats, at_b: int, radius: float, size: float
) -> Crossing:
    """Return the crossing of two edges (:func:`bodies.contacts.features.edge_crossing.cross_edges`).

    The second edge has a radius [m].  The rows of the edges begin at the indices ``at_a`` and ``at_b``.
    """
    parallel = least_sine(size) if radius == 0.0 else PARALLEL
    return cross_edges(a, b, edge_a, at_a, edge_b, at_b, parallel, CLOSED * size, size)


@compiled
def past_surface(
    frame: Floats,
    other: Floats,
    surface: Floats,
    edges: Floats,
    row: int,
    extensions: tuple[float, float],
    depth: float,
    point: Vector3,
) -> float:
    """Return how far an edge of the other body is from an overlap of this depth with a surface [m].

    See :func:`bodies.contacts.surface.surface_vertex.past_depth`.  The row of the edge begins at the index ``row`` of
    ``edges``; its body extends past its ends by the lengths ``extensions`` [m].  ``point`` is the nearest point of the
    edge in the world [m].
    """
    start, along, length = vector_at(edges, row), vector_at(edges, row + ALONG), edges[row + LENGTH]
    first = plus_scaled(start, -extensions[0], along)
    second = plus_scaled(start, length + extensions[1], along)
    ends = seen_from(frame, other, first), seen_from(frame, other, second)
    into = block_at(edges, row + INTO_FIRST)
    return float(past_depth(frame, other, surface, 2.0, into, ends, depth, point_in_body(frame, point)))


@compiled
def write_edges(a: Floats, out: Floats, crossing: Crossing, past: float, radius: float) -> None:
    """Write the geometry block of two edges at the nearest points of their lines; the second edge has a radius [m].

    If the distance ``past`` [m] of the edges past the boundary of their features is positive, the contact is open, with
    a positive gap.
    """
    p, e, f, n, gap, _, _ = crossing
    gap -= radius
    if past > 0.0:
        gap = math.hypot(gap, past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    write_vector(out, NORMAL, n)
    write_vector(out, POINT_A, p)
    write_vector(out, POINT_B, plus_scaled(p, gap, n))
    write_tangent(a, out)
    write_principal(out, SIDE_A, e, 0.0, 1.0, 1.0, 0.0)
    write_principal(out, SIDE_B, f, 0.0, 1.0, 1.0, radius)
