"""Tables of vertices, faces and edges of a polyhedron, as arguments of the compiled contact functions."""

from __future__ import annotations

import itertools

import numpy as np

from nonsmooth.compiled import block_at, compiled
from nonsmooth.parameters import SharedNumbers
from nonsmooth.types import Floats

from ...shapes.polytope import Point, Polytope

SWEEP, N_FACES, N_EDGES, N_VERTICES, FACES, EDGES, ENDS, VERTICES = range(8)
"""Indices in the head of a core's numbers (:func:`core_numbers`).

``SWEEP`` is the index of the radius about the core [m].  Names that begin with ``N_`` are indices of a number of rows.
The others are indices of the offset at which the rows of that name begin.
"""
FACE = 5
"""Floats in the row of a face: outward normal, distance of its plane from the origin [m], depth of the body [m]."""
OFFSET = 3
"""Offset in the row of a face: distance of its plane from the origin."""
EDGE = 13
"""Floats in the row of an edge: first end [m], unit vector, length [m], unit vectors into its first and second face."""
VERTEX = 5
"""Floats in the row of a vertex: position [m], number of its edges, index of the unit vectors along them."""
N_STAR, STAR = 3, 4
"""Offsets in the row of a vertex: number of its edges, index of the unit vectors along them."""
START, ALONG, LENGTH, INTO_FIRST, INTO_SECOND = 0, 3, 6, 7, 10
"""Offsets in the row of an edge: first end, unit vector, length, unit vector into the first face, into the second."""

Numbers = tuple[float, ...]


def face_table(polytope: Polytope) -> Numbers:
    """Return the rows of all faces, joined; empty for a segment, which has no faces."""
    vertices = np.array(polytope.vertices)
    rows = [(*plane, plane[3] - float(np.min(vertices @ plane[:3]))) for plane in polytope.planes]
    return tuple(itertools.chain(*rows))


def core_numbers(polytope: Polytope, sweep: float = 0.0) -> SharedNumbers:
    """Return the numbers of a polyhedron or a segment: head, faces, edges, ends of edges, vertices, unit vectors.

    ``sweep`` is the radius about the core [m].  A segment has no faces.  The unit vectors lead from each vertex along
    its edges.
    """
    stars = [star_of(polytope, i) for i in range(len(polytope.vertices))]
    faces, edges, ends = face_table(polytope), [*itertools.chain(*edge_rows(polytope))], end_table(polytope)
    sizes = len(faces), len(edges), len(ends), VERTEX * len(stars), *map(len, stars)
    begins = [*itertools.accumulate(sizes, initial=8)]
    rows = [(*place, len(star) // 3, at) for place, star, at in zip(polytope.vertices, stars, begins[4:], strict=False)]
    head = sweep, len(faces) // FACE, len(polytope.edges), len(stars), *begins[:4]
    return SharedNumbers([*head, *faces, *edges, *ends, *itertools.chain(*rows), *itertools.chain(*stars)])


def point_numbers(place: Point) -> SharedNumbers:
    """Return the numbers of a point [m], in the layout of :func:`core_numbers`: a core with one vertex, without edges.

    All rows begin after the head.
    """
    # head; position, number of edges, index of the unit vectors along them
    return SharedNumbers([0.0, 0.0, 0.0, 1.0, *[8.0] * 4, *place, 0.0, 0.0])


def part_names(polytope: Polytope) -> list[str]:
    """Return the names of all faces, edges and vertices by number; the edge of a segment is its side."""
    edge = "edge" if polytope.planes else "side"
    counts = ("face", len(polytope.planes)), (edge, len(polytope.edges)), ("vertex", len(polytope.vertices))
    return [f"{kind} {i}" for kind, n in counts for i in range(n)]


@compiled
def faces_of(core: Floats) -> tuple[float, Floats]:
    """Return the number of the faces of a core, a whole number as a float, and the block with their rows."""
    return core[N_FACES], block_at(core, int(core[FACES]))


@compiled
def edges_of(core: Floats) -> tuple[float, Floats]:
    """Return the number of the edges of a core, a whole number as a float, and the block with their rows."""
    return core[N_EDGES], block_at(core, int(core[EDGES]))


@compiled
def edge_at(core: Floats, edge: float) -> int:
    """Return the index at which the row of an edge begins."""
    return int(core[EDGES]) + EDGE * int(edge)


@compiled
def vertex_at(core: Floats, vertex: float) -> int:
    """Return the index at which the row of a vertex begins."""
    return int(core[VERTICES]) + VERTEX * int(vertex)


def edge_rows(polytope: Polytope) -> list[Numbers]:
    """Return the row of each edge (:data:`EDGE`); a segment has no faces, so its unit vectors into the faces are 0."""
    vertices, edges = np.array(polytope.vertices), np.array(polytope.edges, dtype=int).reshape(-1, 4)
    start, side = vertices[edges[:, 0]], vertices[edges[:, 1]] - vertices[edges[:, 0]]
    length = np.linalg.norm(side, axis=1, keepdims=True)
    along, inward = side / length, np.zeros((2, len(edges), 3))
    of_faces = edges[:, 2] >= 0
    if np.any(of_faces):
        normals = np.array(polytope.planes)[edges[of_faces, 2:], :3]
        # counter-clockwise round either face, so that it lies to the left of the edge
        inward[0, of_faces] = np.cross(normals[:, 0], along[of_faces])
        inward[1, of_faces] = np.cross(along[of_faces], normals[:, 1])
    return [tuple(row) for row in np.hstack([start, along, length, *inward]).tolist()]


def end_table(polytope: Polytope) -> Numbers:
    """Return the numbers of the two end vertices of each edge, two for each edge."""
    return tuple(float(i) for one, two, *_ in polytope.edges for i in (one, two))


def star_of(polytope: Polytope, vertex: int) -> Numbers:
    """Return the unit vectors from a vertex along its edges, three components for each edge."""
    points, star = np.array(polytope.vertices), []
    for one, two, *_ in polytope.edges:
        if vertex in (one, two):
            # one of both ends is the vertex itself
            side = points[one] + points[two] - 2.0 * points[vertex]
            star += (side / np.linalg.norm(side)).tolist()
    return tuple(star)


def star_lengths(polytope: Polytope, vertex: int) -> Numbers:
    """Return the lengths of the edges of a vertex [m], in the order of :func:`star_of`."""
    points = np.array(polytope.vertices)
    return tuple(
        float(np.linalg.norm(points[two] - points[one])) for one, two, *_ in polytope.edges if vertex in (one, two)
    )
