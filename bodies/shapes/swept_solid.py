"""Mass properties and drawing of a polyhedron swept by a sphere, piece by piece.

Every face of the core carries a prism as high as the radius, every edge a wedge of a cylinder, and every vertex the
sector of a ball, whose directions lie between the normals of the vertex's faces (J. Steiner's formula, for the moments
too).
"""

from __future__ import annotations

import functools
import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces.body import Vector

from .drawing import check_fineness, solid_of
from .polytope import Polytope

Integrals = tuple[float, Vector, Vector]
"""Volume [m^3], centroid [m], inertia tensor at density 1 about the centroid [m^5]."""


@dataclass
class _Sums:
    """Sums over the pieces of a body of the integrals of 1, x and x x^T."""

    volume: float
    first: Vector
    second: Vector

    def add(self, place: Vector, volume: float, first: Vector, second: Vector) -> None:
        """Add a piece, whose integrals of x and x x^T are relative to the point ``place`` [m]."""
        cross = np.outer(place, first)
        self.volume += volume
        self.first += volume * place + first
        self.second += volume * np.outer(place, place) + cross + cross.T + second


@functools.lru_cache(maxsize=64)
def swept_solid(core: Polytope, radius: float) -> Integrals:
    """Return volume, centroid and inertia, read-only, of all points within ``radius`` [m] of a polyhedron.

    Parameters
    ----------
    core : Polytope
        The polyhedron.
    radius : float
        Radius of the sphere [m].
    """
    vertices, normals = np.array(core.vertices), np.array(core.planes)[:, :3]
    middle = np.mean(vertices, axis=0)
    vertices -= middle
    sums = _Sums(0.0, np.zeros(3), np.zeros((3, 3)))

    def add_mesh(points: Vector, triangles: Vector) -> None:
        volume, centroid, inertia = solid_of(points, triangles)
        sums.add(centroid, volume, np.zeros(3), 0.5 * np.trace(inertia) * np.eye(3) - inertia)

    add_mesh(vertices, np.array(core.triangles))
    for face, normal in zip(core.faces, normals, strict=True):
        bottom = vertices[list(face)]
        add_mesh(np.vstack([bottom, bottom + radius * normal]), _prism(len(face)))
    angles = np.zeros(len(vertices))
    firsts, seconds = np.zeros((len(vertices), 3)), np.zeros((len(vertices), 3, 3))
    for one, two, left, right in core.edges:
        m, n = normals[left], normals[right]
        along = (vertices[two] - vertices[one]) / np.linalg.norm(vertices[two] - vertices[one])
        angle = math.atan2(float(np.linalg.norm(np.cross(m, n))), float(m @ n))
        _add_wedge(sums, vertices[one], vertices[two], (m + n) / np.linalg.norm(m + n), angle, radius)
        # the arc between the normals is the same at both ends, on either side of the directions of the vertex
        for vertex, inward in ((one, -along), (two, along)):
            firsts[vertex] += 0.5 * angle * inward
            seconds[vertex] += math.tan(0.5 * angle) / 3.0 * np.outer(m + n, inward)
    for face in core.faces:
        corners = vertices[list(face)]
        before, after = np.roll(corners, 1, axis=0) - corners, np.roll(corners, -1, axis=0) - corners
        across = np.linalg.norm(np.cross(before, after), axis=1)
        angles[list(face)] += np.arctan2(across, np.sum(before * after, axis=1))
    for i, place in enumerate(vertices):
        # the integrals over the directions, by the theorems of Gauss and Bonnet and of Gauss on the cone under them
        solid_angle = 2.0 * math.pi - angles[i]
        second = solid_angle / 3.0 * np.eye(3) + 0.5 * (seconds[i] + seconds[i].T)
        sums.add(place, solid_angle * radius**3 / 3.0, firsts[i] * radius**4 / 4.0, second * radius**5 / 5.0)
    centroid = sums.first / sums.volume
    about = sums.second - sums.volume * np.outer(centroid, centroid)
    inertia = np.trace(about) * np.eye(3) - about
    centroid = centroid + middle
    centroid.flags.writeable = inertia.flags.writeable = False
    return sums.volume, centroid, inertia


def _prism(n: int) -> Vector:
    """Return the triangles of a prism with n corners; vertices are numbered first below, then above."""
    fan = [(0, i + 1, i) for i in range(1, n - 1)]
    top = [(n, n + i, n + i + 1) for i in range(1, n - 1)]
    sides = [(i, (i + 1) % n, n + (i + 1) % n) for i in range(n)] + [(i, n + (i + 1) % n, n + i) for i in range(n)]
    return np.array(fan + top + sides)


def _add_wedge(sums: _Sums, one: Vector, two: Vector, middle: Vector, angle: float, radius: float) -> None:
    """Add the integrals of 1, x and x x^T over a wedge of a cylinder to ``sums``.

    The axis of the cylinder is the edge from ``one`` to ``two`` [m].  The wedge has the opening ``angle`` [rad] and the
    bisector ``middle``, a unit vector.
    """
    way = two - one
    length = float(np.linalg.norm(way))
    across = np.cross(way / length, middle)
    volume = 0.5 * angle * radius**2 * length
    first = 2.0 / 3.0 * radius**3 * math.sin(0.5 * angle) * length * middle
    outward = radius**4 / 8.0 * length * (angle + math.sin(angle)) * np.outer(middle, middle)
    sideways = radius**4 / 8.0 * length * (angle - math.sin(angle)) * np.outer(across, across)
    sums.add(0.5 * (one + two), volume, first, outward + sideways + volume / 12.0 * np.outer(way, way))


Integers = NDArray[np.int64]


def draw_swept(core: Polytope, radius: float, fineness: int) -> tuple[Vector, Vector]:
    """Return vertices [m], shape [n, 3], and triangles, shape [m, 3], of all points within a radius of a polyhedron.

    Every face is shifted outward by the radius.  Every edge becomes a strip of ``fineness`` / 4 steps, rounded up.
    Every vertex becomes a cap of the same number of rings about the mean normal of its faces.
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
    # arcs[vertex][face]: the arc about the vertex from this face to the next, counter-clockwise as seen from outside;
    # its entries: the next face, the indices of the arc's points without the last, the unit vectors to these points
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
    """Return the unit vectors at the fraction ``share`` of the great circles from m to all n, shape [k, 3]."""
    angle = np.arctan2(np.linalg.norm(np.cross(m, n), axis=1), n @ m)[:, None]
    flat = angle == 0.0
    angle = np.where(flat, 1.0, angle)
    found = (np.sin((1.0 - share) * angle) * m + np.sin(share * angle) * n) / np.sin(angle)
    return np.asarray(np.where(flat, m, found))
