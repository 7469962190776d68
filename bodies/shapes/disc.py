"""Disc, without thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector

from .drawing import revolved
from .frustum import FEET, Frustum, Point, check_feet, check_rounding, feet_on, frustum_numbers, standing_height
from .placement import across_axis, farthest_on_circle
from .revolution import draw_swept_frustum, swept_frustum


@final
@dataclass(frozen=True)
class Disc(Frustum):
    """A rigid disc with its centre at (x, y, z) in the body frame, a rim and two faces; a sharp one has no thickness.

    On a plane it touches with the lowest point of its rim.  A disc that lies flat has no lowest point: three small feet
    on either face hold it, at two thirds of the radius.  The convex shape has no feet: it is flat and has no volume.

    Rounded by the radius ``rounding`` it is twice that thick, with half a torus for a rim.  Its radius is that of the
    whole.  Its feet are those of the core, and round: they stand out of the faces.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis in the body frame, first component", **UNIT_PART)
    axis_y: float = parameter(0.0, doc="unit axis in the body frame, second component", **UNIT_PART)
    axis_z: float = parameter(1.0, doc="unit axis in the body frame, third component", **UNIT_PART)
    foot_height: float = parameter(0.0, doc="height of the feet on either face; 0 for the least", unit="m", minimum=0.0)
    rounding: float = parameter(0.0, doc="radius of its rim, half of its thickness", unit="m", minimum=0.0)

    def _check(self) -> None:
        unit_vector("Disc axis", self._axis)
        check_rounding("Disc", self.radius, (self.radius,), self.rounding)
        check_feet("Disc", self.foot_height, self.core_radius)

    @property
    def core_radius(self) -> float:
        """Radius without the rounding [m]."""
        return self.radius - self.rounding

    @property
    def _center(self) -> Point:
        return self.x, self.y, self.z

    @property
    def _axis(self) -> Point:
        return self.axis_x, self.axis_y, self.axis_z

    @property
    def frustum(self) -> tuple[float, ...]:
        """Both rims are the same."""
        radius, height = self.core_radius, standing_height(self.foot_height, self.core_radius, self.rounding)
        return frustum_numbers((radius, radius), (0.0, 0.0), self._center, self._axis, height, self.rounding)

    @property
    def feet(self) -> tuple[Point, ...]:
        """Tips of the feet in the body frame, first of the face against the axis [m]."""
        return feet_on(self._center, self._axis, self.core_radius, self.frustum[FEET])

    @property
    def length(self) -> float:
        """Distance of the farthest point of the rim and the feet [m]."""
        rim = farthest_on_circle(self.core_radius, self._center, self._axis)
        return max([rim, *(math.hypot(*foot) for foot in self.feet)]) + self.rounding

    def support(self, direction: Vector) -> Vector:
        """Return the farthest point of the rim, of several the centre, and the rounding [m]."""
        _, _, across = across_axis(direction, self._axis)
        point = np.array(self._center) + self.core_radius * across
        return np.asarray(point + self._rounded(direction))

    @property
    def volume(self) -> float:
        """None, or that of a rounded one, slice by slice [m^3]."""
        return swept_frustum(self.frustum)[0] if self.rounding > 0.0 else 0.0

    @property
    def centroid(self) -> Vector:
        """The centre [m]."""
        return np.array(self._center)

    @property
    def inertia(self) -> Vector:
        """None, as without volume, or that of a rounded one, slice by slice [m^5]."""
        return swept_frustum(self.frustum)[2] if self.rounding > 0.0 else np.zeros((3, 3))

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return both faces; of a rounded one with arcs at the rim."""
        if self.rounding > 0.0:
            return draw_swept_frustum(self.frustum, fineness)
        return revolved(((0.0, 0.0), (self.radius, 0.0), (0.0, 0.0)), fineness, self._center, self._axis)
