"""Egg: a ball that is longer along one axis, and more pointed at one end of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter

from .support_shape import SupportShape

_LEAST = 0.01


@final
@dataclass(frozen=True)
class Egg(SupportShape):
    """A ball that is longer along the third axis, and more pointed at the upper end of it.

    Its support function is r |d| (1 + a n_z^2 + b n_z^3), n = d / |d|: flatter where a < 0, pointed below where b < 0.
    Its radii of curvature are finite, above 0, and do not jump.

    Raises
    ------
    InvalidInput
        If a radius of curvature would be below a hundredth of the radius.
    """

    radius: float = parameter(0.01, doc="radius r across", unit="m", above=0.0)
    longer: float = parameter(0.1, doc="how much longer half of it is, in units of the radius, a", unit="1")
    pointed: float = parameter(0.05, doc="how much farther the upper end is, the lower one nearer, b", unit="1")

    def _check(self) -> None:
        a, b, z = self.longer, self.pointed, np.linspace(-1.0, 1.0, 201)
        round_axis = 1.0 - a * z**2 - 2.0 * b * z**3
        least = float(np.min([round_axis, round_axis + (2.0 * a + 6.0 * b * z) * (1.0 - z**2)]))
        if least < _LEAST:
            raise InvalidInput(
                "Egg",
                f"must have radii of curvature of {_LEAST:g} of its radius at least",
                least,
                f"Take it less long or flat than {a:g}, or less pointed than {b:g}.",
            )

    def support(self, direction: Vector) -> Vector:
        """Return the gradient of the support function [m]."""
        n = direction / math.sqrt(np.sum(direction * direction))
        height = 1.0 + self.longer * n[2] ** 2 + self.pointed * n[2] ** 3
        slope = 2.0 * self.longer * n[2] + 3.0 * self.pointed * n[2] ** 2
        return np.asarray(self.radius * ((height - slope * n[2]) * n + slope * np.array([0.0, 0.0, 1.0])))

    @property
    def volume(self) -> float:
        """A third of the integral of the support function over the surface [m^3]."""
        a, b = self.longer, self.pointed
        ball = 4.0 / 3.0 * math.pi * self.radius**3
        return ball * (1.0 + a - a**2 / 5.0 + a**3 / 35.0 - 12.0 * b**2 / 35.0 + 4.0 * a * b**2 / 21.0)
