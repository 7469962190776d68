"""Box."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.shapes.placement import turned, with_axes
from bodies.shapes.polyhedron import Polyhedron
from bodies.shapes.polytope import Polytope, polytope_of
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector


@final
@dataclass(frozen=True)
class Box(Polyhedron):
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

    @property
    def polytope(self) -> Polytope:
        """Vertices, faces and edges in the body frame."""
        return polytope_of("Box", self.vertices)

    @property
    def _axes(self) -> Vector:
        return with_axes(self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z)

    def support(self, direction: Vector) -> Vector:
        """Return the farthest vertex [m]; of several, that on the positive sides."""
        signs = np.where(direction @ self._axes >= 0.0, 1.0, -1.0)
        return np.asarray(self.centroid + self._axes @ (signs * [self.half_x, self.half_y, self.half_z]))

    @property
    def volume(self) -> float:
        """8 a b c [m^3]."""
        return 8.0 * self.half_x * self.half_y * self.half_z

    @property
    def centroid(self) -> Vector:
        """The centre [m]."""
        return np.array([self.x, self.y, self.z])

    @property
    def inertia(self) -> Vector:
        """V (b^2 + c^2) / 3 and so on about its own axes [m^5]."""
        x, y, z = self.half_x**2, self.half_y**2, self.half_z**2
        moments = self.volume / 3.0 * np.array([y + z, z + x, x + y])
        return np.asarray(self._axes * moments @ self._axes.T)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return its vertices and two triangles a face."""
        quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
        faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
        return np.array(self.vertices), np.array(faces)
