"""A circular rim of one body over a plane of another."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import ROTATION, SIDE_B, SPIN
from nonsmooth.types import Floats

from ..features.frames import across, point_in_world, vector_in_world
from ..features.writing import write_principal, write_sweep
from .plane_point import place_over_plane

FLATTEST = 1e-9
"""Sine of the angle between rim and plane below which the lowest point is not followed any more."""
_STILL = 1e-2
"""A turning of a flat rim that is slower is none [rad/s]."""


@compiled
def _soonest(a: Floats, b: Floats, axis_x: float, axis_y: float, axis_z: float) -> tuple[float, float, float, float]:
    """Return how fast a flat rim turns about its plane, and the unit vector to its point that goes down fastest."""
    n = a[ROTATION + 2], a[ROTATION + 5], a[ROTATION + 8]
    wx, wy, wz = b[SPIN] - a[SPIN], b[SPIN + 1] - a[SPIN + 1], b[SPIN + 2] - a[SPIN + 2]
    x, y, z = wy * n[2] - wz * n[1], wz * n[0] - wx * n[2], wx * n[1] - wy * n[0]
    found = across(x, y, z, axis_x, axis_y, axis_z)
    return found[1], found[2], found[3], found[4]


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
    """Write the geometry block of the lowest point of the rim, or of the torus about it.

    For a rim that lies flat all points are lowest; the one is taken that its turning makes the lowest, and stands for a
    rim that is :data:`FLATTEST`.  One that hardly turns has its lowest point on a crown, by which a face is not quite
    flat: the middle of it where it lies flat, a point of the rim where that is :data:`FLATTEST`.  A face whose feet
    stand out beyond a ``crown`` has a larger one, a cap of a sphere with that sine at the rim.
    """
    x, y, z = point_in_world(b, x, y, z)
    axis_x, axis_y, axis_z = vector_in_world(b, axis_x, axis_y, axis_z)
    n_x, n_y, n_z = a[ROTATION + 2], a[ROTATION + 5], a[ROTATION + 8]
    along, sine, down_x, down_y, down_z = across(-n_x, -n_y, -n_z, axis_x, axis_y, axis_z)
    reach, flat, turn, below, out_of_rim = radius, 1.0, 0.0, rounding, 0.0
    if FLATTEST < crown > sine:
        reach, flat, turn = radius * sine / crown, crown, radius
        sum_of_cosines = math.sqrt(1.0 - crown * crown) + math.sqrt(1.0 - sine * sine)
        out_of_rim = math.copysign(radius / crown * (crown * crown - sine * sine) / sum_of_cosines, along)
    elif sine < FLATTEST:
        turning, soon_x, soon_y, soon_z = _soonest(a, b, axis_x, axis_y, axis_z)
        if turning > _STILL:
            down_x, down_y, down_z = soon_x, soon_y, soon_z
        else:
            reach, flat, turn = radius * sine / FLATTEST, FLATTEST, radius
        # the gap is that of the rim's lowest point all the same
        below += radius * sine + reach * (down_x * n_x + down_y * n_y + down_z * n_z)
    x, y, z = x + reach * down_x, y + reach * down_y, z + reach * down_z
    x, y, z = x + out_of_rim * axis_x, y + out_of_rim * axis_y, z + out_of_rim * axis_z
    place_over_plane(a, out, x - below * n_x, y - below * n_y, z - below * n_z, height)
    rim_x = axis_y * down_z - axis_z * down_y
    rim_y = axis_z * down_x - axis_x * down_z
    rim_z = axis_x * down_y - axis_y * down_x
    write_principal(out, SIDE_B, rim_x, rim_y, rim_z, max(sine, crown, FLATTEST), radius, flat, turn)
    write_sweep(out, SIDE_B, rounding)
