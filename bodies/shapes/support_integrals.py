"""What follows from the farthest points of a convex body: radii of curvature and integrals over its volume."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np

from bodies.shapes.drawing import solid_of
from nonsmooth.interfaces.body import Vector

Support = Callable[[Vector], Vector]
"""Returns the farthest points along directions, shape [n, 3] both."""
_TURN = 1e-3
_WAYS, _FIRST, _LAST, _CLOSER = 4, 0.15, 1e-4, 0.8
"""How many ways to a flat place are gone, the first and the last step on them [rad], and what each is of the last."""
_ROUND = [(math.cos(0.25 * math.pi * i), math.sin(0.25 * math.pi * i)) for i in range(8)]
_COARSEST, _TIMES = 24, 4
"""Edges round the coarsest mesh, and how many there are, each twice as fine."""


def spiral(count: int) -> tuple[Vector, float]:
    """Return unit vectors all round, shape [count, 3], and an angle [rad] from which none is farther."""
    i = np.arange(count) + 0.5
    z, angle = 1.0 - 2.0 * i / count, math.pi * (1.0 + math.sqrt(5.0)) * i
    r = np.sqrt(1.0 - z * z)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z]), 3.0 / math.sqrt(count)


def least_radius(support: Support, directions: Vector) -> float:
    """Return the least radius of curvature where directions are normals [m].

    The principal ones are the eigenvalues of dP/dn, with the point P(n) that lies farthest along n.
    """
    rates = _rates(support, directions)
    middle, half = 0.5 * (rates[:, 0] + rates[:, 2]), 0.5 * (rates[:, 0] - rates[:, 2])
    return float(np.min(middle - np.hypot(half, rates[:, 1])))


def largest_radius(support: Support, directions: Vector, points: Vector) -> float:
    """Return the largest radius of curvature that is met on ways to where points lie ever farther apart [m].

    A flat place has a single normal, which no direction meets: its points part wherever directions come near that.
    """
    beside = points[np.argsort(directions @ directions.T, axis=1)[:, -5:]]
    apart = np.max(np.linalg.norm(beside - points[:, None], axis=2), axis=1)
    largest = 0.0
    for n in directions[np.argsort(apart)[-_WAYS:]]:
        step = _FIRST
        while step > _LAST:
            looks = np.vstack([n, math.cos(step) * n + _ways(n[None], step)[:, 0]])
            n, step = looks[int(np.argmax(_chords(support, looks, step)))], _CLOSER * step
        largest = max(largest, float(_chords(support, n[None], step)[0]) / (2.0 * step))
    return largest


def _ways(directions: Vector, step: float, count: int = len(_ROUND)) -> Vector:
    """Return what turns directions by an angle to sides all round, shape [count, n, 3]."""
    t, u = _across(directions)
    return np.array([math.sin(step) * (c * t + s * u) for c, s in _ROUND[:count]])


def _chords(support: Support, directions: Vector, step: float) -> Vector:
    """Return how far points lie apart on both sides of each direction at most [m], shape [n]."""
    along, ways = math.cos(step) * directions, _ways(directions, step, len(_ROUND) // 2)
    one, other = (support(sides.reshape(-1, 3)) for sides in (along + ways, along - ways))
    return np.asarray(np.max(np.linalg.norm(one - other, axis=1).reshape(len(ways), -1), axis=0))


def integrals_over(drawing: Callable[[int], tuple[Vector, Vector]]) -> tuple[float, Vector, Vector]:
    """Return volume [m^3], centroid [m], and inertia at density 1 about the centroid [m^5].

    Those of meshes with vertices on the surface, each twice as fine, whose errors are a series in the squares of the
    edges, extrapolated (L. F. Richardson): to 1e-8 where the curvature does not jump, else to some 1e-4.

    Parameters
    ----------
    drawing : callable
        The mesh of a fineness.
    """
    rows = []
    for time in range(_TIMES):
        volume, first, about = solid_of(*drawing(_COARSEST * 2**time))
        rows.append(np.concatenate([[volume], first, about.ravel()]))
    for order in range(1, _TIMES):
        rows = [(4.0**order * fine - coarse) / (4.0**order - 1.0) for coarse, fine in itertools.pairwise(rows)]
    return float(rows[0][0]), rows[0][1:4], rows[0][4:].reshape(3, 3)


def _across(directions: Vector) -> tuple[Vector, Vector]:
    """Return unit vectors t and u across each direction, shape [n, 3] each."""
    other = np.eye(3)[np.argmin(np.abs(directions), axis=1)]
    t = np.cross(directions, other)
    t /= np.linalg.norm(t, axis=1)[:, None]
    return t, np.cross(directions, t)


def _rates(support: Support, directions: Vector) -> Vector:
    """Return tt, tu and uu of dP/dn for two vectors across each direction [m], shape [n, 3]."""
    t, u = _across(directions)
    slopes = [np.zeros_like(t), np.zeros_like(t)]
    for slope, across in zip(slopes, (t, u), strict=True):
        for i, weight in ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)):
            turned = math.cos(i * _TURN) * directions + math.sin(i * _TURN) * across
            slope += weight / (12.0 * _TURN) * support(turned)
    (by_t, by_u) = slopes
    mixed = 0.5 * (np.sum(by_t * u, axis=1) + np.sum(by_u * t, axis=1))
    return np.column_stack([np.sum(by_t * t, axis=1), mixed, np.sum(by_u * u, axis=1)])
