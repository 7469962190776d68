"""Checks of a closed surface: an error states the rule, a number that shows where it is broken, and the remedy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector
from nonsmooth.notices import warn
from nonsmooth.parameters import UnusualValue

from .integrals import volume_of, winding_number
from .topology import Integers, edge_counts, half_edges, shells

FLAT = 1e-12
"""Height over longest edge below which a triangle has no area."""
_EMPTY = 1e-12
"""Volume over the cube of the largest extent below which there is none."""


def check_surface(thing: str, vertices: Vector, faces: Integers) -> None:
    """Check that the triangles are the surface of one body, cavities allowed.

    Raises
    ------
    InvalidInput
        If a vertex is not finite, a triangle without area, an edge not that of two triangles,
        neighbours are wound against each other, the volume is negative or nothing, there is more than one body, or the
        surface passes through itself.
    """
    check_finite(thing, vertices)
    flat = int(np.sum(flat_triangles(vertices, faces)))
    if flat:
        raise InvalidInput(
            thing, "must have no triangle of zero area", flat, "Repair with 'zero_area', which says what it changes."
        )
    _check_edges(thing, faces)
    volume = volume_of(vertices, faces)
    extent = float(np.max(np.ptp(vertices, axis=0)))
    if abs(volume) <= _EMPTY * extent**3:
        raise InvalidInput(thing, "must enclose a volume [m^3]", volume, "Is it a sheet, or wound half and half?")
    if volume < 0.0:
        raise InvalidInput(
            thing,
            "must be wound counter-clockwise seen from outside, with a positive volume [m^3]",
            volume,
            "It is inside out: repair with 'winding', which turns it.",
        )
    _check_shells(thing, vertices, faces)
    _check_crossings(thing, vertices, faces)


def _check_crossings(thing: str, vertices: Vector, faces: Integers) -> None:
    try:
        crossings = count_crossings(vertices, faces)
    except TooManyPairs as many:
        warn(
            f"{thing} was not looked at for passing through itself: of {len(faces)} triangles {many.args[0]} pairs are "
            f"near each other, more than {MOST_PAIRS}. What overlaps would count twice. Simplify the mesh, or remesh "
            "it without long thin triangles.",
            UnusualValue,
        )
        return
    if crossings:
        raise InvalidInput(
            f"{thing}: number of pairs of triangles that pass through each other",
            "must be 0",
            crossings,
            "What overlaps would count twice: unite the parts (boolean union) in the program that made the mesh.",
        )


def check_indices(thing: str, vertices: Vector, faces: Integers) -> None:
    """Raise InvalidInput unless there are triangles, of vertices that exist."""
    if len(faces) == 0:
        raise InvalidInput(thing, "must have triangles", 0, "An empty mesh encloses nothing.")
    outside = int(np.sum((faces < 0) | (faces >= len(vertices))))
    if outside:
        raise InvalidInput(
            thing, f"must name vertices from 0 to {len(vertices) - 1} only", f"{outside} others", "Check the indices."
        )


def check_finite(thing: str, vertices: Vector) -> None:
    """Raise InvalidInput unless all vertices are finite."""
    wrong = int(np.sum(~np.all(np.isfinite(vertices), axis=1)))
    if wrong:
        raise InvalidInput(
            f"{thing}: number of vertices with nan or infinity",
            "must be 0",
            wrong,
            f"They are {wrong} of {len(vertices)}. Export it anew; or repair with ('not_finite', 'holes').",
        )


def flat_triangles(vertices: Vector, faces: Integers) -> np.ndarray:
    """Return which triangles have no area, shape [m]."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    longest = np.max([np.sum(side**2, axis=1) for side in (b - a, c - b, a - c)], axis=0)
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) <= FLAT * longest)


def _check_edges(thing: str, faces: Integers) -> None:
    edges, counts, which = edge_counts(faces)
    opened, crowded = int(np.sum(counts == 1)), int(np.sum(counts > 2))
    if opened:
        raise InvalidInput(
            f"{thing}: number of open edges",
            "must be 0, as of a closed surface",
            opened,
            f"They are {opened} of {len(edges)} edges. Repair with 'merge' if vertices that should meet nearly do, "
            "with 'holes' if there are some: both say what they change.",
        )
    if crowded:
        raise InvalidInput(
            f"{thing}: number of edges with more than two triangles",
            "must be 0",
            crowded,
            "Walls inside, or triangles that come twice: repair with 'duplicates', or unite parts where it was made.",
        )
    halves = half_edges(faces)
    senses = np.where(halves[:, 0] < halves[:, 1], 1, -1)
    against = int(np.sum(np.bincount(which, weights=senses) != 0.0))
    if against:
        raise InvalidInput(
            f"{thing}: number of edges whose two triangles are not wound alike",
            "must be 0",
            against,
            "Repair with 'winding', which turns triangles round.",
        )


def _check_shells(thing: str, vertices: Vector, faces: Integers) -> None:
    """One shell is the body's outside; others are cavities, wound the other way, inside of it and not of each other."""
    number = shells(faces)
    count = int(np.max(number)) + 1
    if count == 1:
        return
    parts = [faces[number == i] for i in range(count)]
    volumes = [volume_of(vertices, part) for part in parts]
    bodies = [i for i in range(count) if volumes[i] > 0.0]
    if len(bodies) != 1:
        told = ", ".join(f"{volume:.3g}" for volume in sorted(volumes, key=abs, reverse=True)[:8])
        raise InvalidInput(
            f"{thing}: number of shells with a volume of their own",
            "must be 1, as of one body",
            len(bodies),
            f"Volumes [m^3]: {told}{', ...' if count > 8 else ''}. Unite parts that overlap (they would count twice); "
            "export bodies that do not one by one, and join them by Compound where they belong together.",
        )
    for i, part in enumerate(parts):
        if i == bodies[0]:
            continue
        point = vertices[part[0, 0]]
        around = [round(winding_number(vertices, other, point)) for j, other in enumerate(parts) if j != i]
        if sum(around) != 1 or min(around) < 0:
            raise InvalidInput(
                thing,
                "must have its cavities inside of its outer shell and apart from each other",
                f"a shell of {volumes[i]:.3g} m^3 is not",
                "A shell wound inside out is a cavity: repair with 'winding' if it should not be one.",
            )


MOST_PAIRS = 2_000_000_000
"""Largest number of pairs of triangles that are examined; so many pairs take minutes."""
_CHUNK = 2_000_000
_STRIPS, _WIDE = 1000, 4.0
"""Limits of the strips into which `count_crossings` divides the surface across one axis.

``_STRIPS``: largest number of strips.  ``_WIDE``: least width of a strip, relative to the mean extent of the triangles
along this axis.  Narrow strips have fewer pairs to compare, but a triangle must not belong to many strips.
"""
_ROUNDED = 1e-12
"""Bound of the round-off of the coordinate along which boxes are sorted, relative to the surface's largest extent.

The coordinates of strip i are shifted by 2 i times the extent.  With 1000 strips they reach 2000 extents, with an error
of 2000 * 2^-52 extents.
"""
_SHALLOW = 1e-6
"""Least distance from a triangle's plane, relative to the largest extent, of both ends of an edge that crosses it.

Smaller overlaps of neighbouring triangles are round-off of files with single precision or few digits, and not counted.
"""


class TooManyPairs(Exception):
    """More pairs of triangles are near each other than can be examined; the argument is their number."""


def count_crossings(vertices: Vector, faces: Integers) -> int:
    """Return the number of pairs of triangles in which an edge of one passes through the inside of the other.

    Bounding boxes of triangles are sorted along one axis, separately in strips across a second axis.  Only boxes that
    overlap in both are compared, so that the time grows little faster than the number of triangles.

    Raises
    ------
    TooManyPairs
        So many boxes overlap, as the boxes of long thin triangles do, that the count would take minutes.
    """
    corners = vertices[faces]
    low, high = np.min(corners, axis=1), np.max(corners, axis=1)
    size = float(np.max(np.max(high, axis=0) - np.min(low, axis=0)))
    # sort along the axis along which the triangles are shortest relative to the extent of the surface: there the fewest
    # boxes overlap
    axes = np.argsort(np.sum(high - low, axis=0) / np.maximum(np.ptp(vertices, axis=0), 1e-300))
    triangle, strip, width = _strips(low[:, axes[1]], high[:, axes[1]])
    begin_of_strip = 2.0 * size * strip
    start, end = (begin_of_strip + side[triangle, axes[0]] - np.min(low[:, axes[0]]) for side in (low, high))
    order = np.argsort(start, kind="stable")
    triangle, strip, start, end = triangle[order], strip[order], start[order], end[order]
    # the strips are laid along one coordinate, each shifted by two extents from the strip before, so that one sorted
    # array serves all strips; the tolerance allows for the round-off of the shift
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
        # a pair that shares several strips is counted only in the first of them
        both = np.maximum(low[one, axes[1]], low[two, axes[1]])
        own = _strip_of(both, np.min(low[:, axes[1]]), width) == where
        one, two = one[own], two[own]
        depth = _SHALLOW * size
        total += int(np.sum(_cross(faces, corners, one, two, depth) | _cross(faces, corners, two, one, depth)))
        begin = stop
    return total


def _strips(low: Vector, high: Vector) -> tuple[Integers, Integers, float]:
    """Divide the range of one coordinate into strips; ``low`` and ``high`` are the triangles' least and largest values.

    Return the numbers of triangles and of strips, one entry for each strip that a triangle meets, and the width [m].
    """
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
    """Return whether an edge of each first triangle passes through the second one, shape [n].

    An edge that shares a vertex with the second triangle is left out.
    """
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
