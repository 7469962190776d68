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
from nonsmooth.engine.memory.blocks import NORMAL, TANGENT
from nonsmooth.types import Floats

from ...shapes.support_function import support_by
from ...vectors import vector_at
from ..features.frames import tangent_of
from .boxy_newton import Norm, Point
from .smooth_core import RADIUS, Axes, back, bend

_FLATTEST = 1e-12
"""Least curvature that is written, relative to 1 / size: on a plane, the engine divides by the body's curvature."""

Symmetric: TypeAlias = tuple[float, float, float]
"""Elements 11, 12 and 22 of a symmetric matrix."""
Chart: TypeAlias = tuple[Point, Point, Point, Point, Symmetric, Symmetric, Point, Point, Point]
"""Point, outward normal, two tangents, S [1/m] and U along them, w, and its derivatives for eps along either."""


@compiled
def _part(one: float, two: float, power: float) -> tuple[float, float, float]:
    """Return both components of the vector (one, two) divided by its p-norm, and this norm; p = ``power`` >= 2."""
    larger, smaller = max(abs(one), abs(two)), min(abs(one), abs(two))
    if larger == 0.0:
        return 1.0, 0.0, 0.0
    norm = larger * (1.0 + (smaller / larger) ** power) ** (1.0 / power)
    return one / norm, two / norm, norm


@compiled
def _dual(one: float, power: float) -> float:
    return math.copysign(abs(one) ** (power - 1.0), one)


@compiled
def start_of(core: Norm, nx: float, ny: float, nz: float) -> Point:
    """Return the chart's vector w (see the module) at the core's surface point with the outward unit normal n."""
    a, b, c, p, q = core
    if p == 2.0 and q == 2.0:
        return nx, ny, nz
    s = support_by(a, b, c, p, q, nx, ny, nz)
    ux, uy = (a * nx, b * ny) if q >= 2.0 else (s[1] / a, s[2] / b)
    ux, uy, _ = _part(ux, uy, max(q, q / (q - 1.0)))
    _, _, normal = _part(a * nx, b * ny, q)
    _, _, point = _part(s[1] / a, s[2] / b, q / (q - 1.0))
    across, along = (normal, c * nz) if p >= 2.0 else (point, s[3] / c)
    across, along, _ = _part(across, along, max(p, p / (p - 1.0)))
    return across * ux, across * uy, along


@compiled
def chart_of(core: Norm, length: float, x: float, y: float, z: float) -> Chart:
    """Return the surface at the vector w = (x, y, z) of any length, without the radius; ``length`` is L [m].

    Of an ellipsoid, which may be flat or a point, w is the normal.
    """
    a, b, c, p, q = core
    if p == 2.0 and q == 2.0:
        found: Chart = _of_ellipsoid(a, b, c, length, x, y, z)
        return found
    # u and its dual, their derivatives round the section; the same along the third axis
    k = max(q, q / (q - 1.0))
    ux, uy, across = _part(x, y, k)
    vx, vy = _dual(ux, k), _dual(uy, k)
    wx, wy = -vy, vx
    ox, oy = (k - 1.0) * abs(ux) ** (k - 2.0) * wx, (k - 1.0) * abs(uy) ** (k - 2.0) * wy
    j = max(p, p / (p - 1.0))
    away, high, _ = _part(across, z, j)
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
    px, py, pz = a * out * sx, b * out * sy, c * up
    mx, my, mz = lean * nx / a, lean * ny / b, rise / c
    size = math.sqrt(mx * mx + my * my + mz * mz)
    mx, my, mz = mx / size, my / size, mz / size
    first, second = tangent_of((mx, my, mz)), (0.0, 0.0, 0.0)
    second = (my * first[2] - mz * first[1], mz * first[0] - mx * first[2], mx * first[1] - my * first[0])
    # the point's and the normal's derivatives along both tangents: round the section, then along
    ex, ey = a * round_s * tx, b * round_s * ty
    x11, x21 = first[0] * ex + first[1] * ey, second[0] * ex + second[1] * ey
    ex, ey, ez = a * d_out * sx, b * d_out * sy, c * d_up
    x12, x22 = first[0] * ex + first[1] * ey + first[2] * ez, second[0] * ex + second[1] * ey + second[2] * ez
    ex, ey = round_n * rx / a / size, round_n * ry / b / size
    n11, n21 = first[0] * ex + first[1] * ey, second[0] * ex + second[1] * ey
    ex, ey, ez = d_lean * nx / a / size, d_lean * ny / b / size, d_rise / c / size
    n12, n22 = first[0] * ex + first[1] * ey + first[2] * ez, second[0] * ex + second[1] * ey + second[2] * ez
    # the inverse of X + L N
    i11, i12, i21, i22 = x22 + length * n22, -x12 - length * n12, -x21 - length * n21, x11 + length * n11
    det = i11 * i22 - i12 * i21
    if det == 0.0:
        # on the third axis: flat, or sharp
        i = 1.0 / length if p >= 2.0 else 0.0
        o = 1.0 - length * i
        ex, ey = (a / (c * length), b / (c * length)) if p >= 2.0 else (1.0 / a, 1.0 / b)
        way, beside = (ex * first[0], ey * first[1], 0.0), (ex * second[0], ey * second[1], 0.0)
        flat, sharp = (i, 0.0, i), (o, 0.0, o)
        return (px, py, pz), (mx, my, mz), first, second, flat, sharp, (away * ux, away * uy, high), way, beside
    i11, i12, i21, i22 = i11 / det, i12 / det, i21 / det, i22 / det
    slide = n11 * i11 + n12 * i21, 0.5 * (n11 * i12 + n12 * i22 + n21 * i11 + n22 * i21), n21 * i12 + n22 * i22
    turn = x11 * i11 + x12 * i21, 0.5 * (x11 * i12 + x12 * i22 + x21 * i11 + x22 * i21), x21 * i12 + x22 * i22
    along = (i11 * wx + i21 * dl * ux, i11 * wy + i21 * dl * uy, i21 * dh)
    beside = (i12 * wx + i22 * dl * ux, i12 * wy + i22 * dl * uy, i22 * dh)
    return (px, py, pz), (mx, my, mz), first, second, slide, turn, (away * ux, away * uy, high), along, beside


@compiled
def _of_ellipsoid(a: float, b: float, c: float, length: float, x: float, y: float, z: float) -> Chart:
    size = math.sqrt(x * x + y * y + z * z)
    n = x / size, y / size, z / size
    h = support_by(a, b, c, 2.0, 2.0, n[0], n[1], n[2])
    t = tangent_of((n[0], n[1], n[2]))
    u = n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]
    # S is 1 / (H + L)
    h11, h12 = bend(h, t[0], t[1], t[2], t[0], t[1], t[2]) + length, bend(h, t[0], t[1], t[2], u[0], u[1], u[2])
    h22 = bend(h, u[0], u[1], u[2], u[0], u[1], u[2]) + length
    det = h11 * h22 - h12 * h12
    s11, s12, s22 = h22 / det, -h12 / det, h11 / det
    slide, turn = (s11, s12, s22), (1.0 - length * s11, -length * s12, 1.0 - length * s22)
    along = (s11 * t[0] + s12 * u[0], s11 * t[1] + s12 * u[1], s11 * t[2] + s12 * u[2])
    beside = (s12 * t[0] + s22 * u[0], s12 * t[1] + s22 * u[1], s12 * t[2] + s22 * u[2])
    return (h[1], h[2], h[3]), n, t, u, slide, turn, n, along, beside


@compiled
def write_chart(out: Floats, side: int, core: Floats, axes: Axes, nx: float, ny: float, nz: float) -> None:
    """Write the curvature matrices of a core at the surface point with the outward normal (nx, ny, nz).

    The normal is in the axes of the core.  The matrices slide [1/m] and turn [1] satisfy slide u = turn nu: if the
    contact point moves by u along the surface [m], the normal turns by nu.  The geometry block ``out`` must already
    hold normal and first tangent; ``axes`` are the core's axes in the world.
    """
    norm, size = (core[0], core[1], core[2], core[3], core[4]), max(core[0], core[1], core[2])
    w = start_of(norm, nx, ny, nz)
    _, _, first, second, slide, turn, _, _, _ = chart_of(norm, size, w[0], w[1], w[2])
    tx, ty, tz = back(axes, vector_at(out, TANGENT))
    ux, uy, uz = back(
        axes,
        (
            out[NORMAL + 1] * out[TANGENT + 2] - out[NORMAL + 2] * out[TANGENT + 1],
            out[NORMAL + 2] * out[TANGENT] - out[NORMAL] * out[TANGENT + 2],
            out[NORMAL] * out[TANGENT + 1] - out[NORMAL + 1] * out[TANGENT],
        ),
    )
    c11 = tx * first[0] + ty * first[1] + tz * first[2]
    c12 = tx * second[0] + ty * second[1] + tz * second[2]
    c21 = ux * first[0] + uy * first[1] + uz * first[2]
    c22 = ux * second[0] + uy * second[1] + uz * second[2]
    s11, s12, s22 = turned_matrix(c11, c12, c21, c22, slide)
    t11, t12, t22 = turned_matrix(c11, c12, c21, c22, turn)
    # with a radius r the turn grows by r times the slide
    t11, t12, t22 = t11 + core[RADIUS] * s11, t12 + core[RADIUS] * s12, t22 + core[RADIUS] * s22
    least = _FLATTEST / size
    out[side], out[side + 3] = s11 + least * t11, s22 + least * t22
    out[side + 1] = out[side + 2] = s12 + least * t12
    out[side + 4], out[side + 7] = t11, t22
    out[side + 5] = out[side + 6] = t12


@compiled
def turned_matrix(c11: float, c12: float, c21: float, c22: float, s: Symmetric) -> Symmetric:
    """Return C S C^T."""
    e11, e12, e21, e22 = (
        c11 * s[0] + c12 * s[1],
        c11 * s[1] + c12 * s[2],
        c21 * s[0] + c22 * s[1],
        c21 * s[1] + c22 * s[2],
    )
    return e11 * c11 + e12 * c12, e11 * c21 + e12 * c22, e21 * c21 + e22 * c22
