"""BoxBody: a solid box."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of, moments_of
from bodies.shapes.box import Box, check_rounding
from nonsmooth.interfaces import Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class BoxBody(FreeBody):
    """A free solid box with its edges, sharp or rounded, along the body axes.

    Attributes
    ----------
    half_x : float
        Half-length along the first axis [m].
    half_y : float
        Half-length along the second axis [m].
    half_z : float
        Half-length along the third axis [m].
    rounding : float
        Radius of its edges and vertices [m]; the half-lengths are those of the whole.
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.

    Raises
    ------
    InvalidInput
        If a size is not positive, the rounding leaves no core, or both mass and density are given.
    """

    half_x: float = parameter(doc="half-length along the first axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    half_y: float = parameter(doc="half-length along the second axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    half_z: float = parameter(doc="half-length along the third axis", unit="m", above=0.0, usual=(1e-5, 10.0))
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)
    rounding: float = parameter(0.0, doc="radius of its edges and vertices", unit="m", minimum=0.0)

    def _check(self) -> None:
        check_mass("BoxBody", self.mass, self.density)
        check_rounding("BoxBody", (self.half_x, self.half_y, self.half_z), self.rounding)

    @property
    def _box(self) -> Box:
        return Box(self.half_x, self.half_y, self.half_z, rounding=self.rounding)

    @property
    def total_mass(self) -> float:
        """As given, or density times volume, 8 a b c of a sharp one [kg]."""
        return mass_of(self.mass, self.density, self._box.volume)

    @property
    def spin(self) -> int:
        """None, though it be a cube: where it touches turns with it, and so do the forces."""
        return -1

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments m (b^2 + c^2) / 3 and so on [kg m^2]; of a rounded one, piece by piece."""
        if self.rounding > 0.0:
            return moments_of(self._box, self.total_mass)
        third, x, y, z = self.total_mass / 3.0, self.half_x**2, self.half_y**2, self.half_z**2
        return third * (y + z), third * (z + x), third * (x + y)

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The box about the mass centre."""
        return (self._box,)
