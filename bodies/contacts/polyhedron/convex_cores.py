"""Two edges of convex cores that cross."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ..features.edge_crossing import Crossing, cross_edges
from ..features.vertex_face import separation_of_faces


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
    them.  The faces and vertices are those of
    :class:`bodies.contacts.features.polytope_tables.ConvexCore`.
    """
    p, e, f, n, gap, over, past = cross_edges(a, b, edge_a, 0, edge_b, 0, parallel, margin, size)
    if past <= 0.0 and gap < -abs(margin):
        best = separation_of_faces(a, b, n_faces_a, faces_a, n_vertices_b, vertices_b)
        best = max(best, separation_of_faces(b, a, n_faces_b, faces_b, n_vertices_a, vertices_a))
        past = max(past, best - gap - abs(margin))
    return p, e, f, n, gap, over, past
