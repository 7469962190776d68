"""A boxy body and a straight line, the continuation of an edge: one angle, and no second derivative.

The normal n goes round the line, at a right angle or, about the axis of a cone, at another.  With p the body's
farthest point against it, the derivative of the gap g(n) is that of the normal times p; between two directions where it
has opposite signs a search halves what is left until the directions are the same to round-off, however flat the body
is.
"""

from __future__ import annotations

import math

from bodies.contacts.boxy_newton import Answer, Point
from bodies.contacts.chart import chart_of, start_of
from bodies.contacts.smooth_core import Axes, back, forth
from bodies.shapes.support_function import support_of
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

_LOOKS = 8
"""Directions of the first look."""
_STEPS = 200
_CLOSED = 4e-16
"""Angle between directions that are the same [rad]."""

_ROUND_OFF = 4e-16
"""Derivative that is none, in units of the size."""
_PATIENCE = 3
"""Steps that leave more than half of the angle, one after the other."""
_REFINEMENTS = 4
"""Steps of Newton's method from a point that is right to some digits."""
_ASTRAY = 0.1
"""Step that is no refinement, in units of the body."""


@compiled
def across_line(
    core: Floats,
    turn: Axes,
    x: float,
    y: float,
    z: float,
    ex: float,
    ey: float,
    ez: float,
    nx: float,
    ny: float,
    nz: float,
    cosine: float,
    sine: float,
    reach: float,
) -> Answer:
    """Return the largest gap of a line through the origin and a boxy core, the core's point and the line's normal.

    All in the axes of the line's body; the gap is nan where none was found.  With a reach it is the gap of the cylinder
    about the line, with a sine as well that of the cone whose normals lean so much along the line.

    Parameters
    ----------
    core : Floats
        The boxy core; its radius is left out.
    turn : Axes
        Rotation from the axes of the core to those of the line's body.
    x, y, z : float
        The core's centre [m].
    ex, ey, ez : float
        Direction of the line, a unit vector.
    nx, ny, nz : float
        A unit vector across it, in whose half the normal is sought.
    cosine, sine : float
        Part of the normal across the line, 1 but for a cone, and along it, 0 but for a cone.
    reach : float
        Height of the surface about the line over the origin along its normals [m], 0 of the line itself.
    """
    spread = math.pi / _LOOKS
    found = _look(core, turn, x, y, z, ex, ey, ez, nx, ny, nz, cosine, sine, 0.0)
    # uphill from the given direction, and from the best of all where the surface is not outside of the body there
    at, low, high, rising, falling, most = 0, 0.0, 0.0, found[7], found[7], found[0]
    way = 1 if found[7] > 0.0 else -1
    for i in range(1, _LOOKS // 2 + 2):
        look = _look(core, turn, x, y, z, ex, ey, ez, nx, ny, nz, cosine, sine, way * i * spread)
        most = max(most, look[0])
        low, high = (high, i * spread) if way > 0 else (-i * spread, low)
        rising, falling = (falling, look[7]) if way > 0 else (look[7], rising)
        if rising > 0.0 > falling:
            break
    if most <= reach:
        best, last = -math.inf, math.nan
        for i in range(-_LOOKS // 2 - 1, _LOOKS // 2 + 2):
            look = _look(core, turn, x, y, z, ex, ey, ez, nx, ny, nz, cosine, sine, i * spread)
            if look[0] > best and abs(i) <= _LOOKS // 2:
                best, at, rising = look[0], i, last
            elif at == i - 1:
                falling = look[7]
            last = look[7]
        low, high = (at - 1) * spread, (at + 1) * spread
    if not (rising > 0.0 > falling):
        return math.nan, found[1], found[2], found[3], found[4], found[5], found[6]
    none = _ROUND_OFF * (abs(x) + abs(y) + abs(z) + max(core[0], core[1], core[2]))
    side, slow = 0, 0
    for _ in range(_STEPS):
        width = high - low
        # where the derivative jumps, as it nearly does at a flat place, the secant does not get on
        middle = (low * falling - high * rising) / (falling - rising)
        if slow >= _PATIENCE or not (low < middle < high):
            middle, slow = 0.5 * (low + high), 0
        found = _look(core, turn, x, y, z, ex, ey, ez, nx, ny, nz, cosine, sine, middle)
        if abs(found[7]) <= none or width <= _CLOSED or middle == low or middle == high:
            return found[0] - reach, found[1], found[2], found[3], found[4], found[5], found[6]
        if found[7] > 0.0:
            low, rising = middle, found[7]
            falling = 0.5 * falling if side == 1 else falling
            side = 1
        else:
            high, falling = middle, found[7]
            rising = 0.5 * rising if side == -1 else rising
            side = -1
        slow = slow + 1 if high - low > 0.5 * width else 0
    return math.nan, found[1], found[2], found[3], found[4], found[5], found[6]


@compiled
def _look(
    core: Floats,
    turn: Axes,
    x: float,
    y: float,
    z: float,
    ex: float,
    ey: float,
    ez: float,
    nx: float,
    ny: float,
    nz: float,
    cosine: float,
    sine: float,
    angle: float,
) -> tuple[float, float, float, float, float, float, float, float]:
    """Return gap, point, normal and the gap's derivative at an angle."""
    ux, uy, uz = ey * nz - ez * ny, ez * nx - ex * nz, ex * ny - ey * nx
    c, s = cosine * math.cos(angle), cosine * math.sin(angle)
    ax, ay, az = c * nx + s * ux + sine * ex, c * ny + s * uy + sine * ey, c * nz + s * uz + sine * ez
    mx, my, mz = back(turn, -ax, -ay, -az)
    f = support_of(core, mx, my, mz)
    px, py, pz = forth(turn, f[1], f[2], f[3])
    px, py, pz = x + px, y + py, z + pz
    slope = (c * ux - s * nx) * px + (c * uy - s * ny) * py + (c * uz - s * nz) * pz
    return ax * px + ay * py + az * pz, px, py, pz, ax, ay, az, slope


@compiled
def nearest_to_line(
    core: Floats,
    turn: Axes,
    x: float,
    y: float,
    z: float,
    foot: Point,
    ex: float,
    ey: float,
    ez: float,
    sine: float,
    normal: Point,
) -> Point:
    """Return the point of a core that is not round that a line sees, from the outward normal of the line's body there.

    Along a flat place the normal says little of the point; with the lean of the normal along the line, it has to lie
    over it.  All in the axes of the line's body, ``foot`` on the line.
    """
    norm, length = (core[0], core[1], core[2], core[3], core[4]), max(core[0], core[1], core[2])
    lx, ly, lz = back(turn, ex, ey, ez)
    fx, fy, fz = back(turn, foot[0] - x, foot[1] - y, foot[2] - z)
    nx, ny, nz = back(turn, -normal[0], -normal[1], -normal[2])
    w = start_of(norm, nx, ny, nz)
    for _ in range(_REFINEMENTS):
        p, n, t, u, slide, way, w, along, beside = chart_of(norm, length, w[0], w[1], w[2])
        # across the line and the normal
        ax, ay, az = ly * n[2] - lz * n[1], lz * n[0] - lx * n[2], lx * n[1] - ly * n[0]
        wx, wy, wz = p[0] - fx, p[1] - fy, p[2] - fz
        off = ax * wx + ay * wy + az * wz
        lean = n[0] * lx + n[1] * ly + n[2] * lz
        a1, a2 = ax * t[0] + ay * t[1] + az * t[2], ax * u[0] + ay * u[1] + az * u[2]
        l1, l2 = lx * t[0] + ly * t[1] + lz * t[2], lx * u[0] + ly * u[1] + lz * u[2]
        k1, k2 = slide[0] * l1 + slide[1] * l2, slide[1] * l1 + slide[2] * l2
        # as the normal turns, the line goes by at its distance along the normal
        g = wx * n[0] + wy * n[1] + wz * n[2] - lean * (wx * lx + wy * ly + wz * lz)
        g /= max(1.0 - lean * lean, _ROUND_OFF)
        b1 = (way[0] - g * slide[0]) * a1 + (way[1] - g * slide[1]) * a2
        b2 = (way[1] - g * slide[1]) * a1 + (way[2] - g * slide[2]) * a2
        determinant = b1 * k2 - b2 * k1
        tilt = lean + sine
        i, j = b2 * tilt - k2 * off, k1 * off - b1 * tilt
        if abs(i) + abs(j) < _ASTRAY * length * abs(determinant):
            i, j = i / determinant, j / determinant
        else:
            # along a flat line any point has the lean: the nearest one over the line
            square = max(b1 * b1 + b2 * b2, _ROUND_OFF)
            i, j = -off * b1 / square, -off * b2 / square
            if abs(i) + abs(j) > _ASTRAY * length:
                break
        w = (
            w[0] + i * along[0] + j * beside[0],
            w[1] + i * along[1] + j * beside[1],
            w[2] + i * along[2] + j * beside[2],
        )
    p, _, _, _, _, _, _, _, _ = chart_of(norm, length, w[0], w[1], w[2])
    px, py, pz = forth(turn, p[0], p[1], p[2])
    return x + px, y + py, z + pz
