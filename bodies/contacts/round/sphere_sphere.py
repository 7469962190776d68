"""Two spheres, in closed form."""

from __future__ import annotations

from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import POINT_A, POINT_B, ROTATION, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.sphere import Sphere
from ...vectors import put, vector_at
from ..features.frames import point_in_world
from ..features.writing import join_cores, write_round


def evaluate_spheres(
    a: Floats, b: Floats, out: Floats, radius_a: float, center_a: Floats, radius_b: float, center_b: Floats
) -> None:
    """Write the geometry block of two spheres, given by radius [m] and centre in the body frame [m]."""
    put(out, POINT_A, point_in_world(a, vector_at(center_a, 0)))
    put(out, POINT_B, point_in_world(b, vector_at(center_b, 0)))
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
        values: dict[str, Value] = {
            "radius_a": first.radius,
            "center_a": (first.x, first.y, first.z),
            "radius_b": second.radius,
            "center_b": (second.x, second.y, second.z),
        }
        return (FeaturePair(evaluate_spheres, values, ("sphere-sphere",)),)
