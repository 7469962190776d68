"""HullBody: the solid convex hull of points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of
from bodies.shapes.hull import ConvexHull
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class HullBody(FreeBody):
    """A free solid convex hull.

    Its frame has the axes in which the points are given, and its origin at the mass centre.

    Attributes
    ----------
    points : sequence
        At least four points that are not in one plane, from an origin of the user's choice [m, shape (n, 3)].
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.
    rounding : float
        Radius of the sphere that sweeps the hull [m]: the faces stand out by it.

    Raises
    ------
    InvalidInput
        If the points have no volume or are not finite, or both mass and density are given.
    """

    points: Sequence[Sequence[float]] = field()
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)
    rounding: float = parameter(0.0, doc="radius of the sphere that sweeps the hull", unit="m", minimum=0.0)
    _hull: ConvexHull = field(init=False, repr=False, compare=False)
    _tensor: Any = field(init=False, repr=False, compare=False)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return the points of a tetrahedron."""
        return ConvexHull.example()

    def _check(self) -> None:
        check_mass("HullBody", self.mass, self.density)
        given = ConvexHull(self.points, rounding=self.rounding)
        object.__setattr__(self, "points", given.points)
        centered = np.array(given.points) - given.centroid
        object.__setattr__(self, "_hull", ConvexHull(centered.tolist(), rounding=self.rounding))
        tensor = self.total_mass / self._hull.volume * self._hull.inertia
        # what is left of products that cancel is round-off; without it principal axes stay principal
        clean = np.where(np.abs(tensor) > 1e-14 * np.max(tensor), tensor, 0.0)
        object.__setattr__(self, "_tensor", clean.tolist())

    @property
    def centre(self) -> Vector:
        """The mass centre, from the origin in which the points are given [m]."""
        return ConvexHull(self.points, rounding=self.rounding).centroid

    @property
    def total_mass(self) -> float:
        """As given, or density times volume [kg]."""
        return mass_of(self.mass, self.density, self._hull.volume)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """By the tetrahedra of its faces; of a rounded one, piece by piece [kg m^2]."""
        return self._tensor[0][0], self._tensor[1][1], self._tensor[2][2]

    @property
    def products(self) -> tuple[float, float, float]:
        """The elements J_yz, J_xz, J_xy [kg m^2]."""
        return self._tensor[1][2], self._tensor[0][2], self._tensor[0][1]

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The hull about the mass centre."""
        return (self._hull,)
