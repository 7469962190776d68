"""CapsuleBody: a solid cylinder with half spheres at its ends."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of
from bodies.shapes.capsule import Capsule
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class CapsuleBody(FreeBody):
    """A free solid capsule about the third body axis.

    Attributes
    ----------
    radius : float
        Radius [m].
    half_length : float
        Half the distance of the end spheres' centres [m].
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.

    Raises
    ------
    InvalidInput
        If a size is not positive, or both mass and density are given.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0, usual=(1e-5, 10.0))
    half_length: float = parameter(
        doc="half the distance of the end spheres' centres", unit="m", above=0.0, usual=(1e-5, 10.0)
    )
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)

    def _check(self) -> None:
        check_mass("CapsuleBody", self.mass, self.density)

    @property
    def total_mass(self) -> float:
        """As given, or density times pi r^2 (2 h + 4/3 r), h the half-length [kg]."""
        return mass_of(
            self.mass, self.density, math.pi * self.radius**2 * (2.0 * self.half_length + 4.0 / 3.0 * self.radius)
        )

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Cylinder and half spheres with their shifts, across the axis and about it [kg m^2]."""
        r, h, mass = self.radius, self.half_length, self.total_mass
        balls = mass * (4.0 / 3.0 * r) / (2.0 * h + 4.0 / 3.0 * r)
        middle = mass - balls
        # the centre of a half sphere lies 3/8 r beyond the end of the cylinder
        across = middle * (r * r / 4.0 + h * h / 3.0) + balls * (0.4 * r * r + h * h + 0.75 * h * r)
        return across, across, middle * r * r / 2.0 + balls * 0.4 * r * r

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The capsule about the mass centre."""
        return (Capsule(self.radius, self.half_length),)
