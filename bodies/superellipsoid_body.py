"""SuperellipsoidBody: a free solid between ellipsoid, box and octahedron."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .inertia import density_field, mass_field, moments_of
from .shapes.superellipsoid import EXPONENT, Superellipsoid
from .solid_body import SolidBody


@final
@dataclass(frozen=True)
class SuperellipsoidBody(SolidBody):
    """A free solid superellipsoid along the body axes.

    With both exponents 1 it is an ellipsoid; towards 0 it approaches a box, towards 2 an octahedron. The semi-axes do
    not include the rounding.
    """

    semi_x: float = parameter(doc="first semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    semi_y: float = parameter(doc="second semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    semi_z: float = parameter(doc="third semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    exponent_along: float = parameter(1.0, doc="exponent e1 along the third axis", **EXPONENT)
    exponent_across: float = parameter(1.0, doc="exponent e2 across it", **EXPONENT)
    rounding: float = parameter(0.0, doc="radius of the sphere that sweeps it", unit="m", minimum=0.0)
    density: float | None = density_field()
    mass: float | None = mass_field()

    @property
    def centred_shape(self) -> Superellipsoid:
        """The superellipsoid."""
        return Superellipsoid(
            self.semi_x, self.semi_y, self.semi_z, self.exponent_along, self.exponent_across, self.rounding
        )

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments of inertia [kg m^2], from the moments of the shape at density 1."""
        return moments_of(self.centred_shape, self.total_mass)
