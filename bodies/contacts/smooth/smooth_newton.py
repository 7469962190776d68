"""The gap of two smooth bodies of any kind, and the curvature of their surfaces.

Cores are of three kinds, by their powers (:mod:`bodies.shapes.support_function`): round cores have radii of curvature
everywhere, boxy cores have flat places, mixed cores have flat and sharp places.  The unknown of Newton's method is the
unit normal for round cores, the surface point for boxy cores, and the chart's vector for mixed cores
(:mod:`bodies.contacts.smooth.chart`).
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.support_function import gauge_of, is_boxy, is_mixed, is_round, support_of
from ...vectors import Vector3
from .boxy_line import across_line
from .boxy_newton import Answer, Point, climb_boxy, write_boxy
from .boxy_pair import meet
from .chart import write_chart
from .chart_newton import meet_in_charts
from .dual_newton import climb
from .inscribed import gauge, no_shorter_way
from .smooth_core import Axes, back, forth, write_core
from .smooth_starts import gap_along, settle, starts_of, uphill

_DEEP = 1e-2
"""Overlap, relative to the least semi-axis, up to which a solution is accepted without a proof.

In a deeper overlap, a shorter translation could separate the bodies: see :mod:`bodies.contacts.smooth.inscribed`.
"""

_TOUCHING = 1e-12
"""Overlap, relative to the distance of the centres, up to which no common point of the bodies is required.

So small an overlap is round-off of touching bodies, which may have no common point.
"""

_TOPS = 4
"""Directions with large gaps from which the search begins, before the twelve axes of both bodies."""
_THIN = 4.0
_BURIED = 0.5
"""Limits above which the search also starts along the axes of both bodies, to find a larger gap than the one found.

``_THIN``: ratio of the largest to the least semi-axis.  ``_BURIED``: ratio of the overlap to the least semi-axis.
"""
_NEARBY, _NEXT_TO = 0.05, 1e-6
"""Accuracy of the direction from which Newton's method is restarted, as its angle to a maximum of the gap [rad].

``_NEARBY``: first restart.  ``_NEXT_TO``: further restarts, for mixed cores only.
"""
_FEW_PARTS, _PARTS = 4, 24
"""Numbers of steps in which the powers of two cores are changed from 2 (ellipsoids) to their own values.

If a core is mixed (one power below 2, the other above) and the direct search fails, the gap is followed through these
steps: first through the few, which cost less, then through the many.
"""
_ON_AXIS, _SUNK = 1e-5, 0.2
"""A maximum of the gap on the axis of a circle is rejected: it belongs to the middle of the disc, not to its rim.

``_ON_AXIS``: angle to the axis up to which a maximum is on the axis [rad].  ``_SUNK``: largest overlap, relative to the
least semi-axis, in which maxima are tested.
"""
_SAMPLES = 8
"""Number of equal parts into which the line between both contact points is divided.

To prove an overlap, the ends of the parts are tested: is one of them inside of both bodies?
"""
_NOWHERE = 1e-300
"""Least gauge, which replaces the gauge 0 of a centre in a division."""
_ON_SURFACE = 1e-12
"""Largest deviation of the gauge from 1 at a point of the surface: round-off."""


@compiled
def widest(first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float) -> Answer:
    """Return the gap of two cores, the second's point and the normal, in the axes of the first and from its centre.

    The gap is the largest one over all directions [m].  If it is positive, it is the only maximum.  A negative gap is
    returned only if a common point of both bodies proves the overlap.  Overlapping bodies can have several maxima: each
    is a locally shortest translation that separates them.  If the first search fails, or its solution is not proved to
    be the shortest translation, the search also starts from directions with a large gap.  The gap is nan if no solution
    was found.

    Parameters
    ----------
    first, second : Floats
        The cores; their radii are not used.
    turn : Axes
        Rotation from the axes of the second core to those of the first.
    x, y, z : float
        The second core's centre from the first's [m].
    """
    mixed = is_mixed(first) or is_mixed(second)
    best: Answer = _first_look(first, second, turn, x, y, z)
    overlap = _share_a_point(first, second, turn, x, y, z, best)
    if best[0] >= 0.0 or (best[0] >= -_DEEP * _thickness(first, second) and overlap):
        return best
    if overlap and no_shorter_way(first, second, turn, x, y, z, best):
        return best
    starts, thin = starts_of(first, second, turn, x, y, z), _is_thin(first, second)
    buried = best[0] < -_BURIED * _thickness(first, second)
    axes = 2 * _TOPS if mixed else _TOPS
    for attempt in range(axes + (13 if mixed else 12)):
        if overlap and best[0] == best[0] and attempt >= _TOPS:
            if attempt == axes + 12 or not (thin or buried):
                break
            if attempt < axes:
                continue
        if attempt == axes + 12:
            found: Answer = _in_charts(first, second, turn, x, y, z, x, y, z)
        elif attempt >= axes:
            sx, sy, sz = _axis(turn, attempt - axes)
            found = _from_start(first, second, turn, x, y, z, sx, sy, sz)
        elif attempt >= _TOPS:
            _, sx, sy, sz = uphill(first, second, turn, x, y, z, starts[attempt - _TOPS], _NEXT_TO)
            found = _from_start(first, second, turn, x, y, z, sx, sy, sz)
        else:
            seen, sx, sy, sz = starts[attempt]
            found = _from_start(first, second, turn, x, y, z, sx, sy, sz)
            if not found[0] >= seen:
                # Newton's method went to a smaller maximum, or did not converge
                _, sx, sy, sz = uphill(first, second, turn, x, y, z, starts[attempt], _NEARBY)
                found = _from_start(first, second, turn, x, y, z, sx, sy, sz)
        overlap = overlap or _share_a_point(first, second, turn, x, y, z, found)
        if found[0] == found[0] and not best[0] >= found[0]:
            best = found
            if best[0] >= 0.0 or (overlap and no_shorter_way(first, second, turn, x, y, z, best)):
                return best
    if not overlap:
        return math.nan, best[1], best[2], best[3], best[4], best[5], best[6]
    return best


@compiled
def _axis(turn: Axes, number: int) -> Point:
    """Return one of the twelve directions along the axes of both bodies."""
    i, sign = number % 3, 1.0 if number < 6 else -1.0
    ex, ey, ez = sign if i == 0 else 0.0, sign if i == 1 else 0.0, sign if i == 2 else 0.0
    if number % 6 >= 3:
        ex, ey, ez = forth(turn, (ex, ey, ez))
    return ex, ey, ez


@compiled
def _is_thin(first: Floats, second: Floats) -> bool:
    most = max(max(first[0], first[1], first[2]), max(second[0], second[1], second[2]))
    return bool(most > _THIN * _thickness(first, second))


@compiled
def _share_a_point(first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, found: Answer) -> bool:
    """Return whether a common point of both bodies is found, which confirms the overlap of a solution.

    Candidates are the two points of the solution, points between them, and the line of centres.
    """
    g, qx, qy, qz, nx, ny, nz = found
    if g >= -_TOUCHING * (abs(x) + abs(y) + abs(z)):
        return True
    for i in range(_SAMPLES + 1):
        # from the first body's point to the second's
        part = g * (1.0 - i / _SAMPLES)
        px, py, pz = qx - part * nx, qy - part * ny, qz - part * nz
        bx, by, bz = back(turn, (px - x, py - y, pz - z))
        if gauge(second, bx, by, bz) <= 1.0 + _ON_SURFACE and gauge(first, px, py, pz) <= 1.0 + _ON_SURFACE:
            return True
    # on the line of centres, each body covers the part 1 / gauge of its length, from the body's own centre: the bodies
    # overlap if these parts together are longer than the line
    ax, ay, az = back(turn, (-x, -y, -z))
    one, two = max(gauge_of(first, x, y, z), _NOWHERE), max(gauge_of(second, ax, ay, az), _NOWHERE)
    return bool(1.0 / one + 1.0 / two >= 1.0)


@compiled
def _thickness(first: Floats, second: Floats) -> float:
    """Return the least semi-axis of two cores, of which one may be a point [m]."""
    a, b = min(first[0], first[1], first[2]), min(second[0], second[1], second[2])
    return a if b == 0.0 or (a > 0.0 and a < b) else b


@compiled
def _first_look(first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float) -> Answer:
    """Return the largest gap over all directions, second core's point and normal; search from the line of centres."""
    if not (is_mixed(first) or is_mixed(second)):
        found: Answer = _from_start(first, second, turn, x, y, z, x, y, z)
        return found
    one, two = (first[0], first[1], first[2], 2.0, 2.0), (second[0], second[1], second[2], 2.0, 2.0)
    g, nx, ny, nz = climb(one, two, turn, (x, y, z), (0.0, 0.0, 0.0), (x, y, z))
    found = (g, x, y, z, nx, ny, nz)
    if g == g:
        # Newton's method starts with the contact normal of two ellipsoids that have the semi-axes of the cores
        found = _by_parts(first, second, turn, x, y, z, nx, ny, nz, 0)
    return found


@compiled
def _from_start(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, sz: float
) -> Answer:
    """Return the largest gap over all directions [m], second core's point and normal; search from (sx, sy, sz)."""
    if is_mixed(first) or is_mixed(second):
        mixed: Answer = _by_parts(first, second, turn, x, y, z, sx, sy, sz, 0)
        return mixed
    if is_boxy(first):
        if is_boxy(second):
            g, px, py, pz, nx, ny, nz = _both(first, second, turn, x, y, z, sx, sy, sz)
        else:
            g, px, py, pz, nx, ny, nz = climb_boxy(first, second, turn, x, y, z, sx, sy, sz)
        return g, px + g * nx, py + g * ny, pz + g * nz, nx, ny, nz
    found: Answer = widest_of_round(first, second, turn, x, y, z, sx, sy, sz)
    return found


@compiled
def _in_charts(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, sz: float
) -> Answer:
    """Return the largest gap over all directions [m], second core's point and normal, if a core is mixed.

    A mixed core has one power below 2 and one above, so that it has flat and sharp places.  The search starts with the
    contact normal of two ellipsoids that have the semi-axes of the cores; this normal is searched from the direction
    (sx, sy, sz).  If the first core is a circle (the rim of a frustum), a maximum along the circle's axis gives nan: it
    is the gap to the middle of the disc, not to the rim.
    """
    one, two = (first[0], first[1], first[2], 2.0, 2.0), (second[0], second[1], second[2], 2.0, 2.0)
    found: Answer = meet_in_charts(one, two, turn, x, y, z, sx, sy, sz, 0)
    if found[0] == found[0]:
        found = _by_parts(first, second, turn, x, y, z, found[4], found[5], found[6], 0)
    if found[0] != found[0] and first[0] > 0.0 and first[2] == 0.0:
        length = math.sqrt(sx * sx + sy * sy + sz * sz)
        nx, ny, nz = sx / length, sy / length, sz / length
        start = gap_along(first, second, turn, x, y, z, nx, ny, nz), nx, ny, nz
        g, nx, ny, nz = uphill(first, second, turn, x, y, z, start, _NEXT_TO)
        shallow = g >= -_SUNK * _thickness(first, second)
        if shallow and max(abs(nx), abs(ny)) < _ON_AXIS:
            return math.nan, x, y, z, nx, ny, nz
        if shallow:
            found = _by_parts(first, second, turn, x, y, z, nx, ny, nz, 0)
    if found[0] != found[0]:
        found = _by_parts(first, second, turn, x, y, z, sx, sy, sz, _FEW_PARTS)
    if found[0] != found[0] and x * x + y * y + z * z > 0.0:
        found = _by_parts(first, second, turn, x, y, z, x, y, z, _PARTS)
    if found[0] != found[0]:
        for start in starts_of(first, second, turn, x, y, z):
            _, nx, ny, nz = uphill(first, second, turn, x, y, z, start, _NEXT_TO)
            found = _by_parts(first, second, turn, x, y, z, nx, ny, nz, 0)
            if found[0] >= 0.0:
                return found
    return found


@compiled
def _by_parts(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, sz: float, parts: int
) -> Answer:
    """Return gap, second core's point and normal; the search starts in the direction (sx, sy, sz).

    If it fails, it is repeated with ellipsoids whose powers are changed in ``parts`` steps from 2 to the cores' own.
    """
    one, two = (
        (first[0], first[1], first[2], first[3], first[4]),
        (second[0], second[1], second[2], second[3], second[4]),
    )
    g, px, py, pz, nx, ny, nz = meet_in_charts(one, two, turn, x, y, z, sx, sy, sz, parts)
    return g, px + g * nx, py + g * ny, pz + g * nz, nx, ny, nz


@compiled
def widest_of_round(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, sz: float
) -> Answer:
    """Return the largest gap over all directions [m], second core's point and normal; search from (sx, sy, sz).

    The first core is round; it may be a point or a circle.  The second core is of any kind.
    """
    if is_mixed(second) or is_boxy(second):
        if is_mixed(second):
            found: Answer = _in_charts(first, second, turn, x, y, z, sx, sy, sz)
        else:
            found = _from_boxy(first, second, turn, x, y, z, sx, sy, sz)
        if found[0] != found[0] and first[0] == 0.0:
            found = _by_cuts(first, second, turn, x, y, z, sx, sy, sz)
        return found
    g, nx, ny, nz = climb(first, second, turn, (x, y, z), (0.0, 0.0, 0.0), (sx, sy, sz))
    mx, my, mz = back(turn, (-nx, -ny, -nz))
    s = support_of(second, (mx, my, mz))
    px, py, pz = forth(turn, (s[1], s[2], s[3]))
    return g, x + px, y + py, z + pz, nx, ny, nz


@compiled
def _from_boxy(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, sz: float
) -> Answer:
    """Return the largest gap over all directions [m], second core's point and normal; search from (sx, sy, sz).

    The second core is boxy: the unknown of Newton's method is the point of its surface.
    """
    ax, ay, az = back(turn, (-x, -y, -z))
    sx, sy, sz = back(turn, (-sx, -sy, -sz))
    g, px, py, pz, nx, ny, nz = climb_boxy(second, first, opposite(turn), ax, ay, az, sx, sy, sz)
    nx, ny, nz = forth(turn, (-nx, -ny, -nz))
    px, py, pz = forth(turn, (px, py, pz))
    return g, x + px, y + py, z + pz, nx, ny, nz


@compiled
def _by_cuts(
    point: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, sz: float
) -> Answer:
    """Return gap, point and normal of a core and a point outside of it, for searches in which Newton's method fails.

    Newton's method fails near a pole of a core with a power just under 2, where the curvatures fall to 0 over a very
    small distance.  The ellipsoid method needs no curvatures.
    """
    bx, by, bz = back(turn, (-x, -y, -z))
    length = math.sqrt(sx * sx + sy * sy + sz * sz)
    nx, ny, nz = sx / length, sy / length, sz / length
    if gauge(core, bx, by, bz) <= 1.0:
        return math.nan, x, y, z, nx, ny, nz
    start = gap_along(point, core, turn, x, y, z, nx, ny, nz), nx, ny, nz
    start = uphill(point, core, turn, x, y, z, start, _NEARBY)
    g, nx, ny, nz = settle(point, core, turn, x, y, z, start)
    bx, by, bz = back(turn, (g * nx - x, g * ny - y, g * nz - z))
    if not (g > 0.0 and abs(gauge(core, bx, by, bz) - 1.0) <= _ON_SURFACE):
        g = math.nan
    return g, g * nx, g * ny, g * nz, nx, ny, nz


@compiled
def opposite(turn: Axes) -> Axes:
    """Return the inverse of a rotation."""
    return turn[0], turn[3], turn[6], turn[1], turn[4], turn[7], turn[2], turn[5], turn[8]


@compiled
def _both(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, sx: float, sy: float, sz: float
) -> Answer:
    """Return the gap of two boxy cores (with flat places) [m], the first core's point and the normal.

    The search starts with the contact normal for which the second core is replaced by an ellipsoid.  If the search
    fails, it starts with the normal for which the first core is replaced instead, and last from (sx, sy, sz).
    """
    other = second[0], second[1], second[2], 2.0, 2.0
    g, _, _, _, nx, ny, nz = climb_boxy(first, other, turn, x, y, z, sx, sy, sz)
    found: Answer = _from(first, second, turn, x, y, z, nx, ny, nz)
    if g == g and found[0] == found[0]:
        return found
    other = first[0], first[1], first[2], 2.0, 2.0
    ax, ay, az = back(turn, (-x, -y, -z))
    bx, by, bz = back(turn, (-sx, -sy, -sz))
    g, _, _, _, nx, ny, nz = climb_boxy(second, other, opposite(turn), ax, ay, az, bx, by, bz)
    nx, ny, nz = forth(turn, (-nx, -ny, -nz))
    found = _from(first, second, turn, x, y, z, nx, ny, nz)
    if g == g and found[0] == found[0]:
        return found
    found = _from(first, second, turn, x, y, z, sx, sy, sz)
    if found[0] != found[0]:
        found = meet(first, second, turn, x, y, z, (sx, sy, sz), (-sx, -sy, -sz))
    return found


@compiled
def _from(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, nx: float, ny: float, nz: float
) -> Answer:
    """Return the gap of two boxy cores [m], the first core's point and the normal.

    Newton's method starts at the support points of the first core along (nx, ny, nz), and of the second against it.
    """
    length = math.sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = nx / length, ny / length, nz / length
    mx, my, mz = back(turn, (-nx, -ny, -nz))
    a, b = support_of(first, (nx, ny, nz)), support_of(second, (mx, my, mz))
    qx, qy, qz = forth(turn, (b[1], b[2], b[3]))
    found: Answer = meet(first, second, turn, x, y, z, (a[1], a[2], a[3]), (qx, qy, qz))
    return found


@compiled
def widest_from(hull: Floats, core: Floats, turn: Axes, place: Vector3, axis: Vector3, start: Vector3) -> Answer:
    """Return the gap between the origin and a core of any kind [m], the core's point and the normal.

    If ``axis`` is not zero, the gap is measured from the line through the origin along this unit vector.  ``place`` is
    the centre of the core [m], ``hull`` begins with the core numbers of a point, and ``turn`` is the rotation from the
    core's axes.  The search starts in the direction ``start``.
    """
    (x, y, z), (along_x, along_y, along_z), (start_x, start_y, start_z) = place, axis, start
    if is_round(core):
        g, nx, ny, nz = climb(hull, core, turn, place, axis, start)
        mx, my, mz = back(turn, (-nx, -ny, -nz))
        s = support_of(core, (mx, my, mz))
        px, py, pz = forth(turn, (s[1], s[2], s[3]))
        return g, x + px, y + py, z + pz, nx, ny, nz
    if along_x == 0.0 and along_y == 0.0 and along_z == 0.0:
        point = (0.0, 0.0, 0.0, 2.0, 2.0, 0.0)
        found: Answer = widest_of_round(point, core, turn, x, y, z, start_x, start_y, start_z)
        return found
    along = start_x * along_x + start_y * along_y + start_z * along_z
    nx, ny, nz = start_x - along * along_x, start_y - along * along_y, start_z - along * along_z
    length = math.sqrt(nx * nx + ny * ny + nz * nz)
    if length == 0.0:
        return math.nan, x, y, z, start_x, start_y, start_z
    nx, ny, nz = nx / length, ny / length, nz / length
    over: Answer = across_line(core, turn, place, axis, (nx, ny, nz), 1.0, 0.0, 0.0)
    return over


@compiled
def write_surface(out: Floats, side: int, core: Floats, axes: Axes, normal: Vector3, p: Vector3) -> None:
    """Write the curvature matrices of a core of any kind at its surface point p with the outward normal ``normal``.

    Point and normal are in the core's axes.  ``side`` is the index of the matrices in the geometry block ``out``;
    ``axes`` are the core's axes in the world.
    """
    (nx, ny, nz), (px, py, pz) = normal, p
    if is_mixed(core):
        write_chart(out, side, core, axes, nx, ny, nz)
    elif is_boxy(core):
        write_boxy(out, side, core, axes, px, py, pz)
    else:
        write_core(out, side, core, axes, nx, ny, nz)
