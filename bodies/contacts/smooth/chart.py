"""A smooth surface in coordinates in which both its point and its normal have derivatives.

The support function of a core is a norm in a norm, of powers p along the third axis and q across it.  Where a power is
2 or more the point is a smooth function of the normal, where it is less the normal is one of the point.  A core that is
flat in one of the two ways and sharp in the other has neither everywhere.  Its chart is a vector w that is the normal
for the one and the point for the other: with k = max(q, q/(q-1)) the part across has the norm k and its dual the
power k - 1, which has a derivative, and the same along.  By the chart's direction eps, a length, the point moves by
U eps and the normal turns by S eps in the tangent plane; U + L S = 1 with a length L, and S / U are the curvatures.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.support_function import Core, support_by
from ...vectors import Vector3, cross, divided, norm, plus, scaled
from ..features.frames import tangent_of
from .smooth_core import RADIUS, Axes, SemiAxes, largest_semi_axis, unit
from .tangent_plane import (
    Symmetric,
    along,
    bends_in_plane,
    determinant,
    from_tangents,
    in_plane,
    tangents_in,
    turned_matrix,
    write_matrices,
)

_FLATTEST = 1e-12
"""Least curvature that is written, relative to 1 / size: on a plane, the engine divides by the body's curvature."""

Chart: TypeAlias = tuple[Vector3, Vector3, Vector3, Vector3, Symmetric, Symmetric, Vector3, Vector3, Vector3]
"""Point, outward normal, two tangents, S [1/m] and U along them, w, and its derivatives for eps along either."""


@compiled
def _part(one: float, two: float, power: float) -> tuple[float, float, float]:
    """Return both components of the vector (one, two) divided by its p-norm, and this norm; p = ``power`` >= 2."""
    larger, smaller = max(abs(one), abs(two)), min(abs(one), abs(two))
    if larger == 0.0:
        return 1.0, 0.0, 0.0
    length = larger * (1.0 + (smaller / larger) ** power) ** (1.0 / power)
    return one / length, two / length, length


@compiled
def _dual(one: float, power: float) -> float:
    return math.copysign(abs(one) ** (power - 1.0), one)


@compiled
def start_of(core: SemiAxes, n: Vector3) -> Vector3:
    """Return the chart's vector w (see the module) at the core's surface point with the outward unit normal n."""
    a, b, c, p, q = core
    if p == 2.0 and q == 2.0:
        return n
    _, s, _ = support_by((a, b, c), p, q, n)
    ux, uy = (a * n[0], b * n[1]) if q >= 2.0 else (s[0] / a, s[1] / b)
    ux, uy, _ = _part(ux, uy, max(q, q / (q - 1.0)))
    _, _, normal = _part(a * n[0], b * n[1], q)
    _, _, point = _part(s[0] / a, s[1] / b, q / (q - 1.0))
    across, up = (normal, c * n[2]) if p >= 2.0 else (point, s[2] / c)
    across, up, _ = _part(across, up, max(p, p / (p - 1.0)))
    return across * ux, across * uy, up


@compiled
def chart_of(core: SemiAxes, length: float, w: Vector3) -> Chart:
    """Return the surface at the vector w of any length, without the radius; ``length`` is L [m].

    Of an ellipsoid, which may be flat or a point, w is the normal.
    """
    a, b, c, p, q = core
    if p == 2.0 and q == 2.0:
        return _of_ellipsoid((a, b, c), length, w)
    # u and its dual, their derivatives round the section; the same along the third axis
    k = max(q, q / (q - 1.0))
    ux, uy, across = _part(w[0], w[1], k)
    vx, vy = _dual(ux, k), _dual(uy, k)
    wx, wy = -vy, vx
    ox, oy = (k - 1.0) * abs(ux) ** (k - 2.0) * wx, (k - 1.0) * abs(uy) ** (k - 2.0) * wy
    j = max(p, p / (p - 1.0))
    away, high, _ = _part(across, w[2], j)
    m, g = _dual(away, j), _dual(high, j)
    dl, dh = -g, m
    dm, dg = (j - 1.0) * abs(away) ** (j - 2.0) * dl, (j - 1.0) * abs(high) ** (j - 2.0) * dh
    # s of the point, n of the normal; a way round the section is an angle times the way from the axis
    sx, sy, tx, ty, nx, ny, rx, ry = ux, uy, wx, wy, vx, vy, ox, oy
    if q >= 2.0:
        sx, sy, tx, ty, nx, ny, rx, ry = vx, vy, ox, oy, ux, uy, wx, wy
    out, up, d_out, d_up, round_s = away, high, dl, dh, 1.0
    lean, rise, d_lean, d_rise, round_n = m, g, dm, dg, away ** (j - 2.0)
    if p >= 2.0:
        out, up, d_out, d_up, round_s = m, g, dm, dg, round_n
        lean, rise, d_lean, d_rise, round_n = away, high, dl, dh, 1.0
    point, w = (a * out * sx, b * out * sy, c * up), (away * ux, away * uy, high)
    normal = lean * nx / a, lean * ny / b, rise / c
    size = norm(normal)
    normal = divided(normal, size)
    first = tangent_of(normal)
    second = cross(normal, first)
    # the point's and the normal's derivatives along both tangents: round the section, then along
    x11, x21 = in_plane(first, second, (a * round_s * tx, b * round_s * ty, 0.0))
    x12, x22 = in_plane(first, second, (a * d_out * sx, b * d_out * sy, c * d_up))
    n11, n21 = in_plane(first, second, (round_n * rx / a / size, round_n * ry / b / size, 0.0))
    n12, n22 = in_plane(first, second, (d_lean * nx / a / size, d_lean * ny / b / size, d_rise / c / size))
    # the inverse of X + L N
    i11, i12, i21, i22 = x22 + length * n22, -x12 - length * n12, -x21 - length * n21, x11 + length * n11
    det = determinant((i11, i12, i21, i22))
    if det == 0.0:
        # on the third axis: flat, or sharp
        i = 1.0 / length if p >= 2.0 else 0.0
        o = 1.0 - length * i
        ex, ey = (a / (c * length), b / (c * length)) if p >= 2.0 else (1.0 / a, 1.0 / b)
        way, beside = (ex * first[0], ey * first[1], 0.0), (ex * second[0], ey * second[1], 0.0)
        return point, normal, first, second, (i, 0.0, i), (o, 0.0, o), w, way, beside
    i11, i12, i21, i22 = i11 / det, i12 / det, i21 / det, i22 / det
    slide = n11 * i11 + n12 * i21, 0.5 * (n11 * i12 + n12 * i22 + n21 * i11 + n22 * i21), n21 * i12 + n22 * i22
    turn = x11 * i11 + x12 * i21, 0.5 * (x11 * i12 + x12 * i22 + x21 * i11 + x22 * i21), x21 * i12 + x22 * i22
    way = i11 * wx + i21 * dl * ux, i11 * wy + i21 * dl * uy, i21 * dh
    beside = i12 * wx + i22 * dl * ux, i12 * wy + i22 * dl * uy, i22 * dh
    return point, normal, first, second, slide, turn, w, way, beside


@compiled
def _of_ellipsoid(semi: Vector3, length: float, w: Vector3) -> Chart:
    n = unit(w)
    _, point, bends = support_by(semi, 2.0, 2.0, n)
    t = tangent_of(n)
    u = cross(n, t)
    # S is 1 / (H + L)
    h11, h12, h22 = bends_in_plane(bends, t, u)
    h11, h22 = h11 + length, h22 + length
    det = h11 * h22 - h12 * h12
    s11, s12, s22 = h22 / det, -h12 / det, h11 / det
    slide, turn = (s11, s12, s22), (1.0 - length * s11, -length * s12, 1.0 - length * s22)
    return point, n, t, u, slide, turn, n, along((s11, s12), t, u), along((s12, s22), t, u)


@compiled
def write_chart(out: Floats, side: int, core: Core, axes: Axes, normal: Vector3) -> None:
    """Write the curvature matrices of a core at the surface point with the outward unit normal ``normal``.

    The normal is in the axes of the core.  The matrices are slide [1/m] and turn [1].  The geometry block ``out`` must
    already hold normal and first tangent; ``axes`` are the core's axes in the world.
    """
    length, size = (core[0], core[1], core[2], core[3], core[4]), largest_semi_axis(core)
    _, _, first, second, slide, turn, _, _, _ = chart_of(length, size, start_of(length, normal))
    t, u = tangents_in(axes, out)
    c = from_tangents(t, u, first, second)
    slide = turned_matrix(c, slide)
    # with a radius r the turn grows by r times the slide
    turn = plus(turned_matrix(c, turn), scaled(core[RADIUS], slide))
    write_matrices(out, side, plus(slide, scaled(_FLATTEST / size, turn)), turn)
