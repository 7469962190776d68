"""Solid: a free body of any shape that encloses a volume."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ConvexShape, Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.rotations import rotation

from .free import TensorBody
from .inertia import density_field, mass_field, tensor_in
from .shapes.box import Box
from .shapes.moved_shape import moved
from .shapes.triangle_mesh import TriangleMesh
from .solid_body import SolidBody
from .values import check_fields


@final
@dataclass(frozen=True)
class Solid(SolidBody, TensorBody):
    """A free body that fills any shape with a volume evenly, as in ``Solid(Cylinder(0.02, 0.05), density=2700.0)``.

    The origin of its frame is the centroid of the shape. The axes of its frame are those in which the shape is given,
    unless ``orientation`` turns the shape. Mass and inertia tensor follow from the volume integrals of the shape.
    Bodies of one shape, such as :class:`bodies.BoxBody`, have closed forms instead.

    Attributes
    ----------
    shape : ConvexShape or TriangleMesh
        The shape, anywhere in its own axes: any convex shape with a volume, or a closed mesh.
    density : float
        Density [kg/m^3]; give either density or mass.
    mass : float
        Mass [kg].
    orientation : tuple of float
        Unit quaternion (scalar first) from the axes of the shape to those of the frame.

    Raises
    ------
    InvalidInput
        The shape has no volume, such as a plane or a sharp disc, or the user gave both density and mass, or neither.
    """

    shape: Shape = field()
    density: float | None = density_field("density")
    mass: float | None = mass_field()
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return an aluminium box whose centre is not the origin of its axes."""
        return {"shape": Box(0.01, 0.02, 0.03, x=0.1), "density": 2700.0}

    def _check(self) -> None:
        if not isinstance(self.shape, (ConvexShape, TriangleMesh)) or not self.shape.volume > 0.0:
            remedy = "Give a Box, a ConvexHull, a TriangleMesh ...; DiscBody is a disc without thickness."
            raise InvalidInput("Solid.shape", "must be a shape with a volume", self.shape, remedy)
        if (self.density is None) == (self.mass is None):
            given = {"density": self.density, "mass": self.mass}
            remedy = "Write Solid(shape, density=2700.0) or Solid(shape, mass=0.1)."
            raise InvalidInput("Solid: density or mass", "must be given, exactly one of the two", given, remedy)
        check_fields(self, "orientation")

    @property
    def centre(self) -> Vector:
        """The mass centre in the axes of the shape [m], shape [3]."""
        assert isinstance(self.shape, (ConvexShape, TriangleMesh))
        return self.shape.centroid

    @functools.cached_property
    def centred_shape(self) -> ConvexShape | TriangleMesh:
        """The shape in the frame of the body."""
        back = -rotation(self.orientation) @ self.centre
        placed = moved(self.shape, back, np.array(self.orientation))
        assert isinstance(placed, (ConvexShape, TriangleMesh))
        return placed

    @functools.cached_property
    def _tensor(self) -> Vector:
        return tensor_in(self.centred_shape, self.total_mass)
