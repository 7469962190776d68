"""A point over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter

from ...shapes.ground import Ground
from ...shapes.point import Point
from .plane_point import evaluate_ball_over_plane


@final
@dataclass(frozen=True)
class PlaneVertex(ContactKinematics):
    """One contact: the first body carries the plane, the second the point."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Point)

    x: float = parameter(doc="point in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="point in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="point in its body frame, third coordinate", unit="m")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    def parameters(self) -> dict[str, float]:
        """Return the numbers given, and a radius of 0: a point is the smallest ball."""
        return {"radius": 0.0, **self.numbers()}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneVertex, ...]:
        """Return the single contact of a plane and a point."""
        return (cls(**second.parameters(), **first.parameters()),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_ball_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("plane-vertex",)
