"""Two spheres, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import POINT_A, POINT_B, ROTATION, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

from ...shapes.sphere import Sphere
from ..features.writing import by_side, join_cores, write_round


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    radius_a: float,
    x_a: float,
    y_a: float,
    z_a: float,
    radius_b: float,
    x_b: float,
    y_b: float,
    z_b: float,
) -> None:
    for i in range(3):
        r = ROTATION + 3 * i
        out[POINT_A + i] = a[i] + a[r] * x_a + a[r + 1] * y_a + a[r + 2] * z_a
        out[POINT_B + i] = b[i] + b[r] * x_b + b[r + 1] * y_b + b[r + 2] * z_b
    join_cores(a, out, radius_a, radius_b, a[ROTATION + 2], a[ROTATION + 5], a[ROTATION + 8])
    write_round(out, SIDE_A, radius_a)
    write_round(out, SIDE_B, radius_b)


@final
@dataclass(frozen=True)
class SphereSphere(ContactKinematics):
    """One contact of two spheres; its normal joins their centres."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Sphere, Sphere)

    radius_a: float = parameter(doc="radius of the first sphere", unit="m", above=0.0)
    x_a: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y_a: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z_a: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    radius_b: float = parameter(doc="radius of the second sphere", unit="m", above=0.0)
    x_b: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y_b: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z_b: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[SphereSphere, ...]:
        """Return the single contact of two spheres."""
        return (cls(**by_side(first, second)),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features."""
        return ("sphere-sphere",)
