"""Sphere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from bodies.shapes.smooth import core_numbers
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class Sphere(Shape):
    """A sphere with its centre at (x, y, z) in the body frame."""

    radius: float = parameter(doc="radius", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")

    @property
    def length(self) -> float:
        """The radius and the distance of the centre [m]."""
        return self.radius + math.hypot(self.x, self.y, self.z)

    @property
    def core(self) -> tuple[float, ...]:
        """Its support function in numbers (:func:`bodies.shapes.smooth.core_numbers`)."""
        return core_numbers((0.0, 0.0, 0.0), (2.0, 2.0), self.radius, (self.x, self.y, self.z), (1.0, 0.0, 0.0, 0.0))
