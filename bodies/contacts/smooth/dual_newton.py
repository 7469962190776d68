"""Newton's method on the support functions of two bodies, of which one at least is smooth.

The gap is the largest value of g(n) = n . X - h_A(n) - h_B(-n) over the unit vectors n.  X is the vector from the
centre of body A to that of body B; h_A and h_B are the support functions, H_A and H_B their second derivatives.  Let d
be the vector from the support point of A to that of B.  On the unit sphere the gradient of g is r = d - g n, and the
second derivative is -(H_A + H_B + g).  A Newton step delta of n solves (H_A + H_B + g) delta = r.

If the bodies are apart, g has one maximum.  If they overlap a little, the gap is the maximum near the line of centres.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from ...rotations import rotated_back
from ...shapes.support_function import support_of
from ...vectors import Vector3, cross, dot, minus, norm, plus, plus_scaled, scaled
from ..features.frames import tangent_of
from .newton import CLOSE, RIGHT, ROUND_OFF, has_ended
from .smooth_core import Cores, NearestPoint, bend, facing_point, size_of, spread, unit
from .tangent_plane import along, in_plane

_STEPS, _HALVINGS = 100, 40
"""Largest number of evaluations, and of successive halvings of one step."""
_WIDEST = 1.0
"""Longest step in the tangent plane of the unit sphere, before it is projected back to the sphere."""
_SEEN = 1e-14
"""Difference of two evaluations of g that is round-off, relative to the size of the bodies."""
_SADDLE = 0.3
"""Angle by which the search leaves a stationary direction that is not a maximum of g [rad]."""


@compiled
def gap_by_normal(cores: Cores, axis: Vector3, start: Vector3) -> NearestPoint:
    """Return the largest gap g(n) [m], the second core's point [m] and the direction n; nan if none was found.

    The search starts in the direction ``start``, of any length.  The direction n stays perpendicular to the unit vector
    ``axis``, such as that of an edge; it is free if ``axis`` is zero.
    """
    is_free = axis[0] == 0.0 and axis[1] == 0.0 and axis[2] == 0.0
    n = plus_scaled(start, -dot(start, axis), axis)
    # a start along the axis gives no direction: take any
    if norm(n) <= CLOSE * spread(start):
        n = tangent_of(axis)
    n = unit(n)
    size = size_of(cores)
    g, last_residual, halvings = -math.inf, math.inf, 0
    last_n, step = n, (0.0, 0.0, 0.0)
    for _ in range(_STEPS):
        _, p, bends_a = support_of(cores.first, n)
        q, bends_b = facing_point(cores, n)
        d = minus(q, p)
        new_g = dot(n, d)
        if new_g < g - _SEEN * size and halvings < _HALVINGS:
            halvings, step = halvings + 1, scaled(0.5, step)
        else:
            g, halvings, last_n = new_g, 0, n
            t, u = (tangent_of(n), axis) if is_free else (cross(axis, n), axis)
            if is_free:
                u = cross(n, t)
            # gradient r, s and elements of H_A + H_B + g along the tangents t and u; if n turns about the axis only,
            # the gradient has no component along u, and the element there is any positive number
            r, s = in_plane(t, u, d)
            v = rotated_back(cores.turn, t)
            tt, tu, uu = bend(bends_a, t, t) + bend(bends_b, v, v) + g, 0.0, size
            if is_free:
                w = rotated_back(cores.turn, u)
                tu, uu = bend(bends_a, t, u) + bend(bends_b, v, w), bend(bends_a, u, u) + bend(bends_b, w, w) + g
            else:
                s = 0.0
            residual = math.sqrt(r * r + s * s)
            # eigenvalues low <= high, the angle of the vector of high, and r along both vectors
            middle, half = 0.5 * (tt + uu), 0.5 * (tt - uu)
            half_difference = math.sqrt(half * half + tu * tu)
            low, high = middle - half_difference, middle + half_difference
            angle = 0.5 * math.atan2(tu, half)
            cosine, sine = math.cos(angle), math.sin(angle)
            r_high, r_low = cosine * r + sine * s, cosine * s - sine * r
            if has_ended(residual, last_residual, size):
                if residual > RIGHT * size:
                    return math.nan, q, n
                if low >= -CLOSE * size:
                    return g, q, n
                # a stationary point that is not a maximum: leave it along the direction in which g grows most
                r_high, r_low, last_residual = 0.0, _SADDLE, math.inf
            else:
                # by absolute values, so that the step increases g
                least = ROUND_OFF * size
                r_high, r_low, last_residual = r_high / max(abs(high), least), r_low / max(abs(low), least), residual
            r, s = cosine * r_high - sine * r_low, sine * r_high + cosine * r_low
            length = math.sqrt(r * r + s * s)
            if length > _WIDEST:
                r, s = r * _WIDEST / length, s * _WIDEST / length
            step = along((r, s), t, u)
        n = unit(plus(last_n, step))
    return math.nan, cores.center, n
