"""Cylinder."""

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
    FEET,
    Frustum,
    Point,
    check_feet,
    check_rounding,
    feet_on,
    frustum_numbers,
    standing_height,
)
from .placement import about_axis, across_axis, farthest_on_circle
from .revolution import draw_swept_frustum, swept_frustum


@final
@dataclass(frozen=True)
class Cylinder(Frustum):
    """A solid circular cylinder with flat caps and its centre at (x, y, z) in the body frame.

    On a plane it touches with the lowest points of its rims.  A cylinder that stands has no lowest point: three small
    feet on either cap hold it, at two thirds of the radius.  Their tips lie in the planes of the caps.  The rims are
    set back by the height of the feet, so the feet do not change the length.  The convex solid has no feet: they are
    too low to count.

    Its rims are sharp, or rounded by the radius ``rounding``.  Radius and half-length are those of the whole: a rounded
    cylinder is as large as a sharp one.  Its feet are those of the core, and round: they stand on the core's caps at
    two thirds of its radius, with tips in the planes of the caps of the whole.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0)
    half_length: float = parameter(doc="half the distance of the caps", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis in the body frame, first component", **UNIT_PART)
    axis_y: float = parameter(0.0, doc="unit axis in the body frame, second component", **UNIT_PART)
    axis_z: float = parameter(1.0, doc="unit axis in the body frame, third component", **UNIT_PART)
    foot_height: float = parameter(0.0, doc="height of the feet on either cap; 0 for the least", unit="m", minimum=0.0)
    rounding: float = parameter(0.0, doc="radius of its rims", unit="m", minimum=0.0)

    def _check(self) -> None:
        unit_vector("Cylinder axis", (self.axis_x, self.axis_y, self.axis_z))
        sizes = self.radius, self.half_length
        check_rounding("Cylinder", min(sizes), sizes, self.rounding)
        check_feet("Cylinder", self.foot_height, *self.core_sizes)

    @property
    def core_sizes(self) -> tuple[float, float]:
        """Radius and half-length without the rounding [m]."""
        return self.radius - self.rounding, self.half_length - self.rounding

    @property
    def frustum(self) -> tuple[float, ...]:
        """Both radii are the same."""
        return frustum_numbers(*self._profile, standing_height(self.foot_height, *self.core_sizes), self.rounding)

    @property
    def _profile(self) -> tuple[tuple[float, float], tuple[float, float], Point, Point]:
        radius, half = self.core_sizes
        radii, heights = (radius, radius), (-half, half)
        return radii, heights, (self.x, self.y, self.z), (self.axis_x, self.axis_y, self.axis_z)

    @property
    def caps(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Centres of the core's caps in the body frame, against and along the axis [m]."""
        return self._on_axis(self.core_sizes[1])

    @property
    def rims(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Centres of the core's rims in the body frame, against and along the axis [m]."""
        return self._on_axis(self.core_sizes[1] - self.frustum[FEET])

    @property
    def feet(self) -> tuple[Point, ...]:
        """Tips of the feet in the body frame, first of the cap against the axis [m]."""
        center, axis = (self.x, self.y, self.z), (self.axis_x, self.axis_y, self.axis_z)
        return feet_on(center, axis, *self.core_sizes)

    def _on_axis(self, away: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        x, y, z = (away * component for component in (self.axis_x, self.axis_y, self.axis_z))
        return (self.x - x, self.y - y, self.z - z), (self.x + x, self.y + y, self.z + z)

    @property
    def length(self) -> float:
        """Distance of the farthest point of the two rims [m]."""
        axis = self.axis_x, self.axis_y, self.axis_z
        return max(farthest_on_circle(self.core_sizes[0], cap, axis) for cap in self.caps) + self.rounding

    def support(self, direction: Vector) -> Vector:
        """Return the farthest point of the farther cap's circle, of several the centre, and the rounding [m]."""
        along, _, across = across_axis(direction, (self.axis_x, self.axis_y, self.axis_z))
        point = np.array(self.caps[1 if along >= 0.0 else 0]) + self.core_sizes[0] * across
        return np.asarray(point + self._rounded(direction))

    @property
    def volume(self) -> float:
        """2 pi r^2 c [m^3]; of a rounded one, slice by slice."""
        if self.rounding > 0.0:
            return swept_frustum(self.frustum)[0]
        return 2.0 * math.pi * self.radius**2 * self.half_length

    @property
    def centroid(self) -> Vector:
        """The centre [m]."""
        return np.array([self.x, self.y, self.z])

    @property
    def inertia(self) -> Vector:
        """V r^2 / 2 about its axis, V (r^2 / 4 + c^2 / 3) across [m^5]; of a rounded one, slice by slice."""
        if self.rounding > 0.0:
            return swept_frustum(self.frustum)[2]
        across = self.volume * (self.radius**2 / 4.0 + self.half_length**2 / 3.0)
        axis = self.axis_x, self.axis_y, self.axis_z
        return about_axis(axis, 0.5 * self.volume * self.radius**2, across)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return a prism with the caps; of a rounded one with arcs at the rims."""
        if self.rounding > 0.0:
            return draw_swept_frustum(self.frustum, fineness)
        r, c = self.radius, self.half_length
        profile = ((0.0, -c), (r, -c), (r, c), (0.0, c))
        return revolved(profile, fineness, self.centroid, (self.axis_x, self.axis_y, self.axis_z))
