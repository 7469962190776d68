"""Libraries for distances with one fault each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from bodies import Sphere
from nonsmooth.interfaces import DistanceBackend, Shape
from nonsmooth.interfaces.distance_backend import Place, Separation


@final
@dataclass(frozen=True)
class Balls(DistanceBackend):
    """A library that knows spheres only."""

    fault: str = ""

    @property
    def rank(self) -> int:
        """Last."""
        return 9

    @property
    def installed(self) -> bool:
        """Unless that is the fault."""
        return self.fault != "not installed"

    def solid(self, shape: Shape) -> Any | None:
        """Return a sphere."""
        return shape if isinstance(shape, Sphere) else None

    def separation(self, first: Any, one: Place, second: Any, two: Place) -> Separation:
        """Return the distance of two spheres, with the fault."""
        centres = [place + axes @ (s.x, s.y, s.z) for (place, axes), s in ((one, first), (two, second))]
        way = centres[1] - centres[0]
        normal = way / np.linalg.norm(way)
        gap = float(np.linalg.norm(way)) - first.radius - second.radius
        points = [centres[0] + first.radius * normal, centres[1] - second.radius * normal]
        if self.fault == "order" and one[0][0] > two[0][0]:
            gap, points = 0.9 * gap, [points[0], points[0] + 0.9 * gap * normal]
        if self.fault == "points":
            points.reverse()
        if self.fault == "planes":
            gap, points = 2.0 * gap, [points[0], points[0] + 2.0 * gap * normal]
        return Separation(gap <= 0.0, gap, 1e-12, points[0], points[1], normal)


DUMMIES = [(fault, Balls(fault)) for fault in ("points", "order", "planes")]
"""Faults by the property made for them."""
