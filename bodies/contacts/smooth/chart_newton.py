"""Newton's method for two smooth bodies of any powers, in their charts (:mod:`bodies.contacts.smooth.chart`).

Let d be the vector from the first point to the second, n and m the outward normals there.  The residuals are the
components of d and of m in the tangent plane of n.  Both are zero if the line between the points is along n and the
normals are opposite.  The equations contain neither curvatures nor radii of curvature, which can be infinite.
Therefore a face of one body may be opposite to an edge or a corner of the other, and two edges may cross.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from ...rotations import rotated, rotated_back
from ...vectors import Vector3, dot, minus, opposite, plus, plus_scaled, scaled
from .chart import chart_of, start_of
from .newton import CLOSE, RIGHT, has_ended
from .smooth_core import Cores, NearestPoint, largest_semi_axis, semi_axes_of, size_of, unit
from .tangent_plane import Symmetric, along, by_symmetric, determinant, from_tangents, in_plane, solved, turned_matrix

_STEPS, _HALVINGS = 100, 30
"""Largest number of evaluations, and of successive halvings of one step."""
_LONGEST = 0.3
"""Longest Newton step eps in either chart, a length, relative to the smaller body's size: charts are linearised."""


@compiled
def gap_by_chart(cores: Cores, start: Vector3) -> NearestPoint:
    """Return the gap of two cores [m], the second core's point [m] and the normal.

    Newton's method starts at the support points of the cores, along ``start``, of any length, and against it.  The gap
    is nan if no solution was found.
    """
    first, second, turn = semi_axes_of(cores.first), semi_axes_of(cores.second), cores.turn
    n, size = unit(start), size_of(cores)
    extent_a, extent_b = largest_semi_axis(first), largest_semi_axis(second)
    weight = max(extent_a, extent_b)
    if min(extent_a, extent_b) > 0.0:
        weight = min(extent_a, extent_b)
    w_a, w_b = start_of(first, n), start_of(second, rotated_back(turn, opposite(n)))
    last_w_a, last_w_b, step_a, step_b = w_a, w_b, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    merit, last_residual, halvings = math.inf, math.inf, 0
    for _ in range(_STEPS):
        p, n, t, u, slide_a, turn_a, w_a, w_a_t, w_a_u = chart_of(first, weight, w_a)
        q, m, t_b, u_b, slide_b, turn_b, w_b, w_b_t, w_b_u = chart_of(second, weight, w_b)
        q, m, t_b, u_b = rotated(turn, q), rotated(turn, m), rotated(turn, t_b), rotated(turn, u_b)
        d = minus(plus(cores.center, q), p)
        (r1, r2), (v1, v2), facing = in_plane(t, u, d), in_plane(t, u, m), dot(n, m)
        # v is 0 for opposite normals and also for equal ones: these get a large merit
        tilt = weight * (v1 * v1 + v2 * v2 if facing < 0.0 else 2.0 - v1 * v1 - v2 * v2)
        new_merit = r1 * r1 + r2 * r2 + weight * tilt
        if new_merit > merit and halvings < _HALVINGS and new_merit > (CLOSE * size) ** 2:
            halvings, step_a, step_b = halvings + 1, scaled(0.5, step_a), scaled(0.5, step_b)
        else:
            if halvings >= _HALVINGS or new_merit != new_merit:
                break
            merit, halvings, last_w_a, last_w_b = new_merit, 0, w_a, w_b
            g, residual = dot(n, d), math.sqrt(new_merit)
            # slide S_B and turn U_B of the second body, along the tangents of the first
            c = from_tangents(t, u, t_b, u_b)
            (s11, s12, s22), (t11, t12, t22) = turned_matrix(c, slide_b), turned_matrix(c, turn_b)
            # U_A + g S_A, and M = S_B (U_A + g S_A) - (n . m) U_B S_A
            a11, a12, a22 = plus(turn_a, scaled(g, slide_a))
            m11, m12, m21, m22 = by_symmetric((s11, s12, s12, s22), (a11, a12, a22))
            b11, b12, b21, b22 = by_symmetric((t11, t12, t12, t22), slide_a)
            matrix = m11 - facing * b11, m12 - facing * b12, m21 - facing * b21, m22 - facing * b22
            det = determinant(matrix)
            if has_ended(residual, last_residual, size):
                # det M is that of S_B (H_A + H_B + g) S_A: below 0 the stationary point is no maximum
                is_maximum = g >= 0.0 or (det >= 0.0 and not _is_least(g, slide_a, turn_a, slide_b, turn_b))
                is_wrong = residual > RIGHT * size or facing > 0.0 or not is_maximum
                return math.nan if is_wrong else g, plus_scaled(p, g, n), n
            last_residual = residual
            # a singular matrix has no solution: keep the step finite
            least = 1e-14 / (weight * weight)
            det = math.copysign(least, det) if abs(det) < least else det
            right = s11 * r1 + s12 * r2 - t11 * v1 - t12 * v2, s12 * r1 + s22 * r2 - t12 * v1 - t22 * v2
            i, j = solved(matrix, det, right)
            f1 = a11 * i + a12 * j - r1 + weight * (facing * (slide_a[0] * i + slide_a[1] * j) - v1)
            f2 = a12 * i + a22 * j - r2 + weight * (facing * (slide_a[1] * i + slide_a[2] * j) - v2)
            # step (i, j) of the first body, step of the second along its own tangents
            i_b, j_b = c[0] * f1 + c[2] * f2, c[1] * f1 + c[3] * f2
            excess = max(math.sqrt(i * i + j * j), math.sqrt(i_b * i_b + j_b * j_b)) / (_LONGEST * weight)
            if excess > 1.0:
                i, j, i_b, j_b = i / excess, j / excess, i_b / excess, j_b / excess
            step_a, step_b = along((i, j), w_a_t, w_a_u), along((i_b, j_b), w_b_t, w_b_u)
        w_a, w_b = plus(last_w_a, step_a), plus(last_w_b, step_b)
    return math.nan, cores.center, n


@compiled
def _is_least(g: float, s_a: Symmetric, u_a: Symmetric, s_b: Symmetric, u_b: Symmetric) -> bool:
    """Return whether the gap g [m] is a minimum, and no maximum, if its second derivative is definite.

    H = U S^-1 holds the radii of curvature of a body [m], with ``s`` and ``u`` of its chart.  The second derivative of
    the gap by the normal is minus H_A + H_B + g times the identity, whose trace is negative at a minimum, for example
    over the far side of a body.  The trace is multiplied by the determinants of S_A and S_B, 0 at flat places.
    """
    det_a, det_b = (s_a[0] * s_a[2] - s_a[1] * s_a[1], s_b[0] * s_b[2] - s_b[1] * s_b[1])
    bent_a = u_a[0] * s_a[2] + u_a[2] * s_a[0] - 2.0 * u_a[1] * s_a[1]
    bent_b = u_b[0] * s_b[2] + u_b[2] * s_b[0] - 2.0 * u_b[1] * s_b[1]
    return bool(det_b * bent_a + det_a * bent_b + 2.0 * g * det_a * det_b < 0.0)
