"""A sphere or a point of one body over a plane of another."""

from __future__ import annotations

from bodies.contacts.curvature import SIDE_A, SIDE_B, write_flat, write_round
from bodies.contacts.frames import point_in_world
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def place_over_plane(a: Floats, out: Floats, x: float, y: float, z: float, radius: float, height: float) -> None:
    """Write gap, axes and witness points for a ball about (x, y, z) in the world, a point with radius 0.

    Normal and first tangent are the third and first axis of the plane's frame.
    """
    out[10], out[11], out[12] = x, y, z
    gap = -height - radius
    for i in range(3):
        out[1 + i] = a[3 + 3 * i + 2]
        out[4 + i] = a[3 + 3 * i]
        gap += out[1 + i] * (out[10 + i] - a[i])
        out[10 + i] -= radius * out[1 + i]
    out[0] = gap
    for i in range(3):
        out[7 + i] = out[10 + i] - gap * out[1 + i]


def evaluate_sphere_over_plane(
    a: Floats,
    b: Floats,
    out: Floats,
    radius: float,
    x: float,
    y: float,
    z: float,
    height: float,
) -> None:
    """Write the geometry block; the sphere's centre is (x, y, z) in its body frame."""
    center_x, center_y, center_z = point_in_world(b, x, y, z)
    place_over_plane(a, out, center_x, center_y, center_z, radius, height)
    write_flat(out, SIDE_A)
    write_round(out, SIDE_B, radius)


def evaluate_point_over_plane(
    a: Floats,
    b: Floats,
    out: Floats,
    x: float,
    y: float,
    z: float,
    height: float,
) -> None:
    """Write the geometry block; the point is (x, y, z) in its body frame."""
    point_x, point_y, point_z = point_in_world(b, x, y, z)
    place_over_plane(a, out, point_x, point_y, point_z, 0.0, height)
    write_flat(out, SIDE_A)
    write_round(out, SIDE_B, 0.0)
