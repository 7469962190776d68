"""Superellipsoid."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector

from . import smooth
from .smooth import SmoothShape

EXPONENT: Mapping[str, Any] = MappingProxyType({"minimum": 0.2, "maximum": 1.8})
"""Bounds of an exponent."""
THINNEST = 10.0
"""Greatest ratio of two semi-axes of a boxy body."""


@final
@dataclass(frozen=True)
class Superellipsoid(SmoothShape):
    """All points within ``rounding`` of ((x/a)^(2/e2) + (y/b)^(2/e2))^(e2/e1) + (z/c)^(2/e1) <= 1.

    The exponents e1 and e2 go from 0.2, nearly a box, over 1, the ellipsoid, towards 2, the octahedron.  The support
    function has the powers p = 2/(2 - e1) and q = 2/(2 - e2) with the semi-axes as factors.  From 1 on the contacts
    follow from it: its radii of curvature do not jump for p >= 2, q >= 2, and q = 2 where p = 2.  With both
    below 1 the body is boxy: it has flat points in the middle of its faces and flat lines across them, where these
    radii are infinite, and the contacts follow from its gauge, whose curvatures are finite
    (:mod:`bodies.contacts.smooth.boxy_newton`).  With one below 1 and one above it has flat lines and sharp
    ones, and the contacts follow from coordinates in which point and normal have derivatives
    (:mod:`bodies.contacts.smooth.chart`).

    References
    ----------
    A. H. Barr, "Superquadrics and angle-preserving transformations", IEEE Computer Graphics and Applications 1 (1981)
    11-23.
    """

    semi_x: float = parameter(doc="first semi-axis, without the rounding, a", unit="m", above=0.0)
    semi_y: float = parameter(doc="second semi-axis, b", unit="m", above=0.0)
    semi_z: float = parameter(doc="third semi-axis, c", unit="m", above=0.0)
    exponent_along: float = parameter(1.0, doc="exponent e1 along the third axis", **EXPONENT)
    exponent_across: float = parameter(1.0, doc="exponent e2 across it", **EXPONENT)
    rounding: float = parameter(0.0, doc="radius of the sphere that sweeps the superellipsoid", unit="m", minimum=0.0)
    x: float = parameter(0.0, doc="centre, first coordinate", unit="m")
    y: float = parameter(0.0, doc="centre, second coordinate", unit="m")
    z: float = parameter(0.0, doc="centre, third coordinate", unit="m")
    orientation_w: float = parameter(1.0, doc="quaternion from its axes to the body's, scalar part", **UNIT_PART)
    orientation_x: float = parameter(0.0, doc="quaternion, first component", **UNIT_PART)
    orientation_y: float = parameter(0.0, doc="quaternion, second component", **UNIT_PART)
    orientation_z: float = parameter(0.0, doc="quaternion, third component", **UNIT_PART)

    def _check(self) -> None:
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        unit_vector("Superellipsoid orientation", orientation, 4)
        along, across = self.exponent_along, self.exponent_across
        if along == 1.0 != across:
            raise InvalidInput(
                "Superellipsoid.exponent_across",
                "must be 1 where exponent_along is 1",
                across,
                "The curvature at the third axis would jump from one direction to the next; "
                "give exponent_along a value on the same side of 1, or exchange the axes.",
            )
        semi = self.semi_x, self.semi_y, self.semi_z
        if min(along, across) < 1.0 and max(semi) > THINNEST * min(semi):
            raise InvalidInput(
                "Superellipsoid: the ratio of the longest semi-axis to the shortest",
                f"must be at most {THINNEST:g} with an exponent below 1",
                max(semi) / min(semi),
                "The gap of thinner boxy bodies is not found at every pose; take a Box, or exponents from 1.",
            )

    @property
    def core(self) -> tuple[float, ...]:
        """Numbers of its support function (:func:`bodies.shapes.smooth.core_numbers`)."""
        return smooth.core_numbers(
            (self.semi_x, self.semi_y, self.semi_z),
            (2.0 / (2.0 - self.exponent_along), 2.0 / (2.0 - self.exponent_across)),
            self.rounding,
            (self.x, self.y, self.z),
            (self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z),
        )

    @property
    def length(self) -> float:
        """Distance of the farthest point [m]; of a shape that is not about the origin a bound."""
        return smooth.farthest(self.core)

    def support(self, direction: Vector) -> Vector:
        """Return the farthest point along a direction [m], shape [3]."""
        return smooth.support_point(self.core, direction)

    @property
    def volume(self) -> float:
        """Volume [m^3]; in closed form without rounding."""
        return self._integrals[0]

    @property
    def centroid(self) -> Vector:
        """The centre [m], shape [3]."""
        return np.array([self.x, self.y, self.z])

    @property
    def inertia(self) -> Vector:
        """Inertia tensor at density 1 about the centre [m^5], shape [3, 3]; in closed form without rounding."""
        return smooth.moments_in_body(self.core, self._integrals[1:])

    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return vertices [m], shape [n, 3], and triangles, shape [m, 3]."""
        return smooth.drawn(self.core, fineness)

    @property
    def _integrals(self) -> tuple[float, float, float, float]:
        """Of 1, x^2, y^2 and z^2, in its own axes."""
        return smooth.integrals_with_radius(self.core) if self.rounding > 0.0 else self._closed()

    def _closed(self) -> tuple[float, float, float, float]:
        """By Dirichlet's integrals over the sections across the third axis, and beta functions along it."""
        p, q = 2.0 / self.exponent_along, 2.0 / self.exponent_across
        a, b, c = self.semi_x, self.semi_y, self.semi_z

        def section(i: int, j: int) -> float:
            return math.gamma(i / q) * math.gamma(j / q) / (q * q * math.gamma((i + j) / q + 1.0))

        def along(i: int, scale: int) -> float:
            return math.gamma(i / p) * math.gamma(scale / p + 1.0) / (p * math.gamma((i + scale) / p + 1.0))

        volume = 8.0 * a * b * c
        return (
            volume * section(1, 1) * along(1, 2),
            volume * a * a * section(3, 1) * along(1, 4),
            volume * b * b * section(1, 3) * along(1, 4),
            volume * c * c * section(1, 1) * along(3, 2),
        )
