"""Starts for the search of the largest gap of two smooth bodies over all directions: directions with a large gap.

The gap along a direction follows from the support functions alone.  It is evaluated along the axes of both bodies and
half-way between two or three axes, where the bodies have flat and sharp places.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled

from ...shapes.support_function import Core, support_of
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus_scaled
from ..features.frames import tangent_of
from .smooth_core import Axes, facing_point, largest_semi_axis, rotated, rotated_back, spread, unit
from .tangent_plane import in_plane

_LONGEST, _MOVES = 0.2, 100
"""Limits of the search uphill (:func:`uphill`), which increases the gap by turning the direction.

``_LONGEST``: first step [rad].  ``_MOVES``: largest number of steps.
"""
_NEAR = 0.95
"""Cosine of the angle within which two directions are the same start; the one with the larger gap is kept."""
Start: TypeAlias = tuple[float, Vector3]
"""A gap [m], and the unit vector along which it is measured."""
Starts: TypeAlias = tuple[Start, Start, Start, Start]
"""Four starts, in no order."""


@compiled
def gap_along(first: Core, second: Core, turn: Axes, place: Vector3, n: Vector3) -> float:
    """Return the gap of two cores along a unit vector [m]; arguments as in :func:`starts_of`."""
    return float(dot(n, place) - support_of(first, n)[0] - support_of(second, rotated_back(turn, opposite(n)))[0])


@compiled
def uphill(first: Core, second: Core, turn: Axes, place: Vector3, start: Start, least: float) -> Start:
    """Return a local maximum of the gap [m] and its direction, to about ``least`` [rad], by steps from ``start``."""
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
            m = unit(plus_scaled(plus_scaled(n, c, t), s, u))
            found = gap_along(first, second, turn, place, m)
            if found > best[0]:
                best = (found, m)
        if best[0] <= g:
            step *= 0.4
        g, n = best
    return g, n


@compiled
def starts_of(first: Core, second: Core, turn: Axes, place: Vector3) -> Starts:
    """Return four directions that are not close to each other, with the largest gaps of all directions tried.

    Parameters
    ----------
    first, second, turn, place : Floats, Axes, Vector3
        See :mod:`bodies.contacts.smooth.smooth_core`; the radii of the cores are not used.
    """
    none: Start = (-math.inf, (0.0, 0.0, 0.0))
    kept: Starts = (none, none, none, none)
    for i in range(54):
        way = i % 27
        if way == 13:
            continue
        n = unit((way // 9 - 1.0, way // 3 % 3 - 1.0, way % 3 - 1.0))
        if i >= 27:
            n = rotated(turn, n)
        kept = _with(kept, (gap_along(first, second, turn, place, n), n))
    return kept


@compiled
def _with(kept: Starts, new: Start) -> Starts:
    """Return the kept starts; a new one with a larger gap replaces a kept one close to it, or else the worst one."""
    place, least = -1, min(min(kept[0][0], kept[1][0]), min(kept[2][0], kept[3][0]))
    for i in range(4):
        if place < 0 and dot(kept[i][1], new[1]) > _NEAR:
            place = i
    for i in range(4):
        if place < 0 and kept[i][0] == least:
            place = i
    if new[0] <= kept[place][0]:
        return kept
    return (
        new if place == 0 else kept[0],
        new if place == 1 else kept[1],
        new if place == 2 else kept[2],
        new if place == 3 else kept[3],
    )


_CUTS, _WIDE = 400, 0.1
"""Largest number of ellipses in a run of the ellipsoid method; radius of its first ellipse, which is a circle [rad]."""
_ELLIPSES = 8
"""Largest number of runs of the ellipsoid method.

Each run starts from the direction that the run before found.  The search ends after a run that turns the direction by
less than about 0.045 rad: the maximum is then well inside the first ellipse of the run.
"""
_HIGHER = 1e-16
"""The ellipsoid method ends if the gap can grow by less than this, relative to the size of the bodies."""


@compiled
def _cut_round(circle: Core, core: Core, turn: Axes, place: Vector3, start: Start) -> Start:
    """Return the largest gap near the direction ``start`` [m], and its direction, by one run of the ellipsoid method.

    The method and the arguments are those of :func:`settle`.
    """
    best: Start = start
    _, n = start
    t = tangent_of(n)
    u = cross(n, t)
    size = spread(place) + largest_semi_axis(core) + circle[0]
    i, j, e11, e12, e22 = 0.0, 0.0, _WIDE * _WIDE, 0.0, _WIDE * _WIDE
    for _ in range(_CUTS):
        m = plus_scaled(plus_scaled(n, i, t), j, u)
        length = norm(m)
        m = divided(m, length)
        q, _ = facing_point(core, turn, place, m)
        d = minus(q, support_of(circle, m)[1])
        g = dot(m, d)
        if g > best[0]:
            best = g, m
        r, s = in_plane(t, u, divided(plus_scaled(d, -g, m), length))
        k, h = e11 * r + e12 * s, e12 * r + e22 * s
        most = r * k + s * h
        if not most > (_HIGHER * size) ** 2:
            break
        most = math.sqrt(most)
        k, h = k / most, h / most
        i, j = i + k / 3.0, j + h / 3.0
        e11, e12, e22 = (e11 - k * k / 1.5) / 0.75, (e12 - k * h / 1.5) / 0.75, (e22 - h * h / 1.5) / 0.75
    return best


@compiled
def settle(circle: Core, core: Core, turn: Axes, place: Vector3, start: Start) -> Start:
    """Return the largest gap near the direction ``start`` [m], and the direction of this gap, by the ellipsoid method.

    The method also converges on narrow ridges, where the gap changes little along one curve of directions.

    Directions are points of the plane that touches the unit sphere at the start.  An ellipse in this plane holds the
    maximum.  The gradient of the gap at its centre shows in which half of the ellipse the gap can be larger.  The next
    ellipse is the smallest one round that half.  If the direction found is far from the start, the method starts again
    from it.

    Parameters
    ----------
    circle, core : Floats
        A circle, or a point, and the smooth body, as cores.
    turn : Axes
        Rotation from the axes of the core to those of the circle.
    place : Vector3
        The core's centre from that of the circle [m].
    start : Start
        Gap and direction to begin with.
    """
    best: Start = start
    for _ in range(_ELLIPSES):
        before = best
        best = _cut_round(circle, core, turn, place, before)
        if dot(before[1], best[1]) > 1.0 - 0.1 * _WIDE * _WIDE:
            break
    return best
