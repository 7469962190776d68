"""Gap of a smooth body and a circle or a segment, by bracketing the nearest point of this curve.

The unknown is the place of a point on the curve.  The derivative of the point's distance from the smooth body is the
tangential component of the normal.  Between two places at which this derivative is negative and positive, secant steps
and bisections narrow the interval.

The search is slow but robust, because it needs no radius of curvature of the circle.  For normals close to the circle's
axis this radius varies without bound, and Newton's method on the normal does not converge.

If the bodies overlap, the direction with the largest gap is found by steps that increase the gap.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled

from ...shapes.support_function import Core, support_of
from ...vectors import Vector3, dot, plus, plus_scaled, scaled
from .bracket import Bracket, narrowed, next_place
from .smooth_core import Cores, NearestPoint, at_place
from .smooth_newton import widest_of_round
from .smooth_starts import Start, gap_along, local_maximum, starts_of

_FIRST = 1e-3
"""First step round the circle [rad]; each further step is twice as long as the one before."""
_STEPS = 120
"""Largest number of steps of a search."""
_SAME = 4e-16
"""Round-off: two places closer than this are equal [rad or m], and a smaller derivative of the distance is zero."""
_ACROSS = 1e-9
"""Largest derivative of the distance by the arc length at an accepted solution [1].

At the exact solution it is 0.  The error of the gap is of the order of its square.
"""
_TOP = 1e-9
"""Angle to a maximum of the gap at which the steps to it end [rad]."""
_OVER = 1e-11
"""Least decrease of the gap that is no round-off, relative to the size of both bodies."""


class _Curve(NamedTuple):
    """A curve from whose points the distance of the smooth body is measured, in the axes of the first core."""

    radius: float
    """Radius of a circle about the third axis [m]; 0 for a line."""
    along: Vector3
    """Unit vector along a line through the origin."""


@compiled
def _sample(cores: Cores, curve: _Curve, place: float) -> tuple[float, NearestPoint]:
    """Return slope and solution for a point of a curve; the first core is a point.

    The ``place`` of the point is its angle on a circle [rad], or its distance from the origin on a line [m].  The slope
    is the derivative of the point's distance from the body by the arc length.  The solution is this distance [m], the
    body's nearest point [m], and the normal.
    """
    point, tangent = scaled(place, curve.along), curve.along
    if curve.radius > 0.0:
        c, s = math.cos(place), math.sin(place)
        point, tangent = (curve.radius * c, curve.radius * s, 0.0), (-s, c, 0.0)
    from_point = at_place(cores, point)
    g, p, n = widest_of_round(from_point, from_point.center)
    return -dot(n, tangent), (g, plus(p, point), n)


@compiled
def round_circle(cores: Cores, radius: float, start: Vector3) -> NearestPoint:
    """Return gap [m], smooth body's point [m] and normal at the least distance of a circle from the body.

    The circle is about the third axis of the first core, which is a point at its centre.  The normal points out of its
    disc.  The search starts at the direction of ``start`` in the plane of the circle.  The gap is nan if no such point
    was found.
    """
    circle, begin = _Curve(radius, (0.0, 0.0, 0.0)), math.atan2(start[1], start[0])
    slope, result = _sample(cores, circle, begin)
    if not abs(slope) <= _SAME:
        # downhill from the start, until the slope changes its sign
        sign = -math.copysign(1.0, slope)
        low, falling, step = begin, slope, _FIRST
        result = math.nan, result[1], result[2]
        while step < math.pi:
            angle = begin + sign * step
            slope, _ = _sample(cores, circle, angle)
            if sign * slope >= 0.0:
                result, _ = _between(cores, circle, Bracket(low, angle, falling, slope, 0))
                break
            low, falling, step = angle, slope, 2.0 * step
    gap, p, n = result
    # an inward normal is that of a body that the circle surrounds, so that the disc passes through the body
    x, y, _ = plus_scaled(p, -gap, n)
    is_outward = x * n[0] + y * n[1] >= -_SAME * (abs(x) + abs(y))
    return gap if is_outward else math.nan, p, n


@compiled
def along_segment(cores: Cores, e: Vector3, length: float) -> tuple[NearestPoint, float]:
    """Return the least distance of a smooth body from a segment: (gap [m], body's point [m], normal), place on it [m].

    The segment goes from the first core, a point, along the unit vector e over ``length`` [m].  The place is the
    distance of the nearest point from the start of the segment.  The gap is nan if the search failed.
    """
    line = _Curve(0.0, e)
    slope, at_start = _sample(cores, line, 0.0)
    if not slope < 0.0:
        return at_start, 0.0
    last_slope, at_end = _sample(cores, line, length)
    if not last_slope > 0.0:
        return at_end, length
    return _between(cores, line, Bracket(0.0, length, slope, last_slope, 0))


@compiled
def _between(cores: Cores, curve: _Curve, sides: Bracket) -> tuple[NearestPoint, float]:
    """Return the solution at the least distance between two places of a curve, and its place.

    The distance decreases from either place into the interval.  The gap is nan if the nearest point jumps there.
    """
    place, slope = sides.low, math.nan
    result: NearestPoint = (math.nan, cores.center, (0.0, 0.0, 1.0))
    for _ in range(_STEPS):
        place = next_place(sides)
        slope, result = _sample(cores, curve, place)
        is_narrow = abs(sides.high - sides.low) <= _SAME or place == sides.low or place == sides.high
        if abs(slope) <= _SAME or is_narrow:
            break
        sides = narrowed(sides, place, slope)
    # deep in the body the nearest surface point is discontinuous along the curve: no stationary point
    gap, p, n = result
    return (gap if abs(slope) <= _ACROSS else math.nan, p, n), place


@compiled
def up_hills(cores: Cores, up: float, limit: Vector3) -> NearestPoint:
    """Return the largest gap of a circle and an overlapping smooth body [m], the body's point [m] and the normal.

    Parameters
    ----------
    cores : Cores
        The circle about the third axis as a core, and the smooth body.
    up : float
        1 or -1: normals are allowed from this direction of the circle's axis to the normal ``limit``; 0 allows all.
    limit : tuple of float
        Radial and axial component of the unit normal at this limit, and size of both bodies [m].
    """
    best: NearestPoint = (math.nan, cores.center, (0.0, 0.0, 1.0))
    for start in starts_of(cores):
        top = local_maximum(cores, start, _TOP)
        solution = widest_of_round(cores, top[1])
        if not solution[0] >= top[0] - _TOP * limit[2]:
            # Newton's method went to a smaller maximum, or did not converge
            solution = _solution_of(cores.first, top)
        g, _, n = solution
        if not _is_in_range(n, up, limit):
            # near a sharp place of the body the gap hardly depends on the normal: try the normal at the limit
            radial = math.sqrt(n[0] * n[0] + n[1] * n[1])
            if radial == 0.0:
                continue
            n = limit[0] * n[0] / radial, limit[0] * n[1] / radial, limit[1]
            gap_at_limit = gap_along(cores, n)
            if not gap_at_limit >= g - _OVER * limit[2]:
                continue
            solution = _solution_of(cores.first, (gap_at_limit, n))
        if not solution[0] <= best[0]:
            best = solution
    return best


@compiled
def _is_in_range(n: Vector3, up: float, limit: Vector3) -> bool:
    """Return whether a unit normal is between the axis and the normal ``limit``; arguments as in :func:`up_hills`."""
    return bool(up == 0.0 or up * (limit[0] * n[2] - limit[1] * math.sqrt(n[0] * n[0] + n[1] * n[1])) >= -_TOP)


@compiled
def _solution_of(circle: Core, top: Start) -> NearestPoint:
    """Return gap [m], body's point [m] and normal for a maximum ``top`` of the gap: the gap and its direction n.

    The body's point is the circle's farthest point along n, moved by the gap along n.
    """
    g, n = top
    return g, plus_scaled(support_of(circle, n)[1], g, n), n
