"""A ball with nothing inside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bodies import FreeBody, Sphere
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class HollowBall(FreeBody):
    """A thin spherical shell, J = 2/3 m r^2."""

    radius: float = parameter(0.02, doc="radius", unit="m", above=0.0, usual=(1e-4, 1.0))
    mass: float = parameter(0.0027, doc="mass", unit="kg", above=0.0)

    @property
    def total_mass(self) -> float:
        """As given [kg]."""
        return self.mass

    @property
    def inertia(self) -> tuple[float, float, float]:
        """2/3 m r^2 about every axis [kg m^2]."""
        moment = 2.0 / 3.0 * self.mass * self.radius**2
        return moment, moment, moment

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The sphere."""
        return (Sphere(self.radius),)
