"""SupportBody: a solid whose shape a user gives by its farthest points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, final

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of
from bodies.shapes.egg import Egg
from bodies.shapes.moved_shape import MovedShape
from bodies.shapes.support_shape import SupportShape
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class SupportBody(FreeBody):
    """A free solid of even density; the origin of its frame is the centroid of the shape, the axes are the shape's.

    Attributes
    ----------
    shape : SupportShape
        The shape, anywhere in its own frame.
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.

    Raises
    ------
    InvalidInput
        If the shape is no SupportShape, or both mass and density are given.
    """

    shape: SupportShape = field()
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return an egg."""
        return {"shape": Egg()}

    def _check(self) -> None:
        if not isinstance(self.shape, SupportShape):
            remedy = "Other shapes have bodies of their own, such as BoxBody or MeshBody; RigidBody carries any."
            raise InvalidInput("SupportBody.shape", "must be a SupportShape", self.shape, remedy)
        check_mass("SupportBody", self.mass, self.density)

    @property
    def total_mass(self) -> float:
        """As given, or density times volume [kg]."""
        return mass_of(self.mass, self.density, self.shape.volume)

    @property
    def _tensor(self) -> Vector:
        return self.total_mass / self.shape.volume * self.shape.inertia

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Moments of the solid about the axes [kg m^2]."""
        x, y, z = self._tensor.diagonal().tolist()
        return x, y, z

    @property
    def products(self) -> tuple[float, float, float]:
        """Its elements J_yz, J_xz, J_xy [kg m^2]."""
        tensor = self._tensor
        return float(tensor[1, 2]), float(tensor[0, 2]), float(tensor[0, 1])

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The shape about the mass centre."""
        x, y, z = (-self.shape.centroid).tolist()
        return (MovedShape(self.shape, x, y, z),)
