"""A sphere against a cylinder, a cone or a disc, in closed form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.across import across
from bodies.contacts.curvature import SIDE_A, SIDE_B, write_round
from bodies.contacts.frames import point_in_world
from bodies.contacts.frustum import axis_in_world, center_in_world, nearest_part, part_names, part_number, write_part
from bodies.contacts.offset import place_sphere
from bodies.shapes.frustum import FEET, Frustum
from bodies.shapes.sphere import Sphere
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats


def evaluate_frustum_ball(
    a: Floats, b: Floats, out: Floats, first: Floats, radius: float, x: float, y: float, z: float
) -> None:
    """Write the geometry block of a frustum and a ball about a point of the second body, or that point."""
    ax, ay, az = axis_in_world(a, first)
    cx, cy, cz = center_in_world(a, first)
    x, y, z = point_in_world(b, x, y, z)
    along, away, ex, ey, ez = across(x - cx, y - cy, z - cz, ax, ay, az)
    distance, radial, axial, part = nearest_part(first, along, away)
    out[1], out[2], out[3] = radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az
    out[29] = part_number(first, part)
    place_sphere(a, out, x, y, z, distance, radius)
    write_part(out, SIDE_A, part, ax, ay, az, ex, ey, ez, radial, away - distance * radial)
    write_round(out, SIDE_B, radius)


@final
@dataclass(frozen=True)
class FrustumSphere(ContactKinematics):
    """One contact of a sphere with a cap, a rim or the side of a cylinder, a cone or a disc; it does not see the feet.

    Attributes
    ----------
    first : tuple of float
        The cylinder, cone or disc (:func:`bodies.shapes.frustum.frustum_numbers`).
    second : Sphere
        The sphere.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, Sphere)

    first: tuple[float, ...]
    second: Sphere

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FrustumSphere, ...]:
        """Return the single contact of the two."""
        assert isinstance(first, Frustum)
        assert isinstance(second, Sphere)
        numbers = first.frustum
        # spheres meet the faces as if there were no feet
        return (cls((*numbers[:FEET], 0.0, *numbers[FEET + 1 :]), second),)

    def parameters(self) -> Mapping[str, Value]:
        """Return the numbers of both."""
        return {"first": self.first, **self.second.parameters()}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_frustum_ball

    @property
    def features(self) -> tuple[str, ...]:
        """From the cap against the axis to the one along it."""
        return tuple(f"{part} and sphere" for part in part_names(self.first))
