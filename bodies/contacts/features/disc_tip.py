"""A vertex that has come through a disc: beside the rim, or through what the disc covers."""

from __future__ import annotations

import math

from bodies.contacts.features.frames import vector_in_world
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def tip_past_rim(
    b: Floats,
    n_star: float,
    star: Floats,
    lengths: Floats,
    px: float,
    py: float,
    pz: float,
    nx: float,
    ny: float,
    nz: float,
    depth: float,
    radius: float,
) -> float:
    """Return how far the edges of a vertex come through the plane of a disc past its rim, negative within it.

    The vertex p, from the centre of the disc, is so deep behind it, against n.  Where it has just come through, so have
    its edges next to it, wherever they lean; an edge that is nearer to the rim than the vertex is deep has come from
    beside, and it is the rim that meets it.  An edge counts for the end of it that is nearer to the plane; without any
    the number is large.
    """
    least = math.inf
    for i in range(int(n_star)):
        ex, ey, ez = vector_in_world(b, star[3 * i], star[3 * i + 1], star[3 * i + 2])
        rise = nx * ex + ny * ey + nz * ez
        if rise * lengths[i] <= 2.0 * depth:
            continue
        way = depth / rise
        x, y, z = px + way * ex, py + way * ey, pz + way * ez
        along = nx * x + ny * y + nz * z
        away = math.sqrt(max(x * x + y * y + z * z - along * along, 0.0))
        least = min(least, away - radius)
    return least + depth
