"""Searches for the largest gap of a smooth body over one part of a cylinder, a cone or a disc.

The gap is a function of the unit normal, and a part of the frustum has a range of normals: a cap has one normal, the
side has normals of one unknown angle, a rim has a normal cone at each of its points.  The result, gap, point and
normal, is a local maximum of the gap over the normals of all parts if the smooth body's point lies opposite the part.
Otherwise the gap is nan.  The angle on the side is found by Newton's method on the support function, or by halving if
the body is boxy.  A rim is searched as a flat ellipsoid, an apex as a point.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, SIDE, SIN
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
_LEAST_LEAN, _MOST_LEAN, _TURNS = 1e-16, 1e-7, 4
"""Least and largest tilt of the normal from the axis tried at the border of a cap [rad]; number of azimuths tried."""
_STEPS, _HALVINGS = 60, 40
"""Largest numbers: of Newton steps in a search on the side, and of halvings of a Newton step or of a tilt."""
_ROUND_OFF, _SEEN, _CLOSE, _RIGHT = 2e-16, 1e-14, 1e-12, 1e-13
"""Tolerances of Newton's method, for residuals and gaps relative to the size of both bodies.

They are those of :mod:`bodies.contacts.smooth.dual_newton`.  A search ends at a residual of ``_ROUND_OFF``, or below
``_CLOSE`` if a step no longer halves the residual.  A gap that is smaller by more than ``_SEEN`` is a failed step.  A
result needs a residual below ``_RIGHT``.
"""


@compiled
def point_against(core: Core, turn: Axes, place: Vector3, n: Vector3) -> Vector3:
    """Return the smooth body's farthest point in the direction -n [m], in the axes of the frustum."""
    return plus(place, rotated(turn, support_of(core, rotated_back(turn, opposite(n)))[1]))


@compiled
def on_cap(frustum: Floats, core: Core, turn: Axes, place: Vector3, part: int, near: float) -> NearestPoint:
    """Return gap, smooth body's point [m] and normal at the point that is lowest over a cap.

    ``part`` is ``LOW_CAP`` or ``HIGH_CAP``.  The gap is nan if the point lies more than ``near`` [m] outside of the
    cap's border.
    """
    radius, level, up = cap_of(frustum, part)
    p = point_against(core, turn, place, (0.0, 0.0, up))
    g = up * (p[2] - level)
    if radius == 0.0 or p[0] * p[0] + p[1] * p[1] > (radius + near) * (radius + near):
        g = math.nan
    return g, p, (0.0, 0.0, up)


@compiled
def _on_end_of_cap(frustum: Floats, core: Core, turn: Axes, place: Vector3, part: int, near: float) -> NearestPoint:
    """Return gap, point and normal as :func:`on_cap`, for a body so flat that round-off moves its lowest point.

    If round-off moved the lowest point past the border of the cap, the normal is tilted outwards: the larger the tilt,
    the farther inwards is the lowest point.  Two tilts are bisected, with lowest points inside and outside of the
    border.  Between these two points, a point over the border is interpolated.
    """
    found = on_cap(frustum, core, turn, place, part, near)
    radius, height, up = cap_of(frustum, part)
    cx, cy, _ = found[1]
    if found[0] == found[0] or not 0.0 < radius * radius < cx * cx + cy * cy:
        return found
    for _ in range(_TURNS):
        away = math.sqrt(cx * cx + cy * cy)
        ex, ey = cx / away, cy / away
        px, py, pz = found[1]
        low, high, lean = 0.0, 0.0, _LEAST_LEAN
        gap, below = 0.0, -math.inf
        for _ in range(_HALVINGS):
            qx, qy, qz = point_against(core, turn, place, (lean * ex, lean * ey, up))
            inside = radius * radius - qx * qx - qy * qy
            if inside > 0.0:
                high = lean
                # the point over the border, on the line from q (inside of the border) to p (outside of it)
                wx, wy = px - qx, py - qy
                along, across = qx * wx + qy * wy, wx * wx + wy * wy
                share = inside / (along + math.sqrt(along * along + across * inside))
                cx, cy = qx + share * wx, qy + share * wy
                cz = qz + share * (pz - qz)
                gap, below = up * (cz - height), lean * (ex * qx + ey * qy - radius) + up * (qz - height)
                if gap - below <= near:
                    return gap, (cx, cy, cz), (lean * ex, lean * ey, up)
            else:
                low, px, py, pz = lean, qx, qy, qz
            lean = 0.5 * (low + high) if high > 0.0 else 10.0 * lean
            if lean > _MOST_LEAN:
                return found
    return found


@compiled
def _if_on_flank(frustum: Floats, near: float, found: NearestPoint) -> NearestPoint:
    """Return a maximum of the gap over the side, continued beyond its rims; the gap is nan if it is not on the side.

    Its point on the side must not have crossed the axis.  ``near`` is the tolerance at the rims [m].
    """
    g, p, n = found
    cosine, sine = frustum[COS], frustum[SIN]
    away = (n[0] * p[0] + n[1] * p[1]) / cosine
    up = cosine * (p[2] - frustum[LOW]) - sine * (away - frustum[0])
    return (g, p, n) if away >= g * cosine and -near <= up <= frustum[SIDE] + near else (math.nan, p, n)


@compiled
def _along_side(frustum: Floats, core: Core, turn: Axes, place: Vector3, ex: float, ey: float) -> NearestPoint:
    """Return the maximum of the gap over the side, continued beyond its rims, by halving."""
    cosine, sine = frustum[COS], frustum[SIN]
    reach = cosine * frustum[0] + sine * frustum[LOW]
    return across_line(core, turn, place, (0.0, 0.0, 1.0), (ex, ey, 0.0), cosine, sine, reach)


@compiled
def on_flank(
    frustum: Floats, core: Core, turn: Axes, place: Vector3, direction: tuple[float, float], near: float
) -> NearestPoint:
    """Return gap, smooth body's point [m] and normal of a local maximum of the gap over the side.

    The gap is nan if there is no maximum.  The search starts at the normal in ``direction`` from the axis.
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
    """Return the maximum of the gap over the side, continued beyond its rims, by Newton's method for one angle.

    The angle is the angle of the normal round the axis.
    """
    cosine, sine = frustum[COS], frustum[SIN]
    reach = cosine * frustum[0] + sine * frustum[LOW]
    size = near / ON_BORDER
    lx, ly, step, p = ex, ey, 0.0, place
    g, before, halvings = -math.inf, math.inf, 0
    for _ in range(_STEPS):
        n = (cosine * ex, cosine * ey, sine)
        s = support_of(core, rotated_back(turn, opposite(n)))
        p = plus(place, rotated(turn, s[1]))
        found = dot(n, p) - reach
        if found < g - _SEEN * size and halvings < _HALVINGS:
            halvings += 1
            step *= 0.5
        else:
            g, halvings = found, 0
            lx, ly = ex, ey
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
def _if_in_fan(frustum: Floats, up: float, height: float, least: float, found: NearestPoint) -> NearestPoint:
    """Return a maximum of the gap over the circle of a rim, from the centre of the frustum.

    The gap is nan if the sine of the angle of its normal over the side is below ``least``; a disc has no side.
    ``height`` is the height of the rim [m], ``up`` is 1 for the upper rim and -1 for the lower one.
    """
    g, p, n = found
    lean = frustum[COS] * n[2] - frustum[SIN] * math.sqrt(n[0] * n[0] + n[1] * n[1])
    is_outside = frustum[SIDE] > 0.0 and up * lean < least
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
    0.  The search starts with a normal in the plane of the axis and ``direction``, a vector perpendicular to the axis.
    |tilt| interpolates this normal between the normal of the side (0) and the normal of the cap (1).  If ``tilt`` is
    negative and the direction from the rim to the core's centre lies between these two normals, the search starts with
    this direction.
    """
    (sx, sy), (x, y, z) = direction, place
    radius, height, up = rim_of(frustum, part)
    if radius > 0.0:
        # where the centre of the cap is nearest, the normal of the circle is the axis
        for sign in (-1.0, 1.0):
            p = point_against(core, turn, place, (0.0, 0.0, sign))
            if sign * (p[2] - height) >= 0.0 and p[0] * p[0] + p[1] * p[1] <= radius * radius:
                return math.nan, p, (0.0, 0.0, sign)
    length = math.sqrt(sx * sx + sy * sy)
    ex, ey = sx / length, sy / length
    flat = frustum[SIDE] == 0.0
    radial, axial = ex * x + ey * y - radius, z - height
    if tilt >= 0.0 or radial <= 0.0 or not (flat or up * (frustum[COS] * axial - frustum[SIN] * radial) > 0.0):
        tilt = abs(tilt)
        cap = math.copysign(1.0, axial) if flat else up
        radial, axial = (1.0 - tilt) * frustum[COS], (1.0 - tilt) * frustum[SIN] + tilt * cap
    found = widest_of_round(circle, core, turn, (x, y, z - height), (radial * ex, radial * ey, axial))
    return _if_in_fan(frustum, up, height, -ON_BORDER, found)


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

    It serves if `on_cap`, `on_flank` and `on_rim` found no maximum.  The tolerance at the border of a part is larger
    here, because the gaps of both parts there differ only by the square of the distance to the border.
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
    side = math.copysign(1.0, z - height) if frustum[SIDE] == 0.0 else up
    px, py, _ = point_against(core, turn, place, (0.0, 0.0, side))
    if px * px + py * py == 0.0:
        px, py = sx, sy
    if is_round(core) and radius > 0.0:
        found = next_to_axis(core, turn, (x, y, z - height), radius, (px, py, 0.0), side)
    if found[0] != found[0]:
        found = round_circle(point, core, turn, (x, y, z - height), radius, (px, py, 0.0))
    return _if_in_fan(frustum, up, height, -_NEAR_BORDER, found)
