"""A sphere against a capsule, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import FEATURE, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

from ...shapes.capsule import Capsule
from ...shapes.sphere import Sphere
from ...vectors import put
from ..features.frames import point_in_world, tangent_of, vector_in_world
from ..features.writing import by_side, join_cores, write_principal, write_round


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    radius_a: float,
    half_length_a: float,
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
    x, y, z = point_in_world(a, (x_a, y_a, z_a))
    axis_x, axis_y, axis_z = vector_in_world(a, (axis_x_a, axis_y_a, axis_z_a))
    put(out, POINT_B, point_in_world(b, (x_b, y_b, z_b)))
    along = (out[POINT_B] - x) * axis_x + (out[POINT_B + 1] - y) * axis_y + (out[POINT_B + 2] - z) * axis_z
    near = min(max(along, -half_length_a), half_length_a)
    put(out, POINT_A, (x + near * axis_x, y + near * axis_y, z + near * axis_z))
    nx, ny, nz = tangent_of((axis_x, axis_y, axis_z))
    join_cores(a, out, radius_a, radius_b, nx, ny, nz)
    if near == along:
        write_principal(out, SIDE_A, axis_x, axis_y, axis_z, 0.0, 1.0, 1.0, radius_a)
        out[FEATURE] = 1.0
    else:
        write_round(out, SIDE_A, radius_a)
        out[FEATURE] = 2.0 if along > 0.0 else 0.0
    write_round(out, SIDE_B, radius_b)


@final
@dataclass(frozen=True)
class CapsuleSphere(ContactKinematics):
    """One contact of a sphere with the side or an end of a capsule."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Capsule, Sphere)

    radius_a: float = parameter(doc="radius of the capsule", unit="m", above=0.0)
    half_length_a: float = parameter(doc="half its length between the end spheres' centres", unit="m", above=0.0)
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
    def between(cls, first: Shape, second: Shape) -> tuple[CapsuleSphere, ...]:
        """Return the single contact of a capsule and a sphere."""
        return (cls(**by_side(first, second)),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Side, and ends against and along the axis."""
        return ("end - and sphere", "side and sphere", "end + and sphere")
