"""Gap of a boxy body, which has flat places, and an infinite straight line, cylinder or cone: a search for one angle.

The normal n goes round the line, perpendicular to it or, for a cone, at a fixed angle.  With p the body's farthest
point in the direction -n, the derivative of the gap g(n) by the angle is dn/d(angle) . p.  Between two angles at which
it has opposite signs, secants and halvings narrow the interval to round-off.  No second derivative is needed, so that
the body may be flat.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from ...shapes.support_function import Core
from ...vectors import Vector3, cross, dot, minus, plus, plus_scaled, scaled
from .bracket import bracket, narrowed, next_place
from .smooth_core import Axes, NearestPoint, facing_point, largest_semi_axis, spread

_LOOKS = 8
"""Number of directions, evenly spaced round the axis of the line, at which the gap is sampled before the search."""
_STEPS = 200
_CLOSED = 4e-16
"""Angle between two directions below which they differ by round-off only [rad]."""

_ROUND_OFF = 4e-16
"""Derivative of the gap by the angle that is zero within round-off, relative to the size of the bodies."""


@compiled
def across_line(
    core: Core, turn: Axes, place: Vector3, e: Vector3, n: Vector3, cosine: float, sine: float, reach: float
) -> NearestPoint:
    """Return the gap of a line and a core with flat places [m], the core's point [m] and the normal.

    The gap is the largest over all normals round the line; it is nan if no maximum was found.  The line goes through
    the origin.  All vectors are in the axes of the line's body.  A positive ``reach`` replaces the line by a cylinder
    with this radius, or, if ``sine`` is not 0, by a cone about the line.

    Parameters
    ----------
    core : Floats
        The core, with flat places; its radius is not used.
    turn : Axes
        Rotation from the axes of the core to those of the line's body.
    place : Vector3
        The core's centre [m].
    e : Vector3
        Direction of the line, a unit vector.
    n : Vector3
        A unit vector perpendicular to the line; the normal is searched in the half-space around it.
    cosine, sine : float
        Component of the normal across the line and along it; 1 and 0 unless the surface is a cone.
    reach : float
        Distance of the surface about the line from the origin, along its normals [m]; 0 for the line itself.
    """
    between = math.pi / _LOOKS
    found, slope = _look(core, turn, place, e, n, cosine, sine, 0.0)
    # climb from the given direction n; if no positive gap is found, climb from the best of all sampled directions
    at, low, high, rising, falling, most = 0, 0.0, 0.0, slope, slope, found[0]
    way = 1 if slope > 0.0 else -1
    for i in range(1, _LOOKS // 2 + 2):
        look, slope = _look(core, turn, place, e, n, cosine, sine, way * i * between)
        most = max(most, look[0])
        low, high = (high, i * between) if way > 0 else (-i * between, low)
        rising, falling = (falling, slope) if way > 0 else (slope, rising)
        if rising > 0.0 > falling:
            break
    if most <= reach:
        best, last, middle_slope = -math.inf, math.nan, 0.0
        for i in range(-_LOOKS // 2 - 1, _LOOKS // 2 + 2):
            look, slope = _look(core, turn, place, e, n, cosine, sine, i * between)
            if look[0] > best and abs(i) <= _LOOKS // 2:
                best, at, rising, middle_slope = look[0], i, last, slope
            elif at == i - 1:
                falling = slope
            last = slope
        low, high = (at - 1) * between, (at + 1) * between
        # in an overlap the gap may have two maxima between the samples next to the best one: bisect the interval, in
        # the direction in which the gap rises from the best sample, until one maximum remains
        for _ in range(_LOOKS):
            if rising > 0.0 > falling:
                break
            middle = at * between
            if middle_slope > 0.0:
                low, rising = middle, middle_slope
            else:
                high, falling = middle, middle_slope
            if rising > 0.0 > falling:
                break
            _, slope = _look(core, turn, place, e, n, cosine, sine, 0.5 * (low + high))
            if middle_slope > 0.0:
                high, falling = 0.5 * (low + high), slope
            else:
                low, rising = 0.5 * (low + high), slope
    if not (rising > 0.0 > falling):
        return math.nan, found[1], found[2]
    none = _ROUND_OFF * (spread(place) + largest_semi_axis(core))
    sides = bracket(low, high, rising, falling)
    for _ in range(_STEPS):
        middle, sides = next_place(sides)
        low, high, _, _, _, _ = sides
        found, slope = _look(core, turn, place, e, n, cosine, sine, middle)
        if abs(slope) <= none:
            return found[0] - reach, found[1], found[2]
        if high - low <= _CLOSED or middle == low or middle == high:
            # the derivative jumps, so a flat place faces the line: interpolate between the points of both directions
            one, up = _look(core, turn, place, e, n, cosine, sine, low)
            two, down = _look(core, turn, place, e, n, cosine, sine, high)
            part = min(max(up / (up - down), 0.0), 1.0) if up > down else 0.5
            return found[0] - reach, plus_scaled(one[1], part, minus(two[1], one[1])), found[2]
        sides = narrowed(sides, middle, slope)
    return math.nan, found[1], found[2]


@compiled
def _look(
    core: Core, turn: Axes, place: Vector3, e: Vector3, n: Vector3, cosine: float, sine: float, angle: float
) -> tuple[NearestPoint, float]:
    """Return gap, core's point and normal, and the gap's derivative by the angle, at an ``angle`` round the line [rad].

    The line has the unit direction ``e``; the unit vector ``n``, perpendicular to it, is at angle 0.  The normal has
    the component ``cosine`` across the line and ``sine`` along it.  The gap is that of the line itself [m]; the
    derivative is in [m].
    """
    u = cross(e, n)
    c, s = cosine * math.cos(angle), cosine * math.sin(angle)
    normal = plus_scaled(plus(scaled(c, n), scaled(s, u)), sine, e)
    p, _ = facing_point(core, turn, place, normal)
    return (dot(normal, p), p, normal), dot(minus(scaled(c, u), scaled(s, n)), p)
