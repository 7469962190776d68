"""A cylinder over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.plane_rim import evaluate_rim_over_plane
from bodies.contacts.plane_vertex import PlaneVertex
from bodies.shapes.cylinder import Cylinder
from bodies.shapes.ground import Ground
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class PlaneCylinder(ContactKinematics):
    """The lowest point of one rim of a cylinder over a plane; a cylinder has two such contacts.

    They hold a cylinder that lies on its side.  One that stands has no lowest point: the numbers stay finite, but a
    single contact cannot hold it.  Its feet can, each a contact of its own.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Cylinder)

    radius: float = parameter(doc="radius of the rim", unit="m", above=0.0)
    x: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    axis_x: float = parameter(doc="unit axis in its body frame, first component")
    axis_y: float = parameter(doc="unit axis in its body frame, second component")
    axis_z: float = parameter(doc="unit axis in its body frame, third component")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of the two rims, first the one against the axis, then those of the feet, if any."""
        assert isinstance(second, Cylinder)
        height = first.parameters()["height"]
        axis = second.axis_x, second.axis_y, second.axis_z
        rims = (cls(second.radius, *rim, *axis, height) for rim in second.rims)
        return *rims, *(PlaneVertex(*foot, height) for foot in second.feet)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_rim_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return ("plane-rim",)
