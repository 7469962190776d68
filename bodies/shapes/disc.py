"""Disc, without thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from bodies.shapes.feet import check_feet, feet_on
from bodies.shapes.placement import farthest_on_circle
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector


@final
@dataclass(frozen=True)
class Disc(Shape):
    """A rigid disc without thickness, with its centre at (x, y, z) in the body frame: a rim and two faces.

    On a plane it touches with the lowest point of its rim, and a disc that lies flat has none.  What holds it then are
    three small feet on either face, at two thirds of the radius, if they have a height.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis in the body frame, first component", **UNIT_PART)
    axis_y: float = parameter(0.0, doc="unit axis in the body frame, second component", **UNIT_PART)
    axis_z: float = parameter(1.0, doc="unit axis in the body frame, third component", **UNIT_PART)
    foot_height: float = parameter(0.0, doc="height of the feet on either face; 0 for none", unit="m", minimum=0.0)

    def _check(self) -> None:
        unit_vector("Disc axis", (self.axis_x, self.axis_y, self.axis_z))
        check_feet("Disc", self.foot_height, self.radius)

    @property
    def feet(self) -> tuple[tuple[float, float, float], ...]:
        """Tips of the feet in the body frame, first of the face against the axis [m]; none without a height."""
        if self.foot_height == 0.0:
            return ()
        center, axis = (self.x, self.y, self.z), (self.axis_x, self.axis_y, self.axis_z)
        return feet_on(center, axis, self.radius, self.foot_height)

    @property
    def length(self) -> float:
        """Distance of the farthest point of the rim and the feet [m]."""
        rim = farthest_on_circle(self.radius, (self.x, self.y, self.z), (self.axis_x, self.axis_y, self.axis_z))
        return max([rim, *(math.hypot(*foot) for foot in self.feet)])
