"""A convex solid, known by the points that lie farthest along directions."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.solid import SolidRegion, Vector


@final
@dataclass(frozen=True)
class ConvexSolid(SolidRegion):
    """A convex solid of a shape, which also has the ``parts`` from which distances are computed.

    Attributes
    ----------
    farthest : callable
        Returns a point that lies farthest along a direction [m], both of shape [3].
    set_back : float
        Largest distance between the boundary and the surface from which contacts compute gaps [m].
    """

    farthest: Callable[[Vector], Vector]
    set_back: float = 0.0

    def support(self, direction: Vector) -> Vector:
        """Return what the function returns."""
        return self.farthest(direction)

    @property
    def surface(self) -> None:
        """None, because it is convex."""

    @functools.cached_property
    def bounds(self) -> tuple[Vector, Vector]:
        """Those of the farthest points along the axes [m]."""
        low, high = (
            np.array([self.support(sign * axis)[i] for i, axis in enumerate(np.eye(3))]) for sign in (-1.0, 1.0)
        )
        return low, high
