"""Newton's method for two bodies with flat places (boxy): the unknowns are a point on each surface.

Let d be the vector from the first point to the second, n and m the outward normals there.  The residuals are the
components of d and of m in the tangent plane of n.  Both are zero if the line between the points is along n and the
normals are opposite.  The residuals contain no second derivative of a support function, which is infinite at flat
places.  Therefore a face of one body may be opposite to an edge or a corner of the other, and two edges may cross.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from .boxy_newton import Answer, Place, Point, place_on
from .smooth_core import Axes, back, forth

_STEPS = 100
_HALVINGS = 30
_ROUND_OFF = 2e-16
_CLOSE = 1e-12
"""Residual below which Newton's method ends as soon as a step does not halve it, relative to the size of the bodies.

A step that does not halve such a small residual is limited by round-off.
"""
_RIGHT = 1e-13
"""Largest residual of an accepted result of Newton's method, relative to the size of the bodies.

An iteration that ends between this bound and ``_CLOSE`` has no result: the gap is nan.
"""
_LONGEST = 0.3
"""Longest Newton step of a contact point, relative to the largest semi-axis of its body.

Newton's method linearises the surfaces, which is wrong for longer steps.
"""


@compiled
def _turned(turn: Axes, s: Place) -> Place:
    x, y, z = forth(turn, (s[0], s[1], s[2]))
    nx, ny, nz = forth(turn, (s[3], s[4], s[5]))
    tx, ty, tz = forth(turn, (s[6], s[7], s[8]))
    ux, uy, uz = forth(turn, (s[9], s[10], s[11]))
    return x, y, z, nx, ny, nz, tx, ty, tz, ux, uy, uz, s[12], s[13], s[14]


@compiled
def meet(
    first: Floats,
    second: Floats,
    turn: Axes,
    x: float,
    y: float,
    z: float,
    start: Point,
    other: Point,
) -> Answer:
    """Return the gap of two boxy cores [m], the point on the first core and its outward normal.

    Point and normal are in the axes of the first core, from its centre.  The gap is nan if no solution was found.

    Parameters
    ----------
    first, second : Floats
        The cores.
    turn : Axes
        Rotation from the axes of the second core to those of the first.
    x, y, z : float
        The second core's centre from the first's [m].
    start, other : Point
        Directions from each centre to the point at which the search starts, both in the axes of the first core.
    """
    extent_a, extent_b = max(first[0], first[1], first[2]), max(second[0], second[1], second[2])
    size = abs(x) + abs(y) + abs(z) + extent_a + extent_b
    weight = min(extent_a, extent_b)
    px, py, pz = start
    qx, qy, qz = other
    kept_p, kept_q, step_p, step_q = (px, py, pz), (qx, qy, qz), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    merit, before = math.inf, math.inf
    halvings = 0
    for _ in range(_STEPS):
        s = place_on(first, px, py, pz)
        bx, by, bz = back(turn, (qx, qy, qz))
        o = _turned(turn, place_on(second, bx, by, bz))
        nx, ny, nz, tx, ty, tz, ux, uy, uz = s[3], s[4], s[5], s[6], s[7], s[8], s[9], s[10], s[11]
        dx, dy, dz = x + o[0] - s[0], y + o[1] - s[1], z + o[2] - s[2]
        r, t = tx * dx + ty * dy + tz * dz, ux * dx + uy * dy + uz * dz
        v, w = tx * o[3] + ty * o[4] + tz * o[5], ux * o[3] + uy * o[4] + uz * o[5]
        facing = nx * o[3] + ny * o[4] + nz * o[5]
        # a large residual for normals that do not face each other
        apart = weight * (v * v + w * w if facing < 0.0 else 2.0 - v * v - w * w)
        found = r * r + t * t + weight * apart
        if found > merit and halvings < _HALVINGS and found > (_CLOSE * size) ** 2:
            halvings += 1
            step_p = 0.5 * step_p[0], 0.5 * step_p[1], 0.5 * step_p[2]
            step_q = 0.5 * step_q[0], 0.5 * step_q[1], 0.5 * step_q[2]
        else:
            if halvings >= _HALVINGS:
                return math.nan, s[0], s[1], s[2], nx, ny, nz
            merit, halvings = found, 0
            kept_p, kept_q = (s[0], s[1], s[2]), (o[0], o[1], o[2])
            g = nx * dx + ny * dy + nz * dz
            residual = math.sqrt(found)
            ended = residual <= _ROUND_OFF * size or (residual <= _CLOSE * size and residual >= 0.5 * before)
            before = residual
            # C, the second body's tangents along the first's, and G = C K_B / C
            c11, c12 = tx * o[6] + ty * o[7] + tz * o[8], tx * o[9] + ty * o[10] + tz * o[11]
            c21, c22 = ux * o[6] + uy * o[7] + uz * o[8], ux * o[9] + uy * o[10] + uz * o[11]
            det_c = c11 * c22 - c12 * c21
            if abs(det_c) < 0.05:
                det_c = math.copysign(0.05, det_c)
            e11, e12 = c11 * o[12] + c12 * o[13], c11 * o[13] + c12 * o[14]
            e21, e22 = c21 * o[12] + c22 * o[13], c21 * o[13] + c22 * o[14]
            g11, g12 = (e11 * c22 - e12 * c21) / det_c, (e12 * c11 - e11 * c12) / det_c
            g21, g22 = (e21 * c22 - e22 * c21) / det_c, (e22 * c11 - e21 * c12) / det_c
            # 1 + g K_A, and M = G (1 + g K_A) - (n . m) K_A
            a11, a12, a22 = 1.0 + g * s[12], g * s[13], 1.0 + g * s[14]
            m11, m12 = g11 * a11 + g12 * a12 - facing * s[12], g11 * a12 + g12 * a22 - facing * s[13]
            m21, m22 = g21 * a11 + g22 * a12 - facing * s[13], g21 * a12 + g22 * a22 - facing * s[14]
            right_1, right_2 = g11 * r + g12 * t - v, g21 * r + g22 * t - w
            det_m = m11 * m22 - m12 * m21
            if ended:
                # det M is that of K_B (H_A + H_B + g) K_A: below 0 the stationary point is no maximum
                if residual > _RIGHT * size or facing > 0.0 or (g < 0.0 and det_m < 0.0):
                    return math.nan, s[0], s[1], s[2], nx, ny, nz
                return g, s[0], s[1], s[2], nx, ny, nz
            least = 1e-14 / (weight * weight)
            if abs(det_m) < least:
                det_m = math.copysign(least, det_m)
            i, j = (m22 * right_1 - m12 * right_2) / det_m, (m11 * right_2 - m21 * right_1) / det_m
            step_p = i * tx + j * ux, i * ty + j * uy, i * tz + j * uz
            f1, f2 = a11 * i + a12 * j - r, a12 * i + a22 * j - t
            i, j = (c22 * f1 - c12 * f2) / det_c, (c11 * f2 - c21 * f1) / det_c
            step_q = i * o[6] + j * o[9], i * o[7] + j * o[10], i * o[8] + j * o[11]
            long_p = math.sqrt(step_p[0] ** 2 + step_p[1] ** 2 + step_p[2] ** 2) / (_LONGEST * extent_a)
            long_q = math.sqrt(step_q[0] ** 2 + step_q[1] ** 2 + step_q[2] ** 2) / (_LONGEST * extent_b)
            over = max(1.0, long_p, long_q)
            step_p = step_p[0] / over, step_p[1] / over, step_p[2] / over
            step_q = step_q[0] / over, step_q[1] / over, step_q[2] / over
        px, py, pz = kept_p[0] + step_p[0], kept_p[1] + step_p[1], kept_p[2] + step_p[2]
        qx, qy, qz = kept_q[0] + step_q[0], kept_q[1] + step_q[1], kept_q[2] + step_q[2]
    return math.nan, kept_p[0], kept_p[1], kept_p[2], 0.0, 0.0, 1.0
