"""The direction along which a pair of convex parts is farthest apart, or overlaps least.

Apart: the search of E. Gilbert, D. Johnson and S. Keerthi, IEEE J. Robotics Automat. 4 (1988) 193, of which every step
gives a separation s(n); the best is kept.  Next to contact the difference of the parts passes so close to the origin
that its direction is lost in round-off.  So the second part is moved away along the direction that is known, by a
thousandth of the size or by twice the overlap; there the search finds a direction that is right to round-off over that
way, and s(n) of the pose itself is taken, again as long as it grows.  Overlaps have several such directions, each least
among its neighbours: all axes of both frames are begun from, too.
"""

from __future__ import annotations

import math

from nonsmooth.engine.native.kernel import Floats, Workspace, frame_at, kernel
from nonsmooth.engine.numerics.vectors import Vector, dot, minus, scaled
from nonsmooth.engine.pairs.simplex import corner, nearest_point, put_corner, reduce_to_nearest
from nonsmooth.engine.pairs.support import closest_difference, middle_of, separation_along

_MOST_STEPS = 100
"""Steps of a search; flat ellipsoids take some sixty."""
_MOST_SHIFTS = 8
"""Times that the second part is moved away; each at least doubles the correct digits of an angle."""
_SHIFT = 1e-3
"""By this part of the size the second part is moved away at least."""
_ROUND_OFF = 1e-13
"""Separations nearer than this part of the size are the same."""


@kernel("v3(v3, v3)")
def _unit(v: Vector, other: Vector) -> Vector:
    """Return a vector divided by its length, another one if it has none."""
    size = math.sqrt(dot(v, v))
    return scaled(1.0 / size, v) if size > 0.0 else other


@kernel("v3(ws, i8, v3, v3, f8)")
def _search(ws: Workspace, number: int, start: Vector, shift: Vector, size: float) -> Vector:
    """Return the unit vector along which the parts are farthest apart, the second being moved by ``shift``."""
    n = best = start
    bound, upper, held, far = -math.inf, math.inf, 0, 0.0
    for _ in range(_MOST_STEPS):
        x, y, z = closest_difference(ws, number, n)
        found = x + shift[0], y + shift[1], z + shift[2]
        height = dot(n, found)
        if height > bound:
            bound, best = height, n
        far = max(far, abs(found[0]) + abs(found[1]) + abs(found[2]))
        known = 0
        for i in range(held):
            off = minus(corner(ws, i), found)
            known += 1 if dot(off, off) == 0.0 else 0
        if known > 0 or upper - bound <= _ROUND_OFF * size:
            break
        put_corner(ws, held, found)
        held = reduce_to_nearest(ws, held + 1, far)
        if held == 0:
            break
        point = nearest_point(ws, held)
        norm = math.sqrt(dot(point, point))
        # inside but for round-off, or no nearer than before
        if norm <= 1e-16 * far or norm >= upper:
            break
        upper, n = norm, scaled(1.0 / norm, point)
    return best


@kernel("v3(ws, i8, v3, f8)")
def _climb(ws: Workspace, number: int, start: Vector, size: float) -> Vector:
    """Return the direction of largest separation among the neighbours of ``start``."""
    n, best = start, separation_along(ws, number, start)
    for _ in range(_MOST_SHIFTS):
        shift = scaled(max(-2.0 * best, _SHIFT * size), n)
        other = _search(ws, number, n, shift, size)
        found = separation_along(ws, number, other)
        if found <= best + _ROUND_OFF * size:
            break
        n, best = other, found
    return n


@kernel("v3(F, i8, i8)")
def _axis_of_frame(w: Floats, frame_place: int, axis: int) -> Vector:
    """Return an axis of a frame; from the fourth on they point the other way."""
    frame, column = frame_at(w, frame_place), axis % 3
    sign = 1.0 if axis < 3 else -1.0
    return sign * frame.rotation[column], sign * frame.rotation[column + 3], sign * frame.rotation[column + 6]


@kernel("v3(ws, i8)")
def _between_middles(ws: Workspace, number: int) -> Vector:
    """Return the direction from the middle of the first part of a pair to that of the second."""
    pair = ws.pairs[number]
    between = minus(middle_of(ws.floats, pair.frame_b, pair.part_b), middle_of(ws.floats, pair.frame_a, pair.part_a))
    return _unit(between, (0.0, 0.0, 1.0))


@kernel("v3(ws, i8, v3)")
def separating_direction(ws: Workspace, number: int, known: Vector) -> Vector:
    """Return a unit vector along which a pair is farthest apart, if it is apart, as far as one search tells.

    ``known`` is one to begin with, of length 0 if there is none.
    """
    pair = ws.pairs[number]
    return _search(ws, number, _unit(known, _between_middles(ws, number)), (0.0, 0.0, 0.0), pair.size)


@kernel("v3(ws, i8, v3, f8)")
def best_direction(ws: Workspace, number: int, known: Vector, enough: float) -> Vector:
    """Return a unit vector along which the separation of a pair is at least ``enough``, or else the largest found.

    ``known`` is one to begin with, of length 0 if there is none.
    """
    pair, across = ws.pairs[number], _between_middles(ws, number)
    start = _unit(known, across)
    n = _search(ws, number, start, (0.0, 0.0, 0.0), pair.size)
    best = separation_along(ws, number, n)
    # the direction that is known, that between the middles, and six axes of either frame
    for trial in range(15):
        if best >= enough:
            break
        begin = start if trial == 0 else n
        if trial == 2:
            begin = across
        elif trial > 2:
            begin = _axis_of_frame(ws.floats, pair.frame_a if trial < 9 else pair.frame_b, (trial - 3) % 6)
        other = _climb(ws, number, begin, pair.size)
        found = separation_along(ws, number, other)
        if found > best:
            best, n = found, other
    return n
