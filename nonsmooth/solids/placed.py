"""A solid where its body stands, and whether two of them overlap."""

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
        """The same solid, moved by ``way`` [m], shape [3]."""
        return replace(self, position=self.position + way)

    @functools.cached_property
    def bounds(self) -> tuple[Vector, Vector]:
        """Corners of a box along the axes that holds it [m], shape [3] each."""
        return _box(*self.solid.bounds, self.rotation, self.position)

    def support(self, direction: Vector) -> Vector:
        """Point that lies farthest along a direction [m], shape [3]."""
        return np.asarray(self.position + self.rotation @ self.solid.support(direction @ self.rotation))

    @property
    def inner(self) -> Vector:
        """Points inside [m], shape [n, 3]."""
        return self.position + self.solid.inner @ self.rotation.T

    def holds(self, point: Vector, margin: float) -> bool:
        """True if a hollow solid encloses a point deeper than a margin under its boundary [m]."""
        return self.solid.holds(self.rotation.T @ (point - self.position), margin)

    def pieces(self, low: Vector, high: Vector) -> list[Piece]:
        """Pieces that may reach into a box [m], in the axes of the world."""
        inverse = self.rotation.T
        box = _box(low, high, inverse, -inverse @ self.position)
        return [self._in_world(piece) for piece in self.solid.pieces(*box)]

    def _in_world(self, piece: Piece) -> Piece:
        place, axes, support = self.position, self.rotation, piece.support

        def turned(direction: Vector) -> Vector:
            return np.asarray(place + axes @ support(direction @ axes))

        return Piece(turned, place + axes @ piece.place, tuple(axes @ normal for normal in piece.normals))


def overlap(one: Placed, two: Placed, tolerance: float, normal: Vector) -> float:
    """Lower bound of the overlap of two solids [m]; 0 if a tolerance covers it.

    Parameters
    ----------
    one, two : Placed
        The solids.
    tolerance : float
        By how much they may overlap [m].
    normal : Vector
        Unit vector from the first to the second across which there may be a plane between them, shape [3]: if there is,
        nothing else is looked at.
    """
    if float(normal @ (one.support(normal) - two.support(-normal))) <= tolerance:
        return 0.0
    for a, b in near_pairs(one, two):
        found = depth(a, b, tolerance)
        if found > 0.0:
            return found
    return nested(one, two, tolerance)


def nested(one: Placed, two: Placed, tolerance: float) -> float:
    """Lower bound of the depth of points of one solid in the other, hollow one [m]; 0 if a tolerance covers it.

    No pieces of them may overlap by more than the tolerance.
    """
    if not (one.solid.hollow or two.solid.hollow):
        return 0.0
    deepest, pairs = 0.0, list(near_pairs(one, two, tolerance))
    for outer, inner, near in ((one, two, [b for _, b in pairs]), (two, one, [a for a, _ in pairs])):
        if outer.solid.hollow:
            # what does not cross is inside as a whole, or outside; boundaries that lie in one another for a part and
            # then go inside have pieces there that are next to one another
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
    """Pieces of two solids whose boxes meet.

    Parameters
    ----------
    one, two : Placed
        The solids.
    margin : float
        Boxes that are so near meet, too [m].
    way : Vector, optional
        By which the first is moved, its boxes being those of all that it passes [m], shape [3].
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
    """Box along the axes of one frame that holds a box along those of another."""
    middle, half = place + axes @ (0.5 * (low + high)), np.abs(axes) @ (0.5 * (high - low))
    return middle - half, middle + half
