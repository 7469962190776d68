"""ConeBody: a solid circular cone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import final

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of, moments_of
from bodies.shapes.cone import Cone, inner_radius
from bodies.shapes.feet import USUAL, check_feet
from bodies.shapes.frustum import check_rounding
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class ConeBody(FreeBody):
    """A free solid cone about the third body axis, with its mass centre in the origin: the apex is above.

    Standing on a plane it stands on three feet, by whose height the rim is set back; tilted by more than three times
    their height over the radius it touches with its rim only.

    Attributes
    ----------
    radius : float
        Radius of the base [m].
    height : float
        Distance of the apex from the base [m]; the mass centre of a sharp one is a quarter of it over the base.
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.
    foot_height : float, optional
        Height of the three feet of the base [m]; 0 for none.  Where it is not given, a ten-thousandth of the radius,
        but no more than a tenth of the height.
    rounding : float, optional
        Radius of its rim and its apex [m]; radius and height are those of the sharp cone with the same base and side,
        the feet those of the core.

    Raises
    ------
    InvalidInput
        If a size is not positive, both mass and density are given, or the feet are higher than a tenth of the radius
        or not less than half the height, or the rounding leaves no core.
    """

    radius: float = parameter(doc="radius of the base", unit="m", above=0.0, usual=(1e-5, 10.0))
    height: float = parameter(doc="distance of the apex from the base", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)
    foot_height: float | None = parameter(
        None, doc="height of the three feet of the base; 1e-4 of the radius where not given", unit="m", minimum=0.0
    )
    rounding: float = parameter(0.0, doc="radius of its rim and its apex", unit="m", minimum=0.0)

    def _check(self) -> None:
        check_mass("ConeBody", self.mass, self.density)
        sizes = self.radius, self.height
        check_rounding("ConeBody", inner_radius(*sizes), sizes, self.rounding)
        radius, height = Cone(*sizes, rounding=self.rounding).core_sizes
        check_feet("ConeBody", self.foot_height or 0.0, radius, 0.5 * height)

    @property
    def _cone(self) -> Cone:
        bare = Cone(self.radius, self.height, rounding=self.rounding)
        radius, height = bare.core_sizes
        feet = min(USUAL * radius, 0.1 * height) if self.foot_height is None else self.foot_height
        return replace(bare, z=-float(bare.centroid[2]), foot_height=feet)

    @property
    def total_mass(self) -> float:
        """As given, or density times a third of pi r^2 h of a sharp one [kg]."""
        return mass_of(self.mass, self.density, self._cone.volume)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments 3 m (4 r^2 + h^2) / 80 across the axis, 3 m r^2 / 10 about it, or by slices [kg m^2]."""
        if self.rounding > 0.0:
            return moments_of(self._cone, self.total_mass)
        mass, square = self.total_mass, self.radius**2
        across = 3.0 / 80.0 * mass * (4.0 * square + self.height**2)
        return across, across, 0.3 * mass * square

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The cone about the mass centre."""
        return (self._cone,)
