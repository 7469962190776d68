"""Gap of a smooth body and a circle or a segment, by bracketing the nearest point of the circle or segment.

The unknown is the angle of a point round the circle, or its distance along the segment.  The derivative of the point's
distance from the smooth body is the tangential component of the normal.  Between two angles at which this derivative
is negative and positive, secant steps and bisections narrow the interval.

The search is slow but robust, because it needs no radius of curvature of the circle.  For normals close to the circle's
axis this radius varies without bound, and Newton's method on the normal does not converge.

If the bodies overlap, the direction with the largest gap is found first, by steps that increase the gap.  The circle's
point is then found by a search along the circle.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled

from ...shapes.support_function import Core, support_of
from ...vectors import Vector3, dot, minus, plus, plus_scaled
from .bracket import bracket, narrowed, next_place
from .inscribed import gauge
from .smooth_core import POINT, Axes, NearestPoint, facing_point, largest_semi_axis, rotated_back, spread
from .smooth_newton import widest_of_round
from .smooth_starts import Start, gap_along, settle, starts_of, uphill
from .tangent_plane import bends_in_plane, determinant, solved

_FIRST = 1e-3
"""First step round the circle [rad]; each further step is twice as long as the one before."""
_LOOKS, _STEPS = 16, 120
"""Numbers of angles and steps of a search.

``_LOOKS``: angles round the circle that are sampled.  ``_STEPS``: largest number of steps.
"""
_SAME = 4e-16
"""Round-off: two angles closer than this [rad] are equal, and a smaller derivative of the distance is zero."""
_ACROSS = 1e-9
"""Largest derivative of the distance by the arc length at an accepted solution.

At the exact solution it is 0.  The error of the gap is of the order of its square.
"""
_TOP, _OVER = 1e-9, 1e-11
"""Accuracy of a maximum of the gap.

``_TOP``: angle to the maximum at which the steps uphill end [rad].  ``_OVER``: largest distance of the body's contact
point from its surface, relative to the size of both bodies.
"""
_GOLDEN = 0.3819660112501051
"""Golden-section search: distance of its two inner points from the ends of the interval, (3 - sqrt 5) / 2 of it."""
_NEWTON, _CLOSED, _STEEPEST = 20, 1e-15, 0.5
"""Limits of Newton's method for a normal close to the axis of the circle (:func:`next_to_axis`).

``_NEWTON``: largest number of steps.  ``_CLOSED``: largest residual of a solution, relative to the size of the bodies.
``_STEEPEST``: angle between normal and axis at which the method gives up [rad].
"""

Look: TypeAlias = tuple[float, NearestPoint]
"""Derivative of the distance by the arc length of the circle [1], and a stop.

A stop is the gap between one point of the circle and the body [m], the body's nearest point to it, and the normal.
"""


@compiled
def _look(point: Core, core: Core, turn: Axes, place: Vector3, radius: float, angle: float) -> Look:
    c, s = math.cos(angle), math.sin(angle)
    rim = radius * c, radius * s, 0.0
    from_rim = minus(place, rim)
    g, p, n = widest_of_round(point, core, turn, from_rim, from_rim)
    return n[0] * s - n[1] * c, (g, plus(p, rim), n)


@compiled
def round_circle(point: Core, core: Core, turn: Axes, place: Vector3, radius: float, start: Vector3) -> NearestPoint:
    """Return gap, smooth body's point and normal at the least distance of a circle from the body.

    The centre of the circle is the origin, its axis the third axis.  The normal points out of its disc.  The gap is nan
    if no such point was found.

    Parameters
    ----------
    point, core : Floats
        Core numbers of a point (a body of size 0, used for each point of the circle), and of the smooth body.
    turn : Axes
        Rotation from the axes of the core to those of the circle.
    place : Vector3
        The core's centre [m].
    radius : float
        Radius of the circle [m].
    start : Vector3
        The search starts at the direction of its part in the plane of the circle, of any length.
    """
    begin = math.atan2(start[1], start[0])
    none: NearestPoint = (math.nan, place, (0.0, 0.0, 1.0))
    look = _look(point, core, turn, place, radius, begin)
    slope, reached = look
    # downhill from the start; if that fails, in every interval of the circle
    way = -math.copysign(1.0, slope)
    low, falling, step = begin, slope, _FIRST
    if abs(slope) > _SAME:
        while step < math.pi:
            angle = begin + way * step
            slope, _ = _look(point, core, turn, place, radius, angle)
            if way * slope >= 0.0:
                answer = _between(point, core, turn, place, radius, low, angle, falling, slope)
                if _is_outward(answer):
                    return answer
                break
            low, falling, step = angle, slope, 2.0 * step
    elif _is_outward(reached):
        return reached
    last, before = begin, look[0]
    for i in range(1, _LOOKS + 1):
        angle = begin + 2.0 * math.pi * i / _LOOKS
        slope, _ = _look(point, core, turn, place, radius, angle)
        if before < 0.0 <= slope:
            answer = _between(point, core, turn, place, radius, last, angle, before, slope)
            if _is_outward(answer):
                return answer
        last, before = angle, slope
    return none


@compiled
def _is_outward(found: NearestPoint) -> bool:
    """Return whether the normal at the circle's point leads away from the circle's axis, up to round-off.

    ``found`` is in the axes of the circle, which is about the z axis: gap [m], point of the smooth core [m], and unit
    normal from the circle to this point.  A circle with an inward normal is a local minimum of the distance, but of a
    body that the circle surrounds: the disc in the circle passes through it.
    """
    gap, point, normal = found
    x, y, _ = plus_scaled(point, -gap, normal)
    return bool(x * normal[0] + y * normal[1] >= -_SAME * (abs(x) + abs(y)))


@compiled
def _between(
    point: Core,
    core: Core,
    turn: Axes,
    place: Vector3,
    radius: float,
    low: float,
    high: float,
    falling: float,
    rising: float,
) -> NearestPoint:
    """Return gap, smooth body's point and normal at the least distance between two angles of the circle.

    At the angle ``low`` the distance decreases towards ``high``, and at ``high`` towards ``low``.  ``falling`` and
    ``rising`` are the derivatives of the distance at these angles.  ``place`` is the centre of the core [m]; the other
    arguments are those of :func:`round_circle`.
    """
    look = _look(point, core, turn, place, radius, high)
    sides = bracket(low, high, falling, rising)
    for _ in range(_STEPS):
        middle, sides = next_place(sides)
        low, high, _, _, _, _ = sides
        look = _look(point, core, turn, place, radius, middle)
        if abs(look[0]) <= _SAME or abs(high - low) <= _SAME or middle == low or middle == high:
            break
        sides = narrowed(sides, middle, look[0])
    found = look[1]
    if not abs(look[0]) <= _ACROSS:
        # deep in the body the nearest surface point is discontinuous along the circle: no stationary point
        return math.nan, found[1], found[2]
    return found


@compiled
def next_to_axis(core: Core, turn: Axes, place: Vector3, radius: float, start: Vector3, up: float) -> NearestPoint:
    """Return the result of :func:`round_circle` by Newton's method, for a normal close to the axis of the circle.

    The method requires a round core, whose radii of curvature are finite, and also finds overlaps.  The unknowns are
    the tilt, which is the angle between normal and axis and starts at 0, and the angle round the axis.  The derivative
    of the gap by the tilt is zero, and so is that by the angle, divided by the sine of the tilt; ``matrix`` is their
    Jacobian.  With these unknowns the equations are regular at the axis.  The normal is along the axis if ``up`` is 1,
    against it if ``up`` is -1.  The gap is nan without convergence.
    """
    tilt, angle = 0.0, math.atan2(start[1], start[0])
    size = spread(place) + largest_semi_axis(core) + radius
    for _ in range(_NEWTON):
        c, s = math.cos(angle), math.sin(angle)
        sine, cosine = math.sin(tilt), math.cos(tilt)
        n, o = (sine * c, sine * s, up * cosine), (cosine * c, cosine * s, -up * sine)
        p, bends = facing_point(core, turn, place, n)
        g = dot(n, p) - radius * sine
        over, beside = dot(o, p) - radius * cosine, c * p[1] - s * p[0]
        h11, h12, h22 = bends_in_plane(bends, rotated_back(turn, o), rotated_back(turn, (-s, c, 0.0)))
        matrix = -g - h11, cosine * beside - sine * h12, -h12, -(c * p[0] + s * p[1]) - sine * h22
        det = determinant(matrix)
        if not (matrix[0] < 0.0 and det > 0.0):
            break
        if abs(over) + abs(beside) <= _CLOSED * size:
            if tilt < -_CLOSED:
                break
            return g, p, n
        by_tilt, by_angle = solved(matrix, det, (over, beside))
        tilt -= by_tilt
        angle -= by_angle
        if abs(tilt) > _STEEPEST:
            break
    return math.nan, place, (0.0, 0.0, 1.0)


@compiled
def along_segment(core: Core, turn: Axes, place: Vector3, e: Vector3, length: float) -> tuple[NearestPoint, float]:
    """Return the least distance of a smooth body from a segment: (gap [m], body's point, normal), distance along it.

    The last number is the distance of the segment's nearest point from the start of the segment [m].  The segment goes
    from the origin along the unit vector e over ``length`` [m].  The core's centre is ``place`` [m]; ``turn`` is the
    rotation from the axes of the core to those of the segment.
    """
    low, high, way = 0.0, length, 0.0
    best: NearestPoint = (math.nan, place, (0.0, 0.0, 1.0))
    for i in range(_STEPS):
        # both ends first, then the middle of the remaining interval
        s = 0.0 if i == 0 else length if i == 1 else 0.5 * (low + high)
        from_point = plus_scaled(place, -s, e)
        g, p, n = widest_of_round(POINT, core, turn, from_point, from_point)
        rise = dot(n, e)
        best, way = (g, plus_scaled(p, s, e), n), s
        if g != g or (i == 0 and rise <= 0.0) or (i == 1 and rise >= 0.0):
            break
        if i > 1 and (abs(rise) <= _SAME or s == low or s == high):
            if g < 0.0 and abs(rise) > _ACROSS:
                # deep in the body the nearest surface point is discontinuous along the segment: no solution
                best = math.nan, best[1], best[2]
            break
        if rise > 0.0:
            low = s
        else:
            high = s
    return best, way


@compiled
def up_hills(circle: Core, core: Core, turn: Axes, place: Vector3, up: float, lean: Vector3) -> NearestPoint:
    """Return gap, smooth body's point and normal for an overlapping circle, along the direction of the largest gap.

    Parameters
    ----------
    circle : Floats
        The circle as a core.
    core, turn, place : Floats, Axes, Vector3
        As in :func:`round_circle`.
    up : float
        1 or -1: normals are allowed from this direction of the circle's axis to the limit ``lean``; 0 allows all.
    lean : tuple of float
        Radial and axial component of the unit normal at this limit, and size of both bodies [m].
    """
    best: NearestPoint = (math.nan, place, (0.0, 0.0, 1.0))
    for start in starts_of(circle, core, turn, place):
        top = uphill(circle, core, turn, place, start, _TOP)
        found = widest_of_round(circle, core, turn, place, top[1])
        if not found[0] >= top[0] - _TOP * lean[2]:
            settled = settle(circle, core, turn, place, top)
            # if two maxima differ by round-off only, the ellipsoid method may go from one to the other
            if _leans_so(settled[1], up, lean) or not _leans_so(top[1], up, lean):
                top = settled
            found = _along(circle, top)
        g, _, n = found
        if not _leans_so(n, up, lean):
            # near a sharp place of the body the gap hardly depends on the normal: try the normal at the limit `lean`
            away = math.sqrt(n[0] * n[0] + n[1] * n[1])
            if away == 0.0:
                continue
            n = lean[0] * n[0] / away, lean[0] * n[1] / away, lean[1]
            limit = gap_along(circle, core, turn, place, n)
            if not limit >= g - _OVER * lean[2]:
                continue
            found = _along(circle, (limit, n))
        if not found[0] <= best[0]:
            found, off_cone = _facing(circle, core, turn, place, found)
            if off_cone <= _OVER * lean[2]:
                best = found
    return best


@compiled
def _leans_so(n: Vector3, up: float, lean: Vector3) -> bool:
    """Return True if a normal is between the axis and the limit ``lean``; arguments as in :func:`up_hills`."""
    return bool(up == 0.0 or up * (lean[0] * n[2] - lean[1] * math.sqrt(n[0] * n[0] + n[1] * n[1])) >= -_TOP)


@compiled
def _along(circle: Core, top: Start) -> NearestPoint:
    """Return gap, body's point and normal for a maximum ``top`` of the gap: the gap and its direction n.

    The body's point is the circle's farthest point along n, moved by the gap along n.
    """
    g, n = top
    return g, plus_scaled(support_of(circle, n)[1], g, n), n


@compiled
def _facing(circle: Core, core: Core, turn: Axes, place: Vector3, found: NearestPoint) -> tuple[NearestPoint, float]:
    """Return a solution whose two points face each other, and the distance of the body's point from its surface [m].

    Close to a sharp place of the body, the gap is accurate to round-off, but the normal is not.  If the normal is
    nearly the axis, its radial component is round-off, and so is the direction of the circle's farthest point.  A
    search along the circle finds its point p for which p + gap normal is nearest to the surface of the body.
    """
    g, p, n = found
    extent, radius = largest_semi_axis(core), circle[0]
    best: NearestPoint = found
    least = _off_surface(core, turn, place, p)
    if radius == 0.0 or not least > _SAME:
        return best, least * extent
    q, _ = facing_point(core, turn, place, n)
    q, c = plus_scaled(q, -g, n), plus_scaled(p, -g, n)
    # search an arc about the circle's point nearest to the body's support point; it includes the present point
    middle = math.atan2(q[1], q[0])
    is_off_axis = c[0] * c[0] + c[1] * c[1] > 0.0
    wide = abs(math.atan2(c[0] * q[1] - c[1] * q[0], c[0] * q[0] + c[1] * q[1])) if is_off_axis else 0.0
    low, high = middle - wide - _FIRST, middle + wide + _FIRST
    for _ in range(_STEPS):
        one, two = low + _GOLDEN * (high - low), high - _GOLDEN * (high - low)
        point_one, point_two = _over_rim(radius, one, g, n), _over_rim(radius, two, g, n)
        first, second = _off_surface(core, turn, place, point_one), _off_surface(core, turn, place, point_two)
        if first < least:
            least, best = first, (g, point_one, n)
        if second < least:
            least, best = second, (g, point_two, n)
        if high - low <= _SAME or least <= _SAME:
            break
        if first < second:
            high = two
        else:
            low = one
    return best, least * extent


@compiled
def _over_rim(radius: float, angle: float, g: float, n: Vector3) -> Vector3:
    """Return the point at the distance g along n from the circle's point at an angle [m]."""
    return radius * math.cos(angle) + g * n[0], radius * math.sin(angle) + g * n[1], g * n[2]


@compiled
def _off_surface(core: Core, turn: Axes, place: Vector3, point: Vector3) -> float:
    """Return abs(gauge - 1) of a point [1], a residual: 0 on the surface of the core, positive inside and outside.

    ``point`` is in the axes of the circle [m].  The gauge has a closed form, which the distance has not.
    """
    return float(abs(gauge(core, rotated_back(turn, minus(point, place))) - 1.0))
