"""DiscBody: a free disc, thin or rounded, that lies flat or rolls on its rim."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter

from .free import FreeBody
from .inertia import check_mass, mass_field, moments_of
from .shapes.disc import Disc
from .shapes.frustum import USUAL, check_feet, check_rounding


@final
@dataclass(frozen=True)
class DiscBody(FreeBody):
    """A free disc about the third body axis, without thickness unless it is rounded: a coin, a plate on its rim.

    Flat on a plane it stands on three feet, so that its centre is at their height above the plane. Tilted by more than
    3 foot_height / radius [rad] it touches with its rim only. A rounded disc has the thickness 2 ``rounding`` and an
    even density; ``radius`` includes the rounding.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0, usual=(1e-5, 10.0))
    surface_density: float | None = parameter(
        None,
        doc="mass per area; 7.8, a millimetre of steel, without a mass",
        unit="kg/m^2",
        above=0.0,
        usual=(1e-3, 1e5),
    )
    mass: float | None = mass_field("surface density")
    foot_height: float | None = parameter(
        None, doc="height of the three feet of either face; 1e-4 of the radius where not given", unit="m", minimum=0.0
    )
    rounding: float = parameter(0.0, doc="radius of its rim, half of its thickness", unit="m", minimum=0.0)

    def _check(self) -> None:
        check_rounding("DiscBody", self.radius, (self.radius,), self.rounding)
        check_feet("DiscBody", self.foot_height or 0.0, self.radius - self.rounding)

    @property
    def _disc(self) -> Disc:
        height = USUAL * (self.radius - self.rounding) if self.foot_height is None else self.foot_height
        return Disc(self.radius, foot_height=height, rounding=self.rounding)

    @property
    def total_mass(self) -> float:
        """Mass as given, or surface density times pi r^2 [kg]."""
        check_mass(self, self.mass, self.surface_density)
        surface = 7.8 if self.surface_density is None else self.surface_density
        return surface * (math.pi * self.radius**2) if self.mass is None else self.mass

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments m r^2 / 4 across the axis, m r^2 / 2 about it [kg m^2]; of a rounded one, by slices."""
        if self.rounding > 0.0:
            return moments_of(self._disc, self.total_mass)
        across = self.total_mass * self.radius**2 / 4.0
        return across, across, 2.0 * across

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The disc about the mass centre."""
        return (self._disc,)
