"""Two spheres, in closed form."""

from __future__ import annotations

from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import POINT_A, POINT_B, ROTATION, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.sphere import Sphere
from ...vectors import write_vector
from ..features.frames import point_in_world
from ..features.writing import join_cores, write_round


def evaluate_spheres(
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
    """Write the geometry block of two spheres, given by radius [m] and centre in the body frame [m]."""
    write_vector(out, POINT_A, point_in_world(a, (x_a, y_a, z_a)))
    write_vector(out, POINT_B, point_in_world(b, (x_b, y_b, z_b)))
    # centres in one point give no normal: take the third axis of the first body
    join_cores(a, out, radius_a, radius_b, (a[ROTATION + 2], a[ROTATION + 5], a[ROTATION + 8]))
    write_round(out, SIDE_A, radius_a)
    write_round(out, SIDE_B, radius_b)


@final
class SphereSphere(ContactKinematics):
    """Two spheres: one contact, whose normal joins their centres."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Sphere, Sphere)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of two spheres."""
        assert isinstance(first, Sphere)
        assert isinstance(second, Sphere)
        # numbers, not vectors: this is a common contact, and a vector is one more reference to follow
        values: dict[str, Value] = {f"{name}_a": value for name, value in first.numbers().items()}
        values |= {f"{name}_b": value for name, value in second.numbers().items()}
        return (FeaturePair(evaluate_spheres, values, ("sphere-sphere",)),)
