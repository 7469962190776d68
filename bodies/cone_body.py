"""ConeBody: a solid circular cone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import final

from nonsmooth.parameters import parameter

from .inertia import density_field, mass_field, moments_of
from .shapes.cone import Cone, inner_radius
from .shapes.frustum import USUAL, check_feet, check_rounding
from .solid_body import SolidBody


@final
@dataclass(frozen=True)
class ConeBody(SolidBody):
    """A free solid cone about the third body axis.

    The apex is above the mass centre. On a plane the cone stands on three small feet of the base, ``foot_height`` high.
    Tilted by more than 3 foot_height / radius [rad], it touches with its rim only. ``radius`` and ``height`` of a
    rounded cone are those of the sharp cone with the same base and side.
    """

    radius: float = parameter(doc="radius of the base", unit="m", above=0.0, usual=(1e-5, 10.0))
    height: float = parameter(doc="distance of the apex from the base", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = density_field()
    mass: float | None = mass_field()
    foot_height: float | None = parameter(
        None, doc="height of the three feet; by default 1e-4 of the radius, at most 0.1 height", unit="m", minimum=0.0
    )
    rounding: float = parameter(0.0, doc="radius of its rim and its apex", unit="m", minimum=0.0)

    def _check(self) -> None:
        sizes = self.radius, self.height
        check_rounding("ConeBody", inner_radius(*sizes), sizes, self.rounding)
        radius, height = Cone(*sizes, rounding=self.rounding).core_sizes
        check_feet("ConeBody", self.foot_height or 0.0, radius, 0.5 * height)

    @property
    def centred_shape(self) -> Cone:
        """The cone with its mass centre at the origin."""
        bare = Cone(self.radius, self.height, rounding=self.rounding)
        radius, height = bare.core_sizes
        feet = min(USUAL * radius, 0.1 * height) if self.foot_height is None else self.foot_height
        return replace(bare, z=-float(bare.centroid[2]), foot_height=feet)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments 3 m (4 r^2 + h^2) / 80 across the axis, 3 m r^2 / 10 about it, or by slices [kg m^2]."""
        if self.rounding > 0.0:
            return moments_of(self.centred_shape, self.total_mass)
        mass, square = self.total_mass, self.radius**2
        across = 3.0 / 80.0 * mass * (4.0 * square + self.height**2)
        return across, across, 0.3 * mass * square
