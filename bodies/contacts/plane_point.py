"""A point, or a ball about it, of one body over a plane of another."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def place_over_plane(a: Floats, out: Floats, x: float, y: float, z: float, height: float) -> None:
    """Write gap, axes, witness points and the matrices of the plane for the point (x, y, z) of the world.

    Normal and first tangent are the third and first axis of the plane's frame.
    """
    out[10], out[11], out[12] = x, y, z
    gap = -height
    for i in range(3):
        out[1 + i] = a[3 + 3 * i + 2]
        out[4 + i] = a[3 + 3 * i]
        gap += out[1 + i] * (out[10 + i] - a[i])
    out[0] = gap
    for i in range(3):
        out[7 + i] = out[10 + i] - gap * out[1 + i]
    # slide 0, turn 1
    out[17] = out[20] = 1.0


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
        normal = a[3 + 3 * i + 2]
        center = b[i] + b[3 + 3 * i] * x + b[3 + 3 * i + 1] * y + b[3 + 3 * i + 2] * z
        out[1 + i] = normal
        out[4 + i] = a[3 + 3 * i]
        out[10 + i] = center - radius * normal
        gap += normal * (center - a[i])
    out[0] = gap
    for i in range(3):
        out[7 + i] = out[10 + i] - gap * out[1 + i]
    # plane: slide 0, turn 1; ball: slide 1, turn its radius
    out[17] = out[20] = 1.0
    out[21] = out[24] = 1.0
    out[25] = out[28] = radius
