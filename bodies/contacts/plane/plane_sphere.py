"""A sphere over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter

from ...shapes.ground import Ground
from ...shapes.sphere import Sphere
from .plane_point import evaluate_ball_over_plane


@final
@dataclass(frozen=True)
class PlaneSphere(ContactKinematics):
    """One contact, Eqs. (8)-(13): the first body carries the plane, the second the sphere."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Sphere)

    radius: float = parameter(doc="radius of the sphere", unit="m", above=0.0)
    x: float = parameter(doc="centre in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="centre in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="centre in its body frame, third coordinate", unit="m")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneSphere, ...]:
        """Return the single contact of a plane and a sphere."""
        return (cls(**second.parameters(), **first.parameters()),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_ball_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("plane-sphere",)
