"""RigidBody: mass, inertia and shapes as given."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter

from .free import TensorBody
from .inertia import read_tensor
from .shapes.sphere import Sphere
from .values import keep_carried


@final
@dataclass(frozen=True)
class RigidBody(TensorBody):
    """A free body with given mass, inertia and shapes.

    Attributes
    ----------
    mass : float
        Mass [kg].
    tensor : sequence
        Three principal moments of inertia, or the inertia tensor about the mass centre in the axes of the body
        [kg m^2, shape (3) or (3, 3)]; the element J_xy is -integral of x y dm.
    carried : tuple of Shape
        Its shapes, in axes with the origin at the mass centre.

    Raises
    ------
    InvalidInput
        If the tensor is not symmetric, not positive definite, or of no distribution of mass.
    """

    mass: float = parameter(doc="mass", unit="kg", above=0.0)
    tensor: Sequence[Any] = field()  # type: ignore[misc]
    carried: tuple[Shape, ...] = ()

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a full tensor and two spheres."""
        return {
            "tensor": ((0.03, -0.004, 0.002), (-0.004, 0.025, 0.005), (0.002, 0.005, 0.04)),
            "carried": (Sphere(0.05, x=0.1), Sphere(0.04, y=-0.1)),
        }

    def _check(self) -> None:
        tensor = read_tensor("RigidBody.tensor", self.tensor)
        object.__setattr__(self, "tensor", tuple(tuple(row) for row in tensor.tolist()))
        keep_carried(self)

    @property
    def total_mass(self) -> float:
        """As given [kg]."""
        return self.mass

    @property
    def _tensor(self) -> Vector:
        return np.array(self.tensor)

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """As given."""
        return self.carried
