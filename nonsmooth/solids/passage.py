"""Distance along a line that a solid moves without rotation until it meets another solid.

The distance of two convex sets is a convex function of this translation.  Each step of the search moves the solid as
far as the planes that prove the distance allow.  So the place of the first meeting is approached from before it and
never passed.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.solid import Piece, Vector
from nonsmooth.solids.overlap import depth
from nonsmooth.solids.placed import Placed, near_pairs, nested
from nonsmooth.solids.separation import separation

_EXACT = 1e-13
"""The search along the line ends if the gap exceeds ``Passage.height`` by less than this.  It is relative to the sum
of ``height`` and the extent of both solids, and slightly larger than round-off."""
_MOST = 1000


@final
@dataclass(frozen=True)
class Passage:
    """A solid that is moved along a line towards another one.

    Attributes
    ----------
    one, two : Placed
        The solids; the first one moves.
    way : Vector
        Unit vector along which the first solid moves, shape [3].
    height : float
        Gap at which the solids meet [m]: 0 if they meet when they touch.
    """

    one: Placed
    two: Placed
    way: Vector
    height: float

    @functools.cached_property
    def _size(self) -> float:
        """Upper bound of the distance of any two points of the solids [m]."""
        (low, high), (below, above) = self.one.bounds, self.two.bounds
        return float(np.linalg.norm(np.maximum(high, above) - np.minimum(low, below)))

    @functools.cached_property
    def tolerance(self) -> float:
        """Tolerance of the gap [m]: the solids have met if the gap is less than ``height`` by more than this."""
        sizes = [float(np.linalg.norm(high - low)) for low, high in (self.one.bounds, self.two.bounds)]
        # the second number is for a point, which has no size
        return max(1e-9 * min(sizes), 1e-15 * max(sizes))

    @property
    def clear(self) -> bool:
        """True if the solids have not met: their gap is at least ``height``, within the tolerance."""
        return not self._near and nested(self.one, self.two, self.tolerance) == 0.0

    def ahead(self) -> float:
        """Distance that the first solid moves until the gap is ``height`` [m]; inf if it never is.

        :attr:`clear` must be True before the motion.
        """
        pairs = near_pairs(self.one, self.two, self.height, (self._size + self.height) * self.way)
        return self._first(list(pairs), 0.0)

    def back(self) -> float:
        """Lower bound of the distance that the first solid must move back until :attr:`clear` is True [m].

        :attr:`clear` must be False before the motion.
        """
        if near := self._near:
            return -self._first(near, self._far)
        met = (
            self._first([pair], self._far) for pair in near_pairs(self.one, self.two, self.height, self._far * self.way)
        )
        return -max((place for place in met if place < -self.tolerance), default=self._far)

    @property
    def _far(self) -> float:
        """Negative displacement along ``way`` [m] that puts the first solid entirely behind the second one."""
        return -2.0 * (self._size + self.height)

    @functools.cached_property
    def _near(self) -> list[tuple[Piece, Piece]]:
        """Pairs of pieces of the two solids that have met: their gap is less than ``height``, beyond the tolerance."""
        pairs, least, still = near_pairs(self.one, self.two, self.height), self.tolerance, np.zeros(3)
        if self.height == 0.0:
            return [(a, b) for a, b in pairs if depth(a, b, least) > 0.0]
        return [(a, b) for a, b in pairs if separation(a, b, still, self.height, 0.1 * least)[0] < -least]

    def _first(self, pairs: list[tuple[Piece, Piece]], start: float) -> float:
        """Least displacement of the first solid along ``way`` [m] at which some pair of pieces has the gap ``height``.

        The search begins at the displacement ``start``, at which the gaps of all pairs must be larger than ``height``.
        The result is inf if no pair comes so near.
        """
        least, best = _EXACT * (self._size + self.height), math.inf
        bounds = [
            (float(self.way @ (two.support(-self.way) - one.support(self.way))) - self.height, i)
            for i, (one, two) in enumerate(pairs)
        ]
        for bound, i in sorted(bounds):
            if bound >= best:
                break
            best = min(best, self._meeting(*pairs[i], start, least))
        return best

    def _meeting(self, one: Piece, two: Piece, start: float, least: float) -> float:
        distance = start
        for _ in range(_MOST):
            gap, normal = separation(one, two, distance * self.way, self.height, 0.1 * least)
            if gap <= least:
                break
            speed = float(normal @ self.way)
            # the pieces do not approach, and never will, as their distance is a convex function of the translation
            if speed <= 0.0 or distance > 2.0 * (self._size + self.height):
                return math.inf
            distance += gap / speed
        return distance
