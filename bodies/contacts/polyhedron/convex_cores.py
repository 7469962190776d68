"""Two edges of convex cores that cross."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ..features.edge_crossing import Crossing, cross_edges
from ..features.polytope_tables import EDGE
from ..features.vertex_face import height_over, separation_of_faces


@compiled
def _separation_of_edges(
    a: Floats,
    b: Floats,
    n_edges_a: float,
    edges_a: Floats,
    n_edges_b: float,
    edges_b: Floats,
    parallel: float,
    size: float,
) -> float:
    """Return the largest separation of two cores along the common normals of their edges [m]."""
    best = -math.inf
    for i in range(int(n_edges_a)):
        for j in range(int(n_edges_b)):
            _, _, _, _, gap, _, astray, _ = cross_edges(a, b, edges_a, EDGE * i, edges_b, EDGE * j, parallel, 0.0, size)
            if astray <= 0.0:
                best = max(best, gap)
    return best


@compiled
def cross_convex_edges(
    a: Floats,
    b: Floats,
    edge_a: float,
    edge_b: float,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    n_edges_a: float,
    edges_a: Floats,
    n_edges_b: float,
    edges_b: Floats,
    parallel: float,
    margin: float,
    size: float,
) -> Crossing:
    """Return the crossing of two edges (:func:`bodies.contacts.features.edge_crossing.cross_edges`) of convex cores.

    ``edge_a`` and ``edge_b`` are the numbers of the edges.

    Edges whose gap is below zero do not face each other if the cores overlap less along the normal of a face of one of
    them.  If both nearest points are outside of the other core, the normals of all pairs of edges count, too.  The
    numbers of the cores are those of :class:`bodies.contacts.features.polytope_tables.ConvexCore`.
    """
    p, e, f, n, gap, over, astray, past = cross_edges(
        a, b, edges_a, EDGE * int(edge_a), edges_b, EDGE * int(edge_b), parallel, margin, size
    )
    if past <= 0.0 and gap < -abs(margin):
        best = separation_of_faces(a, b, n_faces_a, faces_a, n_vertices_b, vertices_b)
        best = max(best, separation_of_faces(b, a, n_faces_b, faces_b, n_vertices_a, vertices_a))
        q = p[0] + gap * n[0], p[1] + gap * n[1], p[2] + gap * n[2]
        outside = min(height_over(b, n_faces_b, faces_b, *p), height_over(a, n_faces_a, faces_a, *q))
        if outside > abs(margin):
            best = max(best, _separation_of_edges(a, b, n_edges_a, edges_a, n_edges_b, edges_b, parallel, size))
        past = max(past, best - gap - abs(margin))
    return p, e, f, n, gap, over, astray, past
