"""Ball: a solid sphere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from bodies.free import FreeBody
from bodies.inertia import STEEL, check_mass
from bodies.shapes.sphere import Sphere
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class Ball(FreeBody):
    """A free solid sphere.

    Attributes
    ----------
    radius : float
        Radius [m].
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.

    Raises
    ------
    InvalidInput
        If the radius is not positive, or both mass and density are given.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0, usual=(1e-4, 1.0))
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)

    def _check(self) -> None:
        check_mass("Ball", self.mass, self.density)

    @property
    def total_mass(self) -> float:
        """As given, or density times 4/3 pi r^3 [kg]."""
        if self.mass is not None:
            return self.mass
        # in this order, on which the last bit hangs and with it how a crowd of balls ends up
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
