"""Ball: a solid sphere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter

from .free import FreeBody
from .inertia import STEEL, check_mass, density_field, mass_field
from .shapes.sphere import Sphere


@final
@dataclass(frozen=True)
class Ball(FreeBody):
    """A free solid sphere."""

    radius: float = parameter(doc="radius", unit="m", above=0.0, usual=(1e-4, 1.0))
    density: float | None = density_field()
    mass: float | None = mass_field()

    @property
    def total_mass(self) -> float:
        """Mass as given, or density times 4/3 pi r^3 [kg]."""
        check_mass(self, self.mass, self.density)
        if self.mass is not None:
            return self.mass
        # the order of the factors fixes the last bit of the mass, on which the motion of many balls depends
        return (STEEL if self.density is None else self.density) * 4.0 / 3.0 * math.pi * self.radius**3

    @property
    def inertia(self) -> tuple[float, float, float]:
        """2/5 m r^2 about every axis [kg m^2]."""
        moment = 0.4 * self.total_mass * self.radius**2
        return moment, moment, moment

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The sphere about the mass centre."""
        return (Sphere(self.radius),)
