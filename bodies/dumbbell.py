"""Dumbbell: two equal solid balls joined by a thin rod."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.look import Look
from nonsmooth.parameters import parameter

from .free import FreeBody
from .shapes.sphere import Sphere


@final
@dataclass(frozen=True)
class Dumbbell(FreeBody):
    """The paper's body (Fig. 1): balls 1 and 2 at -l/2 and +l/2 on the first body axis.

    The rod is thin, of length l - 2 r, and touches nothing.  Of the material, only the density moves the body; the
    elastic constants say how long its impacts last.
    """

    radius: float = parameter(
        4.76e-3, doc="radius r of the balls", unit="m", above=0.0, usual=(1e-4, 1.0), assumed=True
    )
    aspect_ratio: float = parameter(3.9, doc="aspect ratio A_r = (l + 2 r) / (2 r)", minimum=2.0, usual=(2.0, 100.0))
    density: float = parameter(
        7800.0, doc="density of the balls", unit="kg/m^3", above=0.0, usual=(10.0, 3e4), assumed=True
    )
    rod_mass_fraction: float = parameter(
        0.15, doc="share of the rod in the total mass", minimum=0.0, maximum=0.99, assumed=True
    )

    young_modulus: float = parameter(
        210e9, doc="Young's modulus E of the balls", unit="Pa", above=0.0, usual=(1e5, 2e12), assumed=True
    )
    poisson_ratio: float = parameter(0.3, doc="Poisson's ratio nu of the balls", minimum=0.0, maximum=0.5, assumed=True)

    @property
    def centre_distance(self) -> float:
        """Distance l of the ball centres [m]."""
        return 2.0 * self.radius * (self.aspect_ratio - 1.0)

    @property
    def total_mass(self) -> float:
        """Mass m of balls and rod [kg]."""
        balls = 2.0 * self.density * 4.0 / 3.0 * math.pi * self.radius**3
        return balls / (1.0 - self.rod_mass_fraction)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """(J_2, J_1, J_1) of Eq. (4): about the rod axis and across it [kg m^2]."""
        r, length, x, m = self.radius, self.centre_distance, self.rod_mass_fraction, self.total_mass
        across = m * ((1.0 - x) * (length * length / 4.0 + 0.4 * r * r) + x * (length - 2.0 * r) ** 2 / 12.0)
        along = m * (1.0 - x) * 0.4 * r * r
        return along, across, across

    @property
    def level_mass(self) -> float:
        """Effective mass 1 / (n . G n) of one ball against a wall below the level dumbbell, m* [kg]."""
        return 1.0 / (1.0 / self.total_mass + (self.centre_distance / 2.0) ** 2 / self.inertia[1])

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """Balls 1 and 2."""
        half = self.centre_distance / 2.0
        return Sphere(self.radius, x=-half), Sphere(self.radius, x=half)

    @property
    def sketch(self) -> tuple[Look, ...]:
        """The rod."""
        half = self.centre_distance / 2.0
        return (Look.polyline((-half, 0.0, 0.0), (half, 0.0, 0.0)),)
