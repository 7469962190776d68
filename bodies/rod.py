"""Rod: slender."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of
from bodies.shapes.capsule import Capsule
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class Rod(FreeBody):
    """A free slender rod along the first body axis, its ends rounded.

    Its mass counts as spread evenly over the length between the centres of the ends; what its thickness adds across the
    axis, some (r / l)^2, is left out.  CapsuleBody is exact for thick ones.

    Attributes
    ----------
    centre_distance : float
        Distance l of the centres of the rounded ends [m]; the whole is longer by 2 r.
    radius : float
        Radius r of the rod and of its ends [m].
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.

    Raises
    ------
    InvalidInput
        If a size is not positive, or both mass and density are given.
    """

    centre_distance: float = parameter(
        doc="distance l of the centres of the rounded ends", unit="m", above=0.0, usual=(1e-5, 10.0)
    )
    radius: float = parameter(doc="radius r of the rod and of its ends", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a slender one."""
        return {"centre_distance": 0.2, "radius": 0.005}

    def _check(self) -> None:
        check_mass("Rod", self.mass, self.density)

    @property
    def total_mass(self) -> float:
        """As given, or density times pi r^2 l [kg]."""
        return mass_of(self.mass, self.density, math.pi * self.radius**2 * self.centre_distance)

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
