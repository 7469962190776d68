"""Two edges of convex cores that cross."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, vector_at
from ..features.edge_crossing import Crossing, cross_edges, edge_astray
from ..features.frames import point_in_body, point_in_world, vector_in_body, vector_in_world
from ..features.polytope_tables import ALONG, EDGE, INTO_FIRST, INTO_SECOND, LENGTH, START
from ..features.vertex_face import height_over, separation_of_faces

_FLUSH = 1e-5
"""Sine of the angle between the common normal of two edges and a face's normal, up to which they count as equal.

The face is adjacent to one of the edges.
"""


@compiled
def _in_first(a: Floats, b: Floats, edges: Floats, at: int) -> Vector3:
    """Return the components, along the axes of the first body, of a vector of a row of edges of the second body."""
    x, y, z = vector_in_world(b, vector_at(edges, at))
    x, y, z = vector_in_body(a, (x, y, z))
    return x, y, z


@compiled
def _sine(e: Vector3, f: Vector3) -> float:
    """Return the sine of the angle between two unit vectors."""
    x, y, z = e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]
    return math.sqrt(x * x + y * y + z * z)


@compiled
def _separation_of_edges(
    a: Floats, b: Floats, n_edges_a: float, edges_a: Floats, n_edges_b: float, edges_b: Floats, parallel: float
) -> float:
    """Return the largest separation of two cores along normals that an edge of each has in common [m]."""
    best = -math.inf
    for k in range(int(n_edges_b)):
        at = EDGE * k
        fx, fy, fz = _in_first(a, b, edges_b, at + ALONG)
        ux, uy, uz = _in_first(a, b, edges_b, at + INTO_FIRST)
        vx, vy, vz = _in_first(a, b, edges_b, at + INTO_SECOND)
        qx, qy, qz = point_in_world(b, vector_at(edges_b, at))
        qx, qy, qz = point_in_body(a, (qx, qy, qz))
        for i in range(int(n_edges_a)):
            e, one, two = EDGE * i + ALONG, EDGE * i + INTO_FIRST, EDGE * i + INTO_SECOND
            x = edges_a[e + 1] * fz - edges_a[e + 2] * fy
            y = edges_a[e + 2] * fx - edges_a[e] * fz
            z = edges_a[e] * fy - edges_a[e + 1] * fx
            # a normal of an edge leads into none of its faces
            p = x * edges_a[one] + y * edges_a[one + 1] + z * edges_a[one + 2]
            q = x * edges_a[two] + y * edges_a[two + 1] + z * edges_a[two + 2]
            r, s = -x * ux - y * uy - z * uz, -x * vx - y * vy - z * vz
            is_ahead, is_behind = max(p, q, r, s) <= 0.0, min(p, q, r, s) >= 0.0
            sine = math.sqrt(x * x + y * y + z * z)
            if (is_ahead or is_behind) and sine > parallel:
                t = EDGE * i + START
                gap = (x * (qx - edges_a[t]) + y * (qy - edges_a[t + 1]) + z * (qz - edges_a[t + 2])) / sine
                best = max(best, gap if is_ahead else -gap)
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
    them.  If both nearest points are outside of the other core, the normals of all pairs of edges count, too.

    Flush edges do not face each other if a face separates the cores as well as their common normal: then the vertices
    over the face touch.  Edges are flush if they are so nearly parallel that the ends of the shorter edge are within
    ``margin`` [m] of the other edge, and if their common normal is the normal of a face within the sine ``_FLUSH``.

    The numbers of the cores are those of :class:`bodies.contacts.features.polytope_tables.ConvexCore`.
    """
    one, two = EDGE * int(edge_a), EDGE * int(edge_b)
    p, e, f, n, gap, over, past = cross_edges(a, b, edges_a, one, edges_b, two, parallel, margin, size)
    within = abs(margin)
    ends = min(edges_a[one + LENGTH], edges_b[two + LENGTH]) * _sine(e, f)
    inside = max(edge_astray(a, edges_a, one, 1.0, *n), edge_astray(b, edges_b, two, -1.0, *n))
    is_flush = ends < within and inside > -_FLUSH
    if past <= within and (gap < -within or is_flush):
        best = separation_of_faces(a, b, n_faces_a, faces_a, n_vertices_b, vertices_b)
        best = max(best, separation_of_faces(b, a, n_faces_b, faces_b, n_vertices_a, vertices_a))
        if is_flush and best >= gap - within:
            past = max(past, within - ends)
        q = p[0] + gap * n[0], p[1] + gap * n[1], p[2] + gap * n[2]
        outside = min(height_over(b, n_faces_b, faces_b, *p), height_over(a, n_faces_a, faces_a, *q))
        if gap < -within and outside > within:
            best = max(best, _separation_of_edges(a, b, n_edges_a, edges_a, n_edges_b, edges_b, parallel))
        past = max(past, best - gap - within)
    return p, e, f, n, gap, over, past
