"""EllipsoidBody: a solid ellipsoid."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of
from bodies.shapes.ellipsoid import Ellipsoid
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class EllipsoidBody(FreeBody):
    """A free solid ellipsoid with its semi-axes along the body axes.

    Attributes
    ----------
    semi_x : float
        First semi-axis [m].
    semi_y : float
        Second semi-axis [m].
    semi_z : float
        Third semi-axis [m].
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.

    Raises
    ------
    InvalidInput
        If a size is not positive, or both mass and density are given.
    """

    semi_x: float = parameter(doc="first semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    semi_y: float = parameter(doc="second semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    semi_z: float = parameter(doc="third semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)

    def _check(self) -> None:
        check_mass("EllipsoidBody", self.mass, self.density)

    @property
    def total_mass(self) -> float:
        """As given, or density times 4/3 pi a b c [kg]."""
        return mass_of(self.mass, self.density, 4.0 / 3.0 * math.pi * self.semi_x * self.semi_y * self.semi_z)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments m (b^2 + c^2) / 5 and so on [kg m^2]."""
        fifth, x, y, z = self.total_mass / 5.0, self.semi_x**2, self.semi_y**2, self.semi_z**2
        return fifth * (y + z), fifth * (z + x), fifth * (x + y)

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The ellipsoid about the mass centre."""
        return (Ellipsoid(self.semi_x, self.semi_y, self.semi_z),)
