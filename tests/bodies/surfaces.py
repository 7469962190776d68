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


def segment_distance(first: Array, second: Array) -> float:
    """Return the least distance of segments, shapes [n, 2, 3] and [m, 2, 3]: from ends, or across both."""
    starts, ways = [x[:, 0] for x in (first, second)], [x[:, 1] - x[:, 0] for x in (first, second)]
    apart = starts[0][:, None] - starts[1][None]
    one, two = (np.broadcast_to(way, apart.shape) for way in (ways[0][:, None], ways[1][None]))
    normal = np.cross(one, two)
    square = np.einsum("nmi,nmi->nm", normal, normal)
    square[square < 1e-20 * np.max(square)] = np.nan
    s = np.einsum("nmi,nmi->nm", np.cross(two, apart), normal) / square
    t = np.einsum("nmi,nmi->nm", np.cross(one, apart), normal) / square
    crossed = (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    least = np.abs(np.einsum("nmi,nmi->nm", apart, normal)) / np.sqrt(square)
    found = float(np.min(least[crossed], initial=np.inf))
    for ends, segments in ((first, second), (second, first)):
        points, way = ends.reshape(-1, 3), segments[:, 1] - segments[:, 0]
        off = points[:, None] - segments[None, :, 0]
        along = np.clip(np.einsum("nmi,mi->nm", off, way) / np.einsum("mi,mi->m", way, way), 0.0, 1.0)
        found = min(found, float(np.min(np.linalg.norm(off - along[:, :, None] * way, axis=2))))
    return found
