"""Cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bodies.shapes.placement import farthest_on_circle
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter
from nonsmooth.vectors import unit_vector


@final
@dataclass(frozen=True)
class Cylinder(Shape):
    """A solid circular cylinder with flat caps and its centre at (x, y, z) in the body frame."""

    radius: float = parameter(doc="radius", unit="m", above=0.0)
    half_length: float = parameter(doc="half the distance of the caps", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis in the body frame, first component")
    axis_y: float = parameter(0.0, doc="unit axis in the body frame, second component")
    axis_z: float = parameter(1.0, doc="unit axis in the body frame, third component")

    def _check(self) -> None:
        unit_vector("Cylinder axis", (self.axis_x, self.axis_y, self.axis_z))

    @property
    def caps(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Centres of the caps in the body frame, against and along the axis [m]."""
        x, y, z = (self.half_length * component for component in (self.axis_x, self.axis_y, self.axis_z))
        return (self.x - x, self.y - y, self.z - z), (self.x + x, self.y + y, self.z + z)

    @property
    def length(self) -> float:
        """Distance of the farthest point of the two rims [m]."""
        axis = self.axis_x, self.axis_y, self.axis_z
        return max(farthest_on_circle(self.radius, cap, axis) for cap in self.caps)
