"""Patches of a surface: sets of features of which a convex body touches one at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import final

import numpy as np

from bodies.meshes.features import Bools, Features
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

MOST_FACES = 10000
"""Surfaces with more flat faces are refused: each face is held against each."""
_ABOVE = 1e-9
"""Height over a plane, in sizes of the surface, from which a face counts as standing out of it."""
_AROUND = 1.1
"""Factor on the radius of the touching body, for what it may touch while it overlaps or is not quite there."""


@final
@dataclass(frozen=True, eq=False)
class Patches:
    """The patch of every face, convex edge and corner, from 0.

    Attributes
    ----------
    of_faces, of_edges, of_corners : tuple of int
        Their numbers.
    """

    of_faces: tuple[int, ...]
    of_edges: tuple[int, ...]
    of_corners: tuple[int, ...]

    @property
    def count(self) -> int:
        """How many there are: 1 for a convex surface."""
        return 1 + max(self.of_faces + self.of_edges + self.of_corners)


@lru_cache(maxsize=4)
def patches_for_ball(features: Features, radius: float) -> Patches:
    """Return patches for a ball of a radius [m]; points p and q that it touches are r |n_p - n_q| from each other."""
    normals = features.planes[:, :3]
    return _patches(features, lambda i: radius * np.linalg.norm(normals - normals[i], axis=1))


@lru_cache(maxsize=4)
def patches_for_body(features: Features, diameter: float) -> Patches:
    """Return patches for a convex body of a diameter [m]; 0 for a vertex."""
    return _patches(features, lambda _: np.full(len(features.planes), diameter))


def _patches(features: Features, reach: Callable[[int], Vector]) -> Patches:
    """Return patches, where ``reach`` says how far from each other a body may touch a face and each other one [m].

    A body that touches points p and q of two faces from outside lies over both planes: each of the two faces has a
    point over the plane of the other.  Faces of which that is not so, such as all of a convex surface, can be in one
    patch, however a body moves, and so can edges and corners whose faces all get on with all others.

    Faces are taken one after the other over convex edges, and go with a neighbour where they can, because a body that
    rolls from one patch to another changes its contact.

    Raises
    ------
    InvalidInput
        If there are more than :data:`MOST_FACES` faces.
    """
    n_faces = len(features.planes)
    if n_faces > MOST_FACES:
        raise InvalidInput(
            "a mesh that is not convex",
            f"must have at most {MOST_FACES} flat faces to touch other bodies than planes",
            n_faces,
            "Take a coarser mesh, or give its body a decomposition into convex pieces.",
        )
    excludes = _conflicts(features, reach)
    if not np.any(excludes):
        return Patches((0,) * n_faces, (0,) * len(features.edges), (0,) * len(features.corners))
    colours = _Colours(excludes)
    beside: list[list[int]] = [[] for _ in range(n_faces)]
    for _, _, left, right in features.edges:
        beside[left].append(right)
        beside[right].append(left)
    of_faces = [-1] * n_faces
    areas = _areas(features)
    for seed in np.argsort(-areas, kind="stable").tolist():
        queue = [seed] if of_faces[seed] < 0 else []
        for face in queue:
            if of_faces[face] >= 0:
                continue
            near = sorted({of_faces[other] for other in beside[face]} - {-1})
            of_faces[face] = colours.of((face,), near)
            queue += [other for other in beside[face] if of_faces[other] < 0]
    of_edges = [colours.of(edge[2:], sorted({of_faces[edge[2]], of_faces[edge[3]]})) for edge in features.edges]
    around = features.faces_at
    of_corners = [colours.of(around[v], sorted({of_faces[f] for f in around[v]})) for v in features.corners]
    return Patches(tuple(of_faces), tuple(of_edges), tuple(of_corners))


class _Colours:
    """A greedy colouring of sets of faces."""

    def __init__(self, excludes: Bools) -> None:
        self._excludes = excludes
        self._members: list[Bools] = []

    def of(self, faces: Iterable[int], preferred: list[int]) -> int:
        """Return the first colour that takes these faces, the preferred ones first."""
        own = list(faces)
        out = np.any(self._excludes[own], axis=0)
        for colour in (*preferred, *range(len(self._members))):
            if not np.any(out & self._members[colour]):
                self._members[colour][own] = True
                return int(colour)
        self._members.append(np.zeros(len(out), dtype=bool))
        self._members[-1][own] = True
        return len(self._members) - 1


def _areas(features: Features) -> Vector:
    a, b, c = (features.vertices[features.triangles[:, i]] for i in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.asarray(np.bincount(features.face_of, areas, len(features.planes)), dtype=float)


def _conflicts(features: Features, reach: Callable[[int], Vector]) -> Bools:
    """Return for every two faces whether a body may touch both, shape [k, k]."""
    faces = np.repeat(features.face_of, 3)
    order = np.argsort(faces, kind="stable")
    points = features.vertices[features.triangles.reshape(-1)[order]]
    starts = np.searchsorted(faces[order], np.arange(len(features.planes)))
    low, high = np.minimum.reduceat(points, starts), np.maximum.reduceat(points, starts)
    least = _ABOVE * features.size
    out = np.zeros((len(starts), len(starts)), dtype=bool)
    for i, plane in enumerate(features.planes):
        apart = np.linalg.norm(np.maximum(np.maximum(low - high[i], low[i] - high), 0.0), axis=1)
        out[i] = (np.maximum.reduceat(points @ plane[:3], starts) - plane[3] > least) & (
            apart <= _AROUND * reach(i) + least
        )
    return np.asarray(out & out.T)
