"""A circular rim of one body over a plane of another."""

from __future__ import annotations

from bodies.contacts.features.across import across
from bodies.contacts.features.curvature import write_principal, write_sweep
from bodies.contacts.features.frames import point_in_world, vector_in_world
from bodies.contacts.plane.plane_point import place_over_plane
from nonsmooth.engine.memory.blocks import ROTATION, SIDE_B
from nonsmooth.types import Floats

FLATTEST = 1e-9
"""Sine of the angle between rim and plane below which the lowest point is not followed any more."""


def evaluate_rim_over_plane(
    a: Floats,
    b: Floats,
    out: Floats,
    radius: float,
    x: float,
    y: float,
    z: float,
    axis_x: float,
    axis_y: float,
    axis_z: float,
    height: float,
    rounding: float,
) -> None:
    """Write the geometry block of the lowest point of the rim, or of the torus about it.

    For a rim that lies flat all points are lowest; any one is taken, and stands for a rim that is :data:`FLATTEST`.
    """
    x, y, z = point_in_world(b, x, y, z)
    axis_x, axis_y, axis_z = vector_in_world(b, axis_x, axis_y, axis_z)
    _, sine, down_x, down_y, down_z = across(
        -a[ROTATION + 2], -a[ROTATION + 5], -a[ROTATION + 8], axis_x, axis_y, axis_z
    )
    x, y, z = x + radius * down_x, y + radius * down_y, z + radius * down_z
    place_over_plane(
        a, out, x - rounding * a[ROTATION + 2], y - rounding * a[ROTATION + 5], z - rounding * a[ROTATION + 8], height
    )
    rim_x = axis_y * down_z - axis_z * down_y
    rim_y = axis_z * down_x - axis_x * down_z
    rim_z = axis_x * down_y - axis_y * down_x
    write_principal(out, SIDE_B, rim_x, rim_y, rim_z, max(sine, FLATTEST), radius, 1.0, 0.0)
    write_sweep(out, SIDE_B, rounding)
