"""Disc, without thickness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bodies.shapes.placement import farthest_on_circle
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter
from nonsmooth.vectors import unit_vector


@final
@dataclass(frozen=True)
class Disc(Shape):
    """A rigid disc without thickness, with its centre at (x, y, z) in the body frame: a rim and two faces."""

    radius: float = parameter(doc="radius", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis in the body frame, first component")
    axis_y: float = parameter(0.0, doc="unit axis in the body frame, second component")
    axis_z: float = parameter(1.0, doc="unit axis in the body frame, third component")

    def _check(self) -> None:
        unit_vector("Disc axis", (self.axis_x, self.axis_y, self.axis_z))

    @property
    def length(self) -> float:
        """Distance of the farthest point of the rim [m]."""
        return farthest_on_circle(self.radius, (self.x, self.y, self.z), (self.axis_x, self.axis_y, self.axis_z))
