"""The top of the gap along directions, by cuts: slower than Newton's method, and without any second derivative."""

from __future__ import annotations

import math

from bodies.contacts.features.tangents import tangent_of
from bodies.contacts.smooth.smooth_core import Axes, back, forth
from bodies.contacts.smooth.smooth_starts import Start
from bodies.shapes.support_function import support_of
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

_CUTS, _WIDE = 400, 0.1
"""Cuts round a top, and the angle that they begin with [rad]."""
_ELLIPSES = 8
"""How often it begins anew where it ended, if that is far from where it began."""
_HIGHER = 1e-16
"""By how much a gap may be larger than the answer, in units of the size."""


@compiled
def _cut_round(circle: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, start: Start) -> Start:
    """Return the top in reach of one ellipse; as in :func:`settle`."""
    best: Start = start
    _, nx, ny, nz = start
    tx, ty, tz = tangent_of(nx, ny, nz)
    ux, uy, uz = ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx
    size = abs(x) + abs(y) + abs(z) + max(core[0], core[1], core[2]) + circle[0]
    i, j, e11, e12, e22 = 0.0, 0.0, _WIDE * _WIDE, 0.0, _WIDE * _WIDE
    for _ in range(_CUTS):
        mx, my, mz = nx + i * tx + j * ux, ny + i * ty + j * uy, nz + i * tz + j * uz
        length = math.sqrt(mx * mx + my * my + mz * mz)
        mx, my, mz = mx / length, my / length, mz / length
        a = support_of(circle, mx, my, mz)
        bx, by, bz = back(turn, -mx, -my, -mz)
        b = support_of(core, bx, by, bz)
        dx, dy, dz = forth(turn, b[1], b[2], b[3])
        dx, dy, dz = x + dx - a[1], y + dy - a[2], z + dz - a[3]
        g = mx * dx + my * dy + mz * dz
        if g > best[0]:
            best = g, mx, my, mz
        dx, dy, dz = (dx - g * mx) / length, (dy - g * my) / length, (dz - g * mz) / length
        r, s = dx * tx + dy * ty + dz * tz, dx * ux + dy * uy + dz * uz
        k, h = e11 * r + e12 * s, e12 * r + e22 * s
        most = r * k + s * h
        if not most > (_HIGHER * size) ** 2:
            break
        most = math.sqrt(most)
        k, h = k / most, h / most
        i, j = i + k / 3.0, j + h / 3.0
        e11, e12, e22 = (e11 - k * k / 1.5) / 0.75, (e12 - k * h / 1.5) / 0.75, (e22 - h * h / 1.5) / 0.75
    return best


@compiled
def settle(circle: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, start: Start) -> Start:
    """Return the top next to a direction, by the ellipsoid method: no ridge is too narrow for it.

    In the plane that touches the sphere of directions at the start, the part of an ellipse on which the gap may be
    larger than in its middle is one half; the least ellipse round that is the next one.  A top far from the start
    is gone to in turns.

    Parameters
    ----------
    circle, core : Floats
        A circle, or a point, and the smooth body, as cores.
    turn : Axes
        Rotation from the axes of the core to those of the circle.
    x, y, z : float
        The core's centre from that of the circle [m].
    start : Start
        Gap and direction to begin with.
    """
    best: Start = start
    for _ in range(_ELLIPSES):
        before = best
        best = _cut_round(circle, core, turn, x, y, z, before)
        if before[1] * best[1] + before[2] * best[2] + before[3] * best[3] > 1.0 - 0.1 * _WIDE * _WIDE:
            break
    return best
