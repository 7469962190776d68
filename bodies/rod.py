"""Rod: a free slender rod with rounded ends."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter

from .free import FreeBody
from .inertia import density_field, mass_field, mass_of
from .shapes.capsule import Capsule


@final
@dataclass(frozen=True)
class Rod(FreeBody):
    """A free slender rod along the first body axis.

    Its ends are half-spheres of radius r about two centres at the distance l, so that its length is l + 2 r. Its mass
    is spread evenly between the centres. The moment of inertia across the axis neglects the thickness, with a relative
    error of the order (r / l)^2; take CapsuleBody for thick rods.
    """

    centre_distance: float = parameter(
        doc="distance l of the centres of the rounded ends", unit="m", above=0.0, usual=(1e-5, 10.0)
    )
    radius: float = parameter(doc="radius r of the rod and of its ends", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = density_field()
    mass: float | None = mass_field()

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return the sizes of a slender rod."""
        return {"centre_distance": 0.2, "radius": 0.005}

    @property
    def total_mass(self) -> float:
        """Mass as given, or density times pi r^2 l [kg]."""
        return mass_of(self, self.mass, self.density, math.pi * self.radius**2 * self.centre_distance)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments m r^2 / 2 about the axis, m l^2 / 12 across [kg m^2]."""
        mass = self.total_mass
        across = mass * self.centre_distance**2 / 12.0
        return mass * self.radius**2 / 2.0, across, across

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """A capsule along the first axis."""
        return (Capsule(self.radius, 0.5 * self.centre_distance, axis_x=1.0, axis_z=0.0),)
