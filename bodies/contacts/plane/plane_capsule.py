"""A capsule over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter

from ...shapes.capsule import Capsule
from ...shapes.ground import Ground
from .plane_point import evaluate_ball_over_plane


@final
@dataclass(frozen=True)
class PlaneCapsule(ContactKinematics):
    """One end sphere of a capsule over a plane; a capsule has two such contacts, which hold it when it lies."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Capsule)

    radius: float = parameter(doc="radius of the end sphere", unit="m", above=0.0)
    x: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneCapsule, ...]:
        """Return the contacts of the two end spheres, first the one against the axis."""
        assert isinstance(second, Capsule)
        height = first.parameters()["height"]
        return tuple(cls(second.radius, *end, height) for end in second.ends)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_ball_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("plane-end",)
