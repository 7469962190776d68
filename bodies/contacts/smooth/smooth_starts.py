"""Starts for the search of the largest gap of two smooth bodies over all directions: directions with a large gap.

The gap along a direction follows from the support functions alone.  It is evaluated along the axes of both bodies and
half-way between two or three axes, where the bodies have flat and sharp places.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled

from ...rotations import rotated, rotated_back
from ...shapes.support_function import support_of
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus_scaled
from ..features.frames import tangent_of
from .smooth_core import Cores, facing_point, size_of, unit
from .tangent_plane import in_plane

_LONGEST, _MOVES = 0.2, 100
"""Limits of the search for a maximum (:func:`local_maximum`), which increases the gap by turning the direction.

``_LONGEST``: first step [rad].  ``_MOVES``: largest number of steps.
"""
_NEAR = 0.95
"""Cosine of the angle within which two directions are the same start; the one with the larger gap is kept."""
N_STARTS = 4
"""Number of directions with a large gap from which a search starts."""
Start: TypeAlias = tuple[float, Vector3]
"""A gap [m], and the unit vector along which it is measured."""
Starts: TypeAlias = tuple[Start, Start, Start, Start]
"""Four starts, in any order."""


@compiled
def gap_along(cores: Cores, n: Vector3) -> float:
    """Return the gap of two cores along a unit vector [m]."""
    to_second = rotated_back(cores.turn, opposite(n))
    return float(dot(n, cores.center) - support_of(cores.first, n)[0] - support_of(cores.second, to_second)[0])


@compiled
def local_maximum(cores: Cores, start: Start, least: float) -> Start:
    """Return a local maximum of the gap [m] and its direction, to about ``least`` [rad], by steps from ``start``.

    A step is the best of eight directions round the present one.  If none of them has a larger gap, the next step is
    shorter.
    """
    g, n = start
    step = _LONGEST
    for _ in range(_MOVES):
        if step <= least:
            break
        t = tangent_of(n)
        u = cross(n, t)
        best: Start = (g, n)
        for i in range(8):
            c, s = step * math.cos(0.25 * math.pi * i), step * math.sin(0.25 * math.pi * i)
            candidate = unit(plus_scaled(plus_scaled(n, c, t), s, u))
            gap = gap_along(cores, candidate)
            if gap > best[0]:
                best = (gap, candidate)
        if best[0] <= g:
            step *= 0.4
        g, n = best
    return g, n


@compiled
def starts_of(cores: Cores) -> Starts:
    """Return four directions that are not close to each other, with the largest gaps of all directions tried."""
    no_start: Start = (-math.inf, (0.0, 0.0, 0.0))
    kept: Starts = (no_start, no_start, no_start, no_start)
    # vectors with the components -1, 0 or 1 in the axes of the first core, then of the second; number 13 is 0
    for i in range(54):
        number = i % 27
        if number == 13:
            continue
        n = unit((number // 9 - 1.0, number // 3 % 3 - 1.0, number % 3 - 1.0))
        if i >= 27:
            n = rotated(cores.turn, n)
        kept = _updated(kept, (gap_along(cores, n), n))
    return kept


@compiled
def _updated(kept: Starts, new: Start) -> Starts:
    """Return the kept starts, of which the new one replaces one if it has a larger gap.

    It replaces a start close to it, or, if there is none, the start with the least gap.
    """
    index, least = -1, min(min(kept[0][0], kept[1][0]), min(kept[2][0], kept[3][0]))
    for i in range(4):
        if index < 0 and dot(kept[i][1], new[1]) > _NEAR:
            index = i
    for i in range(4):
        if index < 0 and kept[i][0] == least:
            index = i
    if new[0] <= kept[index][0]:
        return kept
    return (
        new if index == 0 else kept[0],
        new if index == 1 else kept[1],
        new if index == 2 else kept[2],
        new if index == 3 else kept[3],
    )


_CUTS, _WIDE = 400, 0.1
"""Largest number of ellipses of the ellipsoid method; radius of its first ellipse, which is a circle [rad]."""
_HIGHER = 1e-16
"""The ellipsoid method ends if the gap can grow by less than this, relative to the size of the bodies."""


@compiled
def largest_near(cores: Cores, start: Start) -> Start:
    """Return the largest gap near the direction ``start`` [m], and the direction of this gap, by the ellipsoid method.

    The method also converges on narrow ridges, where the gap changes little along one curve of directions.

    Directions are points of the plane that touches the unit sphere at the start.  An ellipse in this plane holds the
    maximum.  The gradient of the gap at its centre shows in which half of the ellipse the gap can be larger.  The next
    ellipse is the smallest one round that half.

    The ellipse has the centre (x, y) along the tangents t and u, and the matrix E: (w - centre) . E^-1 (w - centre) <=
    1.  With the gradient c of the gap and b = E c / sqrt(c . E c), the next centre is moved by b / 3, and the next
    matrix is 4/3 (E - 2/3 b b^T).
    """
    best: Start = start
    _, n = start
    t = tangent_of(n)
    u = cross(n, t)
    x, y, e_xx, e_xy, e_yy = 0.0, 0.0, _WIDE * _WIDE, 0.0, _WIDE * _WIDE
    for _ in range(_CUTS):
        direction = plus_scaled(plus_scaled(n, x, t), y, u)
        length = norm(direction)
        direction = divided(direction, length)
        q, _ = facing_point(cores, direction)
        d = minus(q, support_of(cores.first, direction)[1])
        gap = dot(direction, d)
        if gap > best[0]:
            best = gap, direction
        slope_x, slope_y = in_plane(t, u, divided(plus_scaled(d, -gap, direction), length))
        b_x, b_y = e_xx * slope_x + e_xy * slope_y, e_xy * slope_x + e_yy * slope_y
        # squared growth of the gap from the centre to the border of the ellipse, to first order
        growth = slope_x * b_x + slope_y * b_y
        if not growth > (_HIGHER * size_of(cores)) ** 2:
            break
        growth = math.sqrt(growth)
        b_x, b_y = b_x / growth, b_y / growth
        x, y = x + b_x / 3.0, y + b_y / 3.0
        e_xx, e_xy = (e_xx - b_x * b_x / 1.5) / 0.75, (e_xy - b_x * b_y / 1.5) / 0.75
        e_yy = (e_yy - b_y * b_y / 1.5) / 0.75
    return best
