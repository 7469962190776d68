"""A point, or a ball about it, of one body over a plane of another, in closed form."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, POINT_A, POINT_B, POSITION, ROTATION, SIDE_A, SIDE_B, TANGENT
from nonsmooth.types import Floats

from ...vectors import Vector3, minus, plus_scaled, vector_at, write_vector
from ..features.frames import point_in_world
from ..features.writing import write_flat, write_round


@compiled
def axis_of(frame: Floats, i: int) -> Vector3:
    """Return the unit vector along axis i of a body, 0 for the first, in the world."""
    return frame[ROTATION + i], frame[ROTATION + i + 3], frame[ROTATION + i + 6]


@compiled
def place_over_plane(a: Floats, out: Floats, center: Vector3, height: float, radius: float = 0.0) -> None:
    """Write gap, axes, witness points and the matrices of the plane for a ball or, with the radius 0, a point.

    ``center`` is in the world [m].  The plane is at the ``height`` [m] along the third axis of its body, which is the
    normal.  The first axis is the first tangent.
    """
    n = axis_of(a, 2)
    d = minus(center, vector_at(a, POSITION))
    gap = -height - radius + n[0] * d[0] + n[1] * d[1] + n[2] * d[2]
    lowest = plus_scaled(center, -radius, n)
    out[GAP] = gap
    write_vector(out, NORMAL, n)
    write_vector(out, TANGENT, axis_of(a, 0))
    write_vector(out, POINT_A, plus_scaled(lowest, -gap, n))
    write_vector(out, POINT_B, lowest)
    write_flat(out, SIDE_A)


def evaluate_ball_over_plane(
    a: Floats, b: Floats, out: Floats, radius: float, x: float, y: float, z: float, height: float
) -> None:
    """Write the geometry block of a ball over a plane.

    The ball's centre (x, y, z) is in its body frame [m]; a point has radius 0.  ``height`` is that of the plane along
    the third axis of its body [m].
    """
    place_over_plane(a, out, point_in_world(b, (x, y, z)), height, radius)
    write_round(out, SIDE_B, radius)
