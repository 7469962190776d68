"""A disc over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.plane_rim import evaluate_rim_over_plane
from bodies.shapes.disc import Disc
from bodies.shapes.plane import Plane
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class PlaneDisc(ContactKinematics):
    """The lowest point of a disc's rim over a plane.

    A disc that lies flat has no lowest point: the numbers stay finite, but a single contact cannot hold it.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Plane, Disc)

    radius: float = parameter(doc="radius of the disc", unit="m", above=0.0)
    x: float = parameter(doc="centre in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="centre in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="centre in its body frame, third coordinate", unit="m")
    axis_x: float = parameter(doc="unit axis in its body frame, first component")
    axis_y: float = parameter(doc="unit axis in its body frame, second component")
    axis_z: float = parameter(doc="unit axis in its body frame, third component")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneDisc, ...]:
        """Return the single contact of a plane and a disc."""
        return (cls(**second.parameters(), **first.parameters()),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_rim_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return ("plane-rim",)
