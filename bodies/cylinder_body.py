"""CylinderBody: a solid circular cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of, moments_of
from bodies.shapes.cylinder import Cylinder
from bodies.shapes.feet import USUAL, check_feet
from bodies.shapes.frustum import check_rounding
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class CylinderBody(FreeBody):
    """A free solid cylinder about the third body axis.

    Standing on a plane it stands on three feet, by whose height the rims are set back; tilted by more than three times
    their height over the radius it touches with a rim only.

    Attributes
    ----------
    radius : float
        Radius [m].
    half_length : float
        Half the distance of the caps [m].
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.
    foot_height : float, optional
        Height of the three feet of either cap [m]; 0 for none.  Where it is not given, a ten-thousandth of the radius,
        but no more than a tenth of the half-length.
    rounding : float, optional
        Radius of its rims [m]; radius and half-length are those of the whole, the feet those of the core.

    Raises
    ------
    InvalidInput
        If a size is not positive, both mass and density are given, or the feet are higher than a tenth of the radius
        or not less than the half-length, or the rounding leaves no core.
    """

    radius: float = parameter(doc="radius", unit="m", above=0.0, usual=(1e-5, 10.0))
    half_length: float = parameter(doc="half the distance of the caps", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)
    foot_height: float | None = parameter(
        None, doc="height of the three feet of either cap; 1e-4 of the radius where not given", unit="m", minimum=0.0
    )
    rounding: float = parameter(0.0, doc="radius of its rims", unit="m", minimum=0.0)

    def _check(self) -> None:
        check_mass("CylinderBody", self.mass, self.density)
        sizes = self.radius, self.half_length
        check_rounding("CylinderBody", min(sizes), sizes, self.rounding)
        check_feet("CylinderBody", self.foot_height or 0.0, *(size - self.rounding for size in sizes))

    @property
    def _cylinder(self) -> Cylinder:
        usual = min(USUAL * (self.radius - self.rounding), 0.1 * (self.half_length - self.rounding))
        height = usual if self.foot_height is None else self.foot_height
        return Cylinder(self.radius, self.half_length, foot_height=height, rounding=self.rounding)

    @property
    def total_mass(self) -> float:
        """As given, or density times 2 pi r^2 h, h the half-length, of a sharp one [kg]."""
        return mass_of(self.mass, self.density, self._cylinder.volume)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments m (r^2 / 4 + h^2 / 3) across the axis, m r^2 / 2 about it [kg m^2]; of a rounded one, by slices."""
        if self.rounding > 0.0:
            return moments_of(self._cylinder, self.total_mass)
        mass, square = self.total_mass, self.radius**2
        across = mass * (square / 4.0 + self.half_length**2 / 3.0)
        return across, across, mass * square / 2.0

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The cylinder about the mass centre."""
        return (self._cylinder,)
