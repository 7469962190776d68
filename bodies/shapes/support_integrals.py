"""What follows from the farthest points of a convex body: radii of curvature and integrals over its volume."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np

from bodies.shapes.drawing import solid_of
from nonsmooth.interfaces.body import Vector

Support = Callable[[Vector], Vector]
_TURN = 1e-3
_COARSEST, _TIMES = 24, 4
"""Edges round the coarsest mesh, and how many there are, each twice as fine."""


def spiral(count: int) -> tuple[Vector, float]:
    """Return unit vectors all round, shape [count, 3], and an angle [rad] from which none is farther."""
    i = np.arange(count) + 0.5
    z, angle = 1.0 - 2.0 * i / count, math.pi * (1.0 + math.sqrt(5.0)) * i
    r = np.sqrt(1.0 - z * z)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z]), 2.5 / math.sqrt(count)


def radii_along(support: Support, directions: Vector) -> Vector:
    """Return the two principal radii of curvature where directions are normals [m], shape [n, 2].

    They are the eigenvalues of dP/dn, with the point P(n) that lies farthest along n.
    """
    rates = _rates(support, directions)
    middle, half = 0.5 * (rates[:, 0] + rates[:, 2]), 0.5 * (rates[:, 0] - rates[:, 2])
    spread = np.hypot(half, rates[:, 1])
    return np.column_stack([middle - spread, middle + spread])


def integrals_over(drawing: Callable[[int], tuple[Vector, Vector]]) -> tuple[float, Vector, Vector]:
    """Return volume [m^3], centroid [m], and inertia at density 1 about the centroid [m^5].

    Those of meshes with vertices on the surface, each twice as fine, whose errors are a series in the squares of the
    edges, extrapolated (L. F. Richardson): to 1e-10 where the curvature does not jump, else to some 1e-6.

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


def _rates(support: Support, directions: Vector) -> Vector:
    """Return tt, tu and uu of dP/dn for unit vectors t and u across each direction [m], shape [n, 3]."""
    other = np.eye(3)[np.argmin(np.abs(directions), axis=1)]
    t = np.cross(directions, other)
    t /= np.linalg.norm(t, axis=1)[:, None]
    u = np.cross(directions, t)
    slopes = [np.zeros_like(t), np.zeros_like(t)]
    for slope, across in zip(slopes, (t, u), strict=True):
        for i, weight in ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)):
            turned = math.cos(i * _TURN) * directions + math.sin(i * _TURN) * across
            slope += weight / (12.0 * _TURN) * np.array([support(n) for n in turned])
    (by_t, by_u) = slopes
    mixed = 0.5 * (np.sum(by_t * u, axis=1) + np.sum(by_u * t, axis=1))
    return np.column_stack([np.sum(by_t * t, axis=1), mixed, np.sum(by_u * u, axis=1)])
