"""Searches for the largest gap of a smooth body over one part of a cylinder, a cone or a disc.

The gap is a function of the unit normal, and a part of the frustum has a range of normals: a cap has one normal, the
side has normals of one unknown angle, a rim has a normal cone at each of its points.  The result, gap, point and
normal, is a local maximum of the gap over the normals of all parts if the smooth body's point lies opposite the part.
Otherwise the gap is nan.  The angle on the side is found by Newton's method on the support function, or by halving if
the body is boxy.  A rim is searched as a flat ellipsoid, an apex as a point.

All points and normals are in the axes of the frustum, from its centre.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...rotations import rotated_back
from ...shapes.frustum import COS, LOW, LOW_RADIUS, SIDE, SIN
from ...shapes.support_function import Core, is_round
from ...vectors import Vector3, dot
from ..smooth.boxy_line import Line, across_line
from ..smooth.newton import RIGHT, ROUND_OFF, has_ended
from ..smooth.round_search import round_circle
from ..smooth.smooth_core import Cores, NearestPoint, at_place, bend, facing_point
from ..smooth.smooth_newton import widest_of_round
from .frustum import FLANK, HIGH_CAP, LOW_CAP, LOW_RIM, along_side, rim_of

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
"""Largest number of Newton steps in a search on the side, and of halvings of a step or a tilt."""
_SEEN = 1e-14
"""Difference of two gaps that is round-off, relative to the size of both bodies."""
Direction: TypeAlias = tuple[float, float]
"""Two components of a unit vector perpendicular to the axis, along the first and the second axis of the frustum."""


class Pair(NamedTuple):
    """A frustum and a smooth body.

    Attributes
    ----------
    frustum : Floats
        Numbers of the frustum.
    low, high : Floats
        Its rims, each as a core.
    cores : Cores
        A point at the centre of the frustum, and the smooth body.
    size : float
        Size of both bodies [m].
    """

    frustum: Floats
    low: Core
    high: Core
    cores: Cores
    size: float


@compiled
def lowest_point(pair: Pair, n: Vector3) -> Vector3:
    """Return the smooth body's farthest point in the direction -n [m], its lowest one over a face with the normal n."""
    return facing_point(pair.cores, n)[0]


@compiled
def from_rim(pair: Pair, part: int) -> Cores:
    """Return the circle of a rim, or the apex, and the smooth body, from the centre of the circle."""
    _, smooth, turn, center = at_place(pair.cores, (0.0, 0.0, rim_of(pair.frustum, part)[1]))
    return Cores(pair.low if part == LOW_RIM else pair.high, smooth, turn, center)


@compiled
def on_cap(pair: Pair, part: int, near: float) -> NearestPoint:
    """Return gap, smooth body's point [m] and normal at the point that is lowest over a cap.

    ``part`` is ``LOW_CAP`` or ``HIGH_CAP``.  The gap is nan if the point lies more than ``near`` [m] outside of the
    cap's border, or if the frustum has no such cap.
    """
    radius, height, up = rim_of(pair.frustum, part)
    p = lowest_point(pair, (0.0, 0.0, up))
    gap = up * (p[2] - height)
    if radius == 0.0 or p[0] * p[0] + p[1] * p[1] > (radius + near) * (radius + near):
        gap = math.nan
    return gap, p, (0.0, 0.0, up)


@compiled
def _on_end_of_cap(pair: Pair, part: int, near: float) -> NearestPoint:
    """Return gap, point and normal as :func:`on_cap`, for a body so flat that round-off moves its lowest point.

    If round-off moved the lowest point past the border of the cap, the normal is tilted outwards: the larger the tilt,
    the farther inwards is the lowest point.  Two tilts are bisected, with lowest points inside and outside of the
    border.  Between these two points, a point over the border is interpolated.  It is accepted if its gap, an upper
    bound, exceeds the gap along the tilted normal, a lower bound, by at most ``near`` [m].
    """
    untilted = on_cap(pair, part, near)
    radius, height, up = rim_of(pair.frustum, part)
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
            qx, qy, qz = lowest_point(pair, (tilt * ex, tilt * ey, up))
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
    cosine = frustum[COS]
    # coordinates of the smooth body's point: along the normal's radial direction, and along the side from its lower rim
    away = (n[0] * p[0] + n[1] * p[1]) / cosine
    _, up = along_side(frustum, p[2], away)
    return (g, p, n) if away >= g * cosine and -near <= up <= frustum[SIDE] + near else (math.nan, p, n)


@compiled
def _along_side(pair: Pair, direction: Direction) -> NearestPoint:
    """Return gap, point and normal of a maximum over the side, continued past its rims; the gap is nan without one.

    The search goes round the axis from a direction.
    """
    frustum, (ex, ey) = pair.frustum, direction
    cosine, sine = frustum[COS], frustum[SIN]
    # the side is a cone about the axis, with tangent planes at this distance from the centre
    support = cosine * frustum[LOW_RADIUS] + sine * frustum[LOW]
    return across_line(pair.cores, Line((0.0, 0.0, 1.0), cosine, sine, support), (ex, ey, 0.0))


@compiled
def on_flank(pair: Pair, direction: Direction) -> NearestPoint:
    """Return gap, smooth body's point [m] and normal of a local maximum of the gap over the side.

    The gap is nan if there is no maximum.  The search starts at the normal in ``direction``.
    """
    found = _on_round_flank(pair, direction) if is_round(pair.cores.second) else _along_side(pair, direction)
    return _if_on_flank(pair.frustum, ON_BORDER * pair.size, found)


@compiled
def _on_round_flank(pair: Pair, direction: Direction) -> NearestPoint:
    """Return the maximum of the gap over the side, continued past its rims, by Newton's method for one angle.

    It is the angle of the normal round the axis.  A step that lowers the gap is halved.  The gap is nan without
    convergence to a maximum.
    """
    frustum, size = pair.frustum, pair.size
    cosine, sine = frustum[COS], frustum[SIN]
    support = cosine * frustum[LOW_RADIUS] + sine * frustum[LOW]
    # (lx, ly): radial direction of the last accepted normal, with the gap g
    (ex, ey), (lx, ly), step, p = direction, direction, 0.0, pair.cores.center
    g, before, halvings = -math.inf, math.inf, 0
    for _ in range(_STEPS):
        n = (cosine * ex, cosine * ey, sine)
        p, bends = facing_point(pair.cores, n)
        next_gap = dot(n, p) - support
        if next_gap < g - _SEEN * size and halvings < _HALVINGS:
            halvings += 1
            step *= 0.5
        else:
            g, halvings = next_gap, 0
            lx, ly = ex, ey
            # first and second derivative of the gap by the angle
            rate = cosine * (ex * p[1] - ey * p[0])
            t = rotated_back(pair.cores.turn, (-ey, ex, 0.0))
            second = -cosine * (ex * p[0] + ey * p[1]) - cosine * cosine * bend(bends, t, t)
            residual = abs(rate)
            if has_ended(residual, before, size):
                if residual > RIGHT * size or second > 0.0:
                    break
                return g, p, n
            before = residual
            step = rate / max(abs(second), ROUND_OFF * size)
            step = min(max(step, -1.0), 1.0)
        # rotate the direction by the angle whose tangent is the step
        ex, ey = lx - step * ly, ly + step * lx
        length = math.sqrt(ex * ex + ey * ey)
        ex, ey = ex / length, ey / length
    return math.nan, p, (cosine * lx, cosine * ly, sine)


@compiled
def _if_in_cone(pair: Pair, part: int, least: float, found: NearestPoint) -> NearestPoint:
    """Return the maximum ``found`` of the gap over a rim's circle; the gap is nan outside of the rim's normal cone.

    The cone ends at the normal of the side; a disc has no side.  The sine of the angle from there, positive towards the
    cap, must be at least ``least``.  The point found is from the centre of the circle, the point returned from that of
    the frustum.
    """
    frustum, (g, p, n), (_, height, up) = pair.frustum, found, rim_of(pair.frustum, part)
    from_side = frustum[COS] * n[2] - frustum[SIN] * math.sqrt(n[0] * n[0] + n[1] * n[1])
    is_outside = frustum[SIDE] > 0.0 and up * from_side < least
    return math.nan if is_outside else g, (p[0], p[1], p[2] + height), n


@compiled
def on_rim(pair: Pair, direction: Direction, part: int, tilt: float) -> NearestPoint:
    """Return gap, smooth body's point [m] and normal of a local maximum of the gap over a rim, or over the apex.

    The gap is nan if there is no maximum.  ``part`` is ``LOW_RIM`` or ``HIGH_RIM``; the apex is an upper rim of radius
    0.  The search starts with a normal in the plane of the axis and ``direction``.  |tilt| interpolates this normal
    between the normal of the side (0) and the normal of the cap (1).  If ``tilt`` is negative and the direction from
    the rim to the core's centre lies between these two normals, the search starts with this direction.
    """
    frustum, (ex, ey) = pair.frustum, direction
    (radius, _, up), cores = rim_of(frustum, part), from_rim(pair, part)
    is_disc = frustum[SIDE] == 0.0
    # direction from the rim's point to the core's centre, or else the interpolated normal
    x, y, axial = cores.center
    radial = ex * x + ey * y - radius
    if tilt >= 0.0 or radial <= 0.0 or not (is_disc or up * (frustum[COS] * axial - frustum[SIN] * radial) > 0.0):
        tilt = abs(tilt)
        cap = math.copysign(1.0, axial) if is_disc else up
        radial, axial = (1.0 - tilt) * frustum[COS], (1.0 - tilt) * frustum[SIN] + tilt * cap
    found = widest_of_round(cores, (radial * ex, radial * ey, axial))
    return _if_in_cone(pair, part, -ON_BORDER, found)


@compiled
def by_search(pair: Pair, direction: Direction, part: int) -> NearestPoint:
    """Return a local maximum of the gap over a part (cap, side or rim), by searches round the axis.

    It is used if `on_cap`, `on_flank` and `on_rim` found no maximum.  The tolerance at the border of a part is larger
    here, because the gaps of both parts there differ only by the square of the distance to the border.
    """
    frustum, near = pair.frustum, _NEAR_BORDER * pair.size
    if part == LOW_CAP or part == HIGH_CAP:
        return _on_end_of_cap(pair, part, near)
    if part == FLANK:
        return _if_on_flank(frustum, near, _along_side(pair, direction))
    (radius, height, up), (_, _, z) = rim_of(frustum, part), pair.cores.center
    # a disc has normals on both sides of its plane: take the side of the smooth body's centre
    side = math.copysign(1.0, z - height) if frustum[SIDE] == 0.0 else up
    px, py, _ = lowest_point(pair, (0.0, 0.0, side))
    if px * px + py * py == 0.0:
        px, py = direction
    found = round_circle(at_place(pair.cores, (0.0, 0.0, height)), radius, (px, py, 0.0))
    return _if_in_cone(pair, part, -_NEAR_BORDER, found)
