"""A capsule against a sphere, in closed form."""

from __future__ import annotations

from typing import ClassVar, TypeAlias, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.capsule import Capsule
from ...shapes.sphere import Sphere
from ...vectors import Vector3, dot, minus, plus_scaled, vector_at, write_vector
from ..features.frames import point_in_world, tangent_of, vector_in_world
from ..features.writing import join_cores, write_principal, write_round

_PARTS = "end -", "side", "end +"
_CENTER, _AXIS, _HALF_LENGTH, _RADIUS = 0, 3, 6, 7
"""Indices in the numbers of a capsule: centre in the body frame [m], unit axis, half-length [m] and radius [m]."""
Line: TypeAlias = tuple[Vector3, Vector3]
"""Middle of a capsule in the world [m], and its unit axis."""


def numbers_of(capsule: Capsule) -> tuple[float, ...]:
    """Return the numbers of a capsule for the evaluators: centre, unit axis, half-length and radius."""
    axis = capsule.axis_x, capsule.axis_y, capsule.axis_z
    return capsule.x, capsule.y, capsule.z, *axis, capsule.half_length, capsule.radius


@compiled
def _line(frame: Floats, capsule: Floats) -> Line:
    """Return the middle of a capsule [m] and its unit axis, in the world."""
    return point_in_world(frame, vector_at(capsule, _CENTER)), vector_in_world(frame, vector_at(capsule, _AXIS))


@compiled
def _clamped(coordinate: float, half: float) -> float:
    """Return the coordinate, limited to the range from ``-half`` to ``half`` [m]."""
    return min(max(coordinate, -half), half)


@compiled
def _write_side(out: Floats, side: int, axis: Vector3, radius: float) -> None:
    """Write the curvature matrices of the side of a capsule, from its unit axis in the world and its radius [m]."""
    write_principal(out, side, axis, 0.0, 1.0, 1.0, radius)


def evaluate_capsule_sphere(a: Floats, b: Floats, out: Floats, first: Floats, radius: float, center: Floats) -> None:
    """Write the geometry block of a capsule and a sphere, given by radius [m] and centre in the body frame [m]."""
    half, radius_a = first[_HALF_LENGTH], first[_RADIUS]
    middle, axis = _line(a, first)
    point = point_in_world(b, vector_at(center, 0))
    along = dot(minus(point, middle), axis)
    nearest = _clamped(along, half)
    write_vector(out, POINT_B, point)
    write_vector(out, POINT_A, plus_scaled(middle, nearest, axis))
    # the normal, if the centre of the sphere is on the axis: any vector across the axis
    x, y, z = tangent_of(axis)
    join_cores(a, out, radius_a, radius, (x, y, z))
    if nearest == along:
        _write_side(out, SIDE_A, axis, radius_a)
        out[FEATURE] = 1.0
    else:
        write_round(out, SIDE_A, radius_a)
        out[FEATURE] = 2.0 if along > 0.0 else 0.0
    write_round(out, SIDE_B, radius)


@final
class CapsuleSphere(ContactKinematics):
    """A capsule and a sphere: one contact, of the side or an end of the capsule."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Capsule, Sphere)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact; its features are the side and the ends, against and along the axis."""
        assert isinstance(first, Capsule)
        assert isinstance(second, Sphere)
        values: dict[str, Value] = {"first": numbers_of(first), "radius": second.radius}
        values["center"] = second.x, second.y, second.z
        return (FeaturePair(evaluate_capsule_sphere, values, tuple(f"{part} and sphere" for part in _PARTS)),)
