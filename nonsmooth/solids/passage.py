"""Where a solid that is moved along a line, without being turned, meets another one.

The distance of two convex sets that so move is a convex function of the way.  The planes that prove a distance let the
sets come as near as that at least, so that the first meeting is approached from before it and never passed.
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
"""Gaps that count as none, relative to the size of both solids."""
_MOST = 1000


@final
@dataclass(frozen=True)
class Passage:
    """The way of a solid past another one.

    Attributes
    ----------
    one, two : Placed
        The solids; it is the first that moves.
    way : Vector
        Unit vector along which it moves, shape [3].
    height : float
        The distance that counts as met [m].
    """

    one: Placed
    two: Placed
    way: Vector
    height: float

    @functools.cached_property
    def _size(self) -> float:
        """No points of the two are farther from each other than this [m]."""
        (low, high), (below, above) = self.one.bounds, self.two.bounds
        return float(np.linalg.norm(np.maximum(high, above) - np.minimum(low, below)))

    @functools.cached_property
    def tolerance(self) -> float:
        """How much nearer than the height solids may be that have met [m]."""
        sizes = [float(np.linalg.norm(high - low)) for low, high in (self.one.bounds, self.two.bounds)]
        # a point has no size
        return max(1e-9 * min(sizes), 1e-15 * max(sizes))

    @property
    def clear(self) -> bool:
        """Whether the solids are as far apart as they may be."""
        return not self._near and nested(self.one, self.two, self.tolerance) == 0.0

    def ahead(self) -> float:
        """Distance that the first, now clear, can move along the way [m]; infinite if it meets nothing."""
        pairs = near_pairs(self.one, self.two, self.height, (self._size + self.height) * self.way)
        return self._first(list(pairs), 0.0)

    def back(self) -> float:
        """Least distance that the first, not clear now, must go back [m]; it need not suffice."""
        if near := self._near:
            return -self._first(near, self._far)
        met = (
            self._first([pair], self._far) for pair in near_pairs(self.one, self.two, self.height, self._far * self.way)
        )
        return -max((place for place in met if place < -self.tolerance), default=self._far)

    @property
    def _far(self) -> float:
        """Where the first has all of the second ahead of it [m]."""
        return -2.0 * (self._size + self.height)

    @functools.cached_property
    def _near(self) -> list[tuple[Piece, Piece]]:
        """The pieces that are nearer than they may be."""
        pairs, least, still = near_pairs(self.one, self.two, self.height), self.tolerance, np.zeros(3)
        if self.height == 0.0:
            return [(a, b) for a, b in pairs if depth(a, b, least) > 0.0]
        return [(a, b) for a, b in pairs if separation(a, b, still, self.height, 0.1 * least)[0] < -least]

    def _first(self, pairs: list[tuple[Piece, Piece]], start: float) -> float:
        """Distance at which the first of some pairs of pieces meets, from a place where all are apart [m]."""
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
            # they do not come nearer, and never will, as the distance is a convex function of the way
            if speed <= 0.0 or distance > 2.0 * (self._size + self.height):
                return math.inf
            distance += gap / speed
        return distance
