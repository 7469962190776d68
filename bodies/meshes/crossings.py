"""Where a surface passes through itself: edges that pierce triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bodies.meshes.topology import Integers
from nonsmooth.interfaces.body import Vector

_CHUNK = 2_000_000
_SHALLOW = 1e-6
"""How far the ends of an edge must stand out of a triangle on either side, relative to the largest extent: single
precision and a few digits in text files let neighbours overlap by less."""


def count_crossings(vertices: Vector, faces: Integers) -> int:
    """Return the number of pairs of triangles of which an edge of one passes through the inside of the other."""
    corners = vertices[faces]
    low, high = np.min(corners, axis=1), np.max(corners, axis=1)
    depth = _SHALLOW * float(np.max(np.max(high, axis=0) - np.min(low, axis=0)))
    # sweep along the axis along which the triangles are shortest
    axis = int(np.argmin(np.sum(high - low, axis=0) / np.maximum(np.ptp(vertices, axis=0), 1e-300)))
    order = np.argsort(low[:, axis], kind="stable")
    faces, corners, low, high = faces[order], corners[order], low[order], high[order]
    ends = np.searchsorted(low[:, axis], high[:, axis], side="right")
    counts = np.maximum(ends - np.arange(len(faces)) - 1, 0)
    total, begin = 0, 0
    sums = np.cumsum(counts)
    while begin < len(faces):
        done = int(sums[begin - 1]) if begin else 0
        stop = max(begin + 1, int(np.searchsorted(sums, done + _CHUNK, side="right")))
        some = counts[begin:stop]
        one = np.repeat(np.arange(begin, stop), some)
        two = one + 1 + np.arange(len(one)) - np.repeat(np.cumsum(some) - some, some)
        for other in ((axis + 1) % 3, (axis + 2) % 3):
            near = (low[one, other] <= high[two, other]) & (low[two, other] <= high[one, other])
            one, two = one[near], two[near]
        total += int(np.sum(_cross(faces, corners, one, two, depth) | _cross(faces, corners, two, one, depth)))
        begin = stop
    return total


def _cross(faces: Integers, corners: Vector, one: Integers, two: Integers, depth: float) -> NDArray[np.bool_]:
    """Return whether an edge of each first triangle passes through the second; edges that share a vertex do not."""
    found = np.zeros(len(one), dtype=bool)
    a, b, c = (corners[two, i] for i in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    heights = np.einsum("nki,ni->nk", corners[one] - a[:, None], normal)
    shared = np.any(faces[one][:, :, None] == faces[two][:, None, :], axis=2)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        through = (np.minimum(heights[:, i], heights[:, j]) < -depth) & (
            np.maximum(heights[:, i], heights[:, j]) > depth
        )
        rows = np.flatnonzero(through & ~shared[:, i] & ~shared[:, j] & ~found)
        p, q = corners[one[rows], i], corners[one[rows], j]
        part = heights[rows, i] / (heights[rows, i] - heights[rows, j])
        x = p + part[:, None] * (q - p)
        inside = np.ones(len(rows), dtype=bool)
        for s, e in ((a, b), (b, c), (c, a)):
            inside &= np.einsum("ni,ni->n", np.cross(e[rows] - s[rows], x - s[rows]), normal[rows]) > 0.0
        found[rows[inside]] = True
    return found
