"""Nearest feature of a patch of a surface that is not convex to a body with a smooth support function.

A tree of bounding boxes gives the faces, convex edges and corners that may be near.  Of these, the feature is taken
whose stop has the least gap (:mod:`bodies.contacts.surface.smooth_stops`), if the body may touch it there.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.support_function import support_of
from ...vectors import Vector3, divided, dot, minus, norm, opposite, vector_at
from ..features.edge_row import ALONG, LENGTH
from ..features.ends import REACH
from ..smooth.smooth_core import RADIUS, facing_point, rotated_back, spread
from .smooth_stops import Nearest, SmoothOver, Stop, over_corner, over_edge, over_face
from .surface_search import nearest_in_patch, past_edge
from .surface_tables import (
    N_EDGES,
    N_NODES,
    N_TRIANGLES,
    ON_CORNER,
    ON_EDGE,
    ON_FACE,
    SIZE,
    SKIP,
    UPPER,
    corner_at,
    face_height,
    feature_of,
    patch_of,
)
from .surface_tree import box_square, has_patch, members_at, node_at

_SAME = 1e-15
"""Difference of two distances that is round-off, relative to the size of the bodies."""
SupportPlane: TypeAlias = tuple[Vector3, float]
"""Supporting plane below the smooth body: unit normal towards the body, offset from the origin along it [m].

The body lies above the plane, so a point at a height h below it is at least h from the body.  A plane at -inf excludes
nothing.
"""


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
def _above(plane: SupportPlane, point: Vector3) -> float:
    """Return the height of the smooth body's supporting plane over a point of the surface [m]."""
    return float(plane[1] - dot(plane[0], point))


@compiled
def _above_box(surface: Floats, at: int, plane: SupportPlane) -> float:
    """Return the height of the supporting plane over the highest corner of a node's box, whose row is at ``at`` [m]."""
    normal, offset = plane
    for i in range(3):
        offset -= normal[i] * surface[at + UPPER + i if normal[i] > 0.0 else at + i]
    return float(offset)


@compiled
def _evaluate(body: SmoothOver, patch: float, member: int, best: float, plane: SupportPlane) -> tuple[Stop, float]:
    """Return the stop over one feature of the surface, and a lower bound of its distance from the core [m].

    The distance of the core is infinite if the feature belongs to another patch or cannot be nearer than ``best`` [m];
    it is nan if the search failed.  The distance past the end is positive, too, if the centre of the core is on the
    inner side of the feature.  ``member`` is the number of the feature in the tree.  ``plane`` is the body's supporting
    plane for the nearest feature so far.
    """
    surface, center = body.surface, body.cores.center
    kind, number, row = feature_of(surface, member)
    w = minus(center, vector_at(row, 0))
    excluded = Stop(math.inf, 0.0, (0.0, 0.0, 1.0), w), -math.inf
    if patch_of(surface, member) != patch:
        return excluded
    lowest = _above(plane, vector_at(row, 0))
    if kind == ON_FACE:
        least = face_height(surface, number, center) - body.size
        lowest = min(lowest, min(_above(plane, vector_at(row, 3)), _above(plane, vector_at(row, 6))))
        if least > best or lowest > best:
            return excluded
        stop = over_face(body, number, row, 1)
    elif kind == ON_EDGE:
        if lowest - max(row[LENGTH] * dot(plane[0], vector_at(row, ALONG)), 0.0) > best:
            return excluded
        least = _least(body, past_edge(row, center)[1])
        if least > best:
            return excluded
        stop = over_edge(body, row, w)
    else:
        if lowest > best:
            return excluded
        least = _least(body, vector_at(row, 0))
        if least > best:
            return excluded
        stop = over_corner(body, corner_at(surface, number), w)
    past = max(stop.past, -dot(stop.normal, w)) - REACH * surface[SIZE]
    return Stop(stop.gap, past, stop.normal, stop.point), least


@compiled
def _support_plane(body: SmoothOver, normal: Vector3) -> SupportPlane:
    """Return the smooth body's supporting plane across the unit vector ``normal``.

    The plane is raised by round-off: features in one plane then get the same bound, and none of them is excluded.
    """
    p = facing_point(body.cores, normal)[0]
    return normal, dot(normal, p) - body.cores.second[RADIUS] + _SAME * (spread(p) + body.surface[SIZE])


@compiled
def _key(gap: float, past: float) -> float:
    """Return the gap of a feature that the body may touch, else the hypotenuse of gap and distance past its end [m]."""
    return gap if past <= 0.0 else math.sqrt(gap * gap + past * past)


@compiled
def nearest_of_patch(body: SmoothOver, patch: float, reach: float) -> Nearest:
    """Return the stop over a patch's feature with the least key (:func:`_key`), and the feature.

    A feature that the body may touch wins over another one with the same key within round-off: on the border of a face,
    the face wins over its edge.  If no key is below ``reach`` [m], both distances are those of a gap of ``reach``.  The
    distance of the core is nan if the search failed for a feature whose key may be less.

    The size of the ``body`` is the distance of its farthest point from the centre of its core.
    """
    surface, center, extent = body.surface, body.cores.center, body.size
    n_triangles, radius = int(surface[N_TRIANGLES]), body.cores.second[RADIUS]
    round_off = _SAME * (extent + surface[SIZE])
    best_key, least_failed, found = reach, math.inf, 0
    best = Stop(reach + radius, reach, (0.0, 0.0, 1.0), center)
    plane: SupportPlane = (0.0, 0.0, 0.0), -math.inf
    # first evaluate the feature nearest to the centre, then all faces, which cost least; their distances exclude most
    # edges and corners from the search
    nearest = nearest_in_patch(surface, patch, center, reach + extent)
    if nearest.kind != ON_FACE:
        found = nearest.number + n_triangles + (int(surface[N_EDGES]) if nearest.kind == ON_CORNER else 0)
        stop, _ = _evaluate(body, patch, found, best_key, plane)
        key = _key(stop.gap - radius, stop.past)
        if key < best_key:
            best_key, best, plane = key, stop, _support_plane(body, stop.normal)
    for of_faces in (True, False):
        node = 0
        while node < int(surface[N_NODES]):
            at = node_at(surface, node)
            outside = math.sqrt(box_square(surface, at, center)) - extent > best_key
            if outside or _above_box(surface, at, plane) > best_key or not has_patch(surface, at, patch):
                node = int(surface[at + SKIP])
                continue
            leaf = members_at(surface, at, node + 1)
            for i in range(leaf.begin, leaf.end):
                member = int(surface[i])
                if (member < n_triangles) != of_faces:
                    continue
                stop, bound = _evaluate(body, patch, member, best_key, plane)
                if math.isnan(stop.gap):
                    least_failed = min(least_failed, bound)
                    continue
                key = _key(stop.gap - radius, stop.past)
                is_tie = key < best_key + round_off and stop.past <= 0.0
                if key < best_key - round_off or (is_tie and (best.past > 0.0 or member < found)):
                    best_key, best, found, plane = key, stop, member, _support_plane(body, stop.normal)
            node = leaf.after
    if not least_failed >= best_key:
        best = Stop(math.nan, best.past, best.normal, best.point)
    kind, number, _ = feature_of(surface, found)
    return Nearest(best, kind, number)
