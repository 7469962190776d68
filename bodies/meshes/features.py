"""Flat faces, convex edges and corners of a closed surface of triangles: what another body can touch."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces.body import Vector

from .convexity import BENT
from .topology import Integers, neighbours

Edge: TypeAlias = tuple[int, int, int, int]
Bools: TypeAlias = NDArray[np.bool_]

FLAT = 1e-9
"""Sine of an angle between faces below which there is no edge."""
_IN_LINE = 1e-9
"""Sine of an angle below which edges go on in line."""
_POINTED = 1e-7
"""Distance of the hull of the unit vectors along the edges of a corner from the corner, below which it has no tip."""
_ROUNDS = 20
PROTRUDING = 1e-9
"""Height over the plane of another face, relative to the size of the surface, above which a face protrudes from it.

A smaller height is round-off of faces in one plane.  A body may touch two faces together only if each protrudes from
the plane of the other.
"""
_AT_ONCE = 1_000_000
"""Number of pairs of a face and a vertex that are examined together, which limits the memory."""


@final
@dataclass(frozen=True, eq=False)
class Features:
    """The parts of a surface that can touch.

    Attributes
    ----------
    vertices : Vector
        Vertices [m], shape [n, 3], moved so that faces are flat that were so but for the digits of their file.
    triangles : Integers
        Triangles, counter-clockwise seen from outside, shape [m, 3].
    face_of : Integers
        The flat face of every triangle, shape [m].
    planes : Vector
        Outward unit normal of every face and distance of its plane from the origin [m], shape [k, 4].
    inner : Bools
        Whether the edge after each vertex of a triangle has the same face on its other side, shape [m, 3].
    edges : tuple
        Convex edges, parts in line made one: two vertices, and the faces on the left and the right.
    corners : tuple of int
        Vertices that a plane can touch with none of their edges in it.
    stars : tuple of tuple of int
        The vertices at the other ends of the edges of each corner.
    """

    vertices: Vector
    triangles: Integers
    face_of: Integers
    planes: Vector
    inner: Bools
    edges: tuple[Edge, ...]
    corners: tuple[int, ...]
    stars: tuple[tuple[int, ...], ...]

    @property
    def size(self) -> float:
        """Diagonal of the box round it [m]."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    @functools.cached_property
    def is_convex(self) -> bool:
        """Whether no vertex is above the plane of a face, but for round-off."""
        return not np.any(self.protrusions > PROTRUDING * self.size)

    @functools.cached_property
    def protrusions(self) -> Vector:
        """Largest height of a vertex over the plane of each face [m], shape [k]: 0 for a face of the convex hull."""
        from scipy.spatial import ConvexHull

        if len(self.planes) == 0:
            return np.zeros(0)
        tips = self.vertices[ConvexHull(self.vertices).vertices]
        chunks = np.array_split(self.planes, 1 + len(self.planes) * len(tips) // _AT_ONCE)
        return np.concatenate([np.max(chunk[:, :3] @ tips.T, axis=1) for chunk in chunks]) - self.planes[:, 3]

    @property
    def faces_at(self) -> tuple[frozenset[int], ...]:
        """The faces round every vertex."""
        found: list[set[int]] = [set() for _ in self.vertices]
        for face, triangle in zip(self.face_of.tolist(), self.triangles.tolist(), strict=True):
            for vertex in triangle:
                found[vertex].add(face)
        return tuple(frozenset(one) for one in found)


def features_of(vertices: Vector, triangles: Integers) -> Features:
    """Return the parts of a closed surface [m], shapes [n, 3] and [m, 3]."""
    pairs = neighbours(triangles)
    face_of = _merged(vertices, triangles, pairs)
    vertices, planes = _flattened(vertices, triangles, face_of)
    heights = _heights(vertices, triangles, face_of, planes, pairs)
    owner = face_of[pairs // 3]
    inner = np.zeros(triangles.size, dtype=bool)
    inner[pairs[owner[:, 0] == owner[:, 1]].ravel()] = True
    flat = (owner[:, 0] == owner[:, 1]) | (np.abs(heights) <= FLAT)
    ends = np.stack([triangles.reshape(-1)[pairs[:, 0]], triangles.reshape(-1)[_after(pairs[:, 0])]], axis=1)
    convex = ~flat & (heights < 0.0)
    rows = [(*end, *own) for end, own in zip(ends[convex].tolist(), owner[convex].tolist(), strict=True)]
    edges = _in_one(vertices, [(a, b, c, d) for a, b, c, d in rows], ends[~flat])
    corners, stars = _corners(vertices, ends, flat)
    return Features(vertices, triangles, face_of, planes, inner.reshape(-1, 3), edges, corners, stars)


def _after(half: Integers) -> Integers:
    """Return the half edges that follow in the same triangles."""
    return np.asarray(half // 3 * 3 + (half % 3 + 1) % 3)


def _normals(vertices: Vector, triangles: Integers) -> Vector:
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a)


def _merged(vertices: Vector, triangles: Integers, pairs: Integers) -> Integers:
    """Return the number of the face of every triangle: neighbours in the plane of the largest, but for digits."""
    crosses = _normals(vertices, triangles)
    areas = np.linalg.norm(crosses, axis=1)
    shallow = BENT * max(float(np.max(np.ptp(vertices, axis=0))), float(np.max(np.abs(vertices))))
    beside: list[list[int]] = [[] for _ in triangles]
    for one, two in (pairs // 3).tolist():
        beside[one].append(two)
        beside[two].append(one)
    face_of, count = np.full(len(triangles), -1, dtype=np.int64), 0
    for seed in np.argsort(-areas, kind="stable").tolist():
        if face_of[seed] >= 0:
            continue
        normal, point, heap = crosses[seed] / areas[seed], vertices[triangles[seed, 0]], [seed]
        face_of[seed] = count
        while heap:
            for other in beside[heap.pop()]:
                if face_of[other] < 0 and crosses[other] @ normal > 0.0:
                    out = (vertices[triangles[other]] - point) @ normal
                    if np.max(np.abs(out)) <= shallow:
                        face_of[other] = count
                        heap.append(other)
        count += 1
    return face_of


def _flattened(vertices: Vector, triangles: Integers, face_of: Integers) -> tuple[Vector, Vector]:
    """Return the vertices moved to the planes of their faces, and the planes, fitted in turn."""
    n_faces = int(np.max(face_of)) + 1
    about = np.unique(np.stack([np.repeat(face_of, 3), triangles.reshape(-1)], axis=1), axis=0)
    counts = np.bincount(about[:, 0], minlength=n_faces)
    flat = counts[about[:, 0]] > 3
    order = np.argsort(about[flat, 1], kind="stable")
    own = about[flat][order]
    starts = np.flatnonzero(np.diff(own[:, 1], prepend=-1))
    # from the middle, so that a body far from the origin loses no digits
    middle = 0.5 * (np.min(vertices, axis=0) + np.max(vertices, axis=0))
    size, local = float(np.max(np.ptp(vertices, axis=0))), vertices - middle
    planes = _planes(local, triangles, face_of, about, counts)
    for _ in range(_ROUNDS):
        before, local = local, local.copy()
        for group in np.split(own, starts[1:]) if len(own) else []:
            vertex, rows = int(group[0, 1]), planes[group[:, 0]]
            out = rows[:, 3] - rows[:, :3] @ local[vertex]
            if np.max(np.abs(out)) > 1e-17 * size:
                local[vertex] += np.linalg.lstsq(rows[:, :3], out, rcond=1e-6)[0]
        planes = _planes(local, triangles, face_of, about, counts)
        if np.max(np.abs(local - before)) <= 1e-16 * size:
            break
    moved = local + middle
    return moved, _planes(moved, triangles, face_of, about, counts)


def _planes(vertices: Vector, triangles: Integers, face_of: Integers, about: Integers, counts: Integers) -> Vector:
    """Return normal and height of every face: the normal by areas, the height the mean of its vertices."""
    normals = np.zeros((len(counts), 3))
    np.add.at(normals, face_of, _normals(vertices, triangles))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    sums = np.zeros(len(counts))
    np.add.at(sums, about[:, 0], np.einsum("ni,ni->n", normals[about[:, 0]], vertices[about[:, 1]]))
    return np.column_stack([normals, sums / counts])


def _heights(vertices: Vector, triangles: Integers, face_of: Integers, planes: Vector, pairs: Integers) -> Vector:
    """Return the sine of the angle by which the second face of every pair rises over the first; below 0 if convex."""
    one, two = face_of[pairs[:, 0] // 3], face_of[pairs[:, 1] // 3]
    half = pairs[:, 0]
    along = vertices[triangles.reshape(-1)[_after(half)]] - vertices[triangles.reshape(-1)[half]]
    along /= np.linalg.norm(along, axis=1)[:, None]
    # counter-clockwise round the first face; round the second the other way
    inward = np.cross(along, planes[two, :3])
    return np.asarray(np.einsum("ni,ni->n", inward, planes[one, :3]))


def _in_one(vertices: Vector, rows: list[Edge], sharp: Integers) -> tuple[Edge, ...]:
    """Return the edges with those in line between the same faces made one."""
    degree = np.bincount(sharp.ravel(), minlength=len(vertices))
    begins: dict[tuple[int, int, int], Edge] = {}
    for row in rows:
        begins[row[0], row[2], row[3]] = row
        begins[row[1], row[3], row[2]] = (row[1], row[0], row[3], row[2])
    way = {row[:2]: vertices[row[1]] - vertices[row[0]] for row in begins.values()}
    done, found = set[tuple[int, int]](), []

    def onward(row: Edge) -> Edge | None:
        after = begins.get((row[1], row[2], row[3])) if degree[row[1]] == 2 else None
        if after is None or after[1] == row[0]:
            return None
        one, two = way[row[:2]], way[after[:2]]
        bend = np.linalg.norm(np.cross(one, two)) / np.linalg.norm(one) / np.linalg.norm(two)
        return after if one @ two > 0.0 and bend <= _IN_LINE else None

    for row in rows:
        if row[:2] in done:
            continue
        ends = []
        for first in (row, (row[1], row[0], row[3], row[2])):
            last: Edge = first
            done |= {last[:2], last[1::-1]}
            while (after := onward(last)) is not None and after[:2] not in done:
                last = after
                done |= {last[:2], last[1::-1]}
            ends.append(last[1])
        found.append((ends[1], ends[0], row[2], row[3]))
    return tuple(found)


def _corners(vertices: Vector, ends: Integers, flat: Bools) -> tuple[tuple[int, ...], tuple[tuple[int, ...], ...]]:
    """Return the vertices that are a tip of all their edges, and the other ends of those that are not flat."""
    stars: list[list[tuple[int, bool]]] = [[] for _ in vertices]
    for (one, two), level in zip(ends.tolist(), flat.tolist(), strict=True):
        stars[one].append((two, level))
        stars[two].append((one, level))
    corners, found = [], []
    for vertex, star in enumerate(stars):
        sharp = tuple(other for other, level in star if not level)
        if len(sharp) >= 3 and _is_pointed(vertices[[other for other, _ in star]] - vertices[vertex]):
            corners.append(vertex)
            found.append(sharp)
    return tuple(corners), tuple(found)


def _is_pointed(ways: Vector) -> bool:
    """Return whether some plane has all of these vectors strictly on one side."""
    from scipy.optimize import nnls

    ways = ways / np.linalg.norm(ways, axis=1)[:, None]
    middle = np.sum(ways, axis=0)
    if np.min(ways @ middle) > _POINTED * np.linalg.norm(middle):
        return True
    rows, wanted = np.vstack([ways.T, np.ones(len(ways))]), np.array([0.0, 0.0, 0.0, 1.0])
    # the distance of their hull from the origin is 0 where they go all ways
    return bool(nnls(rows, wanted)[1] > _POINTED)
