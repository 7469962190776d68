"""Nearest feature of a patch of a surface that is not convex to a body with a smooth support function.

A tree of bounding boxes gives the faces, convex edges and corners that may be near.  Of these, the feature is taken
whose stop has the least gap (:mod:`bodies.contacts.surface.smooth_stops`), if the body may touch it there.
"""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled

from ...rotations import rotated_back
from ...shapes.support_function import support_of
from ...vectors import Vector3, divided, dot, minus, norm, opposite, vector_at
from ..features.ends import REACH
from ..smooth.smooth_core import RADIUS
from .smooth_stops import Nearest, SmoothOver, Stop, over_corner, over_edge, over_face
from .surface_search import past_edge
from .surface_tables import (
    ON_EDGE,
    ON_FACE,
    SIZE,
    corner_at,
    face_height,
    feature_of,
    patch_of,
)
from .surface_tree import first_leaf, next_leaf

_SAME = 1e-15
"""Difference of two distances that is round-off, relative to the size of the bodies."""


@compiled
def _least(body: SmoothOver, nearest: Vector3) -> float:
    """Return a lower bound of the smooth body's distance from a convex feature [m].

    ``nearest`` is the feature's point nearest to the centre of the body [m].
    """
    way = minus(body.cores.center, nearest)
    apart = norm(way)
    if apart == 0.0:
        return -math.inf
    towards = rotated_back(body.cores.turn, divided(opposite(way), apart))
    return float(apart - support_of(body.cores.second, towards)[0] - body.cores.second[RADIUS])


@compiled
def _evaluate(body: SmoothOver, member: int, most: float) -> tuple[Stop, float]:
    """Return the stop over one feature of the surface, and a lower bound of its distance from the body [m].

    The distance of the core is infinite if the feature cannot be nearer than ``most`` [m]; it is nan if the search
    failed.  The distance past the end is positive, too, if the centre of the core is on the inner side of the feature.
    ``member`` is the number of the feature in the tree.
    """
    kind, number, row = feature_of(body.surface, member)
    w = minus(body.cores.center, vector_at(row, 0))
    stop = Stop(math.inf, 0.0, (0.0, 0.0, 1.0), w)
    if kind == ON_FACE:
        least = face_height(body.surface, number, body.cores.center) - body.size
        if least <= most:
            stop = over_face(body, number, row, 1)
    elif kind == ON_EDGE:
        least = _least(body, past_edge(row, body.cores.center)[1])
        if least <= most:
            stop = over_edge(body, row, w)
    else:
        least = _least(body, vector_at(row, 0))
        if least <= most:
            stop = over_corner(body, corner_at(body.surface, number), w)
    return Stop(stop.gap, max(stop.past, -dot(stop.normal, w)), stop.normal, stop.point), least


@compiled
def nearest_of_patch(body: SmoothOver, patch: float, reach: float) -> Nearest:
    """Return the stop over the feature of a patch with the least key, and the feature.

    The key is the gap of a feature that the body may touch, else the hypotenuse of gap and distance past its end.  A
    feature that the body may touch wins over another one with the same key within round-off: on the border of a face,
    the face wins over its edge.  If no key is below ``reach`` [m], gap and distance past the end are ``reach``.  The
    distance of the core is nan if the search failed for a feature whose key may be less.

    The size of the ``body`` is the distance of its farthest point from the centre of its core.
    """
    surface, center, radius = body.surface, body.cores.center, body.cores.second[RADIUS]
    round_off, margin = _SAME * (body.size + surface[SIZE]), REACH * surface[SIZE]
    best_key, least_failed, found = reach, math.inf, 0
    best = Stop(reach + radius, reach, (0.0, 0.0, 1.0), center)
    leaf = first_leaf(surface, patch, center)
    while leaf.begin < leaf.end:
        for i in range(leaf.begin, leaf.end):
            member = int(surface[i])
            if patch_of(surface, member) != patch:
                continue
            (gap, past, n, point), least = _evaluate(body, member, best_key)
            if math.isnan(gap):
                least_failed = min(least_failed, least)
                continue
            key = gap - radius if past <= margin else math.hypot(gap - radius, past)
            is_tie = key < best_key + round_off and past <= margin
            if key < best_key - round_off or (is_tie and (best.past > 0.0 or member < found)):
                best_key, best, found = key, Stop(gap, past - margin, n, point), member
        # a feature that is nearer than the best one meets the ball that encloses the body, enlarged by its key
        leaf = next_leaf(surface, leaf.after, patch, center, max(body.size + best_key, 0.0) ** 2)
    if not least_failed >= best_key:
        best = Stop(math.nan, best.past, best.normal, best.point)
    kind, number, _ = feature_of(surface, found)
    return Nearest(best, kind, number)
