"""The part of a vector across an axis of a shape."""

from __future__ import annotations

import math

from bodies.contacts.features.tangents import tangent_of
from nonsmooth.compiled import compiled


@compiled
def across(
    x: float, y: float, z: float, axis_x: float, axis_y: float, axis_z: float
) -> tuple[float, float, float, float, float]:
    """Return the part of (x, y, z) along the unit axis, the size of that across, and the unit vector there."""
    along = x * axis_x + y * axis_y + z * axis_z
    x, y, z = x - along * axis_x, y - along * axis_y, z - along * axis_z
    size = math.sqrt(x * x + y * y + z * z)
    if size > 0.0:
        x, y, z = x / size, y / size, z / size
        # of a vector close to the axis the difference is rounding, which may point anywhere
        rest = x * axis_x + y * axis_y + z * axis_z
        x, y, z = x - rest * axis_x, y - rest * axis_y, z - rest * axis_z
        length = math.sqrt(x * x + y * y + z * z)
        if length > 0.5:
            return along, size, x / length, y / length, z / length
    x, y, z = tangent_of(axis_x, axis_y, axis_z)
    return along, size, x, y, z
