"""Separation of a convex surface or a segment and a smooth body: the largest gap over all stops.

For each normal n, the gap between the supporting planes of both bodies is a lower bound of their separation, and the
largest of these gaps is the separation, also in an overlap.  At the maximum, n is the normal of a stop whose point and
normal belong to its feature (:mod:`bodies.contacts.surface.smooth_stops`); such a stop is called valid.  If the bodies
are apart, there is one valid stop.

The search for it goes from feature to feature.  A valid stop's feature is nearest to all points on the normal above the
stop.  If the stop is not valid, the search continues on the feature that is nearest to such a point.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.support_function import Core
from ...vectors import Vector3, cross, dot, minus, opposite, plus, plus_scaled, scaled, vector_at
from ..features.edge_row import ALONG, INTO_FIRST, INTO_SECOND, LENGTH
from ..features.ends import REACH
from ..features.frames import tangent_of
from ..smooth.inscribed import gauge, is_least_overlap
from ..smooth.round_search import along_segment, up_hills
from ..smooth.smooth_core import POINT, Axes, Cores, largest_semi_axis, rotated_back, spread
from .smooth_stops import Nearest, Stop, over_corner, over_edge, over_face
from .surface_search import (
    FAR,
    ON_CORNER,
    ON_EDGE,
    ON_FACE,
    corner_row,
    edge_at,
    face_at,
    face_height,
    nearest_in_patch,
    steepest,
)
from .surface_tables import (
    FIRST_TRIANGLE,
    N_CORNERS,
    N_EDGES,
    N_FACES,
    N_OF_FACE,
    N_STAR,
    STAR,
    STARS,
    TRIANGLE,
    TRIANGLES,
)

_ON_BORDER = 1e-14
"""Distance past the end, relative to the size, up to which a stop is valid: round-off."""
_SHALLOW = 1e-6
"""Overlap of the cores, relative to the size, up to which the first valid stop is accepted.

A deeper overlap can have several valid stops, so that the stop must be proved or compared with those of all features.
"""
_DEEP = 1e-2
"""Overlap, relative to the core's least semi-axis, up to which a valid stop whose point is in the core is accepted.

Several valid stops occur only in deeper overlaps, which are compared with this length.
"""
_ABOVE = 0.1
"""Least height of the point that decides on the next feature above the stop, relative to the core's least semi-axis."""
_STEPS = 12
"""Largest number of features of the search for a valid stop."""
_FEW = 50
"""Number of faces up to which the search begins with the face over which the core's centre is highest."""
_ROUND = 8
"""Number of directions about a segment from which Newton's method starts, if the segment is deep in the body."""

_FAILED: Nearest = ((math.nan, 0.0, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)), ON_FACE, 0)
"""Result of a search that failed."""


@compiled
def _stop(
    surface: Floats, kind: int, number: int, core: Core, turn: Axes, center: Vector3, size: float, is_outward: bool
) -> Stop:
    """Return the stop over a feature of a convex surface.

    Over an edge or a corner, the search starts with the direction to the centre of the core; if ``is_outward``, with
    the direction opposite to the sum of the unit vectors into the faces or along the edges.
    """
    if kind == ON_FACE:
        f = face_at(surface, number)
        t = int(surface[TRIANGLES]) + TRIANGLE * int(surface[f + FIRST_TRIANGLE])
        stop: Stop = over_face(surface, t, int(surface[f + N_OF_FACE]), core, turn, center)
    elif kind == ON_EDGE:
        e = edge_at(surface, number)
        start = minus(center, vector_at(surface, e))
        if is_outward and surface[N_FACES] > 0.0:
            start = opposite(plus(vector_at(surface, e + INTO_FIRST), vector_at(surface, e + INTO_SECOND)))
        stop = over_edge(surface, e, core, turn, center, start, size)
    else:
        c = corner_row(surface, number)
        start = minus(center, vector_at(surface, c))
        if is_outward:
            start, star = (0.0, 0.0, 0.0), int(surface[STARS]) + int(surface[c + STAR])
            for i in range(int(surface[c + N_STAR])):
                start = minus(start, vector_at(surface, star + 3 * i))
        stop = over_corner(surface, c, core, turn, center, start, size)
    return stop


@compiled
def nearest_of_convex(surface: Floats, core: Core, turn: Axes, center: Vector3) -> Nearest:
    """Return the separation of a convex surface or a segment and the core, with feature, normal and point.

    It is the first valid stop, if its overlap is below ``_SHALLOW``; below ``_DEEP``, if the stop's point is inside of
    the core; or if a ball inside of the core proves that no other stop has a larger gap.  Otherwise it is the largest
    gap over the stops of all features.  ``turn`` and ``center`` are those of
    :mod:`bodies.contacts.smooth.smooth_core`, in the axes of the surface.
    """
    size = spread(center) + largest_semi_axis(core) + spread(vector_at(surface, edge_at(surface, 0)))
    first = _first_valid(surface, core, turn, center, size)
    g, _, n, point = first[0]
    if g >= -_SHALLOW * size:
        return first
    if g >= -_DEEP * min(core[0], core[1], core[2]) and gauge(core, rotated_back(turn, minus(point, center))) < 1.0:
        return first
    if g == g and is_least_overlap(Cores(POINT, core, turn, minus(center, point)), (g, scaled(g, n), n)):
        return first
    if surface[N_FACES] == 0.0:
        return _of_segment(surface, core, turn, center, size, first)
    return _of_all(surface, core, turn, center, size, first)


@compiled
def _is_valid(stop: Stop, size: float) -> bool:
    """Return whether a stop was found, and its point and normal belong to its feature up to round-off."""
    return bool(stop[0] == stop[0] and stop[1] <= _ON_BORDER * size)


@compiled
def _first_valid(surface: Floats, core: Core, turn: Axes, center: Vector3, size: float) -> Nearest:
    """Return the first valid stop on the way from a feature near to the core's centre, or a failed search."""
    radius, aim = min(core[0], core[1], core[2]), center
    last, part = (0.0, 0.0, 0.0), 1.0
    kind, number = ON_FACE, _highest_face(surface, center)
    for _ in range(_STEPS):
        if number < 0:
            _, _, kind, number, _, _, _ = nearest_in_patch(surface, 0.0, aim, FAR)
        stop = _stop(surface, kind, number, core, turn, center, size, False)
        if _is_valid(stop, size):
            return stop, kind, number
        g, _, n, point = stop
        if g != g:
            break
        # next, aim at the centre of a ball in the core that touches its surface over the stop
        step = minus(plus_scaled(point, max(radius + g, _ABOVE * radius), n), aim)
        # half of a step that turns back, so that the search finds the edge between two faces
        part = 0.5 * part if dot(step, last) < 0.0 else part
        aim, last, number = plus_scaled(aim, part, step), step, -1
    return _FAILED


@compiled
def _highest_face(surface: Floats, point: Vector3) -> int:
    """Return the face over whose plane a point is highest, or -1 if a search of the tree costs less than all faces."""
    highest, most = -1, -math.inf
    if surface[N_FACES] <= _FEW:
        for face in range(int(surface[N_FACES])):
            height = face_height(surface, face_at(surface, face), point)
            if height > most:
                highest, most = face, height
    return highest


@compiled
def _of_all(surface: Floats, core: Core, turn: Axes, center: Vector3, size: float, first: Nearest) -> Nearest:
    """Return the valid stop with the largest gap, of ``first`` and of all features.

    If no stop is valid within round-off, it is the stop least past its end, up to the tolerance ``REACH``.
    """
    best, closest, least = first, _FAILED, REACH * size
    for kind in (ON_FACE, ON_EDGE, ON_CORNER):
        count = surface[N_FACES if kind == ON_FACE else N_EDGES if kind == ON_EDGE else N_CORNERS]
        for number in range(int(count)):
            stop = _stop(surface, kind, number, core, turn, center, size, True)
            if stop[0] != stop[0]:
                stop = _stop(surface, kind, number, core, turn, center, size, False)
            if _is_valid(stop, size):
                if not stop[0] <= best[0][0]:
                    best = stop, kind, number
            elif stop[0] == stop[0] and stop[1] <= least:
                closest, least = (stop, kind, number), stop[1]
    return best if best[0][0] == best[0][0] else closest


@compiled
def _of_segment(surface: Floats, core: Core, turn: Axes, center: Vector3, size: float, first: Nearest) -> Nearest:
    """Return the result of :func:`nearest_of_convex` for a segment that overlaps with the core.

    First, the segment's point nearest to the core is found by bisection.  If its gap is not negative, it is the result.
    Otherwise it is the largest gap over valid stops, over the side from ``_ROUND`` directions.  If no stop is valid, it
    is the overlap of the point by bisection, or the largest gap of searches from directions with a large gap at an end.
    """
    row = edge_at(surface, 0)
    begin, e, length = vector_at(surface, row), vector_at(surface, row + ALONG), surface[row + LENGTH]
    (g, _, n), s = along_segment(core, turn, minus(center, begin), e, length)
    kind, number = (ON_CORNER, 0) if s == 0.0 else (ON_CORNER, 1) if s == length else (ON_EDGE, 0)
    bisected: Nearest = (g, 0.0, n, plus_scaled(begin, s, e)), kind, number
    if g >= 0.0:
        return bisected
    best = _of_all(surface, core, turn, center, size, first)
    t = tangent_of(e)
    u = cross(e, t)
    for i in range(_ROUND):
        angle = 2.0 * math.pi * i / _ROUND
        start = plus(scaled(math.cos(angle), t), scaled(math.sin(angle), u))
        stop = over_edge(surface, row, core, turn, center, start, size)
        if _is_valid(stop, size) and not stop[0] <= best[0][0]:
            best = stop, ON_EDGE, 0
    if best[0][0] == best[0][0]:
        return best
    if g == g:
        return bisected
    for end in range(2):
        c = corner_row(surface, end)
        place = vector_at(surface, c)
        g, _, n = up_hills(POINT, core, turn, minus(center, place), 0.0, (1.0, 0.0, size))
        if steepest(surface, c, n) <= 0.0 and g == g and not g <= best[0][0]:
            best = (g, 0.0, n, place), ON_CORNER, end
    return best
