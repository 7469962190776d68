"""HullBody: a free solid that fills the convex hull of given points."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter

from .free import TensorBody
from .inertia import density_field, mass_field, tensor_in
from .shapes.hull import ConvexHull
from .solid_body import SolidBody


@final
@dataclass(frozen=True)
class HullBody(SolidBody, TensorBody):
    """A free solid convex hull.

    Its frame has the axes in which the points are given, and its origin at the mass centre.

    Attributes
    ----------
    points : sequence
        At least four points that are not in one plane, from an origin of the user's choice [m, shape (n, 3)].
    rounding : float
        Radius of the sphere that sweeps the hull [m]: the faces stand out by it.
    """

    points: Sequence[Sequence[float]] = field()
    density: float | None = density_field()
    mass: float | None = mass_field()
    rounding: float = parameter(0.0, doc="radius of the sphere that sweeps the hull", unit="m", minimum=0.0)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return the points of a tetrahedron."""
        return ConvexHull.example()

    def _check(self) -> None:
        object.__setattr__(self, "points", ConvexHull(self.points, rounding=self.rounding).points)

    @property
    def centre(self) -> Vector:
        """The mass centre, from the origin in which the points are given [m]."""
        return ConvexHull(self.points, rounding=self.rounding).centroid

    @functools.cached_property
    def centred_shape(self) -> ConvexHull:
        """The hull with its mass centre at the origin."""
        return ConvexHull((np.array(self.points) - self.centre).tolist(), rounding=self.rounding)

    @functools.cached_property
    def _tensor(self) -> Vector:
        return tensor_in(self.centred_shape, self.total_mass)
