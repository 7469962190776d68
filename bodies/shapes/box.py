"""Box."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import final

from bodies.shapes.placement import turned
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector


@final
@dataclass(frozen=True)
class Box(Shape):
    """A solid box with its centre at (x, y, z) in the body frame and its axes turned by a unit quaternion."""

    half_x: float = parameter(doc="half-length along its first axis", unit="m", above=0.0)
    half_y: float = parameter(doc="half-length along its second axis", unit="m", above=0.0)
    half_z: float = parameter(doc="half-length along its third axis", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    orientation_w: float = parameter(1.0, doc="quaternion from its axes to the body's, scalar part", **UNIT_PART)
    orientation_x: float = parameter(0.0, doc="quaternion, first component", **UNIT_PART)
    orientation_y: float = parameter(0.0, doc="quaternion, second component", **UNIT_PART)
    orientation_z: float = parameter(0.0, doc="quaternion, third component", **UNIT_PART)

    def _check(self) -> None:
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        unit_vector("Box orientation", orientation, 4)

    @property
    def vertices(self) -> tuple[tuple[float, float, float], ...]:
        """The eight vertices in the body frame [m]."""
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        corners = []
        for i, j, k in itertools.product((-1.0, 1.0), repeat=3):
            a, b, c = turned(*orientation, i * self.half_x, j * self.half_y, k * self.half_z)
            corners.append((self.x + a, self.y + b, self.z + c))
        return tuple(corners)

    @property
    def length(self) -> float:
        """Distance of the farthest vertex [m]."""
        return max(math.hypot(*vertex) for vertex in self.vertices)
