"""What the pairs of polytopes with smooth bodies see of a polytope: vertices, edges, faces, and who is next to whom.

The numbers begin like those of a core that is a point (:func:`bodies.shapes.smooth.core_numbers`), as which a vertex is
seen: no semi-axes, two powers, the radius [m].  Then come the numbers of vertices, edges and faces, the offsets of the
parts, and the parts, all in the frame of the body: vertices, edges, faces, loops (a vertex and the edge that leaves
it), stars (of every vertex where its list of edges begins and how long it is), lists.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from bodies.shapes.polytope import Polytope

Numbers = tuple[float, ...]

COUNTS, VERTICES, EDGES, FACES, LOOPS, STARS, LISTS = 6, 9, 10, 11, 12, 13, 14
"""Where the numbers of vertices, edges and faces stand, and the offsets of the parts."""
EDGE, FACE = 4, 6
"""Numbers of an edge (both vertices, the faces on its left and right, -1 for none) and of a face (outward normal,
distance of its plane from the origin, beginning and length of its loop)."""
_HEADER = 15


def polyhedron_numbers(polytope: Polytope, radius: float = 0.0) -> Numbers:
    """Return the numbers of a polyhedron, with a radius about it [m]."""
    return _numbers(polytope.vertices, polytope.faces, polytope.planes, polytope.edges, radius)


def segment_numbers(ends: Sequence[tuple[float, float, float]], radius: float) -> Numbers:
    """Return the numbers of a segment with a radius about it [m], a capsule."""
    return _numbers(ends, (), (), ((0, 1, -1, -1),), radius)


def _numbers(
    vertices: Sequence[tuple[float, float, float]],
    faces: Sequence[tuple[int, ...]],
    planes: Sequence[tuple[float, float, float, float]],
    edges: Sequence[tuple[int, int, int, int]],
    radius: float,
) -> Numbers:
    number = {pair: i for i, (one, two, _, _) in enumerate(edges) for pair in ((one, two), (two, one))}
    loops = [(one, number[one, two]) for face in faces for one, two in zip(face, (*face[1:], face[0]), strict=True)]
    begins = itertools.accumulate((len(face) for face in faces), initial=0)
    rows = [(*plane, 2 * begin, len(face)) for plane, begin, face in zip(planes, begins, faces, strict=False)]
    own: list[list[int]] = [[] for _ in vertices]
    for i, edge in enumerate(edges):
        for vertex in edge[:2]:
            own[vertex].append(i)
    begins = itertools.accumulate((len(one) for one in own), initial=0)
    stars = [(begin, len(one)) for begin, one in zip(begins, own, strict=False)]
    parts = [list(itertools.chain(*part)) for part in (vertices, edges, rows, loops, stars, own)]
    offsets = itertools.accumulate((len(part) for part in parts[:-1]), initial=_HEADER)
    head = (0, 0, 0, 2, 2, radius, len(vertices), len(edges), len(faces), *offsets)
    return tuple(float(x) for x in (*head, *itertools.chain(*parts)))
