"""Vertices, faces and edges of the convex hull of points."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

from ..meshes.features import Features

Point = tuple[float, float, float]
MOST_VERTICES = 500
"""A hull with more vertices is refused: every one of them is a contact of its own."""
_SAME = 1e-9
"""Points nearer than this part of the size are one, planes that differ by as much or this angle [rad] too."""
_FLAT = 1e-6
"""Points within a layer thinner than this part of the size have no volume."""


@final
@dataclass(frozen=True)
class Polytope:
    """A convex polyhedron, no three of its vertices of one face in line.

    Attributes
    ----------
    vertices : tuple
        Coordinates [m, shape (n, 3)].
    faces : tuple of tuple of int
        Vertices round every face, counter-clockwise seen from outside.
    planes : tuple
        Outward unit normal of every face and distance of its plane from the origin [m, shape (m, 4)].
    edges : tuple
        Two vertices, the face that has them in this order, and the one that has them in the other, shape [k, 4]; of a
        segment, which has no faces, -1.
    """

    vertices: tuple[Point, ...]
    faces: tuple[tuple[int, ...], ...]
    planes: tuple[tuple[float, float, float, float], ...]
    edges: tuple[tuple[int, int, int, int], ...]

    @property
    def triangles(self) -> tuple[tuple[int, int, int], ...]:
        """The faces as fans."""
        return tuple((f[0], f[i], f[i + 1]) for f in self.faces for i in range(1, len(f) - 1))

    @property
    def features(self) -> Features:
        """The polyhedron as a surface, with the numbers of its faces, edges and vertices."""
        numbers = range(len(self.vertices))
        pairs = [(i, j) for one, two, *_ in self.edges for i, j in ((one, two), (two, one))]
        return Features(
            np.array(self.vertices),
            np.array(self.triangles, dtype=np.int64).reshape(-1, 3),
            np.repeat(np.arange(len(self.faces)), [len(face) - 2 for face in self.faces]),
            np.array(self.planes).reshape(-1, 4),
            # of a fan, the sides next to its first vertex are inside of the face, but for the first and the last one
            np.array([(i > 1, False, i < len(f) - 2) for f in self.faces for i in range(1, len(f) - 1)]).reshape(-1, 3),
            self.edges,
            tuple(numbers),
            tuple(tuple(j for i, j in pairs if i == vertex) for vertex in numbers),
        )

    @property
    def size(self) -> float:
        """Diagonal of the box round it [m]."""
        return math.dist(np.min(self.vertices, axis=0), np.max(self.vertices, axis=0))


def read_points(thing: str, points: object) -> tuple[Point, ...]:
    """Return points as tuples of floats.

    Raises
    ------
    InvalidInput
        Unless they are at least four, of three finite numbers each.
    """
    try:
        array = np.array(points, dtype=float)
    except (TypeError, ValueError):
        array = np.zeros(0)
    if array.ndim != 2 or array.shape[1] != 3 or len(array) < 4:
        raise InvalidInput(thing, "must be at least four points of three numbers [m]", points, "Give vertices.")
    if not np.all(np.isfinite(array)):
        wrong = int(np.flatnonzero(~np.all(np.isfinite(array), axis=1))[0])
        raise InvalidInput(f"{thing}[{wrong}]", "must be finite [m]", array[wrong].tolist(), "Remove the point.")
    return tuple((x, y, z) for x, y, z in array.tolist())


@functools.lru_cache(maxsize=1000)
def polytope_of(thing: str, points: tuple[Point, ...]) -> Polytope:
    """Return the convex hull of points [m], by Qhull, with facets in one plane merged.

    Raises
    ------
    InvalidInput
        If the points have no volume, or their hull more than :data:`MOST_VERTICES` vertices.
    """
    from scipy.spatial import ConvexHull

    array = np.array(points)
    middle = 0.5 * (np.min(array, axis=0) + np.max(array, axis=0))
    size = float(np.max(np.abs(array - middle)))
    unit = (array - middle) / size if size > 0.0 else array - middle
    spread = np.linalg.svd(unit, compute_uv=False)
    if spread[2] <= _FLAT * spread[0]:
        raise InvalidInput(
            thing,
            "must be points that do not lie in one plane",
            f"points within {spread[2] * size:.3g} m of a plane",
            "A hull needs a volume; give a flat body some thickness.",
        )
    hull = ConvexHull(unit)
    if len(hull.vertices) > MOST_VERTICES:
        raise InvalidInput(
            thing,
            f"must have a hull of at most {MOST_VERTICES} vertices",
            len(hull.vertices),
            "Simplify it, or take a smooth shape: every vertex is a contact of its own.",
        )
    loops = [_loop(hull.simplices[group], unit, hull.equations[group[0], :3]) for group in _coplanar(hull)]
    return _assemble(thing, loops, unit, array)


def _coplanar(hull: Any) -> list[list[int]]:
    """Return the groups of neighbouring facets in one plane."""
    equations, neighbours = hull.equations, hull.neighbors
    group_of: dict[int, int] = {}
    groups: list[list[int]] = []
    for seed in range(len(equations)):
        if seed in group_of:
            continue
        group, heap = len(groups), [seed]
        groups.append([])
        group_of[seed] = group
        while heap:
            facet = heap.pop()
            groups[group].append(facet)
            for other in neighbours[facet].tolist():
                # against the seed, so that a finely faceted round side does not become one face
                if other not in group_of and np.max(np.abs(equations[other] - equations[seed])) <= _SAME:
                    group_of[other] = group
                    heap.append(other)
    return groups


def _loop(simplices: Vector, points: Vector, normal: Vector) -> list[int]:
    """Return the vertices round a face, counter-clockwise."""
    found = np.unique(simplices)
    center = np.mean(points[found], axis=0)
    first = points[found[0]] - center
    first = first - normal * (first @ normal)
    second = np.cross(normal, first)
    angles = [math.atan2((points[i] - center) @ second, (points[i] - center) @ first) for i in found]
    return [int(found[i]) for i in np.argsort(angles)]


def _assemble(thing: str, loops: list[list[int]], unit: Vector, array: Vector) -> Polytope:
    # a point inside a face is on one of them, one within an edge on two
    counts = np.zeros(len(unit), dtype=int)
    for loop in loops:
        counts[loop] += 1
    kept = np.flatnonzero(counts >= 3)
    number = {int(old): new for new, old in enumerate(kept)}
    faces = tuple(tuple(number[i] for i in loop if i in number) for loop in loops)
    vertices = array[kept]
    nearest = min(float(np.min(np.linalg.norm(unit[kept[:i]] - unit[kept[i]], axis=1))) for i in range(1, len(kept)))
    sides: dict[tuple[int, int], int] = {}
    for face, corners in enumerate(faces):
        for one, two in zip(corners, corners[1:] + corners[:1], strict=True):
            sides[one, two] = face
    twins = all((two, one) in sides for one, two in sides)
    if nearest < _SAME or not twins or len(vertices) + len(faces) != len(sides) // 2 + 2:
        raise InvalidInput(
            thing,
            "must have vertices that can be told apart",
            f"points {nearest * float(np.max(np.abs(array))):.3g} m from each other",
            f"Merge points nearer than {_SAME:g} of the size, and faces nearly in one plane.",
        )
    return Polytope(
        tuple((x, y, z) for x, y, z in vertices.tolist()),
        faces,
        tuple(_plane(vertices[list(face)]) for face in faces),
        tuple((one, two, face, sides[two, one]) for (one, two), face in sides.items() if one < two),
    )


def _plane(corners: Vector) -> tuple[float, float, float, float]:
    """Return the plane through the corners of a face, by the areas that it throws on the coordinate planes."""
    center = np.mean(corners, axis=0)
    around = corners - center
    x, y, z = np.sum(np.cross(around, np.roll(around, -1, axis=0)), axis=0)
    area = math.sqrt(x * x + y * y + z * z)
    normal = np.array([x / area, y / area, z / area])
    # no vertex stands out of it
    return float(normal[0]), float(normal[1]), float(normal[2]), float(np.max(corners @ normal))
