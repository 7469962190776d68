"""Cylindrical coordinates about an axis of a shape."""

from __future__ import annotations

import math

from bodies.contacts.tangents import tangent_of
from nonsmooth.compiled import compiled


@compiled
def cylindrical(
    x: float, y: float, z: float, axis_x: float, axis_y: float, axis_z: float
) -> tuple[float, float, float, float, float]:
    """Return height along the unit axis, distance from it [m], and the unit vector away from it."""
    along = x * axis_x + y * axis_y + z * axis_z
    x, y, z = x - along * axis_x, y - along * axis_y, z - along * axis_z
    away = math.sqrt(x * x + y * y + z * z)
    if away > 0.0:
        return along, away, x / away, y / away, z / away
    # on the axis any direction leads away
    x, y, z = tangent_of(axis_x, axis_y, axis_z)
    return along, 0.0, x, y, z
