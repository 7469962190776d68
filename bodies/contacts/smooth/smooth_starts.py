"""Where to begin the search of the shortest way out of two smooth bodies: directions with a large gap.

The gap along a direction is by the support functions alone.  It is looked at along the axes of both bodies and half-way
between two or three of them, where flat and sharp places are.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from bodies.contacts.features.tangents import tangent_of
from bodies.contacts.smooth.smooth_core import Axes, back, forth
from bodies.shapes.support_function import support_of
from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

_LONGEST, _MOVES = 0.2, 100
"""First step uphill [rad], and the most steps."""
_NEAR = 0.95
"""Cosine of the angle between directions of which the better one stands for both."""
Start: TypeAlias = tuple[float, float, float, float]
"""A gap, and the unit vector along which it is."""
Starts: TypeAlias = tuple[Start, Start, Start, Start]
"""Four of them, in no order."""


@compiled
def gap_along(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, nx: float, ny: float, nz: float
) -> float:
    """Return the gap of two cores along a unit vector [m]; arguments as in :func:`starts_of`."""
    mx, my, mz = back(turn, -nx, -ny, -nz)
    return float(
        nx * x + ny * y + nz * z - support_of(first, nx, ny, nz)[0] - support_of(second, mx, my, mz)[0],
    )


@compiled
def uphill(
    first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float, start: Start, least: float
) -> Start:
    """Return a direction with a larger gap than any other at an angle of about ``least`` from it, by steps from one."""
    g, nx, ny, nz = start
    step = _LONGEST
    for _ in range(_MOVES):
        if step <= least:
            break
        tx, ty, tz = tangent_of(nx, ny, nz)
        ux, uy, uz = ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx
        best: Start = (g, nx, ny, nz)
        for i in range(8):
            c, s = step * math.cos(0.25 * math.pi * i), step * math.sin(0.25 * math.pi * i)
            mx, my, mz = nx + c * tx + s * ux, ny + c * ty + s * uy, nz + c * tz + s * uz
            length = math.sqrt(mx * mx + my * my + mz * mz)
            mx, my, mz = mx / length, my / length, mz / length
            found = gap_along(first, second, turn, x, y, z, mx, my, mz)
            if found > best[0]:
                best = (found, mx, my, mz)
        if best[0] <= g:
            step *= 0.4
        g, nx, ny, nz = best
    return g, nx, ny, nz


@compiled
def starts_of(first: Floats, second: Floats, turn: Axes, x: float, y: float, z: float) -> Starts:
    """Return four directions apart from each other with the largest gaps that were seen.

    Parameters
    ----------
    first, second : Floats
        The cores; their radii are left out.
    turn : Axes
        Rotation from the axes of the second core to those of the first.
    x, y, z : float
        The second core's centre from the first's [m].
    """
    none: Start = (-math.inf, 0.0, 0.0, 0.0)
    kept: Starts = (none, none, none, none)
    for i in range(54):
        way = i % 27
        if way == 13:
            continue
        nx, ny, nz = way // 9 - 1.0, way // 3 % 3 - 1.0, way % 3 - 1.0
        length = math.sqrt(nx * nx + ny * ny + nz * nz)
        nx, ny, nz = nx / length, ny / length, nz / length
        if i >= 27:
            nx, ny, nz = forth(turn, nx, ny, nz)
        g = gap_along(first, second, turn, x, y, z, nx, ny, nz)
        kept = _with(kept, (g, nx, ny, nz))
    return kept


@compiled
def _with(kept: Starts, new: Start) -> Starts:
    """Return those kept with a new one in the place of one near it, or else of the worst, if it is better."""
    one, two, three, four = kept
    if _is_near(one, new):
        place = 0
    elif _is_near(two, new):
        place = 1
    elif _is_near(three, new):
        place = 2
    elif _is_near(four, new):
        place = 3
    else:
        least = min(min(one[0], two[0]), min(three[0], four[0]))
        place = 0 if one[0] == least else 1 if two[0] == least else 2 if three[0] == least else 3
    if new[0] <= kept[place][0]:
        return kept
    return (
        new if place == 0 else one,
        new if place == 1 else two,
        new if place == 2 else three,
        new if place == 3 else four,
    )


@compiled
def _is_near(one: Start, two: Start) -> bool:
    return bool(one[1] * two[1] + one[2] * two[2] + one[3] * two[3] > _NEAR)
