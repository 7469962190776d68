"""Searches for the largest gap of a smooth body over one part of a cylinder, a cone or a disc.

The gap is a function of the unit normal, and a part of the frustum has a range of normals: a cap has one normal, the
side has normals of one unknown angle, a rim has a normal cone at each of its points.  The result, gap, point and
normal, is a local maximum of the gap over the normals of all parts if the smooth body's point lies opposite the part.
Otherwise the gap is nan.  The angle on the side is found by Newton's method on the support function, or by halving if
the body is boxy.  A rim is searched as a flat ellipsoid, an apex as a point.

All points and normals are in the axes of the frustum, from its centre.  ``core`` is the core of the smooth body,
``place`` its centre [m]; ``turn`` converts components along the axes of the core to those of the frustum.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, LOW_RADIUS, SIDE, SIN
from ...shapes.support_function import Core, is_round, support_of
from ...vectors import Vector3, dot, opposite, plus
from ..smooth.boxy_line import across_line
from ..smooth.round_search import next_to_axis, round_circle
from ..smooth.smooth_core import Axes, NearestPoint, bend, rotated, rotated_back
from ..smooth.smooth_newton import widest_of_round
from .frustum import FLANK, HIGH_CAP, LOW_CAP, cap_of, rim_of

ON_BORDER = 1e-14
"""Round-off allowed in two checks of a local maximum of the gap.

The first is the distance of its point past the border of the cap or the side, relative to the size of both bodies.  The
second is the sine of the angle of its normal outside of the normal cone of the rim, between side and cap.
"""
_NEAR_BORDER = 1e-10
"""Tolerance of `by_search` in place of ``ON_BORDER``; the error of the gap, which is stationary, is only its square."""
_LEAST_TILT, _MOST_TILT, _AZIMUTHS = 1e-16, 1e-7, 4
"""Least and largest tilt of the normal from the axis tried at the border of a cap [rad]; number of azimuths tried."""
_STEPS, _HALVINGS = 60, 40
"""Largest number of Newton steps in a search on the side; largest number of halvings of a Newton step or a tilt."""
_ROUND_OFF, _SEEN, _CLOSE, _RIGHT = 2e-16, 1e-14, 1e-12, 1e-13
"""Tolerances of Newton's method, for residuals and gaps relative to the size of both bodies.

They are those of :mod:`bodies.contacts.smooth.dual_newton`.  A search ends at a residual of ``_ROUND_OFF``, or below
``_CLOSE`` if a step no longer halves the residual.  A gap that is smaller by more than ``_SEEN`` is a failed step.  A
result needs a residual below ``_RIGHT``.
"""


@compiled
def point_against(core: Core, turn: Axes, place: Vector3, n: Vector3) -> Vector3:
    """Return the smooth body's farthest point in the direction -n [m], its lowest one over a face with the normal n."""
    return plus(place, rotated(turn, support_of(core, rotated_back(turn, opposite(n)))[1]))


@compiled
def on_cap(frustum: Floats, core: Core, turn: Axes, place: Vector3, part: int, near: float) -> NearestPoint:
    """Return gap, smooth body's point [m] and normal at the point that is lowest over a cap.

    ``part`` is ``LOW_CAP`` or ``HIGH_CAP``.  The gap is nan if the point lies more than ``near`` [m] outside of the
    cap's border, or if the frustum has no such cap.
    """
    radius, height, up = cap_of(frustum, part)
    p = point_against(core, turn, place, (0.0, 0.0, up))
    gap = up * (p[2] - height)
    if radius == 0.0 or p[0] * p[0] + p[1] * p[1] > (radius + near) * (radius + near):
        gap = math.nan
    return gap, p, (0.0, 0.0, up)


@compiled
def _on_end_of_cap(frustum: Floats, core: Core, turn: Axes, place: Vector3, part: int, near: float) -> NearestPoint:
    """Return gap, point and normal as :func:`on_cap`, for a body so flat that round-off moves its lowest point.

    If round-off moved the lowest point past the border of the cap, the normal is tilted outwards: the larger the tilt,
    the farther inwards is the lowest point.  Two tilts are bisected, with lowest points inside and outside of the
    border.  Between these two points, a point over the border is interpolated.  It is accepted if its gap, an upper
    bound, exceeds the gap along the tilted normal, a lower bound, by at most ``near`` [m].
    """
    untilted = on_cap(frustum, core, turn, place, part, near)
    radius, height, up = cap_of(frustum, part)
    cx, cy, _ = untilted[1]
    if not math.isnan(untilted[0]) or not 0.0 < radius * radius < cx * cx + cy * cy:
        return untilted
    for _ in range(_AZIMUTHS):
        # tilt towards the last point found at the border
        away = math.sqrt(cx * cx + cy * cy)
        ex, ey = cx / away, cy / away
        px, py, pz = untilted[1]
        low, high, tilt = 0.0, 0.0, _LEAST_TILT
        gap, least_gap = 0.0, -math.inf
        for _ in range(_HALVINGS):
            qx, qy, qz = point_against(core, turn, place, (tilt * ex, tilt * ey, up))
            inside = radius * radius - qx * qx - qy * qy
            if inside > 0.0:
                high = tilt
                # the point over the border, on the line from q (inside of the border) to p (outside of it)
                wx, wy = px - qx, py - qy
                along, across = qx * wx + qy * wy, wx * wx + wy * wy
                fraction = inside / (along + math.sqrt(along * along + across * inside))
                cx, cy = qx + fraction * wx, qy + fraction * wy
                cz = qz + fraction * (pz - qz)
                gap, least_gap = up * (cz - height), tilt * (ex * qx + ey * qy - radius) + up * (qz - height)
                if gap - least_gap <= near:
                    return gap, (cx, cy, cz), (tilt * ex, tilt * ey, up)
            else:
                low, px, py, pz = tilt, qx, qy, qz
            tilt = 0.5 * (low + high) if high > 0.0 else 10.0 * tilt
            if tilt > _MOST_TILT:
                return untilted
    return untilted


@compiled
def _if_on_flank(frustum: Floats, near: float, found: NearestPoint) -> NearestPoint:
    """Return the maximum ``found`` of the gap over the side continued past its rims; the gap is nan off the side.

    The side's contact point must be on the same half of the axis as the normal, and between the rims.  ``near`` is the
    tolerance at the rims [m].
    """
    g, p, n = found
    cosine, sine = frustum[COS], frustum[SIN]
    # coordinates of the smooth body's point: along the normal's radial direction, and along the side from its lower rim
    away = (n[0] * p[0] + n[1] * p[1]) / cosine
    up = cosine * (p[2] - frustum[LOW]) - sine * (away - frustum[LOW_RADIUS])
    return (g, p, n) if away >= g * cosine and -near <= up <= frustum[SIDE] + near else (math.nan, p, n)


@compiled
def _along_side(frustum: Floats, core: Core, turn: Axes, place: Vector3, ex: float, ey: float) -> NearestPoint:
    """Return the maximum of the gap over the side, continued past its rims, by halving from the direction (ex, ey)."""
    cosine, sine = frustum[COS], frustum[SIN]
    support = cosine * frustum[LOW_RADIUS] + sine * frustum[LOW]
    return across_line(core, turn, place, (0.0, 0.0, 1.0), (ex, ey, 0.0), cosine, sine, support)


@compiled
def on_flank(
    frustum: Floats, core: Core, turn: Axes, place: Vector3, direction: tuple[float, float], near: float
) -> NearestPoint:
    """Return gap, smooth body's point [m] and normal of a local maximum of the gap over the side.

    The gap is nan if there is no maximum.  The search starts at the normal in ``direction``, two components of any
    length perpendicular to the axis.  ``near`` is the tolerance at the rims [m], ``ON_BORDER`` times the size.
    """
    sx, sy = direction
    length = math.sqrt(sx * sx + sy * sy)
    ex, ey = sx / length, sy / length
    if is_round(core):
        found = _on_round_flank(frustum, core, turn, place, ex, ey, near)
    else:
        found = _along_side(frustum, core, turn, place, ex, ey)
    return _if_on_flank(frustum, near, found)


@compiled
def _on_round_flank(
    frustum: Floats, core: Core, turn: Axes, place: Vector3, ex: float, ey: float, near: float
) -> NearestPoint:
    """Return the maximum of the gap over the side, continued past its rims, by Newton's method for one angle.

    It is the angle of the normal round the axis; the unit vector (ex, ey) is the radial direction of the first normal.
    A step that lowers the gap is halved.  The gap is nan without convergence.
    """
    cosine, sine = frustum[COS], frustum[SIN]
    support = cosine * frustum[LOW_RADIUS] + sine * frustum[LOW]
    size = near / ON_BORDER
    # (lx, ly): radial direction of the last accepted normal, with the gap g
    lx, ly, step, p = ex, ey, 0.0, place
    g, before, halvings = -math.inf, math.inf, 0
    for _ in range(_STEPS):
        n = (cosine * ex, cosine * ey, sine)
        s = support_of(core, rotated_back(turn, opposite(n)))
        p = plus(place, rotated(turn, s[1]))
        next_gap = dot(n, p) - support
        if next_gap < g - _SEEN * size and halvings < _HALVINGS:
            halvings += 1
            step *= 0.5
        else:
            g, halvings = next_gap, 0
            lx, ly = ex, ey
            # first and second derivative of the gap by the angle
            rate = cosine * (ex * p[1] - ey * p[0])
            t = rotated_back(turn, (-ey, ex, 0.0))
            second = -cosine * (ex * p[0] + ey * p[1]) - cosine * cosine * bend(s[2], t, t)
            residual = abs(rate)
            if residual <= _ROUND_OFF * size or (residual <= _CLOSE * size and residual >= 0.5 * before):
                if residual > _RIGHT * size or second > 0.0:
                    break
                return g, p, n
            before = residual
            step = rate / max(abs(second), _ROUND_OFF * size)
            step = min(max(step, -1.0), 1.0)
        # rotate the direction by the angle whose tangent is the step
        ex, ey = lx - step * ly, ly + step * lx
        length = math.sqrt(ex * ex + ey * ey)
        ex, ey = ex / length, ey / length
    return math.nan, p, (cosine * lx, cosine * ly, sine)


@compiled
def _if_in_cone(frustum: Floats, up: float, height: float, least: float, found: NearestPoint) -> NearestPoint:
    """Return the maximum ``found`` of the gap over a rim's circle; the gap is nan outside of the rim's normal cone.

    The cone ends at the normal of the side; a disc has no side.  The sine of the angle from there, positive towards the
    cap, must be at least ``least``.  ``height`` is the height of the rim [m], ``up`` is 1 for the upper rim and -1 for
    the lower one.  The point found is from the centre of the circle, the point returned from that of the frustum.
    """
    g, p, n = found
    from_side = frustum[COS] * n[2] - frustum[SIN] * math.sqrt(n[0] * n[0] + n[1] * n[1])
    is_outside = frustum[SIDE] > 0.0 and up * from_side < least
    return math.nan if is_outside else g, (p[0], p[1], p[2] + height), n


@compiled
def on_rim(
    frustum: Floats,
    circle: Core,
    core: Core,
    turn: Axes,
    place: Vector3,
    direction: tuple[float, float],
    part: int,
    tilt: float,
) -> NearestPoint:
    """Return gap, smooth body's point [m] and normal of a local maximum of the gap over a rim, or over the apex.

    The gap is nan if there is no maximum.  ``part`` is ``LOW_RIM`` or ``HIGH_RIM``; the apex is an upper rim of radius
    0.  ``circle`` is the rim as a core.  The search starts with a normal in the plane of the axis and ``direction``, a
    vector perpendicular to the axis. |tilt| interpolates this normal between the normal of the side (0) and the normal
    of the cap (1).  If ``tilt`` is negative and the direction from the rim to the core's centre lies between these two
    normals, the search starts with this direction.
    """
    (sx, sy), (x, y, z) = direction, place
    radius, height, up = rim_of(frustum, part)
    if radius > 0.0:
        # if the smooth body's lowest point is over the disc in the circle, the largest gap is along the axis
        for sign in (-1.0, 1.0):
            p = point_against(core, turn, place, (0.0, 0.0, sign))
            if sign * (p[2] - height) >= 0.0 and p[0] * p[0] + p[1] * p[1] <= radius * radius:
                return math.nan, p, (0.0, 0.0, sign)
    length = math.sqrt(sx * sx + sy * sy)
    ex, ey = sx / length, sy / length
    is_disc = frustum[SIDE] == 0.0
    # direction from the rim's point to the core's centre, or else the interpolated normal
    radial, axial = ex * x + ey * y - radius, z - height
    if tilt >= 0.0 or radial <= 0.0 or not (is_disc or up * (frustum[COS] * axial - frustum[SIN] * radial) > 0.0):
        tilt = abs(tilt)
        cap = math.copysign(1.0, axial) if is_disc else up
        radial, axial = (1.0 - tilt) * frustum[COS], (1.0 - tilt) * frustum[SIN] + tilt * cap
    found = widest_of_round(circle, core, turn, (x, y, z - height), (radial * ex, radial * ey, axial))
    return _if_in_cone(frustum, up, height, -ON_BORDER, found)


@compiled
def by_search(
    frustum: Floats,
    point: Core,
    core: Core,
    turn: Axes,
    place: Vector3,
    direction: tuple[float, float],
    part: int,
    size: float,
) -> NearestPoint:
    """Return a local maximum of the gap over a part (cap, side or rim), by searches round the axis.

    It is used if `on_cap`, `on_flank` and `on_rim` found no maximum.  The tolerance at the border of a part is larger
    here, because the gaps of both parts there differ only by the square of the distance to the border.  The arguments
    are those of these functions; ``point`` is the core of a point, ``size`` the size of both bodies [m].
    """
    (sx, sy), (x, y, z) = direction, place
    near = _NEAR_BORDER * size
    found: NearestPoint = (math.nan, place, (0.0, 0.0, 1.0))
    if part == LOW_CAP or part == HIGH_CAP:
        return _on_end_of_cap(frustum, core, turn, place, part, near)
    if part == FLANK:
        length = math.sqrt(sx * sx + sy * sy)
        return _if_on_flank(frustum, near, _along_side(frustum, core, turn, place, sx / length, sy / length))
    radius, height, up = rim_of(frustum, part)
    # a disc has normals on both sides of its plane: take the side of the smooth body's centre
    side = math.copysign(1.0, z - height) if frustum[SIDE] == 0.0 else up
    px, py, _ = point_against(core, turn, place, (0.0, 0.0, side))
    if px * px + py * py == 0.0:
        px, py = sx, sy
    if is_round(core) and radius > 0.0:
        found = next_to_axis(core, turn, (x, y, z - height), radius, (px, py, 0.0), side)
    if math.isnan(found[0]):
        found = round_circle(point, core, turn, (x, y, z - height), radius, (px, py, 0.0))
    return _if_in_cone(frustum, up, height, -_NEAR_BORDER, found)
