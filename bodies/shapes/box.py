"""Box."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ConvexPart
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector

from .placement import turned, with_axes
from .polyhedron import Polyhedron
from .polytope import Polytope, polytope_of
from .swept_solid import draw_swept, swept_solid

_THINNEST = 1e-5
"""The core is at least so thick, in units of the largest half-length."""


def check_rounding(name: str, halves: tuple[float, float, float], rounding: float) -> None:
    """Raise InvalidInput unless half-lengths of a box [m] leave a core when they are rounded [m]."""
    most = min(halves) - _THINNEST * max(halves)
    if rounding > 0.0 and rounding > most:
        raise InvalidInput(
            f"{name}.rounding",
            f"must be less than the least half-length, at most {most:g} [m]",
            rounding,
            "The half-lengths are those of the whole. Round all over is a Capsule or a Sphere.",
        )


@final
@dataclass(frozen=True)
class Box(Polyhedron):
    """A solid box with its centre at (x, y, z) in the body frame and its axes turned by a unit quaternion.

    Its edges and vertices are sharp, or rounded by the radius ``rounding``.  Its half-lengths are those of the whole: a
    rounded box is as large as a sharp one, and its core smaller by the radius on all sides.
    """

    half_x: float = parameter(doc="half-length of the whole along its first axis", unit="m", above=0.0)
    half_y: float = parameter(doc="half-length of the whole along its second axis", unit="m", above=0.0)
    half_z: float = parameter(doc="half-length of the whole along its third axis", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    orientation_w: float = parameter(1.0, doc="quaternion from its axes to the body's, scalar part", **UNIT_PART)
    orientation_x: float = parameter(0.0, doc="quaternion, first component", **UNIT_PART)
    orientation_y: float = parameter(0.0, doc="quaternion, second component", **UNIT_PART)
    orientation_z: float = parameter(0.0, doc="quaternion, third component", **UNIT_PART)

    rounding: float = parameter(0.0, doc="radius of its edges and vertices", unit="m", minimum=0.0)

    def _check(self) -> None:
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        unit_vector("Box orientation", orientation, 4)
        check_rounding("Box", (self.half_x, self.half_y, self.half_z), self.rounding)

    @property
    def core_sizes(self) -> tuple[float, float, float]:
        """Half-lengths without the rounding [m]."""
        return self.half_x - self.rounding, self.half_y - self.rounding, self.half_z - self.rounding

    @property
    def vertices(self) -> tuple[tuple[float, float, float], ...]:
        """The eight vertices of the core, which is the box itself if it is sharp, in the body frame [m]."""
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        half_x, half_y, half_z = self.core_sizes
        corners = []
        for i, j, k in itertools.product((-1.0, 1.0), repeat=3):
            a, b, c = turned(*orientation, i * half_x, j * half_y, k * half_z)
            corners.append((self.x + a, self.y + b, self.z + c))
        return tuple(corners)

    @property
    def core(self) -> Polytope:
        """Vertices, faces and edges of the core in the body frame."""
        return polytope_of("Box", self.vertices)

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """The hull of the vertices, swept: those of the core, whose faces take longer to find."""
        return (ConvexPart.of_points(np.array(self.vertices), self.rounding),)

    @property
    def _axes(self) -> Vector:
        return with_axes(self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z)

    def support(self, direction: Vector) -> Vector:
        """Return the farthest vertex of the core, of several that on the positive sides, and the rounding [m]."""
        signs = np.where(direction @ self._axes >= 0.0, 1.0, -1.0)
        return np.asarray(self.centroid + self._axes @ (signs * self.core_sizes) + self._rounded(direction))

    @property
    def volume(self) -> float:
        """V + S r + M r^2 + 4 pi r^3 / 3, with V = 8 a b c, S = 8 (ab + bc + ca), M = 2 pi (a + b + c) [m^3]."""
        (a, b, c), r = self.core_sizes, self.rounding
        swept = 8.0 * (a * b + b * c + c * a) * r + math.pi * (2.0 * (a + b + c) * r**2 + 4.0 / 3.0 * r**3)
        return 8.0 * a * b * c + swept

    @property
    def centroid(self) -> Vector:
        """The centre [m]."""
        return np.array([self.x, self.y, self.z])

    @property
    def inertia(self) -> Vector:
        """V (b^2 + c^2) / 3 and so on about its own axes [m^5]; of a rounded one, piece by piece."""
        if self.rounding > 0.0:
            return swept_solid(self.core, self.rounding)[2]
        x, y, z = self.half_x**2, self.half_y**2, self.half_z**2
        moments = self.volume / 3.0 * np.array([y + z, z + x, x + y])
        return np.asarray(self._axes * moments @ self._axes.T)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return its vertices and two triangles a face; of a rounded one strips at edges and caps at vertices, too."""
        if self.rounding > 0.0:
            return draw_swept(self.core, self.rounding, fineness)
        quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
        faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
        return np.array(self.vertices), np.array(faces)
