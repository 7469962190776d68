"""Point, a vertex."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces import ConvexPart, Shape
from nonsmooth.interfaces.convex_solid import ConvexSolid
from nonsmooth.interfaces.look import Look
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class Point(Shape):
    """A point at (x, y, z) in the body frame: a corner, a tip, an end."""

    x: float = parameter(0.0, doc="first coordinate", unit="m")
    y: float = parameter(0.0, doc="second coordinate", unit="m")
    z: float = parameter(0.0, doc="third coordinate", unit="m")

    @property
    def length(self) -> float:
        """The distance from the origin of the frame [m]."""
        return math.hypot(self.x, self.y, self.z)

    @property
    def solid(self) -> ConvexSolid:
        """The point."""
        place = np.array([self.x, self.y, self.z])
        return ConvexSolid(lambda direction: place)

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """The point."""
        return (ConvexPart.of_points(np.array([[self.x, self.y, self.z]])),)

    @property
    def look(self) -> Look:
        """A mark."""
        return Look.mark((self.x, self.y, self.z))
