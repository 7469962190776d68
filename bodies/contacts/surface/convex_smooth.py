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

from ...rotations import rotated_back
from ...vectors import cross, dot, minus, opposite, plus, plus_scaled, scaled, vector_at
from ..features.edge_vertex import ALONG, INTO_FIRST, INTO_SECOND, LENGTH, START, steepest
from ..features.ends import REACH
from ..features.frames import tangent_of
from ..smooth.inscribed import gauge, is_least_overlap
from ..smooth.round_search import along_segment, up_hills
from ..smooth.smooth_core import at_place
from .smooth_stops import Nearest, SmoothOver, Stop, over_corner, over_edge, over_face
from .surface_search import FAR, nearest_in_patch
from .surface_tables import (
    N_CORNERS,
    N_EDGES,
    N_FACES,
    ON_CORNER,
    ON_EDGE,
    ON_FACE,
    corner_at,
    edge_at,
    triangles_of,
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
_ROUND = 8
"""Number of directions about a segment from which Newton's method starts, if the segment is deep in the body."""


@compiled
def _stop(body: SmoothOver, kind: int, number: int, is_outward: bool) -> Stop:
    """Return the stop over a feature of a convex surface.

    Over an edge or a corner, the search starts with the direction to the centre of the core; if ``is_outward``, with
    the direction opposite to the sum of the unit vectors into the faces or along the edges.
    """
    surface = body.surface
    if kind == ON_FACE:
        triangle, count = triangles_of(surface, number)
        return over_face(body, number, triangle, count)
    if kind == ON_EDGE:
        edge = edge_at(surface, number)
        start = minus(body.cores.center, vector_at(edge, START))
        if is_outward and surface[N_FACES] > 0.0:
            start = opposite(plus(vector_at(edge, INTO_FIRST), vector_at(edge, INTO_SECOND)))
        return over_edge(body, edge, start)
    corner = corner_at(surface, number)
    start = minus(body.cores.center, corner.place)
    if is_outward:
        start = (0.0, 0.0, 0.0)
        for i in range(int(corner.n_star)):
            start = minus(start, vector_at(corner.star, 3 * i))
    return over_corner(body, corner, start)


@compiled
def nearest_of_convex(body: SmoothOver) -> Nearest:
    """Return the separation of a convex surface or a segment and a smooth body, with feature, normal and point.

    It is the first valid stop, if its overlap is below ``_SHALLOW``; below ``_DEEP``, if the stop's point is inside of
    the core; or if a ball inside of the core proves that no other stop has a larger gap.  Otherwise it is the largest
    gap over the stops of all features.
    """
    core, first = body.cores.second, _first_valid(body)
    g, _, n, point = first.stop
    if g >= -_SHALLOW * body.size:
        return first
    from_point = at_place(body.cores, point)
    is_shallow = g >= -_DEEP * min(core[0], core[1], core[2])
    if is_shallow and gauge(core, rotated_back(from_point.turn, opposite(from_point.center))) < 1.0:
        return first
    if g == g and is_least_overlap(from_point, (g, scaled(g, n), n)):
        return first
    return _of_segment(body, first) if body.surface[N_FACES] == 0.0 else _of_all(body, first)


@compiled
def _is_valid(body: SmoothOver, stop: Stop) -> bool:
    """Return whether a stop was found, and its point and normal belong to its feature up to round-off."""
    return not math.isnan(stop.gap) and stop.past <= _ON_BORDER * body.size


@compiled
def _first_valid(body: SmoothOver) -> Nearest:
    """Return the first valid stop on the way from the feature nearest to the core's centre, or a failed search."""
    core, aim, last, part = body.cores.second, body.cores.center, (0.0, 0.0, 0.0), 1.0
    radius = min(core[0], core[1], core[2])
    for _ in range(_STEPS):
        found = nearest_in_patch(body.surface, 0.0, aim, FAR)
        stop = _stop(body, found.kind, found.number, False)
        if _is_valid(body, stop):
            return Nearest(stop, found.kind, found.number)
        if math.isnan(stop.gap):
            break
        # next, aim at the centre of a ball in the core that touches its surface over the stop
        step = minus(plus_scaled(stop.point, max(radius + stop.gap, _ABOVE * radius), stop.normal), aim)
        # half of a step that turns back, so that the search finds the edge between two faces
        part = 0.5 * part if dot(step, last) < 0.0 else part
        aim, last = plus_scaled(aim, part, step), step
    return Nearest(Stop(math.nan, 0.0, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)), ON_FACE, 0)


@compiled
def _of_all(body: SmoothOver, first: Nearest) -> Nearest:
    """Return the valid stop with the largest gap, of ``first`` and of all features.

    If no stop is valid within round-off, it is the stop least past its end, up to the tolerance ``REACH``.
    """
    best, closest, least = first, first, REACH * body.size
    for kind in (ON_FACE, ON_EDGE, ON_CORNER):
        for number in range(int(body.surface[(N_FACES, N_EDGES, N_CORNERS)[kind]])):
            stop = _stop(body, kind, number, True)
            if math.isnan(stop.gap):
                stop = _stop(body, kind, number, False)
            if _is_valid(body, stop):
                if not stop.gap <= best.stop.gap:
                    best = Nearest(stop, kind, number)
            elif not math.isnan(stop.gap) and stop.past <= least:
                closest, least = Nearest(stop, kind, number), stop.past
    return closest if math.isnan(best.stop.gap) else best


@compiled
def _of_segment(body: SmoothOver, first: Nearest) -> Nearest:
    """Return the result of :func:`nearest_of_convex` for a segment that overlaps with the core.

    First, the segment's point nearest to the core is found by bisection.  If its gap is not negative, it is the result.
    Otherwise it is the largest gap over valid stops, over the side from ``_ROUND`` directions.  If no stop is valid, it
    is the overlap of the point by bisection, or the largest gap of searches from directions with a large gap at an end.
    """
    surface, cores, size = body
    row = edge_at(surface, 0)
    begin, e, length = vector_at(row, START), vector_at(row, ALONG), row[LENGTH]
    (g, _, n), s = along_segment(at_place(cores, begin), e, length)
    kind, number = (ON_CORNER, 0) if s == 0.0 else (ON_CORNER, 1) if s == length else (ON_EDGE, 0)
    bisected = Nearest(Stop(g, 0.0, n, plus_scaled(begin, s, e)), kind, number)
    if g >= 0.0:
        return bisected
    best, t = _of_all(body, first), tangent_of(e)
    u = cross(e, t)
    for i in range(_ROUND):
        angle = 2.0 * math.pi * i / _ROUND
        stop = over_edge(body, row, plus(scaled(math.cos(angle), t), scaled(math.sin(angle), u)))
        if _is_valid(body, stop) and not stop.gap <= best.stop.gap:
            best = Nearest(stop, ON_EDGE, 0)
    if not math.isnan(best.stop.gap):
        return best
    if g == g:
        return bisected
    for end in range(2):
        corner = corner_at(surface, end)
        g, _, n = up_hills(at_place(cores, corner.place), 0.0, (1.0, 0.0, size))
        if steepest(corner, n) <= 0.0 and g == g and not g <= best.stop.gap:
            best = Nearest(Stop(g, 0.0, n, corner.place), ON_CORNER, end)
    return best
