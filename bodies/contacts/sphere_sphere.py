"""Two spheres, in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

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
    radius_b: float,
    x_b: float,
    y_b: float,
    z_b: float,
) -> None:
    square = 0.0
    for i in range(3):
        first = a[i] + a[3 + 3 * i] * x_a + a[3 + 3 * i + 1] * y_a + a[3 + 3 * i + 2] * z_a
        second = b[i] + b[3 + 3 * i] * x_b + b[3 + 3 * i + 1] * y_b + b[3 + 3 * i + 2] * z_b
        out[7 + i], out[10 + i] = first, second
        out[1 + i] = second - first
        square += (second - first) * (second - first)
    distance = math.sqrt(square)
    out[0] = distance - radius_a - radius_b
    for i in range(3):
        # concentric spheres have no normal; any will do there
        out[1 + i] = out[1 + i] / distance if distance > 0.0 else a[3 + 3 * i + 2]
        out[7 + i] += radius_a * out[1 + i]
        out[10 + i] -= radius_b * out[1 + i]
    # a tangent from the normal in the first body's axes, smooth but for one direction
    nx = a[3] * out[1] + a[6] * out[2] + a[9] * out[3]
    ny = a[4] * out[1] + a[7] * out[2] + a[10] * out[3]
    nz = a[5] * out[1] + a[8] * out[2] + a[11] * out[3]
    sign = 1.0 if nz >= 0.0 else -1.0
    shrink = -1.0 / (sign + nz)
    tx, ty, tz = 1.0 + sign * nx * nx * shrink, sign * nx * ny * shrink, -sign * nx
    for i in range(3):
        out[4 + i] = a[3 + 3 * i] * tx + a[3 + 3 * i + 1] * ty + a[3 + 3 * i + 2] * tz
    # sphere: slide 1, turn its radius
    out[13] = out[16] = out[21] = out[24] = 1.0
    out[17] = out[20] = radius_a
    out[25] = out[28] = radius_b


@final
@dataclass(frozen=True)
class SphereSphere(ContactKinematics):
    """One contact of two spheres; its normal joins their centres.

    The tangent follows T. Duff et al., "Building an orthonormal basis, revisited", J. Computer Graphics
    Techniques 6 (2017) 1-8.
    """

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
        one, two = first.parameters(), second.parameters()
        return (cls(**{f"{k}_a": v for k, v in one.items()}, **{f"{k}_b": v for k, v in two.items()}),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return ("sphere-sphere",)
