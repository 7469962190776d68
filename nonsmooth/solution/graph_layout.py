"""Layout of the graph of modes on paper."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from nonsmooth.solution.modes import ContactModes, TransitionGraph

Array: TypeAlias = NDArray[np.float64]
Point: TypeAlias = tuple[float, float]

_WIDE = 1.25
"""Stretch of the layout along the page, along which the words are written."""
_STARTS, _ROUNDS = 16, 300


def places_of(graph: TransitionGraph) -> dict[ContactModes, Point]:
    """Places of the modes whose distances approximate the numbers of transitions between them.

    The weighted squares of the differences are minimised by majorisation (de Leeuw), from modes on a circle in several
    orders.  The result with the fewest crossing lines is taken.
    """
    visits = graph.visits
    modes = sorted(graph.shares, key=lambda m: (m in graph.passing, m != graph.start, -graph.shares[m], -visits[m]))
    n = len(modes)
    steps = _steps_between(modes, graph)
    lines = [(i, j) for i in range(n) for j in range(i + 1, n) if steps[i, j] == 1.0]
    random = np.random.default_rng(n)
    trials = [_relaxed(steps, random.permutation(n).astype(float)) for _ in range(_STARTS)]
    points = min(trials, key=lambda trial: (_crossings(trial, lines), _stress(trial, steps)))
    # the longest extent lies along the page, and the start to the left
    points = points - points.mean(axis=0)
    points = points @ np.linalg.svd(points, full_matrices=False)[2].T if n > 1 else points
    points[:, 0] *= -1.0 if points[modes.index(graph.start), 0] > 0.0 else 1.0
    return {mode: (_WIDE * float(x), float(y)) for mode, (x, y) in zip(modes, points, strict=True)}


def _relaxed(steps: Array, order: Array) -> Array:
    n = len(steps)
    weights = np.divide(1.0, steps**2, out=np.zeros_like(steps), where=steps > 0.0)
    inverse = np.linalg.pinv(np.diag(weights.sum(axis=1)) - weights)
    angles = 2.0 * np.pi * order / n
    points = np.stack([-np.cos(angles), np.sin(angles)], axis=1)
    for _ in range(_ROUNDS):
        apart = np.linalg.norm(points[:, None] - points[None], axis=2)
        pull = np.divide(weights * steps, apart, out=np.zeros_like(steps), where=apart > 1e-12)
        points = inverse @ ((np.diag(pull.sum(axis=1)) - pull) @ points)
    return np.asarray(points)


def _stress(points: Array, steps: Array) -> float:
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    return float(np.sum(np.divide(apart - steps, steps, out=np.zeros_like(steps), where=steps > 0.0) ** 2))


def _crossings(points: Array, lines: Sequence[tuple[int, int]]) -> int:
    """Number of pairs of lines that cross."""

    def side(a: int, b: int, c: int) -> bool:
        (x, y), (u, v) = points[b] - points[a], points[c] - points[a]
        return bool(x * v - y * u > 0.0)

    return sum(
        len({a, b, c, d}) == 4 and side(a, b, c) != side(a, b, d) and side(c, d, a) != side(c, d, b)
        for (a, b), (c, d) in itertools.combinations(lines, 2)
    )


def _steps_between(modes: Sequence[ContactModes], graph: TransitionGraph) -> Array:
    """Least number of transitions between modes, in either direction, shape [n, n]; unconnected: one more than any."""
    n = len(modes)
    steps = np.full((n, n), np.inf)
    np.fill_diagonal(steps, 0.0)
    for one, other, _ in graph.counts:
        if one != other:
            i, j = modes.index(one), modes.index(other)
            steps[i, j] = steps[j, i] = 1.0
    for k in range(n):
        steps = np.minimum(steps, steps[:, k : k + 1] + steps[k : k + 1])
    known = np.isfinite(steps)
    return np.where(known, steps, np.max(steps[known]) + 1.0)
