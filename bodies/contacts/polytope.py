"""What the pairs of polytopes with smooth bodies see of a polytope: vertices, edges, faces, and who is next to whom."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nonsmooth.interfaces.body import Vector

COUNTS, VERTICES, EDGES, FACES, LOOPS, STARS, LISTS = 6, 9, 10, 11, 12, 13, 14
"""Where the numbers of vertices, edges and faces stand, and the offsets of the parts."""
EDGE, FACE = 4, 6
"""Numbers of an edge (both vertices, the faces on its left and right, -1 for none) and of a face (outward normal,
distance of its plane from the origin, beginning and length of its loop)."""
_HEADER = 15


def polytope_numbers(
    vertices: Sequence[Sequence[float]] | Vector,
    faces: Sequence[Sequence[int]],
    radius: float = 0.0,
    lonely: Sequence[tuple[int, int]] = (),
) -> tuple[float, ...]:
    """Return the numbers of a convex polytope, in the frame of its body.

    They begin like those of a core that is a point (:func:`bodies.shapes.smooth.core_numbers`), as which a vertex is
    seen: no semi-axes, two powers, the radius.  Then come the numbers of vertices, edges and faces, the offsets of the
    parts, and the parts: vertices, edges, faces, loops (a vertex and the edge that leaves it), stars (of every vertex
    where its list of edges begins and how long it is), lists.

    Parameters
    ----------
    vertices : sequence
        Vertices [m], shape [n, 3].
    faces : sequence of sequence of int
        Of every face its vertices, counter-clockwise seen from outside; none of a segment.
    radius : float, optional
        All points within this distance belong to the body [m].
    lonely : sequence of tuple of int
        Edges without faces, as of a segment.
    """
    points = np.asarray(vertices, dtype=float).reshape(-1, 3)
    edges: dict[tuple[int, int], list[int]] = {pair: [-1, -1] for pair in lonely}
    numbers = {pair: float(i) for i, pair in enumerate(edges)}
    stars: list[list[float]] = [[] for _ in points]
    loops: list[float] = []
    planes: list[float] = []
    for number, face in enumerate(faces):
        begin = len(loops)
        for one, two in zip(face, (*face[1:], face[0]), strict=True):
            pair = (one, two) if one < two else (two, one)
            edges.setdefault(pair, [-1, -1])[0 if one < two else 1] = number
            loops += [float(one), numbers.setdefault(pair, float(len(numbers)))]
        normal = _normal(points[list(face)])
        planes += [*normal.tolist(), float(np.mean(points[list(face)] @ normal)), float(begin), float(len(face))]
    for pair, i in numbers.items():
        for vertex in pair:
            stars[vertex].append(i)
    begins = np.cumsum([0, *(len(own) for own in stars)])
    heads = [float(x) for begin, own in zip(begins, stars, strict=False) for x in (begin, len(own))]
    lists = [i for own in stars for i in own]
    sides = [float(x) for pair, sides in edges.items() for x in (*pair, *sides)]
    parts = [points.ravel().tolist(), sides, planes, loops, heads, lists]
    offsets = [float(_HEADER + sum(len(part) for part in parts[:i])) for i in range(len(parts))]
    counts = [float(len(points)), float(len(edges)), float(len(faces))]
    return (0.0, 0.0, 0.0, 2.0, 2.0, radius, *counts, *offsets, *(x for part in parts for x in part))


def _normal(corners: Vector) -> Vector:
    """Return the unit normal of a polygon (Newell's rule)."""
    normal = np.sum(np.cross(corners - corners[0], np.roll(corners, -1, axis=0) - corners[0]), axis=0)
    return np.asarray(normal / np.linalg.norm(normal))
