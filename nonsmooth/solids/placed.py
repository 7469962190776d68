"""Solids at their places in the world, and the overlap of two of them."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from nonsmooth.interfaces.solid import Piece, SolidRegion, Vector
from nonsmooth.solids.overlap import depth


@final
@dataclass(frozen=True)
class Placed:
    """A solid in the world.

    Attributes
    ----------
    solid : SolidRegion
        The solid.
    position : Vector
        Origin of its frame [m], shape [3].
    rotation : Vector
        Axes of its frame as columns, shape [3, 3].
    """

    solid: SolidRegion
    position: Vector
    rotation: Vector

    def moved(self, way: Vector) -> Placed:
        """Copy of the placed solid after a translation ``way`` [m], shape [3]."""
        return replace(self, position=self.position + way)

    @functools.cached_property
    def bounds(self) -> tuple[Vector, Vector]:
        """Lower and upper corner of a box along the world axes that contains the solid [m], shape [3] each."""
        return _box(*self.solid.bounds, self.rotation, self.position)

    def support(self, direction: Vector) -> Vector:
        """Point that lies farthest along a direction [m], shape [3]."""
        return np.asarray(self.position + self.rotation @ self.solid.support(direction @ self.rotation))

    @property
    def inner(self) -> Vector:
        """Points of the solid that are as far inside as possible [m], in world axes, shape [n, 3].

        They decide whether this solid is completely inside a hollow one.
        """
        return self.position + self.solid.inner @ self.rotation.T

    def holds(self, point: Vector, margin: float) -> bool:
        """True if the solid is hollow and a point is inside of it, more than ``margin`` [m] below its boundary."""
        return self.solid.holds(self.rotation.T @ (point - self.position), margin)

    def pieces(self, low: Vector, high: Vector) -> list[Piece]:
        """Pieces that may reach into the box between two corners [m], in world axes."""
        inverse = self.rotation.T
        box = _box(low, high, inverse, -inverse @ self.position)
        return [self._in_world(piece) for piece in self.solid.pieces(*box)]

    def _in_world(self, piece: Piece) -> Piece:
        place, axes, support = self.position, self.rotation, piece.support

        def turned(direction: Vector) -> Vector:
            return np.asarray(place + axes @ support(direction @ axes))

        return Piece(turned, place + axes @ piece.place, tuple(axes @ normal for normal in piece.normals))


def overlap(one: Placed, two: Placed, tolerance: float, normal: Vector) -> float:
    """Lower bound of the least translation that separates two solids [m]; 0 if it is within the tolerance.

    Parameters
    ----------
    one, two : Placed
        The solids.
    tolerance : float
        Largest overlap that is treated as touching [m].
    normal : Vector
        Unit vector from the first to the second, shape [3]. If a plane across it separates them, the result is 0 at
        once.
    """
    if float(normal @ (one.support(normal) - two.support(-normal))) <= tolerance:
        return 0.0
    for a, b in near_pairs(one, two):
        found = depth(a, b, tolerance)
        if found > 0.0:
            return found
    return nested(one, two, tolerance)


def nested(one: Placed, two: Placed, tolerance: float) -> float:
    """Lower bound of the depth [m] to which a solid is inside a hollow one; 0 if neither solid is inside the other.

    A depth of at most ``tolerance`` [m] is returned as 0, too.  The pieces of the two solids must not overlap by more
    than ``tolerance``.
    """
    if not (one.solid.hollow or two.solid.hollow):
        return 0.0
    deepest, pairs = 0.0, list(near_pairs(one, two, tolerance))
    for outer, inner, near in ((one, two, [b for _, b in pairs]), (two, one, [a for a, _ in pairs])):
        if outer.solid.hollow:
            # if the boundaries do not cross, a solid is wholly inside or wholly outside: its inner points decide. If
            # the boundaries coincide in some region, a solid may enter beside this region. So points of the pieces that
            # are near the other solid decide, too
            places = np.unique(np.array([*inner.inner, *(piece.place for piece in near)]), axis=0)
            low, high = outer.bounds
            for place in places[np.all((places > low) & (places < high), axis=1)]:
                margin = max(deepest, tolerance)
                while outer.holds(place, margin):
                    deepest, margin = margin, 2.0 * margin
    return deepest


def near_pairs(
    one: Placed, two: Placed, margin: float = 0.0, way: Vector | None = None
) -> Iterator[tuple[Piece, Piece]]:
    """Pairs of pieces of two solids whose boxes overlap or are at most ``margin`` apart.

    Parameters
    ----------
    one, two : Placed
        The solids.
    margin : float
        Largest distance of the boxes of a pair [m].
    way : Vector, optional
        Translation of the first solid [m], shape [3]. The boxes of its pieces then contain the whole path.
    """
    path = np.zeros(3) if way is None else way
    low, high = two.bounds
    mine = one.bounds
    swept = mine[0] + np.minimum(path, 0.0) - margin, mine[1] + np.maximum(path, 0.0) + margin
    if np.any(swept[0] > high) or np.any(swept[1] < low):
        return
    for a in one.pieces(low - np.maximum(path, 0.0) - margin, high - np.minimum(path, 0.0) + margin):
        extremes = [[float(a.support(sign * axis)[i]) for i, axis in enumerate(np.eye(3))] for sign in (-1.0, 1.0)]
        box = extremes[0] + np.minimum(path, 0.0) - margin, extremes[1] + np.maximum(path, 0.0) + margin
        if np.all(box[0] <= high) and np.all(box[1] >= low):
            for b in two.pieces(*box):
                yield a, b


def _box(low: Vector, high: Vector, axes: Vector, place: Vector) -> tuple[Vector, Vector]:
    """Corners of a box along the axes of one frame that contains a box along the axes of another frame."""
    middle, half = place + axes @ (0.5 * (low + high)), np.abs(axes) @ (0.5 * (high - low))
    return middle - half, middle + half
