"""Direction along which a pair of convex parts is farthest apart, or overlaps least.

Parts that are apart: the search of E. Gilbert, D. Johnson and S. Keerthi, IEEE J. Robotics Automat. 4 (1988) 193. Each
of its steps gives a separation s(n), which is a lower bound of the distance, so the best one is kept.

Close to contact, the difference of the parts passes so close to the origin that round-off spoils its direction. So the
second part is shifted away along the known direction, by a thousandth of the size or by twice the overlap. The search
there gives a direction that is accurate relative to that shift. Then s(n) of the true position is evaluated. This is
repeated as long as s(n) grows.

Parts that overlap have several directions of locally least overlap. So the search also starts from all axes of both
frames. The expanding polytope algorithm would find the global one, but it needs a growing list of faces.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.support import farthest_of_first, farthest_of_second, middle_of, separation_along
from nonsmooth.engine.native.kernel import Floats, Workspace, frame_at, kernel
from nonsmooth.engine.numerics.vectors import Vector, dot, minus, opposite, scaled
from nonsmooth.engine.pairs.simplex import corner, nearest_point, put_corner, reduce_to_nearest

_MOST_STEPS = 100
"""Most steps of a search. Flat ellipsoids take about sixty."""
_MOST_SHIFTS = 8
"""Most shifts of the second part. Each at least doubles the correct digits of an angle."""
SHIFT = 1e-3
"""Least shift of the second part, relative to the size of the pair."""
ROUND_OFF = 1e-13
"""Difference of two separations that is round-off, relative to the size of the pair."""


@kernel("v3(v3, v3)")
def unit(v: Vector, other: Vector) -> Vector:
    """Vector divided by its length, or ``other`` if its length is zero."""
    size = math.sqrt(dot(v, v))
    return scaled(1.0 / size, v) if size > 0.0 else other


@kernel("v3(ws, i8, v3, v3, f8)")
def search(ws: Workspace, number: int, start: Vector, shift: Vector, size: float) -> Vector:
    """Unit vector along which the parts of pair ``number`` are farthest apart if the second is moved by ``shift`` [m].

    It is the algorithm of Gilbert, Johnson and Keerthi, from the unit vector ``start``. The simplex holds points of the
    difference of the parts. Its point nearest to the origin is an upper bound of the distance, and the separation s(n)
    a lower one. ``size`` [m] is that of the pair. However the search ends, the direction of the largest s(n) is taken.
    """
    n = best = start
    lower, upper, n_corners, far = -math.inf, math.inf, 0, 0.0
    for _ in range(_MOST_STEPS):
        of_first = farthest_of_first(ws, number, n)
        x, y, z = minus(farthest_of_second(ws, number, opposite(n)), of_first)
        # a point of the difference of the parts; its height along n is s(n)
        found = x + shift[0], y + shift[1], z + shift[2]
        height = dot(n, found)
        if height > lower:
            lower, best = height, n
        # size of the simplex, to which round-off is relative
        far = max(far, abs(found[0]) + abs(found[1]) + abs(found[2]))
        # no new point, or both bounds agree
        if _is_corner(ws, n_corners, found) or upper - lower <= ROUND_OFF * size:
            break
        put_corner(ws, n_corners, found, of_first)
        n_corners = reduce_to_nearest(ws, n_corners + 1, far)
        # the origin is inside: the parts overlap
        if n_corners == 0:
            break
        point = nearest_point(ws, n_corners)
        norm = math.sqrt(dot(point, point))
        # the origin is inside up to the round-off of doubles, 1e-16, or the point is no nearer than before
        if norm <= 1e-16 * far or norm >= upper:
            break
        upper, n = norm, scaled(1.0 / norm, point)
    return best


@kernel("b1(ws, i8, v3)")
def _is_corner(ws: Workspace, n_corners: int, point: Vector) -> bool:
    """True if a point is one of the ``n_corners`` corners of the simplex: the search has found nothing new."""
    for i in range(n_corners):
        off = minus(corner(ws, i), point)
        if dot(off, off) == 0.0:
            return True
    return False


@kernel("v3(ws, i8, v3, f8)")
def climb(ws: Workspace, number: int, start: Vector, size: float) -> Vector:
    """Unit vector of a local maximum of the separation s(n), from ``start`` on. ``size`` [m] is that of the pair.

    The second part is shifted away along n, so that the parts are apart and a search is accurate. The direction that it
    finds is then judged at the true position.
    """
    n, best = start, separation_along(ws, number, start)
    for _ in range(_MOST_SHIFTS):
        # twice the overlap, or a small part of the size if the parts are close
        shift = scaled(max(-2.0 * best, SHIFT * size), n)
        other = search(ws, number, n, shift, size)
        found = separation_along(ws, number, other)
        if found <= best + ROUND_OFF * size:
            break
        n, best = other, found
    return n


@kernel("v3(F, i8, i8)")
def _axis_of_frame(floats: Floats, frame_place: int, axis: int) -> Vector:
    """Axis 0, 1 or 2 of the frame at ``frame_place``, or its opposite for ``axis`` 3, 4 or 5."""
    frame, column = frame_at(floats, frame_place), axis % 3
    sign = 1.0 if axis < 3 else -1.0
    return sign * frame.rotation[column], sign * frame.rotation[column + 3], sign * frame.rotation[column + 6]


@kernel("v3(ws, i8)")
def _between_middles(ws: Workspace, number: int) -> Vector:
    """Unit vector from the middle of the first part of pair ``number`` to that of the second, or z if they coincide."""
    pair = ws.pairs[number]
    between = minus(middle_of(ws.floats, pair.frame_b, pair.part_b), middle_of(ws.floats, pair.frame_a, pair.part_a))
    return unit(between, (0.0, 0.0, 1.0))


@kernel("v3(ws, i8, v3)")
def separating_direction(ws: Workspace, number: int, known: Vector) -> Vector:
    """Unit vector along which a pair is farthest apart, by one search from ``known``. Parts that overlap need more."""
    # a direction of length 0 means that none is known: the search starts from the direction between the middles
    pair = ws.pairs[number]
    return search(ws, number, unit(known, _between_middles(ws, number)), (0.0, 0.0, 0.0), pair.size)


@kernel("v3(ws, i8, v3)")
def accurate_direction(ws: Workspace, number: int, known: Vector) -> Vector:
    """Unit vector along which a pair is farthest apart, accurate next to contact, too, by searches from ``known``.

    Of parts that overlap, it need not be the direction of least overlap.
    """
    n, size = separating_direction(ws, number, known), ws.pairs[number].size
    return climb(ws, number, n, size) if separation_along(ws, number, n) < SHIFT * size else n


@kernel("v3(ws, i8, v3, f8)")
def best_direction(ws: Workspace, number: int, known: Vector, enough: float) -> Vector:
    """Unit vector along which the separation of a pair is at least ``enough`` [m], or else the largest one found.

    The search starts from ``known``, or from the direction between the middles if that has length 0. Other starts are
    tried only as long as the separation is less than ``enough``.
    """
    pair, between = ws.pairs[number], _between_middles(ws, number)
    start = unit(known, between)
    n = separating_direction(ws, number, known)
    best = separation_along(ws, number, n)
    # starts: the known direction, the best so far, that between the middles, and six axes of either frame
    for trial in range(15):
        if best >= enough:
            break
        begin = start if trial == 0 else n
        if trial == 2:
            begin = between
        elif trial > 2:
            begin = _axis_of_frame(ws.floats, pair.frame_a if trial < 9 else pair.frame_b, (trial - 3) % 6)
        other = climb(ws, number, begin, pair.size)
        found = separation_along(ws, number, other)
        if found > best:
            best, n = found, other
    return n
