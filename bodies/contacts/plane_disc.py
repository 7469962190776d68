"""A disc over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.plane_rim import evaluate_rim_over_plane
from bodies.contacts.plane_vertex import PlaneVertex
from bodies.shapes.disc import Disc
from bodies.shapes.ground import Ground
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class PlaneDisc(ContactKinematics):
    """The lowest point of a disc's rim over a plane.

    A disc that lies flat has no lowest point: the numbers stay finite, but a single contact cannot hold it.  Its feet
    can, each a contact of its own.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Disc)

    radius: float = parameter(doc="radius of the disc", unit="m", above=0.0)
    x: float = parameter(doc="centre in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="centre in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="centre in its body frame, third coordinate", unit="m")
    axis_x: float = parameter(doc="unit axis in its body frame, first component")
    axis_y: float = parameter(doc="unit axis in its body frame, second component")
    axis_z: float = parameter(doc="unit axis in its body frame, third component")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contact of the rim, then those of the feet, if there are any."""
        assert isinstance(second, Disc)
        height = first.parameters()["height"]
        rim = cls(second.radius, second.x, second.y, second.z, second.axis_x, second.axis_y, second.axis_z, height)
        return rim, *(PlaneVertex(*foot, height) for foot in second.feet)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_rim_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return ("plane-rim",)
