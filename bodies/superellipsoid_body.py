"""SuperellipsoidBody: a solid superellipsoid, rounded or not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of
from bodies.shapes.superellipsoid import EXPONENT, Superellipsoid
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class SuperellipsoidBody(FreeBody):
    """A free solid superellipsoid with its semi-axes along the body axes, swept by a sphere if a rounding is given.

    Attributes
    ----------
    semi_x, semi_y, semi_z : float
        Semi-axes, without the rounding [m].
    exponent_along, exponent_across : float
        Its exponents along the third axis and across it, 1 for an ellipsoid, towards 0 for a box, towards
        2 for an octahedron.
    rounding : float
        Radius of the sphere that sweeps it [m].
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.

    Raises
    ------
    InvalidInput
        If a size is not positive, the shape refuses its exponents, or both mass and density are given.
    """

    semi_x: float = parameter(doc="first semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    semi_y: float = parameter(doc="second semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    semi_z: float = parameter(doc="third semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    exponent_along: float = parameter(1.0, doc="exponent e1 along the third axis", **EXPONENT)
    exponent_across: float = parameter(1.0, doc="exponent e2 across it", **EXPONENT)
    rounding: float = parameter(0.0, doc="radius of the sphere that sweeps it", unit="m", minimum=0.0)
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)

    def _check(self) -> None:
        check_mass("SuperellipsoidBody", self.mass, self.density)
        _ = self._shape

    @property
    def _shape(self) -> Superellipsoid:
        return Superellipsoid(
            self.semi_x, self.semi_y, self.semi_z, self.exponent_along, self.exponent_across, self.rounding
        )

    @property
    def total_mass(self) -> float:
        """As given, or density times volume [kg]."""
        return mass_of(self.mass, self.density, self._shape.volume)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments, from those of the shape at density 1 [kg m^2]."""
        x, y, z = (self.total_mass / self._shape.volume * np.diag(self._shape.inertia)).tolist()
        return x, y, z

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The superellipsoid about the mass centre."""
        return (self._shape,)
