"""The first tangent of a pair of shapes that has no direction of its own."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL, ROTATION, TANGENT
from nonsmooth.types import Floats

_ROUND_OFF = 1e-16
"""Square of what round-off may leave of a zero in a normal, of a face in other axes or of edges that lie in one."""


@compiled
def tangent_of(x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a unit vector across the unit normal (x, y, z), continuous in it but for the normal (0, 0, -1).

    No tangent field is continuous everywhere.  This one turns (1, 0, 0) with (0, 0, 1) to the normal on the shortest
    way: J. R. Frisvad, "Building an orthonormal basis from a 3D unit vector without normalization", J. Graphics Tools
    16 (2012) 151-159.
    """
    if z >= 0.0:
        return 1.0 - x * x / (1.0 + z), -x * y / (1.0 + z), -x
    # 1 + z = (x^2 + y^2) / (1 - z) keeps its digits where the normal points down
    square = x * x + y * y
    if square < _ROUND_OFF:
        # faces that lie on each other with the normal (0, 0, -1) keep their tangent however the bodies turn
        length = math.sqrt(1.0 - x * x)
        return length, -x * y / length, -x * z / length
    grow = (1.0 - z) / square
    return 1.0 - grow * x * x, -grow * x * y, -x


@compiled
def write_tangent(a: Floats, out: Floats) -> None:
    """Write the first tangent for the normal that stands in ``out``, fixed to the first body but for the normal."""
    x, y, z = tangent_of(
        a[ROTATION] * out[NORMAL] + a[ROTATION + 3] * out[NORMAL + 1] + a[ROTATION + 6] * out[NORMAL + 2],
        a[ROTATION + 1] * out[NORMAL] + a[ROTATION + 4] * out[NORMAL + 1] + a[ROTATION + 7] * out[NORMAL + 2],
        a[ROTATION + 2] * out[NORMAL] + a[ROTATION + 5] * out[NORMAL + 1] + a[ROTATION + 8] * out[NORMAL + 2],
    )
    for i in range(3):
        r = ROTATION + 3 * i
        out[TANGENT + i] = a[r] * x + a[r + 1] * y + a[r + 2] * z
