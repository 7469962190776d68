"""A smooth surface in coordinates in which both its point and its normal have derivatives.

The support function of a core is a norm in a norm, with the power p along the third axis and q across it.  If a power
is 2 or more, the point is a smooth function of the normal; if it is less, the normal is one of the point.  A core with
one power below 2 and one above has neither everywhere.

The chart is a vector w.  Its part across the axis is that of the normal if q >= 2, else that of the point, scaled by
the semi-axes.  With k = max(q, q / (q - 1)) this part has the k-norm 1.  The other one of normal and point has the dual
part: the components to the power k - 1, which has a derivative because k >= 2.  The parts along the axis follow from p
in the same way.  For a step eps in the tangent plane, a length, the point moves by U eps, and the normal turns by
S eps.  The step is scaled so that U + L S = 1 with a length L; S U^-1 is the matrix of the curvatures.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...rotations import Axes
from ...shapes.support_function import Core, support_by
from ...vectors import Vector3, cross, divided, norm, plus, scaled
from ..features.frames import tangent_of
from .smooth_core import RADIUS, SemiAxes, largest_semi_axis, semi_axes_of, unit
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
"""Point [m], outward normal, two tangents, S [1/m] and U along them, w, and its derivatives along either [1/m]."""


@compiled
def _normalised(x: float, y: float, power: float) -> tuple[float, float, float]:
    """Return both components of the vector (x, y) divided by its p-norm, and this norm; p = ``power`` >= 2.

    For a vector 0, the direction is (1, 0).
    """
    larger, smaller = max(abs(x), abs(y)), min(abs(x), abs(y))
    if larger == 0.0:
        return 1.0, 0.0, 0.0
    length = larger * (1.0 + (smaller / larger) ** power) ** (1.0 / power)
    return x / length, y / length, length


@compiled
def _dual_component(component: float, power: float) -> float:
    """Return the component of the dual of a vector of p-norm 1, p = ``power``: its component to the power p - 1."""
    return math.copysign(abs(component) ** (power - 1.0), component)


@compiled
def start_of(core: SemiAxes, n: Vector3) -> Vector3:
    """Return the chart's vector w (see the module) at the core's surface point with the outward unit normal n."""
    a, b, c, p, q = core
    if p == 2.0 and q == 2.0:
        return n
    _, farthest, _ = support_by((a, b, c), p, q, n)
    ux, uy = (a * n[0], b * n[1]) if q >= 2.0 else (farthest[0] / a, farthest[1] / b)
    ux, uy, _ = _normalised(ux, uy, max(q, q / (q - 1.0)))
    _, _, normal_r = _normalised(a * n[0], b * n[1], q)
    _, _, point_r = _normalised(farthest[0] / a, farthest[1] / b, q / (q - 1.0))
    w_r, w_z = (normal_r, c * n[2]) if p >= 2.0 else (point_r, farthest[2] / c)
    w_r, w_z, _ = _normalised(w_r, w_z, max(p, p / (p - 1.0)))
    return w_r * ux, w_r * uy, w_z


@compiled
def chart_of(core: SemiAxes, length: float, w: Vector3) -> Chart:
    """Return the surface of a core without its radius at the vector w, of any length; ``length`` is L [m].

    For an ellipsoid, which may be flat or a point, w is the normal.
    """
    a, b, c, p, q = core
    if p == 2.0 and q == 2.0:
        return _of_ellipsoid((a, b, c), length, w)
    # across the axis: the direction u of w, its dual v, and their derivatives du and dv round the section
    k = max(q, q / (q - 1.0))
    ux, uy, w_r = _normalised(w[0], w[1], k)
    vx, vy = _dual_component(ux, k), _dual_component(uy, k)
    dux, duy = -vy, vx
    dvx, dvy = (k - 1.0) * abs(ux) ** (k - 2.0) * dux, (k - 1.0) * abs(uy) ** (k - 2.0) * duy
    # the parts r and z of w across and along the axis, their duals, and their derivatives from the axis
    j = max(p, p / (p - 1.0))
    r, z, _ = _normalised(w_r, w[2], j)
    r_dual, z_dual = _dual_component(r, j), _dual_component(z, j)
    dr, dz = -z_dual, r_dual
    dr_dual, dz_dual = (j - 1.0) * abs(r) ** (j - 2.0) * dr, (j - 1.0) * abs(z) ** (j - 2.0) * dz
    # by the powers, point and normal have the directions (px, py) and (nx, ny) across the axis, and the parts p_r, p_z
    # and n_r, n_z. If w moves by du round the section, u changes by du / r: p_round is p_r / r, n_round is n_r / r
    px, py, dpx, dpy, nx, ny, dnx, dny = ux, uy, dux, duy, vx, vy, dvx, dvy
    if q >= 2.0:
        px, py, dpx, dpy, nx, ny, dnx, dny = vx, vy, dvx, dvy, ux, uy, dux, duy
    p_r, p_z, dp_r, dp_z, p_round = r, z, dr, dz, 1.0
    n_r, n_z, dn_r, dn_z, n_round = r_dual, z_dual, dr_dual, dz_dual, r ** (j - 2.0)
    if p >= 2.0:
        p_r, p_z, dp_r, dp_z, p_round = r_dual, z_dual, dr_dual, dz_dual, n_round
        n_r, n_z, dn_r, dn_z, n_round = r, z, dr, dz, 1.0
    point, w = (a * p_r * px, b * p_r * py, c * p_z), (r * ux, r * uy, z)
    normal = n_r * nx / a, n_r * ny / b, n_z / c
    size = norm(normal)
    normal = divided(normal, size)
    first = tangent_of(normal)
    second = cross(normal, first)
    # derivatives of point (x) and normal (n) along both tangents, for w round the section (1) and from the axis (2)
    x11, x21 = in_plane(first, second, (a * p_round * dpx, b * p_round * dpy, 0.0))
    x12, x22 = in_plane(first, second, (a * dp_r * px, b * dp_r * py, c * dp_z))
    n11, n21 = in_plane(first, second, (n_round * dnx / a / size, n_round * dny / b / size, 0.0))
    n12, n22 = in_plane(first, second, (dn_r * nx / a / size, dn_r * ny / b / size, dn_z / c / size))
    # the inverse of X + L N, so that U = X (X + L N)^-1 and S = N (X + L N)^-1
    i11, i12, i21, i22 = x22 + length * n22, -x12 - length * n12, -x21 - length * n21, x11 + length * n11
    det = determinant((i11, i12, i21, i22))
    if det == 0.0:
        # on the third axis: sharp, with U = 0, if p >= 2; else flat, with S = 0
        s_pole = 1.0 / length if p >= 2.0 else 0.0
        u_pole = 1.0 - length * s_pole
        ex, ey = (a / (c * length), b / (c * length)) if p >= 2.0 else (1.0 / a, 1.0 / b)
        w_by_first, w_by_second = (ex * first[0], ey * first[1], 0.0), (ex * second[0], ey * second[1], 0.0)
        return point, normal, first, second, (s_pole, 0.0, s_pole), (u_pole, 0.0, u_pole), w, w_by_first, w_by_second
    i11, i12, i21, i22 = i11 / det, i12 / det, i21 / det, i22 / det
    s = n11 * i11 + n12 * i21, 0.5 * (n11 * i12 + n12 * i22 + n21 * i11 + n22 * i21), n21 * i12 + n22 * i22
    u = x11 * i11 + x12 * i21, 0.5 * (x11 * i12 + x12 * i22 + x21 * i11 + x22 * i21), x21 * i12 + x22 * i22
    w_by_first = i11 * dux + i21 * dr * ux, i11 * duy + i21 * dr * uy, i21 * dz
    w_by_second = i12 * dux + i22 * dr * ux, i12 * duy + i22 * dr * uy, i22 * dz
    return point, normal, first, second, s, u, w, w_by_first, w_by_second


@compiled
def _of_ellipsoid(semi: Vector3, length: float, w: Vector3) -> Chart:
    """Return the surface of an ellipsoid with the semi-axes ``semi`` [m] at the normal w, of any length."""
    n = unit(w)
    _, point, bends = support_by(semi, 2.0, 2.0, n)
    t = tangent_of(n)
    u = cross(n, t)
    # S is 1 / (H + L)
    h11, h12, h22 = bends_in_plane(bends, t, u)
    h11, h22 = h11 + length, h22 + length
    det = h11 * h22 - h12 * h12
    s11, s12, s22 = h22 / det, -h12 / det, h11 / det
    s, u_matrix = (s11, s12, s22), (1.0 - length * s11, -length * s12, 1.0 - length * s22)
    return point, n, t, u, s, u_matrix, n, along((s11, s12), t, u), along((s12, s22), t, u)


@compiled
def write_chart(out: Floats, side: int, core: Core, axes: Axes, normal: Vector3) -> None:
    """Write the curvature matrices of a rounded core at the surface point with the outward unit normal ``normal``.

    The normal is in the axes of the core.  With S and U of the module, the matrices are slide, S [1/m], and turn, U +
    radius S [1]: slide u = turn nu, if the point moves by u and the normal turns by nu.  At flat places slide is raised
    to the curvature ``_FLATTEST`` / size.  ``side`` is the index of the matrices in the geometry block ``out``, which
    must already hold normal and first tangent; ``axes`` are the core's axes in the world.
    """
    semi, size = semi_axes_of(core), largest_semi_axis(core)
    _, _, first, second, slide, turn, _, _, _ = chart_of(semi, size, start_of(semi, normal))
    # from the tangents of the chart to those of the contact
    t, u = tangents_in(axes, out)
    c = from_tangents(t, u, first, second)
    slide = turned_matrix(c, slide)
    # the surface of the body is at the distance of the radius from the core: turn grows by radius times slide
    turn = plus(turned_matrix(c, turn), scaled(core[RADIUS], slide))
    write_matrices(out, side, plus(slide, scaled(_FLATTEST / size, turn)), turn)
