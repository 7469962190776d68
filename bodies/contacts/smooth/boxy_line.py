"""Gap of a boxy body, which has flat places, and an infinite straight line, cylinder or cone: a search for one angle.

The normal n goes round the line, perpendicular to it or, for a cone, at a fixed angle.  With p the body's farthest
point in the direction -n, the derivative of the gap g(n) by the angle is dn/d(angle) . p.  Between two angles at which
it has opposite signs, secants narrow the interval to round-off.  No second derivative is needed, so that
the body may be flat.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from ...shapes.support_function import Core
from ...vectors import Vector3, cross, dot, minus, plus, plus_scaled, scaled
from .bracket import Bracket, narrowed, next_place
from .smooth_core import Axes, NearestPoint, facing_point, largest_semi_axis, spread

_SAMPLES = 8
"""Number of equal parts of a half-circle of directions; the gap is sampled at their ends before the search."""
_STEPS = 200
"""Largest number of steps of the search."""
_CLOSED = 4e-16
"""Angle between two directions below which they differ by round-off only [rad]."""

_ROUND_OFF = 4e-16
"""Derivative of the gap by the angle that is zero within round-off, relative to the size of the bodies."""


@compiled
def across_line(
    core: Core, turn: Axes, center: Vector3, e: Vector3, n: Vector3, cosine: float, sine: float, reach: float
) -> NearestPoint:
    """Return a maximum of the gap of a line and a core with flat places [m], the core's point [m] and the normal.

    The line goes through the origin along the unit vector ``e``.  All vectors are in the axes of the line's body, to
    which ``turn`` converts those of the core.  The maximum is the nearest one to the unit vector ``n``, perpendicular
    to the line, on the side on which the gap rises.  The gap is nan if it is more than about a right angle away.

    A positive ``reach`` replaces the line by a cylinder with this radius [m], or, if ``sine`` is not 0, by a cone about
    the line: ``cosine`` and ``sine`` are the components of the normal across the line and along it, and ``reach`` is
    the distance of the surface from the origin along its normals.

    First, samples round the line enclose the maximum between two angles, at which the gap rises (``rising`` > 0) and
    falls (``falling`` < 0).  Then :mod:`bodies.contacts.smooth.bracket` finds the zero of the derivative.
    """
    spacing = math.pi / _SAMPLES
    current, slope = _sample(core, turn, center, e, n, cosine, sine, 0.0)
    # go from the direction n to where the gap rises, until it falls again
    low, high, rising, falling = 0.0, 0.0, slope, slope
    sign = 1 if slope > 0.0 else -1
    for i in range(1, _SAMPLES // 2 + 2):
        _, slope = _sample(core, turn, center, e, n, cosine, sine, sign * i * spacing)
        low, high = (high, i * spacing) if sign > 0 else (-i * spacing, low)
        rising, falling = (falling, slope) if sign > 0 else (slope, rising)
        if rising > 0.0 > falling:
            break
    if not (rising > 0.0 > falling):
        return math.nan, current[1], current[2]
    zero_slope = _ROUND_OFF * (spread(center) + largest_semi_axis(core))
    sides = Bracket(low, high, rising, falling, 0)
    for _ in range(_STEPS):
        middle = next_place(sides)
        low, high = sides.low, sides.high
        current, slope = _sample(core, turn, center, e, n, cosine, sine, middle)
        if abs(slope) <= zero_slope:
            return current[0] - reach, current[1], current[2]
        if high - low <= _CLOSED or middle == low or middle == high:
            # the derivative jumps from slope_low to slope_high, so a flat place faces the line: interpolate its point
            at_low, slope_low = _sample(core, turn, center, e, n, cosine, sine, low)
            at_high, slope_high = _sample(core, turn, center, e, n, cosine, sine, high)
            fraction = min(max(slope_low / (slope_low - slope_high), 0.0), 1.0) if slope_low > slope_high else 0.5
            return current[0] - reach, plus_scaled(at_low[1], fraction, minus(at_high[1], at_low[1])), current[2]
        sides = narrowed(sides, middle, slope)
    return math.nan, current[1], current[2]


@compiled
def _sample(
    core: Core, turn: Axes, center: Vector3, e: Vector3, n: Vector3, cosine: float, sine: float, angle: float
) -> tuple[NearestPoint, float]:
    """Return gap of the line [m], core's point [m] and normal at an ``angle`` [rad], and the derivative of the gap.

    The line has the unit direction ``e``; the unit vector ``n``, perpendicular to it, is at angle 0.  The normal has
    the component ``cosine`` across the line and ``sine`` along it.  The last number is the derivative of the gap by the
    angle [m].
    """
    u = cross(e, n)
    c, s = cosine * math.cos(angle), cosine * math.sin(angle)
    normal = plus_scaled(plus(scaled(c, n), scaled(s, u)), sine, e)
    p, _ = facing_point(core, turn, center, normal)
    return (dot(normal, p), p, normal), dot(minus(scaled(c, u), scaled(s, n)), p)
