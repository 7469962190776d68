"""Where a surface passes through itself: edges that pierce triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bodies.meshes.topology import Integers
from nonsmooth.interfaces.body import Vector

MOST_PAIRS = 2_000_000_000
"""Pairs of triangles whose places along one axis overlap, strip by strip, that are looked at."""
_CHUNK = 2_000_000
_STRIPS, _WIDE = 1000, 4.0
"""Most strips; their least width in units of the triangles' mean extent."""
_ROUNDED = 1e-12
"""Bound of the rounding of a place in the last strip, in units of the largest extent."""
_SHALLOW = 1e-6
"""How far the ends of an edge must stand out of a triangle on either side, relative to the largest extent: single
precision and a few digits in text files let neighbours overlap by less."""


class TooManyPairs(Exception):
    """There are more pairs of triangles near each other than can be looked at; the argument is their number."""


def count_crossings(vertices: Vector, faces: Integers) -> int:
    """Return the number of pairs of triangles of which an edge of one passes through the inside of the other.

    The boxes of the triangles are swept along one axis, strip by strip of a second one, so that the time grows little
    faster than their number.

    Raises
    ------
    TooManyPairs
        If the boxes of so many overlap, as those of long thin triangles do, that it would take minutes.
    """
    corners = vertices[faces]
    low, high = np.min(corners, axis=1), np.max(corners, axis=1)
    size = float(np.max(np.max(high, axis=0) - np.min(low, axis=0)))
    # sweep along the axis along which the triangles are shortest
    axes = np.argsort(np.sum(high - low, axis=0) / np.maximum(np.ptp(vertices, axis=0), 1e-300))
    triangle, strip, width = _strips(low[:, axes[1]], high[:, axes[1]])
    begin_of_strip = 2.0 * size * strip
    start, end = (begin_of_strip + side[triangle, axes[0]] - np.min(low[:, axes[0]]) for side in (low, high))
    order = np.argsort(start, kind="stable")
    triangle, strip, start, end = triangle[order], strip[order], start[order], end[order]
    # the places of the last strips are rounded more than those of the first
    ends = np.searchsorted(start, end + _ROUNDED * size, side="right")
    counts = np.maximum(ends - np.arange(len(triangle)) - 1, 0)
    total, begin = 0, 0
    sums = np.cumsum(counts)
    if sums[-1] > MOST_PAIRS:
        raise TooManyPairs(int(sums[-1]))
    while begin < len(triangle):
        done = int(sums[begin - 1]) if begin else 0
        stop = max(begin + 1, int(np.searchsorted(sums, done + _CHUNK, side="right")))
        some = counts[begin:stop]
        first = np.repeat(np.arange(begin, stop), some)
        second = first + 1 + np.arange(len(first)) - np.repeat(np.cumsum(some) - some, some)
        one, two, where = triangle[first], triangle[second], strip[first]
        for axis in (axes[1], axes[2], axes[0]):
            near = (low[one, axis] <= high[two, axis]) & (low[two, axis] <= high[one, axis])
            one, two, where = one[near], two[near], where[near]
        # of the strips that both are in, the pair counts in the first
        both = np.maximum(low[one, axes[1]], low[two, axes[1]])
        own = _strip_of(both, np.min(low[:, axes[1]]), width) == where
        one, two = one[own], two[own]
        depth = _SHALLOW * size
        total += int(np.sum(_cross(faces, corners, one, two, depth) | _cross(faces, corners, two, one, depth)))
        begin = stop
    return total


def _strips(low: Vector, high: Vector) -> tuple[Integers, Integers, float]:
    """Return triangles and strips, one entry for every strip that a triangle is in, and the width of a strip."""
    origin, span = float(np.min(low)), float(np.max(high) - np.min(low))
    width = max(_WIDE * float(np.mean(high - low)), span / _STRIPS, 1e-300)
    first = _strip_of(low, origin, width)
    number = _strip_of(high, origin, width) - first + 1
    triangle = np.repeat(np.arange(len(low)), number)
    strip = np.arange(len(triangle)) - np.repeat(np.cumsum(number) - number, number) + first[triangle]
    return triangle, strip, width


def _strip_of(place: Vector, origin: float, width: float) -> Integers:
    return np.asarray(np.floor((place - origin) / width), dtype=np.int64)


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
