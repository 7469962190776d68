"""The path of a slip under one normal impulse, whose direction turns: Keller's equations.

With the Delassus matrix G of the contact, b = G_nn, c = G_tn and A = G_tt, the slip s changes with the normal impulse p
by c - mu A e, e = s / |s|.  Over the parameter of dp = |s| dparameter its direction and the logarithm of its length
change by smooth functions of the direction alone, also where it ends.
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
"""Turning below this part of what the impulses do is none."""
_SINGULAR = 1e-14
"""Determinant in units of the square of the trace that is none: in a mechanism a contact may slip one way alone."""
_LEAST = 1e-300


@compiled
def way_of_slip(angle: float, g: Matrix, mu: float) -> tuple[float, float]:
    """Return how fast a slip of a direction turns, and how fast it grows by parts of itself."""
    x, y = math.cos(angle), math.sin(angle)
    along, across = g[3] - mu * (g[4] * x + g[5] * y), g[6] - mu * (g[7] * x + g[8] * y)
    return y * -along + x * across, x * along + y * across


@compiled
def runs_straight(angle: float, g: Matrix, mu: float) -> bool:
    """Tell whether a slip of a direction keeps it."""
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
    """Return where the path leads in a step ``h`` of its parameter, by the classical method of Runge and Kutta."""
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
    """Return the tangential impulse of a unit of the normal one where nothing slips: it sticks, or starts to slip.

    With friction opposing it the slip starts along the one direction e in which c - mu A e = l e, l > 0, does not turn.
    """
    a, b, d = g[4], 0.5 * (g[5] + g[7]), g[8]
    x, y = _solved(a, b, d, g[3], g[6])
    if math.hypot(x, y) <= mu:
        return -x, -y
    # (l + mu A) e = c has |e| = 1 between none and all that the normal impulse pushes
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
    """Return the solution of the symmetric system [[a, b], [b, d]] by (x, y), where singular that of least norm."""
    determinant, trace = a * d - b * b, a + d
    if determinant <= _SINGULAR * trace * trace:
        square = max(trace * trace, _LEAST)
        return (a * x + b * y) / square, (b * x + d * y) / square
    return (d * x - b * y) / determinant, (a * y - b * x) / determinant
