"""Newton's method for two bodies with flat places (boxy): the unknowns are a point on each surface.

Let d be the vector from the first point to the second, n and m the outward normals there.  The residuals are the
components of d and of m in the tangent plane of n.  Both are zero if the line between the points is along n and the
normals are opposite.  The residuals contain no second derivative of a support function, which is infinite at flat
places.  Therefore a face of one body may be opposite to an edge or a corner of the other, and two edges may cross.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from ...shapes.support_function import Core
from ...vectors import Vector3, divided, dot, minus, norm, plus, scaled
from .boxy_newton import place_on
from .newton import CLOSE, RIGHT, away_from_zero, has_ended, misfit
from .smooth_core import Axes, NearestPoint, largest_semi_axis, rotated, rotated_back, spread
from .tangent_plane import along, by_symmetric, determinant, from_tangents, in_plane, solved

_STEPS, _HALVINGS = 100, 30
"""Largest number of evaluations, and of successive halvings of one step."""
_LONGEST = 0.3
"""Longest Newton step of a contact point, relative to the largest semi-axis of its body.

Newton's method linearises the surfaces, which is wrong for longer steps.
"""
_LEAST = 0.05
"""Least determinant of the rotation between both tangent planes by which the step is divided."""


@compiled
def meet(first: Core, second: Core, turn: Axes, center: Vector3, start_a: Vector3, start_b: Vector3) -> NearestPoint:
    """Return the gap of two boxy cores [m], the point on the first core and its outward normal.

    Point and normal are in the axes of the first core, from its centre.  The gap is nan if no solution was found.

    Parameters
    ----------
    first, second, turn, center : Floats, Axes, Vector3
        See :mod:`bodies.contacts.smooth.smooth_core`.
    start_a, start_b : Vector3
        Directions from each centre to the point at which the search starts, both in the axes of the first core.
    """
    extent_a, extent_b = largest_semi_axis(first), largest_semi_axis(second)
    size, weight = spread(center) + extent_a + extent_b, min(extent_a, extent_b)
    p, q, last_p, last_q = start_a, start_b, start_a, start_b
    step_p, step_q = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    merit, last_residual, halvings = math.inf, math.inf, 0
    for _ in range(_STEPS):
        p, n, t, u, (a11, a12, a22) = place_on(first, p)
        q, m, t_b, u_b, k_b = place_on(second, rotated_back(turn, q))
        q, m, t_b, u_b = rotated(turn, q), rotated(turn, m), rotated(turn, t_b), rotated(turn, u_b)
        d = minus(plus(center, q), p)
        (r, s), (v, w), facing = in_plane(t, u, d), in_plane(t, u, m), dot(n, m)
        new_merit = misfit(r, s, v, w, facing, weight)
        if new_merit > merit and halvings < _HALVINGS and new_merit > (CLOSE * size) ** 2:
            halvings, step_p, step_q = halvings + 1, scaled(0.5, step_p), scaled(0.5, step_q)
        else:
            if halvings >= _HALVINGS:
                return math.nan, p, n
            merit, halvings, last_p, last_q = new_merit, 0, p, q
            g, residual = dot(n, d), math.sqrt(new_merit)
            # C, the second body's tangents along the first's, and G = C K_B C^-1
            c = from_tangents(t, u, t_b, u_b)
            det_c = away_from_zero(determinant(c), _LEAST)
            e11, e12, e21, e22 = by_symmetric(c, k_b)
            g11, g12 = (e11 * c[3] - e12 * c[2]) / det_c, (e12 * c[0] - e11 * c[1]) / det_c
            g21, g22 = (e21 * c[3] - e22 * c[2]) / det_c, (e22 * c[0] - e21 * c[1]) / det_c
            # the unknown is the step (i, j) of p: 1 + g K_A, and M = G (1 + g K_A) - (n . m) K_A
            k11, k12, k22 = 1.0 + g * a11, g * a12, 1.0 + g * a22
            m11, m12, m21, m22 = by_symmetric((g11, g12, g21, g22), (k11, k12, k22))
            matrix = m11 - facing * a11, m12 - facing * a12, m21 - facing * a12, m22 - facing * a22
            det = determinant(matrix)
            if has_ended(residual, last_residual, size):
                # det M is that of K_B (H_A + H_B + g) K_A: below 0 the stationary point is no maximum
                is_wrong = residual > RIGHT * size or facing > 0.0 or (g < 0.0 and det < 0.0)
                return math.nan if is_wrong else g, p, n
            last_residual = residual
            # a singular matrix has no solution: keep the step finite
            det = away_from_zero(det, 1e-14 / (weight * weight))
            i, j = solved(matrix, det, (g11 * r + g12 * s - v, g21 * r + g22 * s - w))
            step_p = along((i, j), t, u)
            step_q = along(solved(c, det_c, (k11 * i + k12 * j - r, k12 * i + k22 * j - s)), t_b, u_b)
            longest_step = max(1.0, _relative_length(step_p, extent_a), _relative_length(step_q, extent_b))
            step_p, step_q = divided(step_p, longest_step), divided(step_q, longest_step)
        p, q = plus(last_p, step_p), plus(last_q, step_q)
    return math.nan, last_p, (0.0, 0.0, 1.0)


@compiled
def _relative_length(step: Vector3, extent: float) -> float:
    """Return the length of a step relative to the longest one; ``extent`` is the largest semi-axis of the body [m]."""
    return float(norm(step) / (_LONGEST * extent))
