"""A point over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.shapes.plane import Plane
from bodies.shapes.point import Point
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    x: float,
    y: float,
    z: float,
    height: float,
) -> None:
    # normal and first tangent are the third and first axis of the plane's frame
    gap = -height
    for i in range(3):
        point = b[i] + b[3 + 3 * i] * x + b[3 + 3 * i + 1] * y + b[3 + 3 * i + 2] * z
        out[1 + i] = a[3 + 3 * i + 2]
        out[4 + i] = a[3 + 3 * i]
        out[10 + i] = point
        gap += out[1 + i] * (point - a[i])
    out[0] = gap
    for i in range(3):
        out[7 + i] = out[10 + i] - gap * out[1 + i]
    # plane: slide 0, turn 1; vertex: slide 1, turn 0
    out[17] = out[20] = 1.0
    out[21] = out[24] = 1.0


@final
@dataclass(frozen=True)
class PlaneVertex(ContactKinematics):
    """One contact: the first body carries the plane, the second the point."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Plane, Point)

    x: float = parameter(doc="point in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="point in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="point in its body frame, third coordinate", unit="m")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneVertex, ...]:
        """Return the single contact of a plane and a point."""
        return (cls(**second.parameters(), **first.parameters()),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return ("plane-vertex",)
