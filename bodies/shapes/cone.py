"""Cone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.shapes.drawing import revolved
from bodies.shapes.feet import FEET, check_feet, feet_on
from bodies.shapes.frustum import Frustum, Point, frustum_numbers, on_axis, rims_over_faces
from bodies.shapes.placement import about_axis, farthest_on_circle
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector


@final
@dataclass(frozen=True)
class Cone(Frustum):
    """A solid circular cone with the centre of its base at (x, y, z) in the body frame; the axis points to the apex.

    On a plane it touches with the lowest point of its rim and with its apex, and on its side with both.  What holds one
    that stands on its base are three small feet, at two thirds of the radius, if they have a height.  Their tips lie in
    the plane of the base; it is the rim that is set back by the height.  As a convex solid it is that without feet.
    """

    radius: float = parameter(doc="radius of the base", unit="m", above=0.0)
    height: float = parameter(doc="distance of the apex from the base", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre of the base, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre of the base, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre of the base, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis to the apex in the body frame, first component", **UNIT_PART)
    axis_y: float = parameter(0.0, doc="unit axis to the apex in the body frame, second component", **UNIT_PART)
    axis_z: float = parameter(1.0, doc="unit axis to the apex in the body frame, third component", **UNIT_PART)
    foot_height: float = parameter(0.0, doc="height of the feet on the base; 0 for none", unit="m", minimum=0.0)

    def _check(self) -> None:
        unit_vector("Cone axis", self._axis)
        check_feet("Cone", self.foot_height, self.radius, 0.5 * self.height)

    @property
    def _center(self) -> Point:
        return self.x, self.y, self.z

    @property
    def _axis(self) -> Point:
        return self.axis_x, self.axis_y, self.axis_z

    @property
    def apex(self) -> Point:
        """The apex in the body frame [m]."""
        return on_axis(self._center, self._axis, self.height)

    @property
    def frustum(self) -> tuple[float, ...]:
        """The upper radius is 0."""
        return frustum_numbers((self.radius, 0.0), (0.0, self.height), self._center, self._axis, self.foot_height)

    @property
    def standing_rims(self) -> tuple[tuple[float, Point], ...]:
        """The rim of the base, set back, and the apex."""
        return rims_over_faces((self.radius, 0.0), (0.0, self.height), self._center, self._axis, self.foot_height)

    @property
    def feet(self) -> tuple[Point, ...]:
        """Tips of the feet of the base in the body frame [m]; none without a height."""
        return feet_on(self._center, self._axis, self.radius, 0.0)[:FEET] if self.foot_height > 0.0 else ()

    @property
    def length(self) -> float:
        """Distance of the apex or of the farthest point of the rim [m]."""
        return max(math.hypot(*self.apex), farthest_on_circle(self.radius, self._center, self._axis))

    def support(self, direction: Vector) -> Vector:
        """Return the apex or the farthest point of the base, of several its centre [m]."""
        axis, center = np.array(self._axis), np.array(self._center)
        along = direction @ axis
        across = direction - along * axis
        size = float(np.linalg.norm(across))
        # next to the axis a direction across is round-off
        if size <= 1e-15 * abs(along):
            size = 0.0
        if along * self.height >= size * self.radius:
            return np.array(self.apex)
        return np.asarray(center + self.radius * across / size if size > 0.0 else center)

    @property
    def volume(self) -> float:
        """A third of pi r^2 h [m^3]."""
        return math.pi * self.radius**2 * self.height / 3.0

    @property
    def centroid(self) -> Vector:
        """A quarter of the height over the base [m]."""
        return np.array(on_axis(self._center, self._axis, 0.25 * self.height))

    @property
    def inertia(self) -> Vector:
        """3 V r^2 / 10 about its axis, 3 V (4 r^2 + h^2) / 80 across [m^5]."""
        across = 3.0 / 80.0 * self.volume * (4.0 * self.radius**2 + self.height**2)
        return about_axis(self._axis, 0.3 * self.volume * self.radius**2, across)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return a pyramid with its base."""
        profile = ((0.0, 0.0), (self.radius, 0.0), (0.0, self.height))
        return revolved(profile, fineness, self._center, self._axis)
