"""What the evaluators of polyhedra read: vertices, faces and edges as rows of numbers."""

from __future__ import annotations

import itertools

import numpy as np

from bodies.shapes.polytope import Polytope

FACE = 5
"""Floats of a face: outward normal, distance of its plane from the origin, depth of the body behind it."""
EDGE = 13
"""Floats of an edge: first end, direction, length, and in either face the direction from the edge into it."""

Numbers = tuple[float, ...]


def vertex_table(polytope: Polytope) -> Numbers:
    """Return the coordinates one after the other."""
    return tuple(itertools.chain(*polytope.vertices))


def face_table(polytope: Polytope) -> Numbers:
    """Return the faces."""
    vertices = np.array(polytope.vertices)
    rows = [(*plane, plane[3] - float(np.min(vertices @ plane[:3]))) for plane in polytope.planes]
    return tuple(itertools.chain(*rows))


def edge_rows(polytope: Polytope) -> list[Numbers]:
    """Return the edges, one row each."""
    vertices, normals = np.array(polytope.vertices), np.array(polytope.planes)[:, :3]
    rows = []
    for one, two, left, right in polytope.edges:
        way = vertices[two] - vertices[one]
        length = float(np.linalg.norm(way))
        along = way / length
        # counter-clockwise round either face, so that it lies to the left of the edge
        inward = [np.cross(normals[left], along), np.cross(along, normals[right])]
        rows.append((*vertices[one].tolist(), *along.tolist(), length, *inward[0].tolist(), *inward[1].tolist()))
    return rows
