"""Two capsules, in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

from ...shapes.capsule import Capsule
from ...vectors import put
from ..features.frames import point_in_world, tangent_of, vector_in_world
from ..features.writing import by_side, join_cores, write_principal, write_round

ROUNDING = 1e-12
"""Excess of the distance at the middle of the overlap, relative to the lengths, up to which segments are parallel.

The excess is taken over the least distance of the segments.  At a smaller excess, round-off would move the crossing
point along both segments.
"""
_PARTS = "end -", "side", "end +"
_FEATURES = tuple(f"{one} and {two}" for one in _PARTS for two in _PARTS)


@compiled
def _within(coordinate: float, half: float) -> float:
    return min(max(coordinate, -half), half)


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
    half_length_b: float,
    x_b: float,
    y_b: float,
    z_b: float,
    axis_x_b: float,
    axis_y_b: float,
    axis_z_b: float,
) -> None:
    first_x, first_y, first_z = point_in_world(a, (x_a, y_a, z_a))
    ux, uy, uz = vector_in_world(a, (axis_x_a, axis_y_a, axis_z_a))
    second_x, second_y, second_z = point_in_world(b, (x_b, y_b, z_b))
    vx, vy, vz = vector_in_world(b, (axis_x_b, axis_y_b, axis_z_b))
    x, y, z = second_x - first_x, second_y - first_y, second_z - first_z
    # points s along the first segment and t along the second; nearest to a given t is s = ru + cosine t
    ru, rv = x * ux + y * uy + z * uz, x * vx + y * vy + z * vz
    cosine = ux * vx + uy * vy + uz * vz
    cx, cy, cz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    square = cx * cx + cy * cy + cz * cz
    s = t = 0.0
    shortest, is_parallel = math.inf, False
    for end in range(6):
        if end < 4:
            # an end of one and the point of the other that is nearest to it
            sign = 1.0 if end % 2 == 1 else -1.0
            if end < 2:
                s_tried = sign * half_length_a
                t_tried = _within(cosine * s_tried - rv, half_length_b)
            else:
                t_tried = sign * half_length_b
                s_tried = _within(cosine * t_tried + ru, half_length_a)
            allowed = 0.0
        elif end == 4:
            # the two lines cross
            if square == 0.0:
                continue
            s_tried, t_tried = (ru - cosine * rv) / square, (cosine * ru - rv) / square
            if abs(s_tried) > half_length_a or abs(t_tried) > half_length_b:
                continue
            allowed = 0.0
        else:
            # the middle of the overlap of parallel segments: as near as the nearest points, within round-off
            low = max(ru - half_length_b, -half_length_a)
            high = min(ru + half_length_b, half_length_a)
            if low > high:
                continue
            s_tried = 0.5 * (low + high)
            t_tried = _within(cosine * s_tried - rv, half_length_b)
            allowed = ROUNDING * (half_length_a + half_length_b)
        dx, dy, dz = x + t_tried * vx - s_tried * ux, y + t_tried * vy - s_tried * uy, z + t_tried * vz - s_tried * uz
        distance = math.sqrt(dx * dx + dy * dy + dz * dz)
        if distance <= shortest + allowed:
            s, t, shortest, is_parallel = s_tried, t_tried, distance, end == 5
    put(out, POINT_A, (first_x + s * ux, first_y + s * uy, first_z + s * uz))
    put(out, POINT_B, (second_x + t * vx, second_y + t * vy, second_z + t * vz))
    if square > 0.0:
        sine = math.sqrt(square)
        cx, cy, cz = cx / sine, cy / sine, cz / sine
    else:
        cx, cy, cz = tangent_of((ux, uy, uz))
    join_cores(a, out, radius_a, radius_b, cx, cy, cz)
    side_a, side_b = abs(s) < half_length_a, abs(t) < half_length_b
    write_round(out, SIDE_A, radius_a)
    write_round(out, SIDE_B, radius_b)
    if side_b:
        write_principal(out, SIDE_B, vx, vy, vz, 0.0, 1.0, 1.0, radius_b)
    if side_a and side_b and is_parallel:
        write_principal(out, SIDE_A, ux, uy, uz, 1.0, 0.0, 1.0, radius_a)
    elif side_a:
        write_principal(out, SIDE_A, ux, uy, uz, 0.0, 1.0, 1.0, radius_a)
    number = 4.0
    if not side_a:
        number += 3.0 if s > 0.0 else -3.0
    if not side_b:
        number += 1.0 if t > 0.0 else -1.0
    out[FEATURE] = number


@final
@dataclass(frozen=True)
class CapsuleCapsule(ContactKinematics):
    """One contact of two capsules, at the closest points of their segments.

    Parallel capsules that overlap touch along a line; the contact is in its middle, where it can hold them as far as
    they do not tilt.  They tilt about it, and the contact goes to an end.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Capsule, Capsule)

    radius_a: float = parameter(doc="radius of the capsule", unit="m", above=0.0)
    half_length_a: float = parameter(doc="half its length between the end spheres' centres", unit="m", above=0.0)
    x_a: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y_a: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z_a: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    axis_x_a: float = parameter(doc="unit axis in its body frame, first component")
    axis_y_a: float = parameter(doc="unit axis in its body frame, second component")
    axis_z_a: float = parameter(doc="unit axis in its body frame, third component")
    radius_b: float = parameter(doc="radius of the capsule", unit="m", above=0.0)
    half_length_b: float = parameter(doc="half its length between the end spheres' centres", unit="m", above=0.0)
    x_b: float = parameter(doc="its centre in its body frame, first coordinate", unit="m")
    y_b: float = parameter(doc="its centre in its body frame, second coordinate", unit="m")
    z_b: float = parameter(doc="its centre in its body frame, third coordinate", unit="m")
    axis_x_b: float = parameter(doc="unit axis in its body frame, first component")
    axis_y_b: float = parameter(doc="unit axis in its body frame, second component")
    axis_z_b: float = parameter(doc="unit axis in its body frame, third component")

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[CapsuleCapsule, ...]:
        """Return the single contact of two capsules."""
        return (cls(**by_side(first, second)),)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Ends and side of the first with those of the second."""
        return _FEATURES
