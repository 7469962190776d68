"""Distance along a line that a shape moves without rotation until it meets another shape.

The distance of two convex sets is a convex function of this translation.  Each step of the search moves the shape as
far as the planes that prove the distance allow.  So the place of the first meeting is approached from before it and
never passed.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.solid import Vector
from nonsmooth.solids.measure import Measured
from nonsmooth.solids.placed import Placed, measured, near_pairs, nested

_EXACT = 1e-13
"""The search along the line ends if the gap exceeds ``Passage.height`` by less than this.  It is relative to the sum
of ``height`` and the extent of both shapes, and slightly larger than round-off."""
_MOST = 1000


@final
@dataclass(frozen=True)
class Passage:
    """A shape that is moved along a line towards another one.

    Attributes
    ----------
    one, two : Placed
        The shapes; the first one moves.
    way : Vector
        Unit vector along which the first shape moves, shape [3].
    height : float
        Gap at which the shapes meet [m]: 0 if they meet when they touch.
    """

    one: Placed
    two: Placed
    way: Vector
    height: float

    @functools.cached_property
    def _size(self) -> float:
        """Upper bound of the distance of any two points of the shapes [m]."""
        (low, high), (below, above) = self.one.bounds, self.two.bounds
        return float(np.linalg.norm(np.maximum(high, above) - np.minimum(low, below)))

    @functools.cached_property
    def tolerance(self) -> float:
        """Tolerance of the gap [m]: the shapes have met if the gap is less than ``height`` by more than this."""
        sizes = [float(np.linalg.norm(high - low)) for low, high in (self.one.bounds, self.two.bounds)]
        # the second number is for a point, which has no size
        return max(1e-9 * min(sizes), 1e-15 * max(sizes))

    @property
    def clear(self) -> bool:
        """True if the shapes have not met: their gap is at least ``height``, within the tolerance."""
        return not self._near and nested(self.one, self.two, self.tolerance) == 0.0

    def ahead(self) -> float:
        """Distance that the first shape moves until the gap is ``height`` [m]; inf if it never is.

        :attr:`clear` must be True before the motion.
        """
        return self._first(self._pairs((self._size + self.height) * self.way), 0.0)

    def back(self) -> float:
        """Lower bound of the distance that the first shape must move back until :attr:`clear` is True [m].

        :attr:`clear` must be False before the motion.
        """
        if near := self._near:
            return -self._first(near, self._far)
        met = (self._first([pair], self._far) for pair in self._pairs(self._far * self.way))
        return -max((place for place in met if place < -self.tolerance), default=self._far)

    @property
    def _far(self) -> float:
        """Negative displacement along ``way`` [m] that puts the first shape entirely behind the second one."""
        return -2.0 * (self._size + self.height)

    def _pairs(self, way: Vector | None = None) -> list[tuple[int, int]]:
        """Pairs of pieces that may come as near as ``height`` while the first shape moves by ``way`` [m]."""
        return [(i, j) for i, j, _ in near_pairs(self.one, self.two, self.height, way)]

    def _measured(self, pair: tuple[int, int], distance: float) -> Measured:
        """Distance of a pair of pieces after the first shape has moved by ``distance`` [m] along ``way``."""
        return measured(self.one.moved(distance * self.way), self.two, *pair)

    @functools.cached_property
    def _near(self) -> list[tuple[int, int]]:
        """Pairs of pieces of the two shapes that have met: their gap is less than ``height``, beyond the tolerance."""
        return [pair for pair in self._pairs() if self._measured(pair, 0.0).separation < self.height - self.tolerance]

    def _first(self, pairs: list[tuple[int, int]], start: float) -> float:
        """Least displacement of the first shape along ``way`` [m] at which some pair of pieces has the gap ``height``.

        The search begins at the displacement ``start``, at which the gaps of all pairs must be larger than ``height``.
        The result is inf if no pair comes so near.
        """
        best = math.inf
        for pair in pairs:
            best = min(best, self._meeting(pair, start, best))
        return best

    def _meeting(self, pair: tuple[int, int], start: float, most: float) -> float:
        """Displacement at which a pair of pieces has the gap ``height`` [m]; inf if it is not less than ``most``."""
        distance, least = start, _EXACT * (self._size + self.height)
        for _ in range(_MOST):
            found = self._measured(pair, distance)
            gap, speed = found.separation - self.height, float(found.normal @ self.way)
            if gap <= least:
                break
            # the pieces do not approach, and never will, as their distance is a convex function of the translation
            if speed <= 0.0 or distance > 2.0 * (self._size + self.height):
                return math.inf
            distance += gap / speed
            if distance >= most:
                return math.inf
        return distance
