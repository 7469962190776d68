"""CapsuleBody: a solid cylinder with half spheres at its ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .inertia import density_field, mass_field
from .shapes.capsule import Capsule
from .solid_body import SolidBody


@final
@dataclass(frozen=True)
class CapsuleBody(SolidBody):
    """A free solid capsule about the third body axis."""

    radius: float = parameter(doc="radius", unit="m", above=0.0, usual=(1e-5, 10.0))
    half_length: float = parameter(
        doc="half the distance of the end spheres' centres", unit="m", above=0.0, usual=(1e-5, 10.0)
    )
    density: float | None = density_field()
    mass: float | None = mass_field()

    @property
    def centred_shape(self) -> Capsule:
        """The capsule."""
        return Capsule(self.radius, self.half_length)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Cylinder and half spheres with their shifts, across the axis and about it [kg m^2]."""
        r, h, mass = self.radius, self.half_length, self.total_mass
        balls = mass * (4.0 / 3.0 * r) / (2.0 * h + 4.0 / 3.0 * r)
        middle = mass - balls
        # the centre of a half sphere lies 3/8 r beyond the end of the cylinder
        across = middle * (r * r / 4.0 + h * h / 3.0) + balls * (0.4 * r * r + h * h + 0.75 * h * r)
        return across, across, middle * r * r / 2.0 + balls * 0.4 * r * r
