"""A sphere against a disc, in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from bodies.contacts.across import across
from bodies.contacts.curvature import SIDE_A, SIDE_B, write_flat, write_principal, write_round
from bodies.contacts.frames import point_in_world, vector_in_world
from bodies.contacts.offset import place_sphere
from bodies.contacts.sides import by_side
from bodies.shapes.disc import Disc
from bodies.shapes.sphere import Sphere
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    radius_a: float,
    x_a: float,
    y_a: float,
    z_a: float,
    axis_x_a: float,
    axis_y_a: float,
    axis_z_a: float,
    radius_b: float,
    x_b: float,
    y_b: float,
    z_b: float,
) -> None:
    x, y, z = point_in_world(a, x_a, y_a, z_a)
    axis_x, axis_y, axis_z = vector_in_world(a, axis_x_a, axis_y_a, axis_z_a)
    center_x, center_y, center_z = point_in_world(b, x_b, y_b, z_b)
    along, away, ex, ey, ez = across(center_x - x, center_y - y, center_z - z, axis_x, axis_y, axis_z)
    beyond = away - radius_a
    if beyond > 0.0:
        distance = math.sqrt(along * along + beyond * beyond)
        radial, axial = beyond / distance, along / distance
        out[29] = 1.0
    else:
        distance, radial, axial = abs(along), 0.0, 1.0 if along >= 0.0 else -1.0
        out[29] = 1.0 + axial
    out[1], out[2], out[3] = radial * ex + axial * axis_x, radial * ey + axial * axis_y, radial * ez + axial * axis_z
    place_sphere(a, out, center_x, center_y, center_z, distance, radius_b)
    if radial == 0.0:
        write_flat(out, SIDE_A)
    else:
        rim_x, rim_y, rim_z = axis_y * ez - axis_z * ey, axis_z * ex - axis_x * ez, axis_x * ey - axis_y * ex
        write_principal(out, SIDE_A, rim_x, rim_y, rim_z, radial, radius_a, 1.0, 0.0)
    write_round(out, SIDE_B, radius_b)


@final
@dataclass(frozen=True)
class DiscSphere(ContactKinematics):
    """One contact of a sphere with a face or the rim of a disc; it does not see the feet."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Disc, Sphere)

    radius_a: float = parameter(doc="radius of the disc", unit="m", above=0.0)
    x_a: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y_a: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z_a: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    axis_x_a: float = parameter(doc="unit axis in its body frame, first component")
    axis_y_a: float = parameter(doc="unit axis in its body frame, second component")
    axis_z_a: float = parameter(doc="unit axis in its body frame, third component")
    radius_b: float = parameter(doc="radius of the sphere", unit="m", above=0.0)
    x_b: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y_b: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z_b: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[DiscSphere, ...]:
        """Return the single contact of a disc and a sphere."""
        return (cls(**by_side(first, second)),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Rim, and faces against and along the axis."""
        return ("face - and sphere", "rim and sphere", "face + and sphere")
