"""A polyhedron over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter

from ...shapes.ground import Ground
from ...shapes.polyhedron import Polyhedron
from .plane_point import evaluate_ball_over_plane


@final
@dataclass(frozen=True)
class PlanePolyhedron(ContactKinematics):
    """One vertex of a polyhedron, with its rounding, over a plane; it has as many such contacts as vertices."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Polyhedron)

    x: float = parameter(doc="vertex in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="vertex in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="vertex in its body frame, third coordinate", unit="m")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")
    radius: float = parameter(
        0.0, doc="rounding of the vertex; a sharp one is the smallest ball", unit="m", minimum=0.0
    )

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlanePolyhedron, ...]:
        """Return the contacts of all vertices."""
        assert isinstance(second, Polyhedron)
        height = first.parameters()["height"]
        return tuple(cls(*vertex, height, second.rounding) for vertex in second.core.vertices)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_ball_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("plane-vertex",)
