"""A cylinder over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.plane_rim import evaluate_rim_over_plane
from bodies.shapes.cylinder import Cylinder
from bodies.shapes.plane import Plane
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class PlaneCylinder(ContactKinematics):
    """The lowest point of one rim of a cylinder over a plane; a cylinder has two such contacts.

    They hold a cylinder that lies on its side.  One that stands has no lowest point: the numbers stay finite, but a
    single contact cannot hold it.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Plane, Cylinder)

    radius: float = parameter(doc="radius of the rim", unit="m", above=0.0)
    x: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    axis_x: float = parameter(doc="unit axis in its body frame, first component")
    axis_y: float = parameter(doc="unit axis in its body frame, second component")
    axis_z: float = parameter(doc="unit axis in its body frame, third component")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[PlaneCylinder, ...]:
        """Return the contacts of the two rims, first the one against the axis."""
        assert isinstance(second, Cylinder)
        height = first.parameters()["height"]
        axis = second.axis_x, second.axis_y, second.axis_z
        return tuple(cls(second.radius, *cap, *axis, height) for cap in second.caps)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_rim_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return ("plane-rim",)
