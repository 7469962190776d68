"""Shapes at their places in the world, and the pairs of their pieces that are near each other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.interfaces.solid import Vector
from nonsmooth.solids.measure import Measured, measure
from nonsmooth.solids.pieces import Pieces

_ENTRIES = 1_000_000
"""Largest number of pairs of pieces whose boxes are compared at once, so that they take tens of megabytes."""


@final
@dataclass(frozen=True, eq=False)
class Placed:
    """Pieces of a shape in the world.

    Attributes
    ----------
    pieces : Pieces
        The pieces of the shape.
    position : Vector
        Origin of its frame [m], shape [3].
    rotation : Vector
        Axes of its frame as columns, shape [3, 3].
    """

    pieces: Pieces
    position: Vector
    rotation: Vector

    @property
    def place(self) -> Place:
        """Position and rotation."""
        return self.position, self.rotation

    def moved(self, way: Vector) -> Placed:
        """Copy of the placed shape after a translation ``way`` [m], shape [3]."""
        return replace(self, position=self.position + way)

    @property
    def bounds(self) -> tuple[Vector, Vector]:
        """Lower and upper corner of a box along the world axes that contains the shape [m], shape [3] each."""
        low, high = self._boxes(*(corner[None, :] for corner in self.pieces.bounds))
        return low[0], high[0]

    @property
    def inner(self) -> Vector:
        """Points deep inside of the shape [m], in world axes, shape [n, 3]."""
        return self.in_world(self.pieces.inner)

    def in_world(self, points: Vector) -> Vector:
        """Points of the frame of the body in world axes [m], shape [n, 3]."""
        return np.asarray(self.position + points @ self.rotation.T)

    def holds(self, point: Vector, margin: float) -> bool:
        """True if the shape has a surface, and a point is inside of it, more than ``margin`` [m] below it."""
        surface = self.pieces.surface
        return surface is not None and surface.holds(self.rotation.T @ (point - self.position), margin)

    def near(self, low: Vector, high: Vector) -> NDArray[np.int64]:
        """Numbers of the pieces that may reach into the box between two corners in the world [m], shape [3] each."""
        middle = self.rotation.T @ (0.5 * (low + high) - self.position)
        half = np.abs(self.rotation.T) @ (0.5 * (high - low))
        return self.pieces.near(middle - half, middle + half)

    def boxes(self, numbers: NDArray[np.int64]) -> tuple[Vector, Vector]:
        """Corners of boxes along the world axes that contain some pieces [m], shape [n, 3] each."""
        return self._boxes(*self.pieces.boxes(numbers))

    def _boxes(self, low: Vector, high: Vector) -> tuple[Vector, Vector]:
        middle, half = self.in_world(0.5 * (low + high)), (0.5 * (high - low)) @ np.abs(self.rotation.T)
        return middle - half, middle + half


def measured(one: Placed, two: Placed, i: int, j: int) -> Measured:
    """Distance of piece ``i`` of the first shape and piece ``j`` of the second, or the depth of their overlap."""
    return measure(one.pieces.piece(i), one.place, two.pieces.piece(j), two.place)


def measured_hulls(one: Placed, two: Placed) -> Measured:
    """Distance of the convex parts that hold two shapes, one of which may be unbounded, or the depth of an overlap."""
    found = (measure(a, one.place, b, two.place) for a in one.pieces.hull for b in two.pieces.hull)
    return min(found, key=lambda each: each.separation)


def near_pairs(
    one: Placed, two: Placed, reach: float = 0.0, way: Vector | None = None
) -> Iterator[tuple[int, int, float]]:
    """Pairs of pieces of two bounded shapes whose boxes are at most ``reach`` apart, the nearest boxes first.

    Parameters
    ----------
    one, two : Placed
        The shapes.
    reach : float
        Largest distance of the boxes of a pair [m].
    way : Vector, optional
        Translation of the first shape [m], shape [3]. The boxes of its pieces then contain the whole path.

    Yields
    ------
    i, j : int
        Numbers of the pieces.
    apart : float
        Distance of their boxes [m].
    """
    path = np.zeros(3) if way is None else way
    back, ahead = np.minimum(path, 0.0), np.maximum(path, 0.0)
    low, high = two.bounds
    first = one.near(low - ahead - reach, high - back + reach)
    if len(first) == 0:
        return
    low, high = one.boxes(first)
    low, high = low + back, high + ahead
    second = two.near(np.min(low, axis=0) - reach, np.max(high, axis=0) + reach)
    below, above = two.boxes(second)
    found = []
    rows = max(1, _ENTRIES // max(1, len(second)))
    for start in range(0, len(first), rows):
        some = slice(start, start + rows)
        between = np.maximum(below[None] - high[some, None], low[some, None] - above[None])
        apart = np.linalg.norm(np.maximum(between, 0.0), axis=2)
        i, j = np.nonzero(apart <= reach)
        found.append((first[some][i], second[j], apart[i, j]))
    i, j, apart = (np.concatenate(each) for each in zip(*found, strict=True))
    order = np.argsort(apart, kind="stable")
    yield from zip(i[order].tolist(), j[order].tolist(), apart[order].tolist(), strict=True)


def overlap(one: Placed, two: Placed, tolerance: float) -> float:
    """Lower bound of the least translation that separates two bounded shapes [m]; 0 if it is within the tolerance.

    Parameters
    ----------
    one, two : Placed
        The shapes.
    tolerance : float
        Largest overlap that is treated as touching [m].
    """
    if measured_hulls(one, two).separation >= -tolerance:
        return 0.0
    for i, j, _ in near_pairs(one, two):
        found = measured(one, two, i, j)
        if found.upper < -tolerance:
            return -found.upper
    return nested(one, two, tolerance)


def nested(one: Placed, two: Placed, tolerance: float) -> float:
    """Lower bound of the depth [m] to which a shape is inside a surface; 0 if neither shape is inside the other.

    A depth of at most ``tolerance`` [m] is returned as 0, too.  The pieces of the two shapes must not overlap by more
    than ``tolerance``.
    """
    if one.pieces.surface is None and two.pieces.surface is None:
        return 0.0
    pairs = list(near_pairs(one, two, tolerance))
    near = {0: {i for i, _, _ in pairs}, 1: {j for _, j, _ in pairs}}
    deepest = 0.0
    for outer, inner, numbers in ((one, two, near[1]), (two, one, near[0])):
        # if the boundaries do not cross, a shape is wholly inside or wholly outside: its inner points decide. If the
        # boundaries coincide in some region, a shape may enter beside this region. So points of the pieces that are
        # near the other shape decide, too
        middles = [inner.pieces.piece(number).middle for number in sorted(numbers)]
        places = np.unique(np.array([*inner.inner, *inner.in_world(np.reshape(middles, (-1, 3)))]), axis=0)
        low, high = outer.bounds
        for place in places[np.all((places > low) & (places < high), axis=1)]:
            margin = max(deepest, tolerance)
            while outer.holds(place, margin):
                deepest, margin = margin, 2.0 * margin
    return deepest
