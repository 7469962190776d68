"""A box over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.plane_point import evaluate_ball_over_plane
from bodies.shapes.box import Box
from bodies.shapes.ground import Ground
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class PlaneBox(ContactKinematics):
    """One vertex of a box, with its rounding, over a plane; a box has eight such contacts."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Box)

    x: float = parameter(doc="vertex in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="vertex in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="vertex in its body frame, third coordinate", unit="m")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")
    radius: float = parameter(
        0.0, doc="rounding of the vertex; a sharp one is the smallest ball", unit="m", minimum=0.0
    )

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneBox, ...]:
        """Return the contacts of the eight vertices."""
        assert isinstance(second, Box)
        height = first.parameters()["height"]
        return tuple(cls(*vertex, height, second.rounding) for vertex in second.vertices)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_ball_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return ("plane-vertex",)
