"""Newton's method for two smooth bodies of any kind, in their charts (:mod:`bodies.contacts.smooth.chart`).

Let d be the vector from the first point to the second, n and m the outward normals there.  The residuals are the
components of d and of m in the tangent plane of n, as in :mod:`bodies.contacts.smooth.boxy_pair`.  The equations
contain neither curvatures nor radii of curvature, which can be infinite.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from .boxy_newton import Answer, Norm, Point
from .chart import Symmetric, chart_of, start_of, turned_matrix
from .smooth_core import Axes, back, forth

_STEPS = 40
_HALVINGS = 10
_ROUND_OFF = 2e-16
_CLOSE = 1e-12
"""Residual, relative to the size of the bodies, below which Newton's method ends once a step no longer halves it.

Below this bound, round-off limits the residual.
"""
_RIGHT = 1e-13
"""Residual, relative to the size of the bodies, above which a result of Newton's method is rejected."""
_LONGEST = 0.3
"""Longest Newton step eps in either chart, a length, relative to the smaller body's size: charts are linearised."""


@compiled
def meet_in_charts(
    first: Norm, second: Norm, turn: Axes, x: float, y: float, z: float, nx: float, ny: float, nz: float, parts: int
) -> Answer:
    """Return the gap of two cores [m], the point on the first core and its outward normal.

    Point and normal are in the axes of the first core, from its centre.  The gap is nan if no solution was found.

    Parameters
    ----------
    first, second : Norm
        Semi-axes and powers; one of them may be a point.
    turn : Axes
        Rotation from the axes of the second core to those of the first.
    x, y, z : float
        The second core's centre from the first's [m].
    nx, ny, nz : float
        The normal with which the search starts, of any length.
    parts : int
        Used if the direct search fails: the search is repeated with ellipsoids, whose powers then change to the cores'
        own powers in this number of steps; 0 for no further search.
    """
    length = math.sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = nx / length, ny / length, nz / length
    found: Answer = _climb(first, second, turn, x, y, z, nx, ny, nz)
    if found[0] == found[0]:
        return found
    # solve for ellipsoids first and change their powers step by step, each solution as the next start
    for i in range(parts + 1 if parts > 0 else 0):
        part = i / parts
        one, two = _between(first, part), _between(second, part)
        found = _climb(one, two, turn, x, y, z, nx, ny, nz)
        if found[0] == found[0]:
            nx, ny, nz = found[4], found[5], found[6]
    return found


@compiled
def _between(core: Norm, part: float) -> Norm:
    """Return a core interpolated between the ellipsoid of equal semi-axes (``part`` 0) and ``core`` (``part`` 1).

    The reciprocal powers 1 / p and 1 / q vary linearly with ``part``.
    """
    a, b, c, p, q = core
    return a, b, c, 1.0 / (0.5 + part * (1.0 / p - 0.5)), 1.0 / (0.5 + part * (1.0 / q - 0.5))


@compiled
def _climb(
    first: Norm, second: Norm, turn: Axes, x: float, y: float, z: float, nx: float, ny: float, nz: float
) -> Answer:
    """Return the largest gap of two cores over all directions [m], the first core's point and normal there.

    Newton's method starts at the support points of the cores, along the unit normal (nx, ny, nz) and against it.  The
    other arguments are those of :func:`meet_in_charts`.  The gap is nan if no solution was found.
    """
    extent_a, extent_b = max(first[0], max(first[1], first[2])), max(second[0], max(second[1], second[2]))
    size = abs(x) + abs(y) + abs(z) + extent_a + extent_b
    weight = max(extent_a, extent_b)
    if min(extent_a, extent_b) > 0.0:
        weight = min(extent_a, extent_b)
    mx, my, mz = back(turn, (-nx, -ny, -nz))
    w, o = start_of(first, nx, ny, nz), start_of(second, mx, my, mz)
    kept_w, kept_o = w, o
    step_w: Point = (0.0, 0.0, 0.0)
    step_o: Point = (0.0, 0.0, 0.0)
    merit, before = math.inf, math.inf
    halvings = 0
    for _ in range(_STEPS):
        p, n, t, u, sa, ua, w, along_w, beside_w = chart_of(first, weight, w[0], w[1], w[2])
        q, m, tb, ub_, sb, ub, o, along_o, beside_o = chart_of(second, weight, o[0], o[1], o[2])
        qx, qy, qz = forth(turn, (q[0], q[1], q[2]))
        mx, my, mz = forth(turn, (m[0], m[1], m[2]))
        dx, dy, dz = x + qx - p[0], y + qy - p[1], z + qz - p[2]
        r1, r2 = t[0] * dx + t[1] * dy + t[2] * dz, u[0] * dx + u[1] * dy + u[2] * dz
        v1, v2 = t[0] * mx + t[1] * my + t[2] * mz, u[0] * mx + u[1] * my + u[2] * mz
        facing = n[0] * mx + n[1] * my + n[2] * mz
        # a large residual for normals that do not face each other
        apart = weight * (v1 * v1 + v2 * v2 if facing < 0.0 else 2.0 - v1 * v1 - v2 * v2)
        found = r1 * r1 + r2 * r2 + weight * apart
        if found > merit and halvings < _HALVINGS and found > (_CLOSE * size) ** 2:
            halvings += 1
            step_w = 0.5 * step_w[0], 0.5 * step_w[1], 0.5 * step_w[2]
            step_o = 0.5 * step_o[0], 0.5 * step_o[1], 0.5 * step_o[2]
        else:
            if halvings >= _HALVINGS or found != found:
                return math.nan, p[0], p[1], p[2], n[0], n[1], n[2]
            merit, halvings = found, 0
            kept_w, kept_o = w, o
            g = n[0] * dx + n[1] * dy + n[2] * dz
            residual = math.sqrt(found)
            ended = residual <= _ROUND_OFF * size or (residual <= _CLOSE * size and residual >= 0.5 * before)
            before = residual
            # the second body's matrices along the first's tangents
            bx, by, bz = forth(turn, (tb[0], tb[1], tb[2]))
            c11, c21 = t[0] * bx + t[1] * by + t[2] * bz, u[0] * bx + u[1] * by + u[2] * bz
            bx, by, bz = forth(turn, (ub_[0], ub_[1], ub_[2]))
            c12, c22 = t[0] * bx + t[1] * by + t[2] * bz, u[0] * bx + u[1] * by + u[2] * bz
            s11, s12, s22 = turned_matrix(c11, c12, c21, c22, sb)
            t11, t12, t22 = turned_matrix(c11, c12, c21, c22, ub)
            # U_A + g S_A, and M = S_B (U_A + g S_A) - (n . m) U_B S_A
            a11, a12, a22 = ua[0] + g * sa[0], ua[1] + g * sa[1], ua[2] + g * sa[2]
            m11 = s11 * a11 + s12 * a12 - facing * (t11 * sa[0] + t12 * sa[1])
            m12 = s11 * a12 + s12 * a22 - facing * (t11 * sa[1] + t12 * sa[2])
            m21 = s12 * a11 + s22 * a12 - facing * (t12 * sa[0] + t22 * sa[1])
            m22 = s12 * a12 + s22 * a22 - facing * (t12 * sa[1] + t22 * sa[2])
            det = m11 * m22 - m12 * m21
            if ended:
                # M is S_B (H_A + H_B + g) S_A: below 0 the stationary point is no maximum
                is_top = g >= 0.0 or (det >= 0.0 and not _is_least(g, sa, ua, sb, ub))
                if residual > _RIGHT * size or facing > 0.0 or not is_top:
                    return math.nan, p[0], p[1], p[2], n[0], n[1], n[2]
                return g, p[0], p[1], p[2], n[0], n[1], n[2]
            least = 1e-14 / (weight * weight)
            if abs(det) < least:
                det = math.copysign(least, det)
            right_1 = s11 * r1 + s12 * r2 - t11 * v1 - t12 * v2
            right_2 = s12 * r1 + s22 * r2 - t12 * v1 - t22 * v2
            i, j = (m22 * right_1 - m12 * right_2) / det, (m11 * right_2 - m21 * right_1) / det
            f1 = a11 * i + a12 * j - r1 + weight * (facing * (sa[0] * i + sa[1] * j) - v1)
            f2 = a12 * i + a22 * j - r2 + weight * (facing * (sa[1] * i + sa[2] * j) - v2)
            k, e = c11 * f1 + c21 * f2, c12 * f1 + c22 * f2
            over = max(math.sqrt(i * i + j * j), math.sqrt(k * k + e * e)) / (_LONGEST * weight)
            if over > 1.0:
                i, j, k, e = i / over, j / over, k / over, e / over
            step_w = (
                i * along_w[0] + j * beside_w[0],
                i * along_w[1] + j * beside_w[1],
                i * along_w[2] + j * beside_w[2],
            )
            step_o = (
                k * along_o[0] + e * beside_o[0],
                k * along_o[1] + e * beside_o[1],
                k * along_o[2] + e * beside_o[2],
            )
        w = kept_w[0] + step_w[0], kept_w[1] + step_w[1], kept_w[2] + step_w[2]
        o = kept_o[0] + step_o[0], kept_o[1] + step_o[1], kept_o[2] + step_o[2]
    return math.nan, x, y, z, nx, ny, nz


@compiled
def _is_least(g: float, sa: Symmetric, ua: Symmetric, sb: Symmetric, ub: Symmetric) -> bool:
    """Return whether H_A + H_B + g has a trace below 0, as where the second body is farthest from a point.

    The trace of H = U S^-1 is that of U times the adjugate of S over the determinant, which is 0 at a flat place.
    """
    flat_a, flat_b = sa[0] * sa[2] - sa[1] * sa[1], sb[0] * sb[2] - sb[1] * sb[1]
    bent_a = ua[0] * sa[2] + ua[2] * sa[0] - 2.0 * ua[1] * sa[1]
    bent_b = ub[0] * sb[2] + ub[2] * sb[0] - 2.0 * ub[1] * sb[1]
    return bool(flat_b * bent_a + flat_a * bent_b + 2.0 * g * flat_a * flat_b < 0.0)
