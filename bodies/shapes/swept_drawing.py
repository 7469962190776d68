"""The mesh to draw a polyhedron swept by a sphere with."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from bodies.shapes.drawing import check_fineness
from bodies.shapes.polytope import Polytope
from nonsmooth.interfaces.body import Vector

Integers = NDArray[np.int64]


def draw_swept(core: Polytope, radius: float, fineness: int) -> tuple[Vector, Vector]:
    """Return vertices [m], shape [n, 3], and triangles, shape [m, 3], of all points within a radius of a polyhedron.

    Every face is shifted outward, every edge becomes a strip with a quarter of ``fineness`` steps, and every vertex as
    many rings about the mean normal of its faces.
    """
    check_fineness(fineness)
    steps = -(-fineness // 4)
    vertices, normals = np.array(core.vertices), np.array(core.planes)[:, :3]
    blocks: list[Vector] = []
    count = 0
    triangles: list[Integers] = []

    def put(vertex: int, directions: Vector) -> Integers:
        nonlocal count
        blocks.append(vertices[vertex] + radius * directions / np.linalg.norm(directions, axis=1)[:, None])
        count += len(directions)
        return np.arange(count - len(directions), count)

    corner = {(v, f): put(v, normals[f : f + 1]) for f, face in enumerate(core.faces) for v in face}
    for f, face in enumerate(core.faces):
        fan = [(corner[face[0], f], corner[a, f], corner[b, f]) for a, b in itertools.pairwise(face[1:])]
        triangles.append(np.array(fan).reshape(-1, 3))
    # the arc round a vertex from one of its faces to the next, counter-clockwise as seen from outside
    arcs: dict[int, dict[int, tuple[int, Integers, Vector]]] = {v: {} for v in range(len(vertices))}
    shares = np.arange(steps)[:, None] / steps
    for one, two, left, right in core.edges:
        around = _between(normals[right], normals[left : left + 1], shares)
        rows = [np.concatenate([corner[v, right], put(v, around[1:]), corner[v, left]]) for v in (one, two)]
        a, b, c, d = rows[0][:-1], rows[0][1:], rows[1][:-1], rows[1][1:]
        triangles += [np.column_stack([a, c, d]), np.column_stack([a, d, b])]
        arcs[one][right] = left, rows[0][:-1], around
        backwards = np.concatenate([normals[left : left + 1], around[:0:-1]])
        arcs[two][left] = right, rows[1][:0:-1], backwards
    for vertex, own in arcs.items():
        start = at = next(iter(own))
        loop, rim = list[Integers](), list[Vector]()
        while True:
            at, row, directions = own[at]
            loop.append(row)
            rim.append(directions)
            if at == start:
                break
        ends, outward = np.concatenate(loop), np.concatenate(rim)
        axis = np.sum([normals[f] for f in own], axis=0)
        axis /= np.linalg.norm(axis)
        before = np.repeat(put(vertex, axis[None]), len(ends))
        for ring in range(1, steps + 1):
            now = ends if ring == steps else put(vertex, _between(axis, outward, ring / steps))
            after = np.roll(now, -1)
            triangles.append(np.column_stack([before, now, after]))
            if ring > 1:
                triangles.append(np.column_stack([before, after, np.roll(before, -1)]))
            before = now
    return np.concatenate(blocks), np.concatenate(triangles)


def _between(m: Vector, n: Vector, share: Vector | float) -> Vector:
    """Return the unit vectors so far on the way from m to all n, shape [k, 3], along their great circles."""
    angle = np.arctan2(np.linalg.norm(np.cross(m, n), axis=1), n @ m)[:, None]
    flat = angle == 0.0
    angle = np.where(flat, 1.0, angle)
    found = (np.sin((1.0 - share) * angle) * m + np.sin(share * angle) * n) / np.sin(angle)
    return np.asarray(np.where(flat, m, found))
