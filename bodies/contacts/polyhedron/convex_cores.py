"""Two edges of convex cores that cross."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ..features.edge_crossing import Crossing, cross_edges
from ..features.polytope_tables import LENGTH
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
    them.  Edges so nearly parallel that the ends of the shorter one are within ``margin`` [m] of the other one do not
    face each other if a face separates the cores as well: then the vertices over the face touch.  The faces and
    vertices are those of :class:`bodies.contacts.features.polytope_tables.ConvexCore`.
    """
    p, e, f, n, gap, over, past = cross_edges(a, b, edge_a, 0, edge_b, 0, parallel, margin, size)
    within = abs(margin)
    x, y, z = e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]
    ends = min(edge_a[LENGTH], edge_b[LENGTH]) * math.sqrt(x * x + y * y + z * z)
    if past <= within and (gap < -within or ends < within):
        best = separation_of_faces(a, b, n_faces_a, faces_a, n_vertices_b, vertices_b)
        best = max(best, separation_of_faces(b, a, n_faces_b, faces_b, n_vertices_a, vertices_a))
        past = max(past, best - gap - within)
        if best >= gap - within:
            past = max(past, within - ends)
    return p, e, f, n, gap, over, past
