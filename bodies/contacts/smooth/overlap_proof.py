"""Whether two convex bodies overlap, of which one at least is smooth, by their support functions alone.

The difference of two bodies holds the vectors from all points of the first body to all points of the second.  It is
convex, and the bodies overlap if it holds the origin.  The search keeps a triangle of its support points through which
the line from an inner point to the origin passes (G. Snethen, XenoCollide, in Game Programming Gems 7, 2008).  If the
origin lies in front of the triangle, four points of the difference enclose it: an overlap.  If it lies behind the
supporting plane with the normal of the triangle, the bodies are apart.  Otherwise the support point there replaces a
corner of the triangle.  No derivative is needed, so that a body may have flat places and sharp edges.
"""

from __future__ import annotations

from nonsmooth.compiled import compiled

from ...shapes.support_function import Core, support_of
from ...vectors import Vector3, cross, dot, minus, norm, opposite
from .smooth_core import Cores, facing_point, spread, unit

_STEPS = 100
"""Largest number of support points."""
_ROUND_OFF = 1e-15
"""Distance that is round-off, relative to the size of the bodies."""


@compiled
def do_overlap(low: Core, low_height: float, high: Core, high_height: float, cores: Cores) -> bool:
    """Return whether two bodies are proved to have a common point.

    The first body is the convex hull of two cores, whose centres have two heights on its third axis [m]: the rims of a
    frustum, or twice the first core.  The second body is that of ``cores``.
    """
    bodies = low, low_height, high, high_height, cores
    inner = minus(cores.center, (0.0, 0.0, 0.5 * (low_height + high_height)))
    if spread(inner) == 0.0:
        return True
    a = _support(bodies, opposite(inner))
    across = cross(a, inner)
    near = _ROUND_OFF * (spread(inner) + spread(a))
    if norm(across) <= near * norm(inner):
        # the origin is on the line from the inner point to the corner
        return dot(a, inner) <= 0.0
    b = _support(bodies, across)
    normal = cross(minus(a, inner), minus(b, inner))
    if dot(normal, inner) > 0.0:
        a, b, normal = b, a, opposite(normal)
    c = _support(bodies, normal)
    is_crossed = False
    for _ in range(_STEPS):
        if not is_crossed and dot(cross(a, c), inner) < 0.0:
            # the line from the inner point to the origin passes the triangle outside of its edge a c: c replaces b
            b = c
            c = _support(bodies, cross(minus(a, inner), minus(b, inner)))
        elif not is_crossed and dot(cross(c, b), inner) < 0.0:
            # it passes outside of the edge c b: c replaces a
            a = c
            c = _support(bodies, cross(minus(a, inner), minus(b, inner)))
        else:
            is_crossed = True
            normal = unit(cross(minus(b, a), minus(c, a)))
            if dot(normal, a) >= -near:
                return True
            d = _support(bodies, normal)
            if dot(normal, d) < -near or dot(normal, minus(d, c)) <= near:
                return False
            # of the three triangles with the new corner, the line crosses one
            across = cross(d, inner)
            if dot(a, across) > 0.0:
                a, c = (d, c) if dot(b, across) > 0.0 else (a, d)
            elif dot(c, across) > 0.0:
                b = d
            else:
                a = d
    return False


@compiled
def _support(bodies: tuple[Core, float, Core, float, Cores], direction: Vector3) -> Vector3:
    """Return the point of the difference that lies farthest along a direction of any length [m].

    It is the second body's farthest point along the direction minus the first one's farthest point against it.
    ``bodies`` are the arguments of :func:`do_overlap`.  The point is in the axes of the first body.
    """
    low, low_height, high, high_height, cores = bodies
    n = opposite(unit(direction))
    low_support, p, _ = support_of(low, n)
    high_support, high_p, _ = support_of(high, n)
    if high_support + n[2] * high_height > low_support + n[2] * low_height:
        p, low_height = high_p, high_height
    q, _ = facing_point(cores, n)
    return minus(q, (p[0], p[1], p[2] + low_height))
