"""A point, or a ball about it, of one body over a plane of another."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import GAP, NORMAL, POINT_A, POINT_B, ROTATION, SIDE_A, SIDE_B, TANGENT
from nonsmooth.types import Floats

from ...vectors import put
from ..features.writing import write_flat, write_round


@compiled
def place_over_plane(a: Floats, out: Floats, x: float, y: float, z: float, height: float) -> None:
    """Write gap, axes, witness points and the matrices of the plane for the point (x, y, z) of the world.

    Normal and first tangent are the third and first axis of the plane's frame.
    """
    put(out, POINT_B, (x, y, z))
    gap = -height
    for i in range(3):
        out[NORMAL + i] = a[ROTATION + 3 * i + 2]
        out[TANGENT + i] = a[ROTATION + 3 * i]
        gap += out[NORMAL + i] * (out[POINT_B + i] - a[i])
    out[GAP] = gap
    for i in range(3):
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    write_flat(out, SIDE_A)


def evaluate_ball_over_plane(
    a: Floats,
    b: Floats,
    out: Floats,
    radius: float,
    x: float,
    y: float,
    z: float,
    height: float,
) -> None:
    """Write the geometry block; the ball's centre is (x, y, z) in its body frame, and a point has radius 0."""
    # normal and first tangent are the third and first axis of the plane's frame
    gap = -height - radius
    for i in range(3):
        r = ROTATION + 3 * i
        normal = a[r + 2]
        center = b[i] + b[r] * x + b[r + 1] * y + b[r + 2] * z
        out[NORMAL + i] = normal
        out[TANGENT + i] = a[r]
        out[POINT_B + i] = center - radius * normal
        gap += normal * (center - a[i])
    out[GAP] = gap
    for i in range(3):
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    write_flat(out, SIDE_A)
    write_round(out, SIDE_B, radius)
