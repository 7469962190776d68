"""Newton's method for two smooth bodies of any kind, in their charts (:mod:`bodies.contacts.smooth.chart`).

Let d be the vector from the first point to the second, n and m the outward normals there.  The residuals are the
components of d and of m in the tangent plane of n, as in :mod:`bodies.contacts.smooth.boxy_pair`.  The equations
contain neither curvatures nor radii of curvature, which can be infinite.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from ...vectors import Vector3, dot, minus, opposite, plus, scaled
from .chart import chart_of, start_of
from .newton import CLOSE, RIGHT, away_from_zero, has_ended, misfit
from .smooth_core import Axes, NearestPoint, SemiAxes, largest_semi_axis, rotated, rotated_back, spread, unit
from .tangent_plane import Symmetric, along, by_symmetric, determinant, from_tangents, in_plane, solved, turned_matrix

_STEPS = 40
_HALVINGS = 10
_LONGEST = 0.3
"""Longest Newton step eps in either chart, a length, relative to the smaller body's size: charts are linearised."""


@compiled
def meet_in_charts(
    first: SemiAxes, second: SemiAxes, turn: Axes, place: Vector3, start: Vector3, parts: int
) -> NearestPoint:
    """Return the gap of two cores [m], the point on the first core and its outward normal.

    Point and normal are in the axes of the first core, from its centre.  The gap is nan if no solution was found.

    Parameters
    ----------
    first, second : Norm
        Semi-axes and powers; one of them may be a point.
    turn, place : Axes, Vector3
        See :mod:`bodies.contacts.smooth.smooth_core`.
    start : Vector3
        The normal with which the search starts, of any length.
    parts : int
        Used if the direct search fails: the search is repeated with ellipsoids, whose powers then change to the cores'
        own powers in this number of steps; 0 for no further search.
    """
    n = unit(start)
    found = _climb(first, second, turn, place, n)
    if found[0] == found[0]:
        return found
    # solve for ellipsoids first and change their powers step by step, each solution as the next start
    for i in range(parts + 1 if parts > 0 else 0):
        found = _climb(_between(first, i / parts), _between(second, i / parts), turn, place, n)
        if found[0] == found[0]:
            n = found[2]
    return found


@compiled
def _between(core: SemiAxes, part: float) -> SemiAxes:
    """Return a core interpolated between the ellipsoid of equal semi-axes (``part`` 0) and ``core`` (``part`` 1).

    The reciprocal powers 1 / p and 1 / q vary linearly with ``part``.
    """
    a, b, c, p, q = core
    return a, b, c, 1.0 / (0.5 + part * (1.0 / p - 0.5)), 1.0 / (0.5 + part * (1.0 / q - 0.5))


@compiled
def _climb(first: SemiAxes, second: SemiAxes, turn: Axes, place: Vector3, start: Vector3) -> NearestPoint:
    """Return the largest gap of two cores over all directions [m], the first core's point and normal there.

    Newton's method starts at the support points of the cores, along the unit normal ``start`` and against it.  The
    other arguments are those of :func:`meet_in_charts`.  The gap is nan if no solution was found.
    """
    extent_a, extent_b = largest_semi_axis(first), largest_semi_axis(second)
    size, weight = spread(place) + extent_a + extent_b, max(extent_a, extent_b)
    if min(extent_a, extent_b) > 0.0:
        weight = min(extent_a, extent_b)
    w, o = start_of(first, start), start_of(second, rotated_back(turn, opposite(start)))
    last_w, last_o, step_w, step_o = w, o, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    merit, before, halvings = math.inf, math.inf, 0
    for _ in range(_STEPS):
        p, n, t, u, s_a, u_a, w, along_w, beside_w = chart_of(first, weight, w)
        q, m, t_b, u_b, s_b, turn_b, o, along_o, beside_o = chart_of(second, weight, o)
        q, m, t_b, u_b = rotated(turn, q), rotated(turn, m), rotated(turn, t_b), rotated(turn, u_b)
        d = minus(plus(place, q), p)
        (r1, r2), (v1, v2), facing = in_plane(t, u, d), in_plane(t, u, m), dot(n, m)
        found = misfit(r1, r2, v1, v2, facing, weight)
        if found > merit and halvings < _HALVINGS and found > (CLOSE * size) ** 2:
            halvings, step_w, step_o = halvings + 1, scaled(0.5, step_w), scaled(0.5, step_o)
        else:
            if halvings >= _HALVINGS or found != found:
                return math.nan, p, n
            merit, halvings, last_w, last_o = found, 0, w, o
            g, residual = dot(n, d), math.sqrt(found)
            # the second body's matrices along the first's tangents
            c = from_tangents(t, u, t_b, u_b)
            (s11, s12, s22), (t11, t12, t22) = turned_matrix(c, s_b), turned_matrix(c, turn_b)
            # U_A + g S_A, and M = S_B (U_A + g S_A) - (n . m) U_B S_A
            a11, a12, a22 = plus(u_a, scaled(g, s_a))
            m11, m12, m21, m22 = by_symmetric((s11, s12, s12, s22), (a11, a12, a22))
            b11, b12, b21, b22 = by_symmetric((t11, t12, t12, t22), s_a)
            matrix = m11 - facing * b11, m12 - facing * b12, m21 - facing * b21, m22 - facing * b22
            det = determinant(matrix)
            if has_ended(residual, before, size):
                # M is S_B (H_A + H_B + g) S_A: below 0 the stationary point is no maximum
                is_top = g >= 0.0 or (det >= 0.0 and not _is_least(g, s_a, u_a, s_b, turn_b))
                is_wrong = residual > RIGHT * size or facing > 0.0 or not is_top
                return math.nan if is_wrong else g, p, n
            before = residual
            det = away_from_zero(det, 1e-14 / (weight * weight))
            right = s11 * r1 + s12 * r2 - t11 * v1 - t12 * v2, s12 * r1 + s22 * r2 - t12 * v1 - t22 * v2
            i, j = solved(matrix, det, right)
            f1 = a11 * i + a12 * j - r1 + weight * (facing * (s_a[0] * i + s_a[1] * j) - v1)
            f2 = a12 * i + a22 * j - r2 + weight * (facing * (s_a[1] * i + s_a[2] * j) - v2)
            k, e = c[0] * f1 + c[2] * f2, c[1] * f1 + c[3] * f2
            over = max(math.sqrt(i * i + j * j), math.sqrt(k * k + e * e)) / (_LONGEST * weight)
            if over > 1.0:
                i, j, k, e = i / over, j / over, k / over, e / over
            step_w, step_o = along((i, j), along_w, beside_w), along((k, e), along_o, beside_o)
        w, o = plus(last_w, step_w), plus(last_o, step_o)
    return math.nan, place, start


@compiled
def _is_least(g: float, s_a: Symmetric, u_a: Symmetric, s_b: Symmetric, u_b: Symmetric) -> bool:
    """Return whether H_A + H_B + g has a trace below 0, as where the second body is farthest from a point.

    The trace of H = U S^-1 is that of U times the adjugate of S over the determinant, which is 0 at a flat place.
    """
    flat_a, flat_b = s_a[0] * s_a[2] - s_a[1] * s_a[1], s_b[0] * s_b[2] - s_b[1] * s_b[1]
    bent_a = u_a[0] * s_a[2] + u_a[2] * s_a[0] - 2.0 * u_a[1] * s_a[1]
    bent_b = u_b[0] * s_b[2] + u_b[2] * s_b[0] - 2.0 * u_b[1] * s_b[1]
    return bool(flat_b * bent_a + flat_a * bent_b + 2.0 * g * flat_a * flat_b < 0.0)
