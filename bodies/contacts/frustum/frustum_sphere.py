"""A sphere against a cylinder, a cone or a disc, in closed form."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, NORMAL, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.frustum import SWEEP, Frustum, without_feet
from ...shapes.sphere import Sphere
from ...vectors import put
from ..features.frames import across, point_in_world
from ..features.writing import place_sphere, write_round, write_sweep
from .frustum import (
    axis_in_world,
    center_in_world,
    nearest_part,
    part_names,
    part_number,
    write_part,
)


@compiled
def write_frustum_ball(
    a: Floats, b: Floats, out: Floats, first: Floats, radius: float, x: float, y: float, z: float
) -> tuple[float, float, float, float, int]:
    """Write the geometry block of a frustum and a ball about a point of the second body.

    Return the point in the world [m], its distance from the frustum's core [m], and the number of the nearest part.
    """
    ax, ay, az = axis_in_world(a, first)
    cx, cy, cz = center_in_world(a, first)
    x, y, z = point_in_world(b, (x, y, z))
    along, away, (ex, ey, ez) = across((x - cx, y - cy, z - cz), (ax, ay, az))
    distance, radial, axial, part = nearest_part(first, along, away)
    put(out, NORMAL, (radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az))
    out[FEATURE] = part_number(first, part)
    place_sphere(a, out, x, y, z, distance - first[SWEEP], radius)
    write_part(out, SIDE_A, part, (ax, ay, az), (ex, ey, ez), radial, away - distance * radial)
    write_sweep(out, SIDE_A, first[SWEEP])
    write_round(out, SIDE_B, radius)
    return x, y, z, distance, part


def _evaluate(a: Floats, b: Floats, out: Floats, first: Floats, radius: float, x: float, y: float, z: float) -> None:
    write_frustum_ball(a, b, out, first, radius, x, y, z)


@final
@dataclass(frozen=True)
class FrustumSphere(ContactKinematics):
    """One contact of a sphere with a cap, a rim or the side of a cylinder, a cone or a disc; feet are ignored.

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
        return (cls(without_feet(first.frustum), second),)

    def parameters(self) -> Mapping[str, Value]:
        """Return the numbers of both bodies by the names of the evaluator's arguments."""
        return {"first": self.first, **self.second.parameters()}

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features: each part of the frustum, from the lower cap upwards, with the sphere."""
        return tuple(f"{part} and sphere" for part in part_names(self.first))
