"""The support function of a core (:func:`bodies.shapes.smooth.core_numbers`) with its derivatives."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import call_support, compiled
from nonsmooth.types import Floats

from ..vectors import Vector3

Support: TypeAlias = tuple[float, float, float, float, float, float, float, float, float, float]
"""Support function h [m] and its derivatives: ten numbers.

The gradient of h (3) is the farthest point [m].  The second derivative of h follows, by its elements xx, yy, zz, yz, xz
and xy [m].
"""


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
def support_of(core: Floats, n: Vector3) -> Support:
    """Return the support function of the core, without the radius, at the unit vector n of its own axes.

    The second derivative is infinite at the axes of a core that is not round; it is returned as nan for such cores.
    """
    x, y, z = n
    if core[3] == OF_FUNCTION:
        found: Support = _by_function(core, x, y, z)
    else:
        found = support_by(core[0], core[1], core[2], core[3], core[4], x, y, z)
    return found


@compiled
def _by_function(core: Floats, x: float, y: float, z: float) -> Support:
    """Return the support function of a core given by a user's function of farthest points.

    The value and the gradient follow from the farthest point.  The second derivative follows from finite differences of
    the farthest points for neighbouring directions.
    """
    px, py, pz = call_support(core, FUNCTION, x, y, z)
    # t and u: unit vectors that form a right-handed system with the direction
    if abs(z) < 0.7:
        length = math.sqrt(x * x + y * y)
        tx, ty, tz = -y / length, x / length, 0.0
    else:
        length = math.sqrt(y * y + z * z)
        tx, ty, tz = 0.0, -z / length, y / length
    ux, uy, uz = y * tz - z * ty, z * tx - x * tz, x * ty - y * tx
    ax, ay, az = _slope(core, x, y, z, tx, ty, tz)
    bx, by, bz = _slope(core, x, y, z, ux, uy, uz)
    tt, uu = ax * tx + ay * ty + az * tz, bx * ux + by * uy + bz * uz
    tu = 0.5 * (ax * ux + ay * uy + az * uz + bx * tx + by * ty + bz * tz)
    return (
        x * px + y * py + z * pz,
        px,
        py,
        pz,
        tt * tx * tx + 2.0 * tu * tx * ux + uu * ux * ux,
        tt * ty * ty + 2.0 * tu * ty * uy + uu * uy * uy,
        tt * tz * tz + 2.0 * tu * tz * uz + uu * uz * uz,
        tt * ty * tz + tu * (ty * uz + tz * uy) + uu * uy * uz,
        tt * tx * tz + tu * (tx * uz + tz * ux) + uu * ux * uz,
        tt * tx * ty + tu * (tx * uy + ty * ux) + uu * ux * uy,
    )


@compiled
def _slope(core: Floats, x: float, y: float, z: float, tx: float, ty: float, tz: float) -> tuple[float, float, float]:
    """Return the derivative of the farthest point by the angle, as the direction turns towards the perpendicular t."""
    sx, sy, sz = 0.0, 0.0, 0.0
    for i in range(-2, 3):
        if i != 0:
            weight = (8.0 if abs(i) == 1 else -1.0) * (1.0 if i > 0 else -1.0) / (12.0 * _TURN)
            c, s = math.cos(i * _TURN), math.sin(i * _TURN)
            px, py, pz = call_support(core, FUNCTION, c * x + s * tx, c * y + s * ty, c * z + s * tz)
            sx, sy, sz = sx + weight * px, sy + weight * py, sz + weight * pz
    return sx, sy, sz


@compiled
def support_by(a: float, b: float, c: float, p: float, q: float, x: float, y: float, z: float) -> Support:
    """Return the support function of a core given by semi-axes a, b, c and powers p, q, at a unit vector."""
    if a == 0.0:
        h = 0.0
        return h, h, h, h, h, h, h, h, h, h
    if p < 2.0 or q < 2.0:
        h, px, py, pz = _norm_and_gradient(a, b, c, p, q, x, y, z)
        none = math.nan
        return h, px, py, pz, none, none, none, none, none, none
    found: Support = norm_of(a, b, c, p, q, x, y, z)
    return found


@compiled
def is_boxy(core: Floats) -> bool:
    """Return whether the gauge of a core has a second derivative rather than its support function: flat points."""
    return core[0] > 0.0 and core[3] < 2.0 and core[4] <= 2.0


@compiled
def is_round(core: Floats) -> bool:
    """Return whether the support function of a core has a second derivative: no flat points."""
    return core[0] == 0.0 or min(core[3], core[4]) >= 2.0


@compiled
def is_mixed(core: Floats) -> bool:
    """Return whether a core has both flat and sharp places: of its powers, one is below 2 and the other above 2."""
    return core[0] > 0.0 and (core[3] - 2.0) * (core[4] - 2.0) < 0.0


@compiled
def boxy_gauge_of(core: Floats, x: float, y: float, z: float) -> Support:
    """Return the gauge of a boxy core, by how much it has to grow to reach (x, y, z), and its derivatives.

    The gauge is the dual norm of the support function, with the powers p / (p - 1) and q / (q - 1), which are 2 and
    more.
    """
    p, q = core[3] / (core[3] - 1.0), core[4] / (core[4] - 1.0)
    found: Support = norm_of(1.0 / core[0], 1.0 / core[1], 1.0 / core[2], p, q, x, y, z)
    return found


@compiled
def _norm_and_gradient(
    a: float, b: float, c: float, p: float, q: float, x: float, y: float, z: float
) -> tuple[float, float, float, float]:
    """Return the support function of a superellipsoid [m] and its gradient [m].

    The support function is h = ((|a x|^q + |b y|^q)^(p/q) + |c z|^p)^(1/p), with semi-axes a, b, c [m] and powers p and
    q above 1.
    """
    ax, by, cz = a * abs(x), b * abs(y), c * abs(z)
    larger, smaller = max(ax, by), min(ax, by)
    r, gx, gy = 0.0, 1.0, 0.0
    if larger > 0.0:
        r = larger * (1.0 + (smaller / larger) ** q) ** (1.0 / q)
        gx, gy = (ax / r) ** (q - 1.0), (by / r) ** (q - 1.0)
    larger, smaller = max(r, cz), min(r, cz)
    h = larger * (1.0 + (smaller / larger) ** p) ** (1.0 / p)
    gr, gz = (r / h) ** (p - 1.0), (cz / h) ** (p - 1.0)
    return h, math.copysign(a, x) * gr * gx, math.copysign(b, y) * gr * gy, math.copysign(c, z) * gz


@compiled
def norm_of(a: float, b: float, c: float, p: float, q: float, x: float, y: float, z: float) -> Support:
    """Return the support function of a superellipsoid [m], its gradient and its second derivatives.

    The support function is h = ((|a x|^q + |b y|^q)^(p/q) + |c z|^p)^(1/p), with semi-axes a, b, c [m] and powers p and
    q of at least 2.
    """
    if p == 2.0 and q == 2.0:
        aa, bb, cc = a * a, b * b, c * c
        h = math.sqrt(aa * x * x + bb * y * y + cc * z * z)
        if h == 0.0:
            # a circle along its axis: of all its points the middle of them
            return h, h, h, h, h, h, h, h, h, h
        px, py, pz = aa * x / h, bb * y / h, cc * z / h
        return (
            h,
            px,
            py,
            pz,
            (aa - px * px) / h,
            (bb - py * py) / h,
            (cc - pz * pz) / h,
            -py * pz / h,
            -px * pz / h,
            -px * py / h,
        )
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
    return (
        h,
        sx * gr * gx,
        sy * gr * gy,
        sz * gz,
        a * a * (h_rr * gx * gx + curve_r * fx * gy * ry),
        b * b * (h_rr * gy * gy + curve_r * fy * gx * rx),
        c * c * h_zz,
        sy * sz * h_rz * gy,
        sx * sz * h_rz * gx,
        sx * sy * (h_rr - curve_r) * gx * gy,
    )


@compiled
def gauge_of(core: Floats, x: float, y: float, z: float) -> float:
    """Return the factor by which the core, without the radius, must grow about its centre to reach (x, y, z).

    It is 0 at the centre, 1 on the surface, and infinite if it is not known.  The point is in the axes of the core.
    The gauge is the norm dual to the support function, with the powers p / (p - 1) and q / (q - 1).
    """
    if core[0] == 0.0 or core[3] == OF_FUNCTION:
        return math.inf
    p, q = core[3] / (core[3] - 1.0), core[4] / (core[4] - 1.0)
    r = ((abs(x) / core[0]) ** q + (abs(y) / core[1]) ** q) ** (1.0 / q)
    return float((r**p + (abs(z) / core[2]) ** p) ** (1.0 / p))
