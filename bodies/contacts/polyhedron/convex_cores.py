"""Two edges of convex cores that cross."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ..features.edge_crossing import NEAR_ENDS, Crossing, cross_edges
from ..features.vertex_face import height_over, separation_of_faces


@compiled
def cross_convex_edges(
    a: Floats,
    b: Floats,
    edge_a: Floats,
    edge_b: Floats,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    parallel: float,
    margin: float,
    size: float,
) -> Crossing:
    """Return the crossing of two edges (:func:`bodies.contacts.features.edge_crossing.cross_edges`) of convex cores.

    Edges whose gap is below zero do not face each other if the cores overlap less along the normal of a face of one of
    them.  Nor do they if both nearest points are outside of the other core and near the ends of the edges
    (:data:`bodies.contacts.features.edge_crossing.NEAR_ENDS`).  The faces and vertices are those of
    :class:`bodies.contacts.features.polytope_tables.ConvexCore`.
    """
    p, e, f, n, gap, over, past = cross_edges(a, b, edge_a, 0, edge_b, 0, parallel, margin, size)
    if past <= 0.0 and gap < -abs(margin):
        best = separation_of_faces(a, b, n_faces_a, faces_a, n_vertices_b, vertices_b)
        best = max(best, separation_of_faces(b, a, n_faces_b, faces_b, n_vertices_a, vertices_a))
        past = max(past, best - gap - abs(margin))
        q = p[0] + gap * n[0], p[1] + gap * n[1], p[2] + gap * n[2]
        outside = min(height_over(b, n_faces_b, faces_b, *p), height_over(a, n_faces_a, faces_a, *q))
        if outside > abs(margin):
            past = max(past, over - NEAR_ENDS * gap)
    return p, e, f, n, gap, over, past
