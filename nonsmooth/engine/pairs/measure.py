"""Distance of a pair of convex parts, or the depth of their overlap, with nearest points and bounds.

The separation s(n) along the best direction n is the signed distance: a lower bound that is exact for the best n. The
nearest points of both parts give the upper bound. Parts that overlap have no distance: -s(n) is then the length of a
translation that separates them, and a polytope bounds the least one from below.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.support import (
    farthest_of_first,
    farthest_of_second,
    has_half_space,
    height_above_plane,
    normal_of_plane,
    separation_along,
)
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.vectors import Vector, distance, minus, opposite, scaled
from nonsmooth.engine.pairs.polytope import proved_depth
from nonsmooth.engine.pairs.separation import ROUND_OFF, SHIFT, best_direction, climb, search, unit
from nonsmooth.engine.pairs.simplex import has_nearest_point, nearest_of_first, nearest_of_second

_ROUNDS = 3
"""Number of searches for the nearest points, each with less shift than the one before."""
_NEARER = 1e-3
"""Shift of the second part in a search, relative to that in the search before."""


@kernel("void(ws, i8, v3)")
def _take_if_better(ws: Workspace, number: int, n: Vector) -> None:
    """Make the unit vector ``n`` the direction of a pair if the separation along it is larger."""
    pair, found = ws.pairs[number], separation_along(ws, number, n)
    if found > pair.separation:
        pair.separation, pair.measured = found, n


@kernel("void(ws, i8)")
def _write_nearest_points(ws: Workspace, number: int) -> None:
    """Write the nearest points of a pair, and improve its direction.

    In a search the second part is moved away along the direction, so that the parts are apart by the shift or more. The
    points are then moved back. The less the shift, the smaller the offset of the points along the tangent plane, but
    the less accurate the direction.
    """
    pair, best, shift = ws.pairs[number], math.inf, SHIFT * ws.pairs[number].size
    # support points serve if no search ends
    pair.first = farthest_of_first(ws, number, pair.measured)
    pair.second = farthest_of_second(ws, number, opposite(pair.measured))
    for _ in range(_ROUNDS):
        n = pair.measured
        away = scaled(shift + max(0.0, -pair.separation), n)
        # without a tolerance the search ends where round-off stops it
        other = search(ws, number, n, away, 0.0)
        if has_nearest_point(ws):
            first, moved = nearest_of_first(ws), nearest_of_second(ws)
            # a search that round-off stops does not evaluate the direction of its last point
            _take_if_better(ws, number, unit(minus(moved, first), n))
            second = minus(moved, away)
            apart = distance(first, second)
            if apart < best:
                best, pair.first, pair.second = apart, first, second
        _take_if_better(ws, number, other)
        shift *= _NEARER


@kernel("void(ws, i8)")
def _measure_from_plane(ws: Workspace, number: int) -> None:
    """Measure a pair whose first part is a half-space: its separation is the height of the lowest point."""
    pair, up = ws.pairs[number], normal_of_plane(ws, number)
    pair.measured, pair.separation = up, height_above_plane(ws, number)
    pair.shallowest = pair.separation
    pair.second = farthest_of_second(ws, number, opposite(up))
    pair.first = minus(pair.second, scaled(pair.separation, up))


@entry_point("void(ws, i8)")
def measure_pair(ws: Workspace, number: int) -> None:
    """Write separation, direction, nearest points and upper bound of pair ``number``. Only its parts are read.

    The search starts from the direction that the pair has, or between the middles if that has length 0.
    """
    if has_half_space(ws, number):
        _measure_from_plane(ws, number)
        return
    pair = ws.pairs[number]
    # parts that are closer than the shift need its accuracy, and those that overlap need several starts
    pair.measured = best_direction(ws, number, pair.measured, SHIFT * pair.size)
    pair.separation = separation_along(ws, number, pair.measured)
    # from a pose in which the parts are farther apart, round-off turns the direction less
    _take_if_better(ws, number, search(ws, number, pair.measured, scaled(pair.size, pair.measured), pair.size))
    depth = 0.0
    if pair.separation < -ROUND_OFF * pair.size:
        depth = proved_depth(ws, number)
        _take_if_better(ws, number, climb(ws, number, pair.measured, pair.size))
    _write_nearest_points(ws, number)
    pair.shallowest = -depth if depth > 0.0 else max(pair.separation, distance(pair.first, pair.second))
