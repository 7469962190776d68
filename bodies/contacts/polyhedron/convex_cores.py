"""Two edges of convex cores that cross, if the cores overlap."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, dot, minus, norm, plus_scaled, vector_at
from ..features.edge_crossing import Crossing, sine_off_cone
from ..features.frames import point_in_body, point_in_world, vector_in_body, vector_in_world
from ..features.polytope_tables import ALONG, EDGE, EDGES, INTO_FIRST, INTO_SECOND, LENGTH, N_EDGES, START, faces_of
from ..features.vertex_face import height_over, separation_of_faces

_FLUSH = 1e-5
"""Sine of the angle between the common normal of two edges and a face's normal, up to which they count as equal.

The face is adjacent to one of the edges.
"""


@compiled
def _in_first(a: Floats, b: Floats, edges: Floats, offset: int) -> Vector3:
    """Return, in the axes of the first body, the vector at an index of a table ``edges`` of the second body."""
    return vector_in_body(a, vector_in_world(b, vector_at(edges, offset)))


@compiled
def _separation_of_edges(a: Floats, b: Floats, core_a: Floats, core_b: Floats, parallel: float) -> float:
    """Return the largest separation of two cores along normals that an edge of each has in common [m].

    Pairs of edges with a sine of their angle up to ``parallel`` are left out.
    """
    largest = -math.inf
    for edge_b in range(int(core_b[N_EDGES])):
        row_b = int(core_b[EDGES]) + EDGE * edge_b
        f = _in_first(a, b, core_b, row_b + ALONG)
        u, v = _in_first(a, b, core_b, row_b + INTO_FIRST), _in_first(a, b, core_b, row_b + INTO_SECOND)
        start_b = point_in_body(a, point_in_world(b, vector_at(core_b, row_b + START)))
        for edge_a in range(int(core_a[N_EDGES])):
            row_a = int(core_a[EDGES]) + EDGE * edge_a
            n = cross(vector_at(core_a, row_a + ALONG), f)
            # n or -n is a normal of both edges, if it leads into no face of the first one and, reversed, of the second
            p, q = dot(n, vector_at(core_a, row_a + INTO_FIRST)), dot(n, vector_at(core_a, row_a + INTO_SECOND))
            r, s = -dot(n, u), -dot(n, v)
            is_normal, is_opposite = max(p, q, r, s) <= 0.0, min(p, q, r, s) >= 0.0
            sine = norm(n)
            if (is_normal or is_opposite) and sine > parallel:
                gap = dot(n, minus(start_b, vector_at(core_a, row_a + START))) / sine
                largest = max(largest, gap if is_normal else -gap)
    return largest


@compiled
def past_if_convex(
    a: Floats,
    b: Floats,
    core_a: Floats,
    row_a: int,
    core_b: Floats,
    row_b: int,
    crossing: Crossing,
    past: float,
    parallel: float,
    margin: float,
) -> float:
    """Return the distance past the boundary of two edges of convex cores that cross [m].

    The separation of convex cores is the largest one over all normals.  So edges with a gap below zero do not face each
    other if the separation along the normal of a face is larger.  If both nearest points are outside of the other core,
    the common normals of all pairs of edges count, too.

    Flush edges do not face each other if a face separates the cores as well as their common normal: then the vertices
    over the face touch.  Edges are flush if they are so nearly parallel that the ends of the shorter edge are within
    ``margin`` of the other edge, and if their common normal is the normal of a face within the sine ``_FLUSH``.

    Parameters
    ----------
    a, b : Floats
        Frame blocks.
    core_a, row_a, core_b, row_b : Floats and int
        Both cores (:func:`bodies.contacts.features.polytope_tables.core_numbers`), and the indices at which the rows of
        the edges begin.
    crossing : tuple
        The crossing of the edges (:func:`bodies.contacts.features.edge_crossing.cross_edges`).
    past : float
        Distance past the boundary of the edges alone [m].
    parallel : float
        Sine of the angle between two edges below which they have no common normal.
    margin : float
        Differences of gaps and distances up to this size are round-off [m].
    """
    p, e, f, n, gap, _, _ = crossing
    ends_apart = min(core_a[row_a + LENGTH], core_b[row_b + LENGTH]) * norm(cross(e, f))
    off_cone = max(sine_off_cone(a, core_a, row_a, 1.0, n), sine_off_cone(b, core_b, row_b, -1.0, n))
    is_flush = ends_apart < margin and off_cone > -_FLUSH
    if past <= margin and (gap < -margin or is_flush):
        separation = max(separation_of_faces(a, b, core_a, core_b), separation_of_faces(b, a, core_b, core_a))
        if is_flush and separation >= gap - margin:
            # positive: the vertices over the face touch instead
            past = max(past, margin - ends_apart)
        height = min(height_over(b, *faces_of(core_b), p), height_over(a, *faces_of(core_a), plus_scaled(p, gap, n)))
        if gap < -margin and height > margin:
            separation = max(separation, _separation_of_edges(a, b, core_a, core_b, parallel))
        past = max(past, separation - gap - margin)
    return past
