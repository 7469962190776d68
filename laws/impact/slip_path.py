"""Slip velocity during an impact of one contact with friction, by Keller's equations: its direction turns.

G is the Delassus matrix of the contact, with b = G_nn, c = G_tn and A = G_tt.  The slip velocity s changes with the
normal impulse p by ds/dp = c - mu A e, e = s / |s|.  The states that s runs through are the path of the impact.  The
path parameter tau is defined by dp = |s| dtau.  The derivatives of the direction of s and of log |s| by tau are smooth
functions of the direction alone, also at the end of slip.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled

Matrix: TypeAlias = tuple[float, float, float, float, float, float, float, float, float]
"""The Delassus matrix of a contact [1/kg], row by row."""
Path: TypeAlias = tuple[float, float, float, float, float, float, float]
"""State of an impact of one contact: slip angle [rad], slip speed [m/s], impulses n, t1, t2 [N s], gap rate, work.

The gap rate is in [m/s]; the work is the work of the normal impulse [J].
"""

_STRAIGHT = 1e-9
"""Turning rate below which the slip direction is constant during an impact, relative to the Delassus matrix's trace.

The turning rate is the derivative of the slip angle [rad] by the path parameter, in [1/kg] as the matrix.
"""
_SINGULAR = 1e-14
"""Determinant, relative to the squared trace, up to which the Delassus matrix's tangential block counts as singular.

It is singular if the mechanism allows the contact to slip in one direction and its opposite only.
"""
_LEAST = 1e-300


@compiled
def way_of_slip(angle: float, g: Matrix, mu: float) -> tuple[float, float]:
    """Return the derivatives of the slip angle and of the logarithm of the slip speed by the path parameter [1/kg].

    ``angle`` [rad] is the direction of slip.  The path parameter tau is defined at the top of this module.
    """
    x, y = math.cos(angle), math.sin(angle)
    along, across = g[3] - mu * (g[4] * x + g[5] * y), g[6] - mu * (g[7] * x + g[8] * y)
    return y * -along + x * across, x * along + y * across


@compiled
def runs_straight(angle: float, g: Matrix, mu: float) -> bool:
    """Return True if a slip in the direction ``angle`` [rad] keeps its direction during the impact."""
    return bool(abs(way_of_slip(angle, g, mu)[0]) <= _STRAIGHT * (g[0] + g[4] + g[8]))


@compiled
def _rates(path: Path, h: float, by: Path, g: Matrix, mu: float) -> Path:
    """Return the derivatives of all seven components of a state by the path parameter, at the state ``path + h * by``.

    ``by`` holds derivatives of the components, so that this is the state after a step ``h`` of the path parameter.
    """
    angle, slip, rate = path[0] + h * by[0], path[1] + h * by[1], path[5] + h * by[5]
    turning, growing = way_of_slip(angle, g, mu)
    t1, t2 = -mu * math.cos(angle), -mu * math.sin(angle)
    return turning, growing * slip, slip, slip * t1, slip * t2, slip * (g[0] + g[1] * t1 + g[2] * t2), slip * rate


@compiled
def along_path(path: Path, g: Matrix, mu: float, h: float) -> Path:
    """Return the state of the impact after one step ``h`` of the path parameter [kg], from the state ``path``.

    It is one step of the classical method of Runge and Kutta.
    """
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
    """Return the tangential impulse (t1, t2) per unit of normal impulse for a contact that does not slip yet.

    c = G_tn and A = G_tt are blocks of the Delassus matrix G.  If |A^-1 c| <= mu, the contact sticks, and the result is
    -A^-1 c.  Otherwise the contact starts to slip in the direction of a unit vector e, which stays constant, and the
    result is -mu e.  The change of the slip velocity with the normal impulse, c - mu A e, must be in the direction of
    e: c - mu A e = l e with a number l > 0 [1/kg].  There is one such direction.
    """
    a, b, d = g[4], 0.5 * (g[5] + g[7]), g[8]
    x, y = _solved(a, b, d, g[3], g[6])
    if math.hypot(x, y) <= mu:
        return -x, -y
    # seek l with |e| = 1 for e = (l + mu A)^-1 c, by halving of the interval from 0 to |c|
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
    """Return the solution z of [[a, b], [b, d]] z = (x, y); if the matrix is singular, the solution of least norm."""
    determinant, trace = a * d - b * b, a + d
    if determinant <= _SINGULAR * trace * trace:
        square = max(trace * trace, _LEAST)
        return (a * x + b * y) / square, (b * x + d * y) / square
    return (d * x - b * y) / determinant, (a * y - b * x) / determinant
