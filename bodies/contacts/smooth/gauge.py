"""Whether a point lies in a smooth body, of any kind of core."""

from __future__ import annotations

from bodies.contacts.smooth.dual_newton import climb
from bodies.shapes.support_function import OF_FUNCTION, gauge_of
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def gauge(core: Floats, x: float, y: float, z: float) -> float:
    """Return 1 for a point of the surface of a core, more outside, less inside; in the axes of the core.

    It is the gauge where that is known in closed form, and else tells the distance, in units of the size, where a
    normal is found; not a number where none is.
    """
    if core[3] != OF_FUNCTION:
        return float(gauge_of(core, x, y, z))
    size = max(core[0], core[1], core[2])
    if abs(x) + abs(y) + abs(z) <= 1e-9 * size:
        return 0.0
    point, same = (0.0, 0.0, 0.0, 2.0, 2.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    g, _, _, _ = climb(point, core, same, -x, -y, -z, 0.0, 0.0, 0.0, -x, -y, -z)
    return float(1.0 + g / size)
