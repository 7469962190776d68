"""A capsule against a sphere or another capsule, in closed form."""

from __future__ import annotations

import math
from typing import ClassVar, TypeAlias, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.capsule import Capsule
from ...shapes.sphere import Sphere
from ...vectors import Vector3, ahead, cross, dot, minus, over, put, size_of, vector_at
from ..features.frames import point_in_world, tangent_of, vector_in_world
from ..features.writing import join_cores, write_principal, write_round

ROUNDING = 1e-12
"""Excess of the distance at the middle of the overlap, relative to the lengths, up to which segments are parallel.

The excess is taken over the least distance of the segments.  At a smaller excess, round-off would move the crossing
point along both segments.
"""
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
    return point_in_world(frame, vector_at(capsule, _CENTER)), vector_in_world(frame, vector_at(capsule, _AXIS))


@compiled
def _within(coordinate: float, half: float) -> float:
    return min(max(coordinate, -half), half)


@compiled
def _write_side(out: Floats, side: int, axis: Vector3, radius: float) -> None:
    """Write the curvature matrices of the side of a capsule with this unit axis in the world."""
    write_principal(out, side, axis, 0.0, 1.0, 1.0, radius)


def evaluate_capsule_sphere(a: Floats, b: Floats, out: Floats, first: Floats, radius: float, center: Floats) -> None:
    """Write the geometry block of a capsule and a sphere, given by radius [m] and centre in the body frame [m]."""
    half, own = first[_HALF_LENGTH], first[_RADIUS]
    middle, axis = _line(a, first)
    point = point_in_world(b, vector_at(center, 0))
    along = dot(minus(point, middle), axis)
    near = _within(along, half)
    put(out, POINT_B, point)
    put(out, POINT_A, ahead(middle, near, axis))
    x, y, z = tangent_of(axis)
    join_cores(a, out, own, radius, (x, y, z))
    if near == along:
        _write_side(out, SIDE_A, axis, own)
        out[FEATURE] = 1.0
    else:
        write_round(out, SIDE_A, own)
        out[FEATURE] = 2.0 if along > 0.0 else 0.0
    write_round(out, SIDE_B, radius)


@compiled
def _nearest_points(first: Line, half_a: float, second: Line, half_b: float) -> tuple[float, float, bool]:
    """Return the places of the nearest points along two segments, from their middles [m].

    The last result is True if the segments are parallel and overlap: the places are then in the middle of the overlap.
    """
    (a, u), (b, v) = first, second
    between = minus(b, a)
    # points s along the first segment and t along the second; nearest to a given t is s = ru + cosine t
    ru, rv, cosine = dot(between, u), dot(between, v), dot(u, v)
    normal = cross(u, v)
    square = dot(normal, normal)
    s = t = 0.0
    shortest, is_parallel = math.inf, False
    for end in range(6):
        allowed = 0.0
        if end < 2:
            # an end of one and the point of the other that is nearest to it
            s_tried = half_a if end == 1 else -half_a
            t_tried = _within(cosine * s_tried - rv, half_b)
        elif end < 4:
            t_tried = half_b if end == 3 else -half_b
            s_tried = _within(cosine * t_tried + ru, half_a)
        elif end == 4:
            # the two lines cross
            if square == 0.0:
                continue
            s_tried, t_tried = (ru - cosine * rv) / square, (cosine * ru - rv) / square
            if abs(s_tried) > half_a or abs(t_tried) > half_b:
                continue
        else:
            # the middle of the overlap of parallel segments: as near as the nearest points, within round-off
            low, high = max(ru - half_b, -half_a), min(ru + half_b, half_a)
            if low > high:
                continue
            s_tried = 0.5 * (low + high)
            t_tried = _within(cosine * s_tried - rv, half_b)
            allowed = ROUNDING * (half_a + half_b)
        distance = size_of(ahead(ahead(between, t_tried, v), -s_tried, u))
        if distance <= shortest + allowed:
            s, t, shortest, is_parallel = s_tried, t_tried, distance, end == 5
    return s, t, is_parallel


def evaluate_capsules(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats) -> None:
    """Write the geometry block of two capsules."""
    line_a, line_b = _line(a, first), _line(b, second)
    half_a, half_b, radius_a, radius_b = first[_HALF_LENGTH], second[_HALF_LENGTH], first[_RADIUS], second[_RADIUS]
    s, t, is_parallel = _nearest_points(line_a, half_a, line_b, half_b)
    (middle, u), (other, v) = line_a, line_b
    put(out, POINT_A, ahead(middle, s, u))
    put(out, POINT_B, ahead(other, t, v))
    normal = cross(u, v)
    sine = size_of(normal)
    x, y, z = over(normal, sine) if sine > 0.0 else tangent_of(u)
    join_cores(a, out, radius_a, radius_b, (x, y, z))
    side_a, side_b = abs(s) < half_a, abs(t) < half_b
    write_round(out, SIDE_A, radius_a)
    write_round(out, SIDE_B, radius_b)
    if side_b:
        _write_side(out, SIDE_B, v, radius_b)
    if side_a and side_b and is_parallel:
        x, y, z = u
        write_principal(out, SIDE_A, (x, y, z), 1.0, 0.0, 1.0, radius_a)
    elif side_a:
        _write_side(out, SIDE_A, u, radius_a)
    part_a, part_b = 0.0 if side_a else math.copysign(1.0, s), 0.0 if side_b else math.copysign(1.0, t)
    out[FEATURE] = 4.0 + 3.0 * part_a + part_b


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


@final
class CapsuleCapsule(ContactKinematics):
    """Two capsules: one contact, at the closest points of their segments.

    Parallel capsules that overlap touch along a line; the contact is in its middle, where it can hold them as far as
    they do not tilt.  They tilt about it, and the contact goes to an end.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Capsule, Capsule)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact; its features are ends and side of the first with those of the second."""
        assert isinstance(first, Capsule)
        assert isinstance(second, Capsule)
        names = tuple(f"{one} and {two}" for one in _PARTS for two in _PARTS)
        return (FeaturePair(evaluate_capsules, {"first": numbers_of(first), "second": numbers_of(second)}, names),)
