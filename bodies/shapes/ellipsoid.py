"""Ellipsoid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector

from .drawing import arc, revolved
from .placement import turned, with_axes
from .smooth import SmoothShape, core_numbers


@final
@dataclass(frozen=True)
class Ellipsoid(SmoothShape):
    """A solid ellipsoid with its centre at (x, y, z) in the body frame and its axes turned by a unit quaternion."""

    semi_x: float = parameter(doc="first semi-axis", unit="m", above=0.0)
    semi_y: float = parameter(doc="second semi-axis", unit="m", above=0.0)
    semi_z: float = parameter(doc="third semi-axis", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    orientation_w: float = parameter(1.0, doc="quaternion from its axes to the body's, scalar part", **UNIT_PART)
    orientation_x: float = parameter(0.0, doc="quaternion, first component", **UNIT_PART)
    orientation_y: float = parameter(0.0, doc="quaternion, second component", **UNIT_PART)
    orientation_z: float = parameter(0.0, doc="quaternion, third component", **UNIT_PART)

    def _check(self) -> None:
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        unit_vector("Ellipsoid orientation", orientation, 4)

    @property
    def core(self) -> tuple[float, ...]:
        """Numbers of its support function (:func:`bodies.shapes.smooth.core_numbers`)."""
        return core_numbers(
            (self.semi_x, self.semi_y, self.semi_z),
            (2.0, 2.0),
            0.0,
            (self.x, self.y, self.z),
            (self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z),
        )

    @property
    def length(self) -> float:
        """Distance of the farthest point [m].

        Where |c + A v| is largest over |v| = 1, (l - A^2) v = A c with l not below the largest a^2; |v| falls with l.
        """
        inverse = self.orientation_w, -self.orientation_x, -self.orientation_y, -self.orientation_z
        semi = self.semi_x, self.semi_y, self.semi_z
        center = turned(*inverse, self.x, self.y, self.z)
        pull = [a * c for a, c in zip(semi, center, strict=True)]
        largest = max(semi) ** 2
        low, high = largest, largest + math.hypot(*pull)
        while low < (middle := 0.5 * (low + high)) < high:
            long = math.hypot(*[_over(p, middle - a * a) for p, a in zip(pull, semi, strict=True)]) > 1.0
            low, high = (middle, high) if long else (low, middle)
        v = [_over(p, high - a * a) for p, a in zip(pull, semi, strict=True)]
        # where nothing pulls along the longest axis, what is missing of |v| = 1 goes there
        longest = semi.index(max(semi))
        rest = math.hypot(*[c for i, c in enumerate(v) if i != longest])
        v[longest] = math.copysign(math.sqrt(max(1.0 - rest * rest, 0.0)), center[longest])
        return math.hypot(*[c + a * w for c, a, w in zip(center, semi, v, strict=True)])

    @property
    def _axes(self) -> Vector:
        return with_axes(self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z)

    def support(self, direction: Vector) -> Vector:
        """Return c + A^2 n / |A n| with A the semi-axes in the axes of the body [m]."""
        semi = np.array([self.semi_x, self.semi_y, self.semi_z])
        stretched = semi * (direction @ self._axes)
        return np.asarray(self.centroid + self._axes @ (semi * stretched) / np.linalg.norm(stretched))

    @property
    def volume(self) -> float:
        """4 pi a b c / 3 [m^3]."""
        return 4.0 / 3.0 * math.pi * self.semi_x * self.semi_y * self.semi_z

    @property
    def centroid(self) -> Vector:
        """The centre [m]."""
        return np.array([self.x, self.y, self.z])

    @property
    def inertia(self) -> Vector:
        """V (b^2 + c^2) / 5 and so on about its own axes [m^5]."""
        x, y, z = self.semi_x**2, self.semi_y**2, self.semi_z**2
        moments = 0.2 * self.volume * np.array([y + z, z + x, x + y])
        return np.asarray(self._axes * moments @ self._axes.T)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return a mesh of meridians and parallels."""
        ball, faces = revolved(arc(fineness, math.pi, 0.0), fineness, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
        return self.centroid + ball * [self.semi_x, self.semi_y, self.semi_z] @ self._axes.T, faces


def _over(numerator: float, denominator: float) -> float:
    return numerator / denominator if denominator > 0.0 else 0.0
