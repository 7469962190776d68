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
def _in_first(a: Floats, b: Floats, edges: Floats, at: int) -> Vector3:
    """Return the components, along the axes of the first body, of a vector of a row of edges of the second body."""
    return vector_in_body(a, vector_in_world(b, vector_at(edges, at)))


@compiled
def _separation_of_edges(a: Floats, b: Floats, core_a: Floats, core_b: Floats, parallel: float) -> float:
    """Return the largest separation of two cores along normals that an edge of each has in common [m]."""
    best = -math.inf
    for k in range(int(core_b[N_EDGES])):
        two = int(core_b[EDGES]) + EDGE * k
        f = _in_first(a, b, core_b, two + ALONG)
        u, v = _in_first(a, b, core_b, two + INTO_FIRST), _in_first(a, b, core_b, two + INTO_SECOND)
        start = point_in_body(a, point_in_world(b, vector_at(core_b, two)))
        for i in range(int(core_a[N_EDGES])):
            one = int(core_a[EDGES]) + EDGE * i
            n = cross(vector_at(core_a, one + ALONG), f)
            # a normal of an edge leads into none of its faces
            p, q = dot(n, vector_at(core_a, one + INTO_FIRST)), dot(n, vector_at(core_a, one + INTO_SECOND))
            r, s = -dot(n, u), -dot(n, v)
            is_ahead, is_behind = max(p, q, r, s) <= 0.0, min(p, q, r, s) >= 0.0
            sine = norm(n)
            if (is_ahead or is_behind) and sine > parallel:
                gap = dot(n, minus(start, vector_at(core_a, one + START))) / sine
                best = max(best, gap if is_ahead else -gap)
    return best


@compiled
def past_if_convex(
    a: Floats,
    b: Floats,
    core_a: Floats,
    one: int,
    core_b: Floats,
    two: int,
    crossing: Crossing,
    past: float,
    parallel: float,
    within: float,
) -> float:
    """Return the distance past the boundary of two edges of convex cores that cross [m].

    Edges whose gap is below zero do not face each other if the cores overlap less along the normal of a face of one of
    them.  If both nearest points are outside of the other core, the normals of all pairs of edges count, too.

    Flush edges do not face each other if a face separates the cores as well as their common normal: then the vertices
    over the face touch.  Edges are flush if they are so nearly parallel that the ends of the shorter edge are within
    ``within`` [m] of the other edge, and if their common normal is the normal of a face within the sine ``_FLUSH``.

    Parameters
    ----------
    a, b : Floats
        Frame blocks.
    core_a, one, core_b, two : Floats and int
        Both cores (:func:`bodies.contacts.features.polytope_tables.core_numbers`), and the rows of the edges in them.
    crossing : tuple
        The crossing of the edges (:func:`bodies.contacts.features.edge_crossing.cross_edges`).
    past : float
        Distance past the boundary of the edges alone [m].
    parallel : float
        Sine of the angle between two edges below which they have no common normal.
    within : float
        Gaps up to this size are round-off [m].
    """
    p, e, f, n, gap, _, _ = crossing
    ends = min(core_a[one + LENGTH], core_b[two + LENGTH]) * norm(cross(e, f))
    inside = max(sine_off_cone(a, core_a, one, 1.0, n), sine_off_cone(b, core_b, two, -1.0, n))
    is_flush = ends < within and inside > -_FLUSH
    if past <= within and (gap < -within or is_flush):
        best = max(separation_of_faces(a, b, core_a, core_b), separation_of_faces(b, a, core_b, core_a))
        if is_flush and best >= gap - within:
            past = max(past, within - ends)
        outside = min(height_over(b, *faces_of(core_b), p), height_over(a, *faces_of(core_a), plus_scaled(p, gap, n)))
        if gap < -within and outside > within:
            best = max(best, _separation_of_edges(a, b, core_a, core_b, parallel))
        past = max(past, best - gap - within)
    return past
