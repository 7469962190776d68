"""Convex shapes as a user writes them: their farthest points, and nothing else."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies import Ellipsoid, SupportShape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class EllipsoidSum(SupportShape):
    """The Minkowski sum of two ellipsoids, the second turned about the first axis."""

    semi_x: float = parameter(6e-3, doc="first semi-axis of the first", unit="m", above=0.0)
    semi_y: float = parameter(4e-3, doc="second semi-axis of the first", unit="m", above=0.0)
    semi_z: float = parameter(3e-3, doc="third semi-axis of the first", unit="m", above=0.0)
    other_x: float = parameter(2e-3, doc="first semi-axis of the second", unit="m", above=0.0)
    other_y: float = parameter(5e-3, doc="second semi-axis of the second", unit="m", above=0.0)
    other_z: float = parameter(3e-3, doc="third semi-axis of the second", unit="m", above=0.0)
    turn: float = parameter(0.7, doc="turn of the second", unit="rad")

    def support(self, direction: Vector) -> Vector:
        """Return the sum of the farthest points of both [m]."""
        one = np.array([self.semi_x, self.semi_y, self.semi_z])
        two = np.array([self.other_x, self.other_y, self.other_z])
        c, s = math.cos(self.turn), math.sin(self.turn)
        axes = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
        v, w = one * direction, two * (axes.T @ direction)
        return np.asarray(one * v / math.sqrt(np.sum(v * v)) + axes @ (two * w) / math.sqrt(np.sum(w * w)))


@final
@dataclass(frozen=True)
class Lens(SupportShape):
    """What two equal balls have in common, with a smaller ball rolled over it; the rim is in the plane z = 0."""

    radius: float = parameter(0.02, doc="radius of the balls", unit="m", above=0.0)
    rim: float = parameter(0.01, doc="radius of the rim, below that of the balls", unit="m", above=0.0)
    rounding: float = parameter(0.0, doc="radius of the smaller ball; 0 leaves the rim sharp", unit="m", minimum=0.0)

    def support(self, direction: Vector) -> Vector:
        """Return a point of a cap or of the rim, and the radius of the smaller ball from there [m]."""
        n = direction / math.sqrt(np.sum(direction * direction))
        across = math.sqrt(n[0] ** 2 + n[1] ** 2)
        if across * self.radius <= self.rim:
            depth = math.sqrt(self.radius**2 - self.rim**2)
            return np.asarray((self.radius + self.rounding) * n - np.array([0.0, 0.0, math.copysign(depth, n[2])]))
        return np.asarray(np.array([n[0], n[1], 0.0]) * self.rim / across + self.rounding * n)


@final
@dataclass(frozen=True)
class Spindle(SupportShape):
    """An arc of a circle turned about its chord, the third axis: it has two tips."""

    radius: float = parameter(0.02, doc="radius of the arc", unit="m", above=0.0)
    half: float = parameter(0.01, doc="half the chord, below the radius", unit="m", above=0.0)

    def support(self, direction: Vector) -> Vector:
        """Return a point of the arc or a tip [m]."""
        n = direction / math.sqrt(np.sum(direction * direction))
        if abs(n[2]) * self.radius > self.half:
            return np.asarray(np.array([0.0, 0.0, math.copysign(self.half, n[2])]))
        depth = math.sqrt(self.radius**2 - self.half**2) / math.sqrt(n[0] ** 2 + n[1] ** 2)
        return np.asarray(self.radius * n - depth * np.array([n[0], n[1], 0.0]))


@final
@dataclass(frozen=True)
class SameEllipsoid(SupportShape):
    """An ellipsoid that nobody knows to be one."""

    semi_x: float = parameter(8e-3, doc="first semi-axis", unit="m", above=0.0)
    semi_y: float = parameter(14e-3, doc="second semi-axis", unit="m", above=0.0)
    semi_z: float = parameter(11e-3, doc="third semi-axis", unit="m", above=0.0)

    def support(self, direction: Vector) -> Vector:
        """Return A^2 d / |A d| [m]."""
        semi = np.array([self.semi_x, self.semi_y, self.semi_z])
        stretched = semi * direction
        return np.asarray(semi * stretched / math.sqrt(np.sum(stretched * stretched)))


@final
@dataclass(frozen=True)
class Sum(SupportShape):
    """The Minkowski sum of two shapes: numba knows none of them."""

    first: Ellipsoid
    second: Ellipsoid

    def support(self, direction: Vector) -> Vector:
        """Return the sum of the farthest points [m]."""
        return self.first.support(direction) + self.second.support(direction)
