"""Gap of a smooth body and a circle or a segment, by searches for the place on it: slow, but without failures.

The unknown is the angle round the circle, or the place along the segment.  The distance of this point from the smooth
body falls or rises along the circle by the tangential component of the normal.  Between two angles at which it falls
and rises, secants and halvings narrow the interval.  The search needs no radius of curvature of the circle.  Close to
the axis of the circle this radius varies without bound, so that Newton's method on the normal does not converge there.

If the bodies overlap, steps uphill lead to the direction with the largest gap.  The circle's point is then again found
by a search along the circle.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...blocks import Vector3
from ...shapes.support_function import support_of
from .boxy_newton import Answer, Point
from .inscribed import gauge
from .smooth_core import Axes, back, bend, forth
from .smooth_newton import widest_of_round
from .smooth_starts import Start, gap_along, settle, starts_of, uphill

_FIRST = 1e-3
"""First step round the circle [rad]; each further step is twice as long as the one before."""
_LOOKS, _STEPS, _PATIENCE = 16, 120, 3
"""Angles round the circle that are sampled; most steps of a search; most successive slow secants before a halving."""
_SAME = 4e-16
"""Angle [rad] below which two directions are equal, and slope that is zero, within round-off."""
_ACROSS = 1e-9
"""Largest slope at a solution; the error of its gap is of the order of the square of the slope."""
_TOP, _OVER = 1e-9, 1e-11
"""Angle to a maximum up to which steps go uphill [rad]; largest relative distance of its point from the surface."""
_GOLDEN = 0.3819660112501051
"""Fraction of an interval, from either end, at which a golden-section search for a minimum evaluates."""
_NEWTON, _CLOSED, _STEEPEST = 20, 1e-15, 0.5
"""Limits of Newton's method next to the axis.

Largest number of steps; residual of a solution, relative to the size; largest angle between normal and axis [rad].
"""

Look: TypeAlias = tuple[float, Answer]
"""Derivative of the distance by the angle round the circle, over the radius, and the stop: gap, point, normal."""


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
        A point as a core, and the smooth body's core.
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
    """Return the stop at the least distance between two angles of the circle.

    At ``low`` the distance falls towards ``high``, at ``high`` it falls towards ``low``; ``falling`` and ``rising`` are
    the slopes there.
    """
    x, y, z = place
    side, slow = 0, 0
    look: Look = _look(point, core, turn, x, y, z, radius, high)
    for _ in range(_STEPS):
        width = abs(high - low)
        # secants; after several that leave more than half of the interval, a halving
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
        # the circle is deep in the body, and the nearest point of the surface jumps: no solution
        return math.nan, found[1], found[2], found[3], found[4], found[5], found[6]
    return found


@compiled
def next_to_axis(
    core: Floats, turn: Axes, x: float, y: float, z: float, radius: float, sx: float, sy: float, up: float
) -> Answer:
    """Return the result of :func:`round_circle` for a normal that is nearly the axis of the circle, by Newton's method.

    It needs a body with radii of curvature.  The unknowns are the angle between normal and axis, at first 0, and the
    angle round the axis.  With these unknowns the equations stay regular at the axis, and it also finds overlaps.  The
    normal is along the axis if ``up`` is 1, against it if ``up`` is -1.
    """
    tilt, angle = 0.0, math.atan2(sy, sx)
    size = abs(x) + abs(y) + abs(z) + max(core[0], core[1], core[2]) + radius
    for _ in range(_NEWTON):
        c, s = math.cos(angle), math.sin(angle)
        sine, cosine = math.sin(tilt), math.cos(tilt)
        nx, ny, nz = sine * c, sine * s, up * cosine
        ox, oy, oz = cosine * c, cosine * s, -up * sine
        mx, my, mz = back(turn, -nx, -ny, -nz)
        b = support_of(core, mx, my, mz)
        px, py, pz = forth(turn, b[1], b[2], b[3])
        px, py, pz = x + px, y + py, z + pz
        g = nx * px + ny * py + nz * pz - radius * sine
        over, beside = ox * px + oy * py + oz * pz - radius * cosine, c * py - s * px
        tx, ty, tz = back(turn, ox, oy, oz)
        ux, uy, uz = back(turn, -s, c, 0.0)
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
    """Return gap, smooth body's point and normal at the least distance from a segment, and the place on it [m].

    The segment goes from the origin along the unit vector e.  The other arguments are those of :func:`round_circle`.
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
                # the segment is deep in the body, and the nearest point of the surface jumps: no solution
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
        1 or -1, the side of the circle's plane on which normals are allowed; 0 for both sides.
    lean : tuple of float
        Radial and axial component of the last normal that is allowed on the other side, and size of both bodies [m].
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
            # close to a sharp place the gap hardly depends on the normal: try the last allowed normal
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
    """Return whether the normal of a maximum is among the allowed normals; arguments as in :func:`up_hills`."""
    _, nx, ny, nz = top
    return bool(up == 0.0 or up * (lean[0] * nz - lean[1] * math.sqrt(nx * nx + ny * ny)) >= -_TOP)


@compiled
def _along(circle: Floats, top: Start) -> Answer:
    """Return gap, point and normal of a maximum of the gap, from the circle's farthest point along its direction."""
    g, nx, ny, nz = top
    a = support_of(circle, nx, ny, nz)
    return g, a[1] + g * nx, a[2] + g * ny, a[3] + g * nz, nx, ny, nz


@compiled
def _facing(
    circle: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, found: Answer
) -> tuple[Answer, float]:
    """Return a solution whose two points face each other, and the distance of the body's point from its surface [m].

    Close to a sharp place of the body, the gap is accurate to round-off, but the normal is not.  If the normal is
    nearly the axis, its radial component is round-off, and so is the direction of the circle's farthest point.  The
    right point of the circle is the one from which the point at the gap along the normal lies on the surface of the
    body.
    """
    g, px, py, pz, nx, ny, nz = found
    extent, radius = max(core[0], core[1], core[2]), circle[0]
    best: Answer = found
    least = _over(core, turn, px - x, py - y, pz - z)
    if radius == 0.0 or not least > _SAME:
        return best, least * extent
    mx, my, mz = back(turn, -nx, -ny, -nz)
    b = support_of(core, mx, my, mz)
    qx, qy, _ = forth(turn, b[1], b[2], b[3])
    qx, qy = x + qx - g * nx, y + qy - g * ny
    cx, cy = px - g * nx, py - g * ny
    # search from the circle's point nearest to the body's point, to both sides as far as the present point
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
    """Return the difference of a point's gauge from 1, which is 0 on the surface of the core."""
    bx, by, bz = back(turn, x, y, z)
    return float(abs(gauge(core, bx, by, bz) - 1.0))
