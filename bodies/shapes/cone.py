"""Cone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector

from .drawing import revolved
from .frustum import (
    FEET_OF_FACE,
    Frustum,
    Point,
    check_feet,
    check_rounding,
    feet_on,
    frustum_numbers,
    on_axis,
    standing_height,
)
from .placement import about_axis, across_axis, farthest_on_circle
from .revolution import draw_swept_frustum, swept_frustum


def inner_radius(radius: float, height: float) -> float:
    """Return the radius of the largest ball within a cone [m]."""
    return radius * height / (radius + math.hypot(radius, height))


@final
@dataclass(frozen=True)
class Cone(Frustum):
    """A solid circular cone with the centre of its base at (x, y, z) in the body frame; the axis points to the apex.

    On a plane it touches with the lowest point of its rim and with its apex, and on its side with both.  A cone that
    stands on its base rests on three small feet, at two thirds of the radius.  Their tips lie in the plane of the base.
    The rim is set back by the height of the feet.  The convex solid has no feet.

    Its rim and its apex are sharp, or rounded by the radius ``rounding``.  Radius and height are those of the sharp
    cone with the same base and side, which is higher.  Feet of a rounded one are those of the core, and round: their
    tips lie in the plane of the base of the whole.
    """

    radius: float = parameter(doc="radius of the base", unit="m", above=0.0)
    height: float = parameter(doc="distance of the apex from the base", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre of the base, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre of the base, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre of the base, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis to the apex in the body frame, first component", **UNIT_PART)
    axis_y: float = parameter(0.0, doc="unit axis to the apex in the body frame, second component", **UNIT_PART)
    axis_z: float = parameter(1.0, doc="unit axis to the apex in the body frame, third component", **UNIT_PART)
    foot_height: float = parameter(0.0, doc="height of the feet on the base; 0 for the least", unit="m", minimum=0.0)
    rounding: float = parameter(0.0, doc="radius of its rim and its apex", unit="m", minimum=0.0)

    def _check(self) -> None:
        unit_vector("Cone axis", self._axis)
        check_rounding("Cone", inner_radius(self.radius, self.height), (self.radius, self.height), self.rounding)
        radius, height = self.core_sizes
        check_feet("Cone", self.foot_height, radius, 0.5 * height)

    @property
    def core_sizes(self) -> tuple[float, float]:
        """Radius of the base and height without the rounding, of a cone of the same slope [m]."""
        part = 1.0 - self.rounding / inner_radius(self.radius, self.height)
        return part * self.radius, part * self.height

    @property
    def _profile(self) -> tuple[tuple[float, float], tuple[float, float], Point, Point]:
        radius, height = self.core_sizes
        return (radius, 0.0), (self.rounding, self.rounding + height), self._center, self._axis

    @property
    def _center(self) -> Point:
        return self.x, self.y, self.z

    @property
    def _axis(self) -> Point:
        return self.axis_x, self.axis_y, self.axis_z

    @property
    def apex(self) -> Point:
        """The apex of the core in the body frame [m]."""
        return on_axis(self._center, self._axis, self._profile[1][1])

    @property
    def _base(self) -> Point:
        return on_axis(self._center, self._axis, self.rounding)

    @property
    def frustum(self) -> tuple[float, ...]:
        """The upper radius is 0."""
        return frustum_numbers(*self._profile, standing_height(self.foot_height, *self.core_sizes), self.rounding)

    @property
    def feet(self) -> tuple[Point, ...]:
        """Tips of the feet of the base in the body frame [m]."""
        return feet_on(self._base, self._axis, self.core_sizes[0], 0.0)[:FEET_OF_FACE]

    @property
    def length(self) -> float:
        """Distance of the apex or of the farthest point of the rim [m]."""
        rim = farthest_on_circle(self.core_sizes[0], self._base, self._axis)
        return max(math.hypot(*self.apex), rim) + self.rounding

    def support(self, direction: Vector) -> Vector:
        """Return the apex or the farthest point of the base, of several its centre, and the rounding [m]."""
        along, size, across = across_axis(direction, self._axis)
        if along * self.height >= size * self.radius:
            return np.asarray(self.apex + self._rounded(direction))
        point = np.array(self._base) + self.core_sizes[0] * across
        return np.asarray(point + self._rounded(direction))

    @property
    def volume(self) -> float:
        """A third of pi r^2 h [m^3]; of a rounded one, slice by slice."""
        if self.rounding > 0.0:
            return swept_frustum(self.frustum)[0]
        return math.pi * self.radius**2 * self.height / 3.0

    @property
    def centroid(self) -> Vector:
        """A quarter of the height over the base [m]; of a rounded one, slice by slice."""
        if self.rounding > 0.0:
            return swept_frustum(self.frustum)[1]
        return np.array(on_axis(self._center, self._axis, 0.25 * self.height))

    @property
    def inertia(self) -> Vector:
        """3 V r^2 / 10 about its axis, 3 V (4 r^2 + h^2) / 80 across [m^5]; of a rounded one, slice by slice."""
        if self.rounding > 0.0:
            return swept_frustum(self.frustum)[2]
        across = 3.0 / 80.0 * self.volume * (4.0 * self.radius**2 + self.height**2)
        return about_axis(self._axis, 0.3 * self.volume * self.radius**2, across)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return a pyramid with its base; of a rounded one with arcs at rim and apex."""
        if self.rounding > 0.0:
            return draw_swept_frustum(self.frustum, fineness)
        profile = ((0.0, 0.0), (self.radius, 0.0), (0.0, self.height))
        return revolved(profile, fineness, self._center, self._axis)
