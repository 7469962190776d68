"""Distances from triangles and sides of closed surfaces, found in another way than by the contact pairs."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def is_inside(points: Array, corners: Array) -> Array:
    """Return for points, shape [n, 3], whether the triangles, shape [m, 3, 3], wind round them.

    By solid angles: A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Transactions on
    Biomedical Engineering 30 (1983) 125-126.
    """
    a, b, c = (corners[None, :, i] - points[:, None] for i in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
    over = np.einsum("nti,nti->nt", a, np.cross(b, c))
    under = la * lb * lc
    for one, two, length in ((a, b, lc), (b, c, la), (c, a, lb)):
        under = under + np.einsum("nti,nti->nt", one, two) * length
    return np.asarray(np.sum(np.arctan2(over, under), axis=1) > np.pi)


def distances(points: Array, corners: Array) -> Array:
    """Return how far points, shape [n, 3], are from triangles, shape [m, 3, 3]: from planes inside, else from edges."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    heights = np.einsum("nti,ti->nt", points[:, None] - corners[None, :, 0], normals)
    feet = points[:, None] - heights[:, :, None] * normals
    within = np.ones(heights.shape, dtype=bool)
    nearest = np.full(heights.shape, np.inf)
    for i in range(3):
        start, way = corners[:, i], corners[:, (i + 1) % 3] - corners[:, i]
        within &= np.einsum("nti,ti->nt", feet - start, np.cross(normals, way)) >= 0.0
        along = np.einsum("nti,ti->nt", points[:, None] - start, way) / np.einsum("ti,ti->t", way, way)
        off = points[:, None] - start - np.clip(along, 0.0, 1.0)[:, :, None] * way
        nearest = np.minimum(nearest, np.linalg.norm(off, axis=2))
    return np.asarray(np.min(np.where(within, np.abs(heights), nearest), axis=1))
