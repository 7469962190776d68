"""Gaps of all pairs that have contacts, over all poses that a run stored, by support functions."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from tests.benchmarks.random_systems import convex
from tests.benchmarks.random_systems.pieces import Piece, half_spaces, pieces_of

_LOOKED_AT = 12
"""Poses of a pair, of those that no plane proves apart, whose depth is measured: the first ones and some later."""
Poses = tuple[Vector, Vector]


def directions(n: int = 400) -> Vector:
    """Return unit vectors spread evenly, shape [n, 3]."""
    z = 1.0 - (2.0 * np.arange(n) + 1.0) / n
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(n)
    flat = np.sqrt(1.0 - z * z)
    return np.column_stack([flat * np.cos(turn), flat * np.sin(turn), z])


@dataclass(frozen=True)
class Overlap:
    """Where two bodies are inside of each other, by the number of the pose, and how deep [m]."""

    pose: int
    depth: float
    allowed: float


def placed(piece: Piece, poses: Poses) -> Poses:
    """Return places [m] and axes of a piece by those of its body."""
    places, axes = poses
    return places + axes @ piece.place, axes @ piece.axes


def _arguments(one: Piece, two: Piece) -> tuple[Vector, Vector, Vector, Vector]:
    return np.array([one.kind, two.kind]), np.stack([one.numbers, two.numbers]), one.corners, two.corners


def _of_pieces(one: Piece, two: Piece, poses: tuple[Poses, Poses]) -> Iterator[Overlap]:
    (first, first_axes), (second, second_axes) = placed(one, poses[0]), placed(two, poses[1])
    first_axes, second_axes = np.ascontiguousarray(first_axes), np.ascontiguousarray(second_axes)
    between, sweep = second - first, one.sweep + two.sweep
    kinds, numbers, corners, others = _arguments(one, two)
    reach = one.reach + two.reach
    left = convex.unproven(kinds, numbers, corners, others, first_axes, second_axes, between, sweep, reach)
    doubtful = np.flatnonzero(left)
    if len(doubtful) > _LOOKED_AT:
        doubtful = doubtful[np.unique(np.linspace(0, len(doubtful) - 1, _LOOKED_AT).astype(int))]
    for k in doubtful:
        axes, ways = np.stack([first_axes[k], second_axes[k]]), directions()
        gap = convex.overlap(kinds, numbers, corners, others, axes, between[k], ways, sweep, np.empty(3))
        yield Overlap(int(k), -gap, one.slack + two.slack)


def _below(piece: Piece, poses: Poses, points: Vector, normals: Vector) -> Iterator[Overlap]:
    places, axes = placed(piece, poses)
    down = -np.einsum("nji,nj->ni", axes, normals)
    heights = np.einsum("ni,ni->n", places - points, normals) - piece.sweep
    for k in np.flatnonzero(heights < piece.reach):
        point = np.empty(3)
        convex._core(piece.kind, piece.numbers, piece.corners, down[k], point)
        depth = float(point @ down[k] - heights[k])
        if depth > 0.0:
            yield Overlap(int(k), depth, piece.slack)


def overlaps(one: Body, two: Body, poses: tuple[Poses, Poses]) -> list[Overlap]:
    """Return where two bodies are inside of each other.

    Parameters
    ----------
    one, two : Body
        The bodies; a plate or an open box comes first.
    poses : tuple
        Places [m] and axes of either, shapes [n, 3] and [n, 3, 3].
    """
    if planes := half_spaces(one):
        return [
            found
            for point, normal in planes
            for piece in pieces_of(two)
            for found in _below(piece, poses[1], poses[0][0] + poses[0][1] @ point, poses[0][1] @ normal)
        ]
    pairs = itertools.product(pieces_of(one), pieces_of(two))
    return [found for first, second in pairs for found in _of_pieces(first, second, poses)]


def distance(one: Body, two: Body, poses: tuple[Poses, Poses]) -> float:
    """Return the distance of two bodies at the first of the poses [m]; 0 where they overlap."""
    least, first_axes = np.inf, poses[0][1][0]
    for (point, normal), piece in itertools.product(half_spaces(one), pieces_of(two)):
        outer = first_axes @ normal
        height = float((poses[1][0][0] - poses[0][0][0] - first_axes @ point) @ outer)
        least = min(least, height - farthest(piece, -poses[1][1][0].T @ outer))
    for first, second in itertools.product(pieces_of(one), pieces_of(two)):
        (at, axes), (other, other_axes) = placed(first, poses[0]), placed(second, poses[1])
        both = np.stack([axes[0], other_axes[0]])
        way = np.array([0.0, 0.0, 1.0])
        found = convex.bounds(*_arguments(first, second), both, other[0] - at[0], 0.0, np.inf, way)
        least = min(least, found[1] - first.sweep - second.sweep)
    return max(least, 0.0)


def farthest(piece: Piece, way: Vector) -> float:
    """Return how far a piece reaches along a direction in the axes of its body [m]."""
    point, local = np.empty(3), piece.axes.T @ way
    convex._core(piece.kind, piece.numbers, piece.corners, local, point)
    return float(piece.place @ way + point @ local + piece.sweep * np.linalg.norm(way))
