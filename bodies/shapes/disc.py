"""Disc, without thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.shapes.drawing import revolved
from bodies.shapes.feet import check_feet, feet_on
from bodies.shapes.frustum import Frustum, Point, frustum_numbers
from bodies.shapes.placement import farthest_on_circle
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector


@final
@dataclass(frozen=True)
class Disc(Frustum):
    """A rigid disc without thickness, with its centre at (x, y, z) in the body frame: a rim and two faces.

    On a plane it touches with the lowest point of its rim, and a disc that lies flat has none.  What holds it then are
    three small feet on either face, at two thirds of the radius, if they have a height.  As a convex shape it is that
    without feet, flat and without volume.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    axis_x: float = parameter(0.0, doc="unit axis in the body frame, first component", **UNIT_PART)
    axis_y: float = parameter(0.0, doc="unit axis in the body frame, second component", **UNIT_PART)
    axis_z: float = parameter(1.0, doc="unit axis in the body frame, third component", **UNIT_PART)
    foot_height: float = parameter(0.0, doc="height of the feet on either face; 0 for none", unit="m", minimum=0.0)

    def _check(self) -> None:
        unit_vector("Disc axis", self._axis)
        check_feet("Disc", self.foot_height, self.radius)

    @property
    def _center(self) -> Point:
        return self.x, self.y, self.z

    @property
    def _axis(self) -> Point:
        return self.axis_x, self.axis_y, self.axis_z

    @property
    def frustum(self) -> tuple[float, ...]:
        """Both rims are the same."""
        return frustum_numbers((self.radius, self.radius), (0.0, 0.0), self._center, self._axis, self.foot_height)

    @property
    def standing_rims(self) -> tuple[tuple[float, Point], ...]:
        """The rim, which is not set back: it is the feet that stand out."""
        return ((self.radius, self._center),)

    @property
    def feet(self) -> tuple[Point, ...]:
        """Tips of the feet in the body frame, first of the face against the axis [m]; none without a height."""
        if self.foot_height == 0.0:
            return ()
        return feet_on(self._center, self._axis, self.radius, self.foot_height)

    @property
    def length(self) -> float:
        """Distance of the farthest point of the rim and the feet [m]."""
        rim = farthest_on_circle(self.radius, self._center, self._axis)
        return max([rim, *(math.hypot(*foot) for foot in self.feet)])

    def support(self, direction: Vector) -> Vector:
        """Return the farthest point of the rim, of several the centre [m]."""
        axis, center = np.array(self._axis), np.array(self._center)
        along = direction @ axis
        across = direction - along * axis
        size = np.linalg.norm(across)
        # next to the axis a direction across is round-off
        return np.asarray(center + self.radius * across / size if size > 1e-15 * abs(along) else center)

    @property
    def volume(self) -> float:
        """None."""
        return 0.0

    @property
    def centroid(self) -> Vector:
        """The centre [m]."""
        return np.array(self._center)

    @property
    def inertia(self) -> Vector:
        """None, as without volume."""
        return np.zeros((3, 3))

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return both faces."""
        return revolved(((0.0, 0.0), (self.radius, 0.0), (0.0, 0.0)), fineness, self._center, self._axis)
