"""The support function of a core (:func:`bodies.shapes.smooth.core_numbers`) with its derivatives."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import call_support, compiled
from nonsmooth.types import ReadFloats

from ..vectors import Vector3, cross, dot, plus, plus_scaled, scaled

Core: TypeAlias = ReadFloats
"""The numbers of a core, which functions only read."""
Bends: TypeAlias = tuple[float, float, float, float, float, float]
"""Second derivative of a support function [m] or of a gauge, by its elements xx, yy, zz, yz, xz and xy."""
Support: TypeAlias = tuple[float, Vector3, Bends]
"""Support function h [m], its gradient, which is the farthest point [m], and its second derivative [m]."""
_NONE = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
_UNKNOWN = math.nan, math.nan, math.nan, math.nan, math.nan, math.nan

OF_FUNCTION = math.inf
"""Marker in place of the powers of a core: the farthest points come from a user's function.

No core with semi-axes and powers has an infinite power.
"""
FUNCTION = 18
"""Index of the address of the user's function in the numbers of a core; its parameters follow."""
_TURN = 3e-4
"""Step of the finite differences of a user's farthest points [rad].

The differences are of fourth order: their error is of the order of step^4, 1e-14 of the size.
"""


@compiled
def support_of(core: Core, n: Vector3) -> Support:
    """Return the support function of the core, without the radius, at the unit vector n of its own axes.

    The second derivative is infinite at the axes of a core that is not round; it is returned as nan for such cores.
    """
    if core[3] == OF_FUNCTION:
        found = _by_function(core, n)
    else:
        found = support_by((core[0], core[1], core[2]), core[3], core[4], n)
    return found


@compiled
def _by_function(core: Core, n: Vector3) -> Support:
    """Return the support function of a core given by a user's function of farthest points.

    The value and the gradient follow from the farthest point.  The second derivative follows from finite differences of
    the farthest points for neighbouring directions.
    """
    x, y, z = n
    p = call_support(core, FUNCTION, x, y, z)
    # t and u: unit vectors that form a right-handed system with the direction
    if abs(z) < 0.7:
        length = math.sqrt(x * x + y * y)
        t = -y / length, x / length, 0.0
    else:
        length = math.sqrt(y * y + z * z)
        t = 0.0, -z / length, y / length
    u = cross(n, t)
    a, b = _slope(core, n, t), _slope(core, n, u)
    tt, uu = dot(a, t), dot(b, u)
    tu = 0.5 * (a[0] * u[0] + a[1] * u[1] + a[2] * u[2] + b[0] * t[0] + b[1] * t[1] + b[2] * t[2])
    bends = (
        tt * t[0] * t[0] + 2.0 * tu * t[0] * u[0] + uu * u[0] * u[0],
        tt * t[1] * t[1] + 2.0 * tu * t[1] * u[1] + uu * u[1] * u[1],
        tt * t[2] * t[2] + 2.0 * tu * t[2] * u[2] + uu * u[2] * u[2],
        tt * t[1] * t[2] + tu * (t[1] * u[2] + t[2] * u[1]) + uu * u[1] * u[2],
        tt * t[0] * t[2] + tu * (t[0] * u[2] + t[2] * u[0]) + uu * u[0] * u[2],
        tt * t[0] * t[1] + tu * (t[0] * u[1] + t[1] * u[0]) + uu * u[0] * u[1],
    )
    return dot(n, p), p, bends


@compiled
def _slope(core: Core, n: Vector3, t: Vector3) -> Vector3:
    """Return the derivative of the farthest point by the angle, as the direction n turns towards t across it."""
    slope = 0.0, 0.0, 0.0
    for i in range(-2, 3):
        if i != 0:
            weight = (8.0 if abs(i) == 1 else -1.0) * (1.0 if i > 0 else -1.0) / (12.0 * _TURN)
            x, y, z = plus(scaled(math.cos(i * _TURN), n), scaled(math.sin(i * _TURN), t))
            slope = plus_scaled(slope, weight, call_support(core, FUNCTION, x, y, z))
    return slope


@compiled
def support_by(semi: Vector3, p: float, q: float, n: Vector3) -> Support:
    """Return the support function of a core given by its semi-axes [m] and powers p and q, at a unit vector."""
    if semi[0] == 0.0:
        return 0.0, (0.0, 0.0, 0.0), _NONE
    if p < 2.0 or q < 2.0:
        h, point = _norm_and_gradient(semi, p, q, n)
        return h, point, _UNKNOWN
    return norm_of(semi, p, q, n)


@compiled
def is_boxy(core: Core) -> bool:
    """Return whether the gauge of a core has a second derivative rather than its support function: flat points."""
    return core[0] > 0.0 and core[3] < 2.0 and core[4] <= 2.0


@compiled
def is_round(core: Core) -> bool:
    """Return whether the support function of a core has a second derivative: no flat points."""
    return core[0] == 0.0 or min(core[3], core[4]) >= 2.0


@compiled
def is_mixed(core: Core) -> bool:
    """Return whether a core has both flat and sharp places: of its powers, one is below 2 and the other above 2."""
    return core[0] > 0.0 and (core[3] - 2.0) * (core[4] - 2.0) < 0.0


@compiled
def boxy_gauge_of(core: Core, point: Vector3) -> Support:
    """Return the gauge of a boxy core, by how much it has to grow to reach a point, and its derivatives.

    The gauge is the dual norm of the support function, with the powers p / (p - 1) and q / (q - 1), which are 2 and
    more.
    """
    p, q = core[3] / (core[3] - 1.0), core[4] / (core[4] - 1.0)
    return norm_of((1.0 / core[0], 1.0 / core[1], 1.0 / core[2]), p, q, point)


@compiled
def _norm_and_gradient(semi: Vector3, p: float, q: float, n: Vector3) -> tuple[float, Vector3]:
    """Return the support function of a superellipsoid [m] and its gradient [m].

    The support function is h = ((|a x|^q + |b y|^q)^(p/q) + |c z|^p)^(1/p), with semi-axes a, b, c [m] and powers p and
    q above 1.
    """
    (a, b, c), (x, y, z) = semi, n
    ax, by, cz = a * abs(x), b * abs(y), c * abs(z)
    larger, smaller = max(ax, by), min(ax, by)
    r, gx, gy = 0.0, 1.0, 0.0
    if larger > 0.0:
        r = larger * (1.0 + (smaller / larger) ** q) ** (1.0 / q)
        gx, gy = (ax / r) ** (q - 1.0), (by / r) ** (q - 1.0)
    larger, smaller = max(r, cz), min(r, cz)
    h = larger * (1.0 + (smaller / larger) ** p) ** (1.0 / p)
    gr, gz = (r / h) ** (p - 1.0), (cz / h) ** (p - 1.0)
    return h, (math.copysign(a, x) * gr * gx, math.copysign(b, y) * gr * gy, math.copysign(c, z) * gz)


@compiled
def norm_of(semi: Vector3, p: float, q: float, n: Vector3) -> Support:
    """Return the support function of a superellipsoid [m], its gradient and its second derivatives.

    The support function is h = ((|a x|^q + |b y|^q)^(p/q) + |c z|^p)^(1/p), with semi-axes a, b, c [m] and powers p and
    q of at least 2.
    """
    (a, b, c), (x, y, z) = semi, n
    if p == 2.0 and q == 2.0:
        aa, bb, cc = a * a, b * b, c * c
        h = math.sqrt(aa * x * x + bb * y * y + cc * z * z)
        if h == 0.0:
            # a circle along its axis: of all its points the middle of them
            return h, (h, h, h), _NONE
        px, py, pz = aa * x / h, bb * y / h, cc * z / h
        along = (aa - px * px) / h, (bb - py * py) / h, (cc - pz * pz) / h
        return h, (px, py, pz), (*along, -py * pz / h, -px * pz / h, -px * py / h)
    # two norms, one in the other: r of (X, Y), h of (r, Z); every ratio is at most 1
    ax, by, cz = a * abs(x), b * abs(y), c * abs(z)
    larger, smaller = max(ax, by), min(ax, by)
    r = 0.0
    rx, ry = 1.0, 0.0
    if larger > 0.0:
        r = larger * (1.0 + (smaller / larger) ** q) ** (1.0 / q)
        rx, ry = ax / r, by / r
    larger, smaller = max(r, cz), min(r, cz)
    h = larger * (1.0 + (smaller / larger) ** p) ** (1.0 / p)
    hr, hz = r / h, cz / h
    # the factors of the second derivatives, then those of the first
    fx, fy, fr, fz = rx ** (q - 2.0), ry ** (q - 2.0), hr ** (p - 2.0), hz ** (p - 2.0)
    gx, gy, gr, gz = fx * rx, fy * ry, fr * hr, fz * hz
    curve_h, curve_r = (p - 1.0) / h, (q - 1.0) / h * fr
    h_rr, h_zz, h_rz = curve_h * fr * gz * hz, curve_h * fz * gr * hr, -curve_h * gr * gz
    sx, sy, sz = math.copysign(a, x), math.copysign(b, y), math.copysign(c, z)
    bends = (
        a * a * (h_rr * gx * gx + curve_r * fx * gy * ry),
        b * b * (h_rr * gy * gy + curve_r * fy * gx * rx),
        c * c * h_zz,
        sy * sz * h_rz * gy,
        sx * sz * h_rz * gx,
        sx * sy * (h_rr - curve_r) * gx * gy,
    )
    return h, (sx * gr * gx, sy * gr * gy, sz * gz), bends


@compiled
def gauge_of(core: Core, point: Vector3) -> float:
    """Return the factor by which the core, without the radius, must grow about its centre to reach a point.

    It is 0 at the centre, 1 on the surface, and infinite if it is not known.  The point is in the axes of the core.
    The gauge is the norm dual to the support function, with the powers p / (p - 1) and q / (q - 1).
    """
    if core[0] == 0.0 or core[3] == OF_FUNCTION:
        return math.inf
    p, q = core[3] / (core[3] - 1.0), core[4] / (core[4] - 1.0)
    r = ((abs(point[0]) / core[0]) ** q + (abs(point[1]) / core[1]) ** q) ** (1.0 / q)
    return float((r**p + (abs(point[2]) / core[2]) ** p) ** (1.0 / p))
