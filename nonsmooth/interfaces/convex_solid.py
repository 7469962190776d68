"""A convex solid, known by the points that lie farthest along directions."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.solid import Piece, SolidRegion, Vector


@final
@dataclass(frozen=True)
class ConvexSolid(SolidRegion):
    """A single piece, which fills the solid.

    Attributes
    ----------
    farthest : callable
        Returns a point that lies farthest along a direction [m], both of shape [3].
    set_back : float
        How far what contacts see may lie off the boundary [m].
    """

    farthest: Callable[[Vector], Vector]
    set_back: float = 0.0

    def support(self, direction: Vector) -> Vector:
        """Return what the function returns."""
        return self.farthest(direction)

    @property
    def hollow(self) -> bool:
        """False, because one piece fills the solid."""
        return False

    @functools.cached_property
    def _extremes(self) -> Vector:
        return np.array([self.support(sign * axis) for sign in (-1.0, 1.0) for axis in np.eye(3)])

    @functools.cached_property
    def _whole(self) -> Piece:
        # in the middle of what is extreme, and so inside
        return Piece(self.farthest, np.mean(self._extremes, axis=0))

    @functools.cached_property
    def bounds(self) -> tuple[Vector, Vector]:
        """Those of the farthest points along the axes [m]."""
        return np.diag(self._extremes[:3]), np.diag(self._extremes[3:])

    def pieces(self, low: Vector, high: Vector) -> Sequence[Piece]:
        """Return the whole: who asks has looked at its bounds."""
        return (self._whole,)

    @property
    def inner(self) -> Vector:
        """A point in the middle [m]."""
        return self._whole.place[None, :]

    def holds(self, point: Vector, margin: float) -> bool:
        """Return False always, because the single convex piece of this solid already decides if a point is inside."""
        return False
