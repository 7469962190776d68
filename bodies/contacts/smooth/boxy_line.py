"""Gap of a boxy body, which has flat places, and an infinite straight line, cylinder or cone: a search for one angle.

The normal n goes round the line, perpendicular to it or, for a cone, at a fixed angle.  With p the body's farthest
point in the direction -n, the derivative of the gap g(n) by the angle is dn/d(angle) . p.  Between two angles at which
it has opposite signs, secants narrow the interval to round-off.  No second derivative is needed, so that
the body may be flat.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled

from ...vectors import Vector3, cross, dot, minus, plus, plus_scaled, scaled
from .bracket import Bracket, narrowed, next_place
from .smooth_core import Cores, NearestPoint, facing_point, size_of

_SAMPLES = 8
"""Number of equal parts of a half-circle of directions; the gap is sampled at their ends before the search."""
_STEPS = 200
"""Largest number of steps of the search."""
_CLOSED = 4e-16
"""Angle between two directions below which they differ by round-off only [rad]."""

_ROUND_OFF = 4e-16
"""Derivative of the gap by the angle that is zero within round-off, relative to the size of the bodies."""


class Line(NamedTuple):
    """A line through the origin, or a cylinder or cone about it, in the axes and from the centre of the first core."""

    along: Vector3
    """Unit vector along the line."""
    cosine: float
    """Component of the normal across the line: 1 for a line or cylinder."""
    sine: float
    """Component of the normal along the line: 0 for a line or cylinder."""
    reach: float
    """Distance of the surface from the origin along its normals [m]; 0 for a line."""


@compiled
def across_line(cores: Cores, line: Line, n: Vector3) -> NearestPoint:
    """Return a maximum of the gap of a line and the second core [m], the core's point [m] and the normal.

    The maximum is the nearest one to the unit vector ``n``, perpendicular to the line, on the side on which the gap
    rises.  The gap is nan if it is more than about a right angle away.

    First, samples round the line enclose the maximum between two angles, at which the gap rises (``rising`` > 0) and
    falls (``falling`` < 0).  Then :mod:`bodies.contacts.smooth.bracket` finds the zero of the derivative.
    """
    spacing = math.pi / _SAMPLES
    current, slope = _sample(cores, line, n, 0.0)
    # go from the direction n to where the gap rises, until it falls again
    low, high, rising, falling = 0.0, 0.0, slope, slope
    sign = 1 if slope > 0.0 else -1
    for i in range(1, _SAMPLES // 2 + 2):
        _, slope = _sample(cores, line, n, sign * i * spacing)
        low, high = (high, i * spacing) if sign > 0 else (-i * spacing, low)
        rising, falling = (falling, slope) if sign > 0 else (slope, rising)
        if rising > 0.0 > falling:
            break
    if not (rising > 0.0 > falling):
        return math.nan, current[1], current[2]
    zero_slope = _ROUND_OFF * size_of(cores)
    sides = Bracket(low, high, rising, falling, 0)
    for _ in range(_STEPS):
        middle = next_place(sides)
        low, high = sides.low, sides.high
        current, slope = _sample(cores, line, n, middle)
        if abs(slope) <= zero_slope:
            return current[0] - line.reach, current[1], current[2]
        if high - low <= _CLOSED or middle == low or middle == high:
            # the derivative jumps from slope_low to slope_high, so a flat place faces the line: interpolate its point
            at_low, slope_low = _sample(cores, line, n, low)
            at_high, slope_high = _sample(cores, line, n, high)
            fraction = min(max(slope_low / (slope_low - slope_high), 0.0), 1.0) if slope_low > slope_high else 0.5
            return current[0] - line.reach, plus_scaled(at_low[1], fraction, minus(at_high[1], at_low[1])), current[2]
        sides = narrowed(sides, middle, slope)
    return math.nan, current[1], current[2]


@compiled
def _sample(cores: Cores, line: Line, n: Vector3, angle: float) -> tuple[NearestPoint, float]:
    """Return gap of the origin [m], core's point [m] and normal at an ``angle`` [rad], and the derivative of the gap.

    The unit vector ``n``, perpendicular to the line, is at angle 0.  The last number is the derivative by the angle
    [m].
    """
    e, cosine, sine, _ = line
    u = cross(e, n)
    c, s = cosine * math.cos(angle), cosine * math.sin(angle)
    normal = plus_scaled(plus(scaled(c, n), scaled(s, u)), sine, e)
    p, _ = facing_point(cores, normal)
    return (dot(normal, p), p, normal), dot(minus(scaled(c, u), scaled(s, n)), p)
