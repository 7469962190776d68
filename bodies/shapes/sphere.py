"""Sphere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter

from .drawing import arc, revolved
from .smooth import SmoothShape, core_numbers


@final
@dataclass(frozen=True)
class Sphere(SmoothShape):
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
    def lever(self) -> float:
        """The distance of the centre [m]: a turn about it moves no surface."""
        return math.hypot(self.x, self.y, self.z)

    @property
    def revolution(self) -> tuple[float, float, float]:
        """From the origin to the centre, if that lies elsewhere."""
        lever = self.lever
        return (self.x / lever, self.y / lever, self.z / lever) if lever > 0.0 else (0.0, 0.0, 0.0)

    @property
    def core(self) -> tuple[float, ...]:
        """Numbers of its support function (:func:`bodies.shapes.smooth.core_numbers`)."""
        return core_numbers((0.0, 0.0, 0.0), (2.0, 2.0), self.radius, (self.x, self.y, self.z), (1.0, 0.0, 0.0, 0.0))

    def support(self, direction: Vector) -> Vector:
        """Return the centre and the radius along the direction [m]."""
        return np.asarray(self.centroid + self.radius * direction / np.linalg.norm(direction))

    @property
    def volume(self) -> float:
        """4 pi r^3 / 3 [m^3]."""
        return 4.0 / 3.0 * math.pi * self.radius**3

    @property
    def centroid(self) -> Vector:
        """The centre [m]."""
        return np.array([self.x, self.y, self.z])

    @property
    def inertia(self) -> Vector:
        """2 V r^2 / 5 about any axis [m^5]."""
        return 0.4 * self.volume * self.radius**2 * np.eye(3)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return a mesh of meridians and parallels."""
        return revolved(self.radius * arc(fineness, math.pi, 0.0), fineness, self.centroid, (0.0, 0.0, 1.0))
