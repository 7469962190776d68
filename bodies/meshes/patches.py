"""Patches of a surface: sets of features; a convex body touches at most one feature of a patch at a time."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias, final
from weakref import WeakKeyDictionary

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector
from nonsmooth.notices import say

from .features import PROTRUDING, Bools, Features
from .topology import Integers

_AT_ONCE, MOST_PAIRS = 1_000_000, 200_000_000
"""Largest numbers of pairs of near faces.

``_AT_ONCE``: pairs that are examined together, which limits the memory.  ``MOST_PAIRS``: pairs of a mesh in all; a mesh
with more pairs is refused by :class:`nonsmooth.errors.InvalidInput`.
"""
_SAMPLE = 1000
"""Number of faces in the sample whose pairs of near faces are counted to estimate the cost of all pairs.

The pairs of a surface with fewer faces are not counted, because they cost little.
"""
_COSTS = np.array([[3500.0, 6.5e-5], [0.0, 2.9e-7], [90.0, 0.0], [170.0, 3e-6]])
"""Memory [B] and time [s] per item to prepare the contacts of a mesh: columns 0 and 1, one kind of item a row.

The kinds are, in this order: triangles, convex edges and corners; pairs of near faces; pairs of near faces that are
examined together (at most ``_AT_ONCE``); pairs of faces in conflict, which a body may touch together.
"""
_MUCH, _LONG = 1.2e8, 2.0
"""Memory [B] and time [s] for the preparation of contacts above which a notice announces it."""
Reach: TypeAlias = Callable[[Integers, Integers], Vector]
Search: TypeAlias = Callable[[int], Iterator[tuple[Integers, Integers, Bools]]]
"""Function ``search(every)`` that yields pairs of near faces as three arrays.

The arrays are the numbers of the first faces, the numbers of the second faces, and whether a body may touch both
faces together (a conflict).  With ``every`` above 1, only pairs with every such face are found, as a sample.
"""
_AROUND = 1.1
"""Safety factor on the largest distance of two faces that a body can touch together.

Contacts are also evaluated at small overlaps and at small gaps, at which a body reaches farther than at touch.
"""


@final
@dataclass(frozen=True, eq=False)
class Patches:
    """Division of a surface into patches: the number of the patch, from 0, of each face, convex edge and corner.

    Attributes
    ----------
    of_faces, of_edges, of_corners : tuple of int
        Number of the patch of each face, each convex edge and each corner.
    """

    of_faces: tuple[int, ...]
    of_edges: tuple[int, ...]
    of_corners: tuple[int, ...]

    @property
    def count(self) -> int:
        """Number of patches: 1 for a convex surface."""
        return 1 + max(self.of_faces + self.of_edges + self.of_corners)


_PATCHES: WeakKeyDictionary[Features, dict[tuple[float, bool], Patches]] = WeakKeyDictionary()
"""Patches that were made, by the size of the body and whether it is a ball, as long as their surface exists.

Those of single faces have the size -1.
"""


def patches_for_ball(features: Features, radius: float) -> Patches:
    """Return patches of a surface for contacts with a ball of the radius r [m].

    If the ball touches two faces with the normals n and m, its contact points are r |n - m| apart.
    """
    normals = features.planes[:, :3]

    def reach(one: Integers, two: Integers) -> Vector:
        return np.asarray(radius * np.linalg.norm(normals[one] - normals[two], axis=1))

    return _made(features, 2.0 * radius, reach, is_ball=True)


def patches_for_body(features: Features, diameter: float) -> Patches:
    """Return patches of a surface for contacts with a convex body of the given diameter [m]; for a vertex it is 0."""
    return _made(features, diameter, lambda i, _: np.full(len(i), diameter), is_ball=False)


def patches_of_faces(features: Features) -> Patches:
    """Return patches of a surface for contacts with a sharp vertex: each face is one.

    A sharp vertex leaves a face at its border: it does not go on to the next face with the same contact.  Edges and
    corners, which it never touches, are in the first patch.
    """
    made = _PATCHES.setdefault(features, {})
    if (-1.0, False) not in made:
        nowhere = (0,) * len(features.edges), (0,) * len(features.corners)
        made[-1.0, False] = Patches(tuple(range(len(features.planes))), *nowhere)
    return made[-1.0, False]


def _made(features: Features, most: float, reach: Reach, *, is_ball: bool) -> Patches:
    """Return patches that were made before, or make them; those of a convex surface are one for all bodies."""
    key = (0.0, True) if features.is_convex else (most, is_ball)
    made = _PATCHES.setdefault(features, {})
    if key not in made:
        made[key] = _patches(features, most, reach)
    return made[key]


def _patches(features: Features, most: float, reach: Reach) -> Patches:
    """Return patches of a surface for a body; faces that the body can touch together are in different patches.

    ``reach(i, j)`` returns the largest distance of two points, on the faces i and j, that the body can touch together
    [m]; ``most`` is the largest value of this function [m].  Two faces are in conflict if their distance is at most
    ``reach``, and if each has a point above the plane of the other.  Otherwise a convex body cannot touch both from
    outside.  Faces without conflict, such as all faces of a convex surface, can share a
    patch.  An edge or a corner can join a patch if its faces have no conflict with the faces of this patch.

    Faces are taken in the order in which convex edges join them.  A face gets the patch of a neighbour if it can,
    because a body that rolls from one patch to another changes its contact.
    """
    n_faces = len(features.planes)
    if features.is_convex:
        return Patches((0,) * n_faces, (0,) * len(features.edges), (0,) * len(features.corners))
    search = _search(features, most, reach)
    memory, seconds = _cost(features, search)
    if memory >= _MUCH or seconds >= _LONG:
        whose = f"bodies of {most:.3g} m" if most > 0.0 else "corners of bodies"
        say(
            f"making contacts of {whose} with a mesh of {len(features.triangles)} triangles (some "
            f"{1e-6 * memory:.0f} MB of memory, the mesh included, and {seconds:.0f} s, longer where the machine is "
            "busy) ..."
        )
    excludes = _conflicts(n_faces, search)
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
    """Greedy colouring: assigns patches (colours) to sets of faces, so that faces in conflict differ."""

    def __init__(self, excludes: Sequence[set[int]]) -> None:
        self._excludes = excludes
        self._of: list[set[int]] = [set() for _ in excludes]
        self._count = 0

    def of(self, faces: Iterable[int], preferred: list[int]) -> int:
        """Return the colour (number of a patch) for ``faces``: the first one that no face in conflict with them has.

        The ``preferred`` colours are tried before the others.
        """
        own = list(faces)
        taken = set[int]().union(*(self._of[other] for face in own for other in self._excludes[face]))
        colour: int = next(colour for colour in (*preferred, *range(self._count + 1)) if colour not in taken)
        self._count = max(self._count, colour + 1)
        for face in own:
            self._of[face].add(colour)
        return int(colour)


def _areas(features: Features) -> Vector:
    a, b, c = (features.vertices[features.triangles[:, i]] for i in range(3))
    areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return np.asarray(np.bincount(features.face_of, areas, len(features.planes)), dtype=float)


def _cost(features: Features, search: Search) -> tuple[float, float]:
    """Return an estimate of memory [B], with the mesh, and time [s] that the preparation of contacts will take.

    Pairs of faces are counted for a sample of the faces.  The cost of each item is a fit to rows of
    ``python -m tests.benchmarks.large_mesh`` with 60, 100, 140 and 220 edges, balls of 2, 10 and 20 cm, and an
    ellipsoid of 10 cm, on two cores of a server: memory is off by a factor of 1.3 at most, time by 1.3 while nothing
    else runs, by 1.8 on a busy machine.
    """
    stride = len(features.planes) // _SAMPLE
    parts = len(features.triangles) + len(features.edges) + len(features.corners)
    counts = [(len(one), int(np.sum(close))) for one, _, close in (search(stride) if stride else ())]
    pairs, conflicts = stride * np.sum([(0, 0), *counts], axis=0)
    memory, seconds = (np.array([parts, pairs, min(pairs, _AT_ONCE), conflicts]) @ _COSTS).tolist()
    return memory, seconds


def _conflicts(n_faces: int, search: Search) -> list[set[int]]:
    """Return, for every face, the numbers of the faces that a body may touch together with it."""
    found: list[set[int]] = [set() for _ in range(n_faces)]
    for one, two, close in search(1):
        for a, b in zip(one[close].tolist(), two[close].tolist(), strict=True):
            found[a].add(b)
            found[b].add(a)
    return found


def _search(features: Features, most: float, reach: Reach) -> Search:
    """Return a function that yields pairs of faces at most ``most`` apart [m], and whether a body may touch both."""
    points, starts = _points(features)
    low, high = np.minimum.reduceat(points, starts), np.maximum.reduceat(points, starts)
    least = PROTRUDING * features.size
    rising = np.flatnonzero(features.protrusions > least)
    middles, radii = 0.5 * (low + high), 0.5 * np.linalg.norm(high - low, axis=1)

    def search(stride: int) -> Iterator[tuple[Integers, Integers, Bools]]:
        for pair in _near(middles[rising], radii[rising], _AROUND * most + least, stride):
            one, two = rising[pair[0]], rising[pair[1]]
            apart = np.linalg.norm(np.maximum(np.maximum(low[two] - high[one], low[one] - high[two]), 0.0), axis=1)
            close = apart <= _AROUND * reach(one, two) + least
            for a, b in ((one, two), (two, one)):
                own = np.flatnonzero(close)
                close[own] = _height(points, starts, features.planes[a[own]], b[own]) > least
            yield one, two, close

    return search


def _points(features: Features) -> tuple[Vector, Integers]:
    """Return the vertices of all triangles, face by face [m], and the index of the first vertex of each face."""
    faces = np.repeat(features.face_of, 3)
    order = np.argsort(faces, kind="stable")
    points = features.vertices[features.triangles.reshape(-1)[order]]
    return points, np.searchsorted(faces[order], np.arange(len(features.planes)))


def _height(points: Vector, starts: Integers, planes: Vector, faces: Integers) -> Vector:
    """Return the largest height of the face ``faces[i]`` over the plane ``planes[i]``, for each i [m], shape [n].

    The vertices of face f begin at row ``starts[f]`` of ``points`` (:func:`_points`).
    """
    if len(faces) == 0:
        return np.zeros(0)
    counts = np.diff(starts, append=len(points))[faces]
    begins = np.cumsum(counts) - counts
    places = np.arange(int(np.sum(counts))) + np.repeat(starts[faces] - begins, counts)
    heights = np.einsum("ij,ij->i", points[places], np.repeat(planes[:, :3], counts, axis=0))
    return np.asarray(np.maximum.reduceat(heights, begins) - planes[:, 3])


def _near(middles: Vector, radii: Vector, reach: float, stride: int) -> Iterator[tuple[Integers, Integers]]:
    """Yield all pairs of balls with a distance of at most ``reach`` [m], each pair once, as two arrays of indices.

    The balls have the centres ``middles`` and the ``radii`` [m]; each ball encloses a face.  With a ``stride`` above 1,
    only pairs with every stride-th ball are found, as a sample from which the number of all pairs is estimated.

    Raises
    ------
    InvalidInput
        There are more pairs than :data:`MOST_PAIRS`.
    """
    from scipy.spatial import cKDTree

    if len(middles) == 0:
        return
    total, order = 0, np.argsort(radii, kind="stable")
    # groups of balls of similar size, so that a large ball does not widen the search for all
    sizes = np.searchsorted(radii[order], np.max(radii) * 0.25 ** np.arange(6)[::-1], side="right")
    for begin, end in itertools.pairwise((0, *sizes.tolist())):
        group = order[begin:end]
        if len(group) == 0:
            continue
        tree, others = cKDTree(middles[group]), order[:end:stride]
        far = reach + radii[others] + radii[group[-1]]
        counts = np.cumsum(tree.query_ball_point(middles[others], far, return_length=True))
        total += int(counts[-1])
        if total > MOST_PAIRS:
            raise InvalidInput(
                "a mesh that is not convex",
                f"must have at most {MOST_PAIRS} pairs of faces that a body of this size may touch at once",
                total,
                "Take a coarser mesh, or give its body a decomposition into convex pieces.",
            )
        ends = np.searchsorted(counts, np.arange(_AT_ONCE, total + _AT_ONCE, _AT_ONCE))
        for chunk, reached in zip(np.split(others, ends), np.split(far, ends), strict=True):
            found = tree.query_ball_point(middles[chunk], reached)
            one = np.repeat(chunk, [len(near) for near in found])
            two = group[np.fromiter(itertools.chain.from_iterable(found), dtype=np.int64, count=len(one))]
            # pairs within one group are found twice: keep one of them
            once = (radii[one] < radii[group[0]]) | (one < two)
            yield one[once], two[once]
