"""SupportBody: a solid body whose shape is given by its farthest points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, final

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

from .free import TensorBody
from .inertia import density_field, mass_field
from .shapes.egg import Egg
from .shapes.moved_shape import MovedShape
from .shapes.support_shape import SupportShape
from .solid_body import SolidBody


@final
@dataclass(frozen=True)
class SupportBody(SolidBody, TensorBody):
    """A free solid whose shape is given by its farthest points.

    Its frame has the axes of the shape and the origin at the centroid.

    Attributes
    ----------
    shape : SupportShape
        The shape, anywhere in its own frame.
    """

    shape: SupportShape = field()
    density: float | None = density_field()
    mass: float | None = mass_field()

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return an egg."""
        return {"shape": Egg()}

    def _check(self) -> None:
        if not isinstance(self.shape, SupportShape):
            remedy = "Solid(shape, density=...) fills any shape with a volume; RigidBody carries any shapes."
            raise InvalidInput("SupportBody.shape", "must be a SupportShape", self.shape, remedy)

    @property
    def centred_shape(self) -> MovedShape:
        """The shape with its mass centre at the origin."""
        x, y, z = (-self.shape.centroid).tolist()
        return MovedShape(self.shape, x, y, z)

    @property
    def _tensor(self) -> Vector:
        return self.total_mass / self.shape.volume * self.shape.inertia
