"""BoxBody: a solid box."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .inertia import density_field, mass_field, moments_of
from .shapes.box import Box, check_rounding
from .solid_body import SolidBody


@final
@dataclass(frozen=True)
class BoxBody(SolidBody):
    """A free solid box along the body axes.

    Its edges are sharp, or rounded by the radius ``rounding``; the half-lengths include the rounding.
    """

    half_x: float = parameter(doc="half-length along the first axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    half_y: float = parameter(doc="half-length along the second axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    half_z: float = parameter(doc="half-length along the third axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = density_field()
    mass: float | None = mass_field()
    rounding: float = parameter(0.0, doc="radius of its edges and vertices", unit="m", minimum=0.0)

    def _check(self) -> None:
        check_rounding("BoxBody", (self.half_x, self.half_y, self.half_z), self.rounding)

    @property
    def centred_shape(self) -> Box:
        """The box, with its centre at the origin of the body frame and its edges rounded by ``rounding``."""
        return Box(self.half_x, self.half_y, self.half_z, rounding=self.rounding)

    @property
    def spin(self) -> int:
        """-1: no axis of symmetry is used, also for a cube, because the contact points turn with the box.

        The angular velocity is integrated in body axes.
        """
        return -1

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments m (b^2 + c^2) / 3 and so on [kg m^2]; of a rounded one, piece by piece."""
        if self.rounding > 0.0:
            return moments_of(self.centred_shape, self.total_mass)
        third, x, y, z = self.total_mass / 3.0, self.half_x**2, self.half_y**2, self.half_z**2
        return third * (y + z), third * (z + x), third * (x + y)
