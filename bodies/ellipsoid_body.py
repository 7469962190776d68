"""EllipsoidBody: a solid ellipsoid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .inertia import density_field, mass_field
from .shapes.ellipsoid import Ellipsoid
from .solid_body import SolidBody


@final
@dataclass(frozen=True)
class EllipsoidBody(SolidBody):
    """A free solid ellipsoid along the body axes."""

    semi_x: float = parameter(doc="first semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    semi_y: float = parameter(doc="second semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    semi_z: float = parameter(doc="third semi-axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = density_field()
    mass: float | None = mass_field()

    @property
    def centred_shape(self) -> Ellipsoid:
        """The ellipsoid."""
        return Ellipsoid(self.semi_x, self.semi_y, self.semi_z)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments m (b^2 + c^2) / 5 and so on [kg m^2]."""
        fifth, x, y, z = self.total_mass / 5.0, self.semi_x**2, self.semi_y**2, self.semi_z**2
        return fifth * (y + z), fifth * (z + x), fifth * (x + y)
