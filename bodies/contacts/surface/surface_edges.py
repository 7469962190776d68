"""Contact of convex edges of two bodies that cross each other; the bodies need not be convex."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...vectors import ahead, put
from ..features.edge_crossing import PARALLEL, cross_edges, least_sine
from ..features.frames import write_tangent
from ..features.vertex_face import CLOSED
from ..features.writing import write_principal

_NEAR_ENDS = 4.0
"""Least distance of overlapping edges' contact points from the ends of the edges, as a multiple of the overlap.

Closer to an end, the edges may pass each other without an overlap of the bodies.
"""


@compiled
def write_edges(
    a: Floats, b: Floats, out: Floats, edge_a: Floats, at_a: int, edge_b: Floats, at_b: int, radius: float, size: float
) -> None:
    """Write the geometry block of two edges at the nearest points of their lines; the second edge has a radius [m].

    The contact is open, with a positive gap, if the edges do not cross or do not face each other
    (:func:`bodies.contacts.features.edge_crossing.cross_edges`), and if they overlap near their ends.  The rows of the
    edges begin at the indices ``at_a`` and ``at_b``.
    """
    margin, parallel = CLOSED * size, least_sine(size) if radius == 0.0 else PARALLEL
    p, e, f, n, gap, over, past = cross_edges(a, b, edge_a, at_a, edge_b, at_b, parallel, margin, size)
    if gap < 0.0:
        past = max(past, over - _NEAR_ENDS * gap - margin)
    gap -= radius
    if past > 0.0:
        gap = math.hypot(gap, past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    put(out, NORMAL, n)
    put(out, POINT_A, p)
    put(out, POINT_B, ahead(p, gap, n))
    write_tangent(a, out)
    write_principal(out, SIDE_A, e, 0.0, 1.0, 1.0, 0.0)
    write_principal(out, SIDE_B, f, 0.0, 1.0, 1.0, radius)
