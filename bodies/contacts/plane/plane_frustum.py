"""A cylinder, a cone or a disc over a plane, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter

from ...shapes.frustum import AXIS, FEET, Frustum, Point
from ...shapes.ground import Ground
from .plane_rim import evaluate_rim_over_plane
from .plane_sphere import PlaneSphere
from .plane_vertex import PlaneVertex


@final
@dataclass(frozen=True)
class PlaneFrustum(ContactKinematics):
    """The lowest point of one rim of a cylinder, a cone or a disc over a plane.

    Two rims, or a rim and the apex, hold a body that lies on its side.  A rim that lies flat has no lowest point: the
    numbers stay finite, but a single contact cannot hold it.  Its feet can, each a contact of its own.  A rounded body
    has a torus about every rim, and spheres about its apex and the tips of its feet.

    Where springs press feet into the plane the face comes to touch it, and would lie now on one point of the rim, now
    on the opposite one, without anything between.  So the face has a crown, half as high as the feet, which on a plane
    is touched only where these are pressed in.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Ground, Frustum)

    radius: float = parameter(doc="radius of the rim", unit="m", above=0.0)
    x: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    axis_x: float = parameter(doc="unit axis in its body frame, first component")
    axis_y: float = parameter(doc="unit axis in its body frame, second component")
    axis_z: float = parameter(doc="unit axis in its body frame, third component")
    height: float = parameter(doc="height of the plane in its body frame", unit="m")
    rounding: float = parameter(0.0, doc="radius of the torus about a rounded rim", unit="m", minimum=0.0)
    crown: float = parameter(0.0, doc="sine at the rim of the cap of a sphere within the feet", minimum=0.0)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of the rims, first the one against the axis, of the apex, and of the feet, if any."""
        assert isinstance(second, Frustum)
        height = first.parameters()["height"]
        axis = second.frustum[AXIS], second.frustum[AXIS + 3], second.frustum[AXIS + 6]
        sweep = second.rounding

        def point(place: Point) -> ContactKinematics:
            return PlaneSphere(sweep, *place, height) if sweep > 0.0 else PlaneVertex(*place, height)

        rims = (
            cls(radius, *center, *axis, height, sweep, second.frustum[FEET] / radius) if radius > 0.0 else point(center)
            for radius, center in second.standing_rims
        )
        return *rims, *(point(foot) for foot in second.feet)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_rim_over_plane

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("plane-rim",)
