"""Capsule, a cylinder with two half spheres at its ends."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector


@final
@dataclass(frozen=True)
class Capsule(Shape):
    """All points within the radius of a segment, which has its middle at (x, y, z) in the body frame."""

    radius: float = parameter(doc="radius", unit="m", above=0.0)
    half_length: float = parameter(
        doc="half the length of the segment between the end spheres' centres", unit="m", above=0.0
    )
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis in the body frame, first component", **UNIT_PART)
    axis_y: float = parameter(0.0, doc="unit axis in the body frame, second component", **UNIT_PART)
    axis_z: float = parameter(1.0, doc="unit axis in the body frame, third component", **UNIT_PART)

    def _check(self) -> None:
        unit_vector("Capsule axis", (self.axis_x, self.axis_y, self.axis_z))

    @property
    def ends(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Centres of the end spheres in the body frame, against and along the axis [m]."""
        x, y, z = (self.half_length * component for component in (self.axis_x, self.axis_y, self.axis_z))
        return (self.x - x, self.y - y, self.z - z), (self.x + x, self.y + y, self.z + z)

    @property
    def length(self) -> float:
        """The radius and the distance of the farther end's centre [m]."""
        return self.radius + max(math.hypot(*end) for end in self.ends)
