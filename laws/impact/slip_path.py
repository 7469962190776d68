"""The path of the slip velocity in an impact of one contact, in which its direction turns: Keller's equations.

G is the Delassus matrix of the contact, with b = G_nn, c = G_tn and A = G_tt.  The slip velocity s changes with the
normal impulse p by ds/dp = c - mu A e, e = s / |s|.  The path has a parameter with dp = |s| dparameter.  Over it, the
direction of s and the logarithm of its length change by smooth functions of the direction alone, also at the end of
slip.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled

Matrix: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]
"""The Delassus matrix of a contact [1/kg], row by row."""
Path: TypeAlias = tuple[float, float, float, float, float, float, float]
"""Angle [rad] and length [m/s] of the slip, impulses n, t1, t2 [N s], gap rate [m/s], work of the normal one [J]."""

_STRAIGHT = 1e-9
"""A slip whose direction turns more slowly than this, relative to the trace of G, counts as straight."""
_SINGULAR = 1e-14
"""Determinant, relative to the squared trace, below which A is singular: a contact of a mechanism slips in a line."""
_LEAST = 1e-300


@compiled
def way_of_slip(angle: float, g: Matrix, mu: float) -> tuple[float, float]:
    """Return the rates of the angle and of the logarithm of the slip speed over the parameter, for a slip direction."""
    x, y = math.cos(angle), math.sin(angle)
    along, across = g[3] - mu * (g[4] * x + g[5] * y), g[6] - mu * (g[7] * x + g[8] * y)
    return y * -along + x * across, x * along + y * across


@compiled
def runs_straight(angle: float, g: Matrix, mu: float) -> bool:
    """Return True if a slip in this direction does not turn."""
    return bool(abs(way_of_slip(angle, g, mu)[0]) <= _STRAIGHT * (g[0] + g[4] + g[8]))


@compiled
def _rates(path: Path, h: float, by: Path, g: Matrix, mu: float) -> Path:
    """Return the derivatives at ``path + h by``."""
    angle, slip, rate = path[0] + h * by[0], path[1] + h * by[1], path[5] + h * by[5]
    turning, growing = way_of_slip(angle, g, mu)
    t1, t2 = -mu * math.cos(angle), -mu * math.sin(angle)
    return turning, growing * slip, slip, slip * t1, slip * t2, slip * (g[0] + g[1] * t1 + g[2] * t2), slip * rate


@compiled
def along_path(path: Path, g: Matrix, mu: float, h: float) -> Path:
    """Return the path after a step ``h`` of its parameter, by the classical method of Runge and Kutta."""
    a = _rates(path, 0.0, path, g, mu)
    b = _rates(path, 0.5 * h, a, g, mu)
    c = _rates(path, 0.5 * h, b, g, mu)
    d = _rates(path, h, c, g, mu)
    w = h / 6.0
    return (
        path[0] + w * (a[0] + 2.0 * b[0] + 2.0 * c[0] + d[0]),
        path[1] + w * (a[1] + 2.0 * b[1] + 2.0 * c[1] + d[1]),
        path[2] + w * (a[2] + 2.0 * b[2] + 2.0 * c[2] + d[2]),
        path[3] + w * (a[3] + 2.0 * b[3] + 2.0 * c[3] + d[3]),
        path[4] + w * (a[4] + 2.0 * b[4] + 2.0 * c[4] + d[4]),
        path[5] + w * (a[5] + 2.0 * b[5] + 2.0 * c[5] + d[5]),
        path[6] + w * (a[6] + 2.0 * b[6] + 2.0 * c[6] + d[6]),
    )


@compiled
def friction_from_rest(g: Matrix, mu: float) -> tuple[float, float]:
    """Return the tangential impulse per normal impulse for a contact without slip: it sticks or starts to slip.

    If friction cannot hold it, the slip starts along the only direction e that does not turn: c - mu A e = l e, l > 0.
    """
    a, b, d = g[4], 0.5 * (g[5] + g[7]), g[8]
    x, y = _solved(a, b, d, g[3], g[6])
    if math.hypot(x, y) <= mu:
        return -x, -y
    # the l of (l + mu A) e = c with |e| = 1 lies between 0 and |c|
    low, high = 0.0, math.hypot(g[3], g[6])
    for _halving in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        x, y = _solved(mu * a + middle, mu * b, mu * d + middle, g[3], g[6])
        low, high = (middle, high) if x * x + y * y > 1.0 else (low, middle)
    x, y = _solved(mu * a + high, mu * b, mu * d + high, g[3], g[6])
    size = math.hypot(x, y)
    return -mu * x / size, -mu * y / size


@compiled
def _solved(a: float, b: float, d: float, x: float, y: float) -> tuple[float, float]:
    """Return the solution of [[a, b], [b, d]] z = (x, y); if the matrix is singular, the one of least norm."""
    determinant, trace = a * d - b * b, a + d
    if determinant <= _SINGULAR * trace * trace:
        square = max(trace * trace, _LEAST)
        return (a * x + b * y) / square, (b * x + d * y) / square
    return (d * x - b * y) / determinant, (a * y - b * x) / determinant
