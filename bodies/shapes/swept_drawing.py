"""The mesh to draw a polyhedron swept by a sphere with."""

from __future__ import annotations

import itertools

import numpy as np

from bodies.shapes.drawing import check_fineness
from bodies.shapes.polytope import Polytope
from nonsmooth.interfaces.body import Vector


def draw_swept(core: Polytope, radius: float, fineness: int) -> tuple[Vector, Vector]:
    """Return vertices [m], shape [n, 3], and triangles, shape [m, 3], of all points within a radius of a polyhedron.

    Every face is shifted outward, every edge becomes a strip with a quarter of ``fineness`` steps, and every vertex as
    many rings about the mean normal of its faces.
    """
    check_fineness(fineness)
    steps = -(-fineness // 4)
    vertices, normals = np.array(core.vertices), np.array(core.planes)[:, :3]
    points: list[Vector] = []
    triangles: list[tuple[int, int, int]] = []

    def put(vertex: int, direction: Vector) -> int:
        points.append(vertices[vertex] + radius * direction / np.linalg.norm(direction))
        return len(points) - 1

    corner = {(v, f): put(v, normals[f]) for f, face in enumerate(core.faces) for v in face}
    for f, face in enumerate(core.faces):
        triangles += [(corner[face[0], f], corner[a, f], corner[b, f]) for a, b in itertools.pairwise(face[1:])]
    # the arc round a vertex from one of its faces to the next, counter-clockwise as seen from outside
    arcs: dict[int, dict[int, tuple[int, list[int]]]] = {v: {} for v in range(len(vertices))}
    for one, two, left, right in core.edges:
        inner = [_between(normals[right], normals[left], i / steps) for i in range(1, steps)]
        rows = [[corner[v, right], *(put(v, n) for n in inner), corner[v, left]] for v in (one, two)]
        for (a, b), (c, d) in zip(itertools.pairwise(rows[0]), itertools.pairwise(rows[1]), strict=True):
            triangles += [(a, c, d), (a, d, b)]
        arcs[one][right] = left, rows[0]
        arcs[two][left] = right, rows[1][::-1]
    for vertex, own in arcs.items():
        start = at = next(iter(own))
        loop: list[int] = []
        while True:
            at, row = own[at]
            loop += row[:-1]
            if at == start:
                break
        axis = np.sum([normals[f] for f in own], axis=0)
        axis /= np.linalg.norm(axis)
        rim = [(points[i] - vertices[vertex]) / radius for i in loop]
        before = [put(vertex, axis)] * len(loop)
        for ring in range(1, steps + 1):
            now = loop if ring == steps else [put(vertex, _between(axis, n, ring / steps)) for n in rim]
            for i in range(len(loop)):
                j = (i + 1) % len(loop)
                triangles.append((before[i], now[i], now[j]))
                if ring > 1:
                    triangles.append((before[i], now[j], before[j]))
            before = now
    return np.array(points), np.array(triangles)


def _between(m: Vector, n: Vector, share: float) -> Vector:
    """Return the unit vector so far on the way from m to n along their great circle."""
    angle = float(np.arctan2(np.linalg.norm(np.cross(m, n)), m @ n))
    if angle == 0.0:
        return m
    return np.asarray((np.sin((1.0 - share) * angle) * m + np.sin(share * angle) * n) / np.sin(angle))
