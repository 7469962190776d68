"""CylinderBody: a solid circular cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .inertia import density_field, mass_field, moments_of
from .shapes.cylinder import Cylinder
from .shapes.frustum import USUAL, check_feet, check_rounding
from .solid_body import SolidBody


@final
@dataclass(frozen=True)
class CylinderBody(SolidBody):
    """A free solid cylinder about the third body axis.

    On a plane it stands on three small feet of a face, ``foot_height`` high. Tilted by more than
    3 foot_height / radius [rad], it touches with a rim only. ``radius`` and ``half_length`` include the rounding.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0, usual=(1e-5, 10.0))
    half_length: float = parameter(doc="half the distance of the caps", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = density_field()
    mass: float | None = mass_field()
    foot_height: float | None = parameter(
        None,
        doc="height of the three feet of either cap; by default 1e-4 of the radius, at most 0.1 half-length",
        unit="m",
        minimum=0.0,
    )
    rounding: float = parameter(0.0, doc="radius of its rims", unit="m", minimum=0.0)

    def _check(self) -> None:
        sizes = self.radius, self.half_length
        check_rounding("CylinderBody", min(sizes), sizes, self.rounding)
        check_feet("CylinderBody", self.foot_height or 0.0, *(size - self.rounding for size in sizes))

    @property
    def centred_shape(self) -> Cylinder:
        """The cylinder."""
        usual = min(USUAL * (self.radius - self.rounding), 0.1 * (self.half_length - self.rounding))
        height = usual if self.foot_height is None else self.foot_height
        return Cylinder(self.radius, self.half_length, foot_height=height, rounding=self.rounding)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments m (r^2 / 4 + h^2 / 3) across the axis, m r^2 / 2 about it [kg m^2]; of a rounded one, by slices."""
        if self.rounding > 0.0:
            return moments_of(self.centred_shape, self.total_mass)
        mass, square = self.total_mass, self.radius**2
        across = mass * (square / 4.0 + self.half_length**2 / 3.0)
        return across, across, mass * square / 2.0
