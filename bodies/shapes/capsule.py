"""Capsule, a cylinder with two half spheres at its ends."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector

from .drawing import arc, revolved
from .placement import about_axis
from .polyhedron import SweptPolytope
from .polytope import Polytope


@final
@dataclass(frozen=True)
class Capsule(SweptPolytope):
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
    def core(self) -> Polytope:
        """The segment: two vertices, an edge, no face."""
        return Polytope(self.ends, (), (), ((0, 1, -1, -1),))

    @property
    def sweep(self) -> float:
        """The radius [m]."""
        return self.radius

    @property
    def length(self) -> float:
        """The radius and the distance of the farther end's centre [m]."""
        return self.radius + max(math.hypot(*end) for end in self.ends)

    def support(self, direction: Vector) -> Vector:
        """Return the farther end's centre and the radius along the direction [m]."""
        end = self.ends[1 if direction @ np.array([self.axis_x, self.axis_y, self.axis_z]) >= 0.0 else 0]
        return np.asarray(end + self.radius * direction / np.linalg.norm(direction))

    @property
    def volume(self) -> float:
        """Volume of the cylinder and its two half-balls, pi r^2 (2 c + 4 r / 3) with half-length c [m^3]."""
        return math.pi * self.radius**2 * (2.0 * self.half_length + 4.0 / 3.0 * self.radius)

    @property
    def centroid(self) -> Vector:
        """The centre [m]."""
        return np.array([self.x, self.y, self.z])

    @property
    def inertia(self) -> Vector:
        """Inertia tensor of the cylinder and the two half-balls, at density 1, by the parallel-axis theorem [m^5]."""
        r, c = self.radius, self.half_length
        side, ends = 2.0 * math.pi * r**2 * c, 4.0 / 3.0 * math.pi * r**3
        along = (0.5 * side + 0.4 * ends) * r**2
        across = side * (r**2 / 4.0 + c**2 / 3.0) + ends * (0.4 * r**2 + 0.75 * r * c + c**2)
        return about_axis((self.axis_x, self.axis_y, self.axis_z), along, across)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return a mesh of meridians and parallels."""
        low = self.radius * arc(fineness, math.pi, 0.5 * math.pi) - (0.0, self.half_length)
        high = self.radius * arc(fineness, 0.5 * math.pi, 0.0) + (0.0, self.half_length)
        axis = self.axis_x, self.axis_y, self.axis_z
        return revolved(np.vstack([low, high]), fineness, self.centroid, axis)
