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
from nonsmooth.types import Floats

from ...shapes.support_function import support_of
from ...vectors import Vector3
from .boxy_newton import Answer, Point
from .inscribed import gauge
from .smooth_core import Axes, back, bend, forth
from .smooth_newton import widest_of_round
from .smooth_starts import Start, gap_along, settle, starts_of, uphill

_FIRST = 1e-3
"""First step round the circle [rad]; each further step is twice as long as the one before."""
_LOOKS, _STEPS, _PATIENCE = 16, 120, 3
"""Numbers of angles and steps of a search.

``_LOOKS``: angles round the circle that are sampled.  ``_STEPS``: largest number of steps.  ``_PATIENCE``: after this
many successive secant steps that did not halve the interval, the interval is bisected.
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

Look: TypeAlias = tuple[float, Answer]
"""Derivative of the distance by the arc length of the circle [1], and a stop.

A stop is the gap between one point of the circle and the body [m], the body's nearest point to it, and the normal.
"""


@compiled
def _look(point: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, radius: float, angle: float) -> Look:
    c, s = math.cos(angle), math.sin(angle)
    cx, cy = radius * c, radius * s
    g, px, py, pz, nx, ny, nz = widest_of_round(point, core, turn, x - cx, y - cy, z, x - cx, y - cy, z)
    return nx * s - ny * c, (g, px + cx, py + cy, pz, nx, ny, nz)


@compiled
def round_circle(
    point: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, radius: float, sx: float, sy: float
) -> Answer:
    """Return gap, smooth body's point and normal at the least distance of a circle from the body.

    The centre of the circle is the origin, its axis the third axis.  The normal points out of its disc.  The gap is nan
    if no such point was found.

    Parameters
    ----------
    point, core : Floats
        Core numbers of a point (a body of size 0, used for each point of the circle), and of the smooth body.
    turn : Axes
        Rotation from the axes of the core to those of the circle.
    x, y, z : float
        The core's centre [m].
    radius : float
        Radius of the circle [m].
    sx, sy : float
        Direction in the plane of the circle at which the search starts, of any length.
    """
    begin = math.atan2(sy, sx)
    none: Answer = (math.nan, x, y, z, 0.0, 0.0, 1.0)
    look: Look = _look(point, core, turn, x, y, z, radius, begin)
    slope, reached = look
    # downhill from the start; if that fails, in every interval of the circle
    way = -math.copysign(1.0, slope)
    low, falling, step = begin, slope, _FIRST
    if abs(slope) > _SAME:
        while step < math.pi:
            angle = begin + way * step
            slope, _ = _look(point, core, turn, x, y, z, radius, angle)
            if way * slope >= 0.0:
                answer: Answer = _between(point, core, turn, (x, y, z), radius, low, angle, falling, slope)
                if _is_outward(answer):
                    return answer
                break
            low, falling, step = angle, slope, 2.0 * step
    elif _is_outward(reached):
        return reached
    last, before = begin, look[0]
    for i in range(1, _LOOKS + 1):
        angle = begin + 2.0 * math.pi * i / _LOOKS
        slope, _ = _look(point, core, turn, x, y, z, radius, angle)
        if before < 0.0 <= slope:
            answer = _between(point, core, turn, (x, y, z), radius, last, angle, before, slope)
            if _is_outward(answer):
                return answer
        last, before = angle, slope
    return none


@compiled
def _is_outward(found: Answer) -> bool:
    g, px, py, _, nx, ny, _ = found
    cx, cy = px - g * nx, py - g * ny
    return bool(cx * nx + cy * ny >= -_SAME * (abs(cx) + abs(cy)))


@compiled
def _between(
    point: Floats,
    core: Floats,
    turn: Axes,
    place: Vector3,
    radius: float,
    low: float,
    high: float,
    falling: float,
    rising: float,
) -> Answer:
    """Return gap, smooth body's point and normal at the least distance between two angles of the circle.

    At the angle ``low`` the distance decreases towards ``high``, and at ``high`` towards ``low``.  ``falling`` and
    ``rising`` are the derivatives of the distance at these angles.  ``place`` is the centre of the core [m]; the other
    arguments are those of :func:`round_circle`.
    """
    x, y, z = place
    side, slow = 0, 0
    look: Look = _look(point, core, turn, x, y, z, radius, high)
    for _ in range(_STEPS):
        width = abs(high - low)
        # a secant step; after _PATIENCE secant steps in succession that did not halve the interval, a bisection
        middle = (low * rising - high * falling) / (rising - falling)
        if slow >= _PATIENCE or not (min(low, high) < middle < max(low, high)):
            middle, slow = 0.5 * (low + high), 0
        look = _look(point, core, turn, x, y, z, radius, middle)
        slope = look[0]
        if abs(slope) <= _SAME or width <= _SAME or middle == low or middle == high:
            break
        if (slope < 0.0) == (falling < 0.0):
            low, falling = middle, slope
            rising = 0.5 * rising if side == 1 else rising
            side = 1
        else:
            high, rising = middle, slope
            falling = 0.5 * falling if side == -1 else falling
            side = -1
        slow = slow + 1 if abs(high - low) > 0.5 * width else 0
    found = look[1]
    if not abs(look[0]) <= _ACROSS:
        # deep in the body the nearest surface point is discontinuous along the circle: no stationary point
        return math.nan, found[1], found[2], found[3], found[4], found[5], found[6]
    return found


@compiled
def next_to_axis(
    core: Floats, turn: Axes, x: float, y: float, z: float, radius: float, sx: float, sy: float, up: float
) -> Answer:
    """Return the result of :func:`round_circle` by Newton's method, for a normal close to the axis of the circle.

    The method requires a round core, whose radii of curvature are finite, and also finds overlaps.  The unknowns are
    the angle between normal and axis, which starts at 0, and the angle round the axis.  With these unknowns the
    equations are regular at the axis.  The normal is along the axis if ``up`` is 1, against it if ``up`` is -1.
    """
    tilt, angle = 0.0, math.atan2(sy, sx)
    size = abs(x) + abs(y) + abs(z) + max(core[0], core[1], core[2]) + radius
    for _ in range(_NEWTON):
        c, s = math.cos(angle), math.sin(angle)
        sine, cosine = math.sin(tilt), math.cos(tilt)
        nx, ny, nz = sine * c, sine * s, up * cosine
        ox, oy, oz = cosine * c, cosine * s, -up * sine
        mx, my, mz = back(turn, (-nx, -ny, -nz))
        b = support_of(core, (mx, my, mz))
        px, py, pz = forth(turn, (b[1], b[2], b[3]))
        px, py, pz = x + px, y + py, z + pz
        g = nx * px + ny * py + nz * pz - radius * sine
        over, beside = ox * px + oy * py + oz * pz - radius * cosine, c * py - s * px
        tx, ty, tz = back(turn, (ox, oy, oz))
        ux, uy, uz = back(turn, (-s, c, 0.0))
        h11, h12 = bend(b, tx, ty, tz, tx, ty, tz), bend(b, tx, ty, tz, ux, uy, uz)
        h22 = bend(b, ux, uy, uz, ux, uy, uz)
        a11, a12, a21 = -g - h11, cosine * beside - sine * h12, -h12
        a22 = -(c * px + s * py) - sine * h22
        det = a11 * a22 - a12 * a21
        if not (a11 < 0.0 and det > 0.0):
            break
        if abs(over) + abs(beside) <= _CLOSED * size:
            if tilt < -_CLOSED:
                break
            return g, px, py, pz, nx, ny, nz
        tilt -= (a22 * over - a12 * beside) / det
        angle -= (a11 * beside - a21 * over) / det
        if abs(tilt) > _STEEPEST:
            break
    return math.nan, x, y, z, 0.0, 0.0, 1.0


@compiled
def along_segment(
    core: Floats, turn: Axes, x: float, y: float, z: float, ex: float, ey: float, ez: float, length: float
) -> tuple[Answer, float]:
    """Return the least distance of a smooth body from a segment: (gap [m], body's point, normal), distance along it.

    The last number is the distance of the segment's nearest point from the start of the segment [m].  The segment goes
    from the origin along the unit vector e over ``length`` [m].  The core's centre is (x, y, z) [m]; ``turn`` is the
    rotation from the axes of the core to those of the segment.
    """
    point = (0.0, 0.0, 0.0, 2.0, 2.0, 0.0)
    low, high = 0.0, length
    best: Answer = (math.nan, x, y, z, 0.0, 0.0, 1.0)
    place = 0.0
    for i in range(_STEPS):
        # both ends first, then the middle of the remaining interval
        s = 0.0 if i == 0 else length if i == 1 else 0.5 * (low + high)
        cx, cy, cz = x - s * ex, y - s * ey, z - s * ez
        g, px, py, pz, nx, ny, nz = widest_of_round(point, core, turn, cx, cy, cz, cx, cy, cz)
        ahead = nx * ex + ny * ey + nz * ez
        best, place = (g, px + s * ex, py + s * ey, pz + s * ez, nx, ny, nz), s
        if g != g or (i == 0 and ahead <= 0.0) or (i == 1 and ahead >= 0.0):
            break
        if i > 1 and (abs(ahead) <= _SAME or s == low or s == high):
            if g < 0.0 and abs(ahead) > _ACROSS:
                # deep in the body the nearest surface point is discontinuous along the segment: no solution
                best = math.nan, best[1], best[2], best[3], best[4], best[5], best[6]
            break
        if ahead > 0.0:
            low = s
        else:
            high = s
    return best, place


@compiled
def up_hills(circle: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, up: float, lean: Point) -> Answer:
    """Return gap, smooth body's point and normal for an overlapping circle, along the direction of the largest gap.

    Parameters
    ----------
    circle : Floats
        The circle as a core.
    core, turn, x, y, z : Floats, Axes, float
        As in :func:`round_circle`.
    up : float
        1 or -1: normals are allowed from this direction of the circle's axis to the limit ``lean``; 0 allows all.
    lean : tuple of float
        Radial and axial component of the unit normal at this limit, and size of both bodies [m].
    """
    best: Answer = (math.nan, x, y, z, 0.0, 0.0, 1.0)
    for start in starts_of(circle, core, turn, x, y, z):
        top = uphill(circle, core, turn, x, y, z, start, _TOP)
        found: Answer = widest_of_round(circle, core, turn, x, y, z, top[1], top[2], top[3])
        if not found[0] >= top[0] - _TOP * lean[2]:
            settled = settle(circle, core, turn, x, y, z, top)
            # if two maxima differ by round-off only, the ellipsoid method may go from one to the other
            if _leans_so(settled, up, lean) or not _leans_so(top, up, lean):
                top = settled
            found = _along(circle, top)
        top = found[0], found[4], found[5], found[6]
        if not _leans_so(top, up, lean):
            # near a sharp place of the body the gap hardly depends on the normal: try the normal at the limit `lean`
            away = math.sqrt(top[1] * top[1] + top[2] * top[2])
            if away == 0.0:
                continue
            nx, ny, nz = lean[0] * top[1] / away, lean[0] * top[2] / away, lean[1]
            g = gap_along(circle, core, turn, x, y, z, nx, ny, nz)
            if not g >= top[0] - _OVER * lean[2]:
                continue
            found = _along(circle, (g, nx, ny, nz))
        if not found[0] <= best[0]:
            found, astray = _facing(circle, core, turn, x, y, z, found)
            if astray <= _OVER * lean[2]:
                best = found
    return best


@compiled
def _leans_so(top: Start, up: float, lean: Point) -> bool:
    """Return True if the normal at a maximum of the gap is between the axis and the limit ``lean``.

    ``up`` and ``lean`` are those of :func:`up_hills`; ``top`` is gap and normal at the maximum.
    """
    _, nx, ny, nz = top
    return bool(up == 0.0 or up * (lean[0] * nz - lean[1] * math.sqrt(nx * nx + ny * ny)) >= -_TOP)


@compiled
def _along(circle: Floats, top: Start) -> Answer:
    """Return gap, body's point and normal for a maximum ``top`` of the gap: the gap and its direction n.

    The body's point is the circle's farthest point along n, moved by the gap along n.
    """
    g, nx, ny, nz = top
    a = support_of(circle, (nx, ny, nz))
    return g, a[1] + g * nx, a[2] + g * ny, a[3] + g * nz, nx, ny, nz


@compiled
def _facing(
    circle: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, found: Answer
) -> tuple[Answer, float]:
    """Return a solution whose two points face each other, and the distance of the body's point from its surface [m].

    Close to a sharp place of the body, the gap is accurate to round-off, but the normal is not.  If the normal is
    nearly the axis, its radial component is round-off, and so is the direction of the circle's farthest point.  A
    search along the circle finds its point p for which p + gap normal is nearest to the surface of the body.
    """
    g, px, py, pz, nx, ny, nz = found
    extent, radius = max(core[0], core[1], core[2]), circle[0]
    best: Answer = found
    least = _over(core, turn, px - x, py - y, pz - z)
    if radius == 0.0 or not least > _SAME:
        return best, least * extent
    mx, my, mz = back(turn, (-nx, -ny, -nz))
    b = support_of(core, (mx, my, mz))
    qx, qy, _ = forth(turn, (b[1], b[2], b[3]))
    qx, qy = x + qx - g * nx, y + qy - g * ny
    cx, cy = px - g * nx, py - g * ny
    # search an arc about the circle's point nearest to the body's support point; it includes the present point
    middle = math.atan2(qy, qx)
    wide = abs(math.atan2(cx * qy - cy * qx, cx * qx + cy * qy)) if cx * cx + cy * cy > 0.0 else 0.0
    low, high = middle - wide - _FIRST, middle + wide + _FIRST
    for _ in range(_STEPS):
        one, two = low + _GOLDEN * (high - low), high - _GOLDEN * (high - low)
        ax, ay = radius * math.cos(one) + g * nx, radius * math.sin(one) + g * ny
        bx, by = radius * math.cos(two) + g * nx, radius * math.sin(two) + g * ny
        first = _over(core, turn, ax - x, ay - y, g * nz - z)
        second = _over(core, turn, bx - x, by - y, g * nz - z)
        if first < least:
            least, best = first, (g, ax, ay, g * nz, nx, ny, nz)
        if second < least:
            least, best = second, (g, bx, by, g * nz, nx, ny, nz)
        if high - low <= _SAME or least <= _SAME:
            break
        if first < second:
            high = two
        else:
            low = one
    return best, least * extent


@compiled
def _over(core: Floats, turn: Axes, x: float, y: float, z: float) -> float:
    """Return abs(gauge - 1) of a point: 0 on the surface of the core, where :func:`gauge` is 1, larger off it."""
    bx, by, bz = back(turn, (x, y, z))
    return float(abs(gauge(core, bx, by, bz) - 1.0))
