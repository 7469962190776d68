"""A circular rim of one body over a plane of another."""

from __future__ import annotations

import math

from nonsmooth.engine.memory.blocks import ROTATION, SIDE_B
from nonsmooth.types import Floats

from ..features.flat_rim import FLATTEST, touching_point, write_rim
from ..features.frames import across, point_in_world, vector_in_world
from .plane_point import place_over_plane


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
    crown: float,
) -> None:
    """Write the geometry block of a rim over a plane, at the lowest point of the rim or of the torus about it.

    The contact point of a flat rim is explained in :mod:`bodies.contacts.features.flat_rim`.  A face with feet is a
    cap of a sphere that protrudes from the rim, but less than the feet.  ``crown`` is the sine of its tilt at the rim;
    0 for a face without feet.
    """
    x, y, z = point_in_world(b, (x, y, z))
    axis_x, axis_y, axis_z = vector_in_world(b, (axis_x, axis_y, axis_z))
    n_x, n_y, n_z = a[ROTATION + 2], a[ROTATION + 5], a[ROTATION + 8]
    at, out_of_rim = touching_point(b, a, (n_x, n_y, n_z), (axis_x, axis_y, axis_z), radius), 0.0
    along, sine, (down_x, down_y, down_z) = across((-n_x, -n_y, -n_z), (axis_x, axis_y, axis_z))
    if FLATTEST < crown > sine:
        at = radius * sine / crown, (down_x, down_y, down_z), 0.0, crown, crown, radius
        sum_of_cosines = math.sqrt(1.0 - crown * crown) + math.sqrt(1.0 - sine * sine)
        out_of_rim = math.copysign(radius / crown * (crown * crown - sine * sine) / sum_of_cosines, along)
    reach, (down_x, down_y, down_z), lift, _, _, _ = at
    x, y, z = x + reach * down_x, y + reach * down_y, z + reach * down_z
    x, y, z = x + out_of_rim * axis_x, y + out_of_rim * axis_y, z + out_of_rim * axis_z
    below = rounding + lift
    place_over_plane(a, out, x - below * n_x, y - below * n_y, z - below * n_z, height)
    write_rim(out, SIDE_B, (axis_x, axis_y, axis_z), radius, at, rounding)
