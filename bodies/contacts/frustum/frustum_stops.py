"""Where a smooth body is nearest to one part of a cylinder, a cone or a disc: gap, point and normal, or nan if nowhere.

On a cap the normal is given.  On the side it has one angle, found by Newton's method on the support function, or for a
boxy body by halving.  A rim is searched as a flat ellipsoid, an apex as a point.  The result, a "stop" of the part,
is valid if the smooth body's point lies before the part and the common normal is a normal of the part.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...blocks import Vector3
from ...shapes.frustum import COS, HIGH, LOW, SIDE, SIN
from ...shapes.support_function import is_round, support_of
from ..smooth.boxy_line import across_line
from ..smooth.boxy_newton import Answer
from ..smooth.round_search import next_to_axis, round_circle
from ..smooth.smooth_core import Axes, back, bend, forth
from ..smooth.smooth_newton import widest_of_round
from .frustum import FLANK, HIGH_CAP, HIGH_RIM, LOW_CAP

ON_BORDER = 1e-14
"""Tolerance of a stop, for round-off, in two checks.

It limits how far the point is past the end of its cap or side, relative to the size of both bodies.  It limits by how
much the unit normal leaves the range of normals of its rim, between side and cap.
"""
_NEAR_BORDER = 1e-10
"""The tolerance ``ON_BORDER`` for a stop of `by_search`; the error of its gap is only the square of this number."""
_LEAST_LEAN, _MOST_LEAN, _TURNS = 1e-16, 1e-7, 4
"""Least and largest angle of a normal to the axis that is tried at the end of a cap [rad]; directions tried."""
_STEPS, _HALVINGS = 60, 40
"""Most Newton steps on the side; most halvings of a Newton step or of an angle."""
_ROUND_OFF, _SEEN, _CLOSE, _RIGHT = 2e-16, 1e-14, 1e-12, 1e-13
"""Tolerances of Newton's method, the same as in :mod:`bodies.contacts.smooth.dual_newton`."""


@compiled
def point_against(
    core: Floats, turn: Axes, x: float, y: float, z: float, nx: float, ny: float, nz: float
) -> tuple[float, float, float]:
    """Return the smooth body's farthest point in the direction -(nx, ny, nz) [m], in the axes of the frustum."""
    mx, my, mz = back(turn, -nx, -ny, -nz)
    s = support_of(core, mx, my, mz)
    px, py, pz = forth(turn, s[1], s[2], s[3])
    return x + px, y + py, z + pz


@compiled
def on_cap(frustum: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, part: int, near: float) -> Answer:
    """Return the stop of a cap: gap, point and normal; the gap is nan if the point is not over the cap."""
    up = 1.0 if part == HIGH_CAP else -1.0
    radius = frustum[1] if part == HIGH_CAP else frustum[0]
    px, py, pz = point_against(core, turn, x, y, z, 0.0, 0.0, up)
    g = pz - frustum[HIGH] if part == HIGH_CAP else frustum[LOW] - pz
    if radius == 0.0 or px * px + py * py > (radius + near) * (radius + near):
        g = math.nan
    return g, px, py, pz, 0.0, 0.0, up


@compiled
def _on_end_of_cap(
    frustum: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, part: int, near: float
) -> Answer:
    """Return the stop of a cap for a smooth body so flat that round-off moves its lowest point past the cap's end.

    The more the normal leans outwards, the farther inwards is the lowest point.  Two leans are bisected whose lowest
    points lie on either side of the end; the line between these points has a point of the body over the end.
    """
    found: Answer = on_cap(frustum, core, turn, x, y, z, part, near)
    radius, height = (frustum[1], frustum[HIGH]) if part == HIGH_CAP else (frustum[0], frustum[LOW])
    up = found[6]
    cx, cy = found[1], found[2]
    if found[0] == found[0] or not 0.0 < radius * radius < cx * cx + cy * cy:
        return found
    for _ in range(_TURNS):
        away = math.sqrt(cx * cx + cy * cy)
        ex, ey = cx / away, cy / away
        px, py, pz = found[1], found[2], found[3]
        low, high, lean = 0.0, 0.0, _LEAST_LEAN
        gap, below = 0.0, -math.inf
        for _ in range(_HALVINGS):
            qx, qy, qz = point_against(core, turn, x, y, z, lean * ex, lean * ey, up)
            inside = radius * radius - qx * qx - qy * qy
            if inside > 0.0:
                high = lean
                # the point of the line between them that is over the end
                wx, wy = px - qx, py - qy
                along, across = qx * wx + qy * wy, wx * wx + wy * wy
                share = inside / (along + math.sqrt(along * along + across * inside))
                cx, cy = qx + share * wx, qy + share * wy
                cz = qz + share * (pz - qz)
                gap, below = up * (cz - height), lean * (ex * qx + ey * qy - radius) + up * (qz - height)
                if gap - below <= near:
                    return gap, cx, cy, cz, lean * ex, lean * ey, up
            else:
                low, px, py, pz = lean, qx, qy, qz
            lean = 0.5 * (low + high) if high > 0.0 else 10.0 * lean
            if lean > _MOST_LEAN:
                return found
    return found


@compiled
def _before_flank(frustum: Floats, near: float, found: Answer) -> bool:
    """Return whether a stop of the side, continued beyond its rims, lies between the rims and outside of the axis."""
    g, px, py, pz, nx, ny, _ = found
    cosine, sine = frustum[COS], frustum[SIN]
    away = (nx * px + ny * py) / cosine
    up = cosine * (pz - frustum[LOW]) - sine * (away - frustum[0])
    return bool(away >= g * cosine and -near <= up <= frustum[SIDE] + near)


@compiled
def on_flank(
    frustum: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, near: float
) -> Answer:
    """Return the stop of the side, nan as gap if there is none; start at the direction (sx, sy) from the axis."""
    cosine, sine = frustum[COS], frustum[SIN]
    reach = cosine * frustum[0] + sine * frustum[LOW]
    length = math.sqrt(sx * sx + sy * sy)
    ex, ey = sx / length, sy / length
    if not is_round(core):
        g, px, py, pz, nx, ny, nz = across_line(
            core, turn, (x, y, z), (0.0, 0.0, 1.0), (ex, ey, 0.0), cosine, sine, reach
        )
    else:
        g, px, py, pz, nx, ny, nz = _on_round_flank(frustum, core, turn, x, y, z, ex, ey, near)
    if not _before_flank(frustum, near, (g, px, py, pz, nx, ny, nz)):
        g = math.nan
    return g, px, py, pz, nx, ny, nz


@compiled
def _on_round_flank(
    frustum: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, ex: float, ey: float, near: float
) -> Answer:
    """Return the stop of the side continued beyond its rims, by Newton's method on the angle round the axis."""
    cosine, sine = frustum[COS], frustum[SIN]
    reach = cosine * frustum[0] + sine * frustum[LOW]
    size = near / ON_BORDER
    lx, ly, step = ex, ey, 0.0
    px, py, pz = x, y, z
    g, before, halvings = -math.inf, math.inf, 0
    for _ in range(_STEPS):
        nx, ny = cosine * ex, cosine * ey
        mx, my, mz = back(turn, -nx, -ny, -sine)
        s = support_of(core, mx, my, mz)
        px, py, pz = forth(turn, s[1], s[2], s[3])
        px, py, pz = x + px, y + py, z + pz
        found = nx * px + ny * py + sine * pz - reach
        if found < g - _SEEN * size and halvings < _HALVINGS:
            halvings += 1
            step *= 0.5
        else:
            g, halvings = found, 0
            lx, ly = ex, ey
            rate = cosine * (ex * py - ey * px)
            tx, ty, tz = back(turn, -ey, ex, 0.0)
            second = -cosine * (ex * px + ey * py) - cosine * cosine * bend(s, tx, ty, tz, tx, ty, tz)
            residual = abs(rate)
            if residual <= _ROUND_OFF * size or (residual <= _CLOSE * size and residual >= 0.5 * before):
                if residual > _RIGHT * size or second > 0.0:
                    break
                return g, px, py, pz, nx, ny, sine
            before = residual
            step = rate / max(abs(second), _ROUND_OFF * size)
            step = min(max(step, -1.0), 1.0)
        # rotate the direction by the angle whose tangent is the step
        ex, ey = lx - step * ly, ly + step * lx
        length = math.sqrt(ex * ex + ey * ey)
        ex, ey = ex / length, ey / length
    return math.nan, px, py, pz, cosine * lx, cosine * ly, sine


@compiled
def on_rim(
    frustum: Floats,
    circle: Floats,
    core: Floats,
    turn: Axes,
    place: Vector3,
    direction: tuple[float, float],
    part: int,
    tilt: float,
) -> Answer:
    """Return the stop of a rim or of the apex: gap, smooth body's point and normal; the gap is nan without a stop.

    The search starts with a normal in the plane of the axis and ``direction``, a vector perpendicular to the axis.  The
    normal is interpolated between the normal of the side (|tilt| = 0) and the normal of the cap (|tilt| = 1).  If
    ``tilt`` is negative, the direction from the rim to the core's centre is taken instead, if it lies between these
    two normals.
    """
    sx, sy = direction
    x, y, z = place
    up = 1.0 if part == HIGH_RIM else -1.0
    radius, height = (frustum[1], frustum[HIGH]) if part == HIGH_RIM else (frustum[0], frustum[LOW])
    if radius > 0.0:
        # where the centre of the cap is nearest, the normal of the circle is the axis
        for sign in (-1.0, 1.0):
            px, py, pz = point_against(core, turn, x, y, z, 0.0, 0.0, sign)
            if sign * (pz - height) >= 0.0 and px * px + py * py <= radius * radius:
                return math.nan, px, py, pz, 0.0, 0.0, sign
    length = math.sqrt(sx * sx + sy * sy)
    ex, ey = sx / length, sy / length
    flat = frustum[SIDE] == 0.0
    radial, axial = ex * x + ey * y - radius, z - height
    if tilt >= 0.0 or radial <= 0.0 or not (flat or up * (frustum[COS] * axial - frustum[SIN] * radial) > 0.0):
        tilt = abs(tilt)
        cap = math.copysign(1.0, axial) if flat else up
        radial, axial = (1.0 - tilt) * frustum[COS], (1.0 - tilt) * frustum[SIN] + tilt * cap
    g, px, py, pz, nx, ny, nz = widest_of_round(circle, core, turn, x, y, z - height, radial * ex, radial * ey, axial)
    lean = frustum[COS] * nz - frustum[SIN] * math.sqrt(nx * nx + ny * ny)
    if not flat and up * lean < -ON_BORDER:
        g = math.nan
    return g, px, py, pz + height, nx, ny, nz


@compiled
def by_search(
    frustum: Floats,
    point: Floats,
    core: Floats,
    turn: Axes,
    place: Vector3,
    direction: tuple[float, float],
    part: int,
    size: float,
) -> Answer:
    """Return the stop of a part by searches round the axis, if `on_cap`, `on_flank` and `on_rim` found no stop.

    Close to the border of two parts a stop of either part is accepted, because their gaps differ only by the square of
    the distance to the border.
    """
    sx, sy = direction
    x, y, z = place
    near = _NEAR_BORDER * size
    found: Answer = (math.nan, x, y, z, 0.0, 0.0, 1.0)
    if part == LOW_CAP or part == HIGH_CAP:
        found = _on_end_of_cap(frustum, core, turn, x, y, z, part, near)
    elif part == FLANK:
        cosine, sine = frustum[COS], frustum[SIN]
        reach, length = cosine * frustum[0] + sine * frustum[LOW], math.sqrt(sx * sx + sy * sy)
        ex, ey = sx / length, sy / length
        found = across_line(core, turn, (x, y, z), (0.0, 0.0, 1.0), (ex, ey, 0.0), cosine, sine, reach)
        if not _before_flank(frustum, near, found):
            found = math.nan, x, y, z, 0.0, 0.0, 1.0
    else:
        up = 1.0 if part == HIGH_RIM else -1.0
        radius, height = (frustum[1], frustum[HIGH]) if part == HIGH_RIM else (frustum[0], frustum[LOW])
        flat = frustum[SIDE] == 0.0
        over = math.copysign(1.0, z - height) if flat else up
        px, py, _ = point_against(core, turn, x, y, z, 0.0, 0.0, over)
        if px * px + py * py == 0.0:
            px, py = sx, sy
        found = math.nan, x, y, z, 0.0, 0.0, 1.0
        if is_round(core) and radius > 0.0:
            found = next_to_axis(core, turn, x, y, z - height, radius, px, py, over)
        if found[0] != found[0]:
            found = round_circle(point, core, turn, x, y, z - height, radius, px, py)
        g, px, py, pz, nx, ny, nz = found
        lean = frustum[COS] * nz - frustum[SIN] * math.sqrt(nx * nx + ny * ny)
        if not flat and up * lean < -_NEAR_BORDER:
            g = math.nan
        found = g, px, py, pz + height, nx, ny, nz
    return found
