"""Nearest feature of a patch of a surface that is not convex to a body with a smooth support function.

A tree of bounding boxes gives the faces, convex edges and corners that may be near.  Of these, the feature is taken
whose stop has the least gap (:mod:`bodies.contacts.surface.smooth_stops`), if the body may touch it there.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.support_function import Core, support_of
from ...vectors import Vector3, divided, dot, minus, norm, opposite, vector_at
from ..features.edge_row import ALONG, LENGTH
from ..features.ends import REACH
from ..smooth.smooth_core import RADIUS, Axes, facing_point, rotated_back, spread
from .smooth_stops import Nearest, Stop, over_corner, over_edge, over_face
from .surface_search import (
    ON_CORNER,
    ON_EDGE,
    ON_FACE,
    box_square,
    face_at,
    face_height,
    feature_of,
    has_patch,
    member_of,
    nearest_in_patch,
    node_at,
    past_edge,
    patch_of,
)
from .surface_tables import N_EDGES, N_MEMBERS, N_NODES, N_TRIANGLES, SIZE, SKIP, UPPER

_SAME = 1e-15
"""Difference of two distances that is round-off, relative to the size of the bodies."""
SupportPlane: TypeAlias = tuple[Vector3, float]
"""Supporting plane below the smooth body: unit normal towards the body, offset from the origin along it [m].

The body lies above the plane, so a point at a height h below it is at least h from the body.  A plane at -inf excludes
nothing.
"""


@compiled
def _least(core: Core, turn: Axes, way: Vector3) -> float:
    """Return a lower bound of the smooth body's distance from a convex feature [m].

    The vector ``way`` leads from the feature's nearest point to the centre of the body.
    """
    apart = norm(way)
    if apart == 0.0:
        return -math.inf
    return float(apart - support_of(core, rotated_back(turn, divided(opposite(way), apart)))[0] - core[RADIUS])


@compiled
def _above(surface: Floats, at: int, plane: SupportPlane) -> float:
    """Return the height of the smooth body's supporting plane over the surface's point at index ``at`` [m]."""
    return float(plane[1] - dot(plane[0], vector_at(surface, at)))


@compiled
def _above_box(surface: Floats, at: int, plane: SupportPlane) -> float:
    """Return the height of the supporting plane over the highest corner of a node's box, whose row is at ``at`` [m]."""
    normal, offset = plane
    for i in range(3):
        offset -= normal[i] * surface[at + UPPER + i if normal[i] > 0.0 else at + i]
    return float(offset)


@compiled
def _evaluate(
    surface: Floats,
    patch: float,
    member: int,
    core: Core,
    turn: Axes,
    center: Vector3,
    extent: float,
    best: float,
    plane: SupportPlane,
) -> tuple[Stop, float]:
    """Return the stop over one feature of the surface, and a lower bound of its distance from the core [m].

    The distance of the core is infinite if the feature belongs to another patch or cannot be nearer than ``best`` [m];
    it is nan if the search failed.  The distance past the end is positive, too, if the centre of the core is on the
    inner side of the feature.  ``member`` is the number of the feature in the tree: triangles, then convex edges, then
    corners.  ``plane`` is the body's supporting plane for the nearest feature so far.
    """
    kind, number, at = feature_of(surface, member)
    w = minus(center, vector_at(surface, at))
    excluded: tuple[Stop, float] = ((math.inf, 0.0, (0.0, 0.0, 1.0), w), -math.inf)
    if patch_of(surface, member) != patch:
        return excluded
    if kind == ON_FACE:
        least = face_height(surface, face_at(surface, number), center) - extent
        lowest = min(_above(surface, at, plane), min(_above(surface, at + 3, plane), _above(surface, at + 6, plane)))
        if least > best or lowest > best:
            return excluded
        g, past, n, point = over_face(surface, at, 1, core, turn, center)
    elif kind == ON_EDGE:
        least = _above(surface, at, plane) - max(
            surface[at + LENGTH] * dot(plane[0], vector_at(surface, at + ALONG)), 0.0
        )
        if least > best:
            return excluded
        least = _least(core, turn, minus(center, past_edge(surface, at, center)[1]))
        if least > best:
            return excluded
        g, past, n, point = over_edge(surface, at, core, turn, center, w, extent)
    else:
        if _above(surface, at, plane) > best:
            return excluded
        least = _least(core, turn, w)
        if least > best:
            return excluded
        g, past, n, point = over_corner(surface, at, core, turn, center, w, extent)
    return (g, max(past, -dot(n, w)) - REACH * surface[SIZE], n, point), least


@compiled
def _support_plane(surface: Floats, core: Core, turn: Axes, center: Vector3, normal: Vector3) -> SupportPlane:
    """Return the smooth body's supporting plane across the unit vector ``normal``.

    The plane is raised by round-off: features in one plane then get the same bound, and none of them is excluded.
    """
    p = facing_point(core, turn, center, normal)[0]
    return normal, dot(normal, p) - core[RADIUS] + _SAME * (spread(p) + surface[SIZE])


@compiled
def _key(gap: float, past: float) -> float:
    """Return the gap of a feature that the body may touch, else the hypotenuse of gap and distance past its end [m]."""
    return gap if past <= 0.0 else math.sqrt(gap * gap + past * past)


@compiled
def nearest_of_patch(
    surface: Floats, patch: float, core: Core, turn: Axes, center: Vector3, extent: float, reach: float
) -> Nearest:
    """Return the stop over a patch's feature with the least key (:func:`_key`), and the feature.

    A feature that the body may touch wins over another one with the same key within round-off: on the border of a face,
    the face wins over its edge.  If no key is below ``reach`` [m], both distances are those of a gap of ``reach``.  The
    distance of the core is nan if the search failed for a feature whose key may be less.

    ``turn`` and ``center`` are those of :mod:`bodies.contacts.smooth.smooth_core`, in the axes of the surface.
    ``extent`` is the distance of the body's farthest point from the centre of its core [m].
    """
    n_triangles, radius = int(surface[N_TRIANGLES]), core[RADIUS]
    round_off = _SAME * (extent + surface[SIZE])
    best_key, least_failed, found = reach, math.inf, 0
    best: Stop = (reach + radius, reach, (0.0, 0.0, 1.0), center)
    plane: SupportPlane = (0.0, 0.0, 0.0), -math.inf
    # first evaluate the feature nearest to the centre, then all faces, which cost least; their distances exclude most
    # edges and corners from the search
    _, _, kind, number, _, _, _ = nearest_in_patch(surface, patch, center, reach + extent)
    if kind != ON_FACE:
        found = number + n_triangles + (int(surface[N_EDGES]) if kind == ON_CORNER else 0)
        stop, _ = _evaluate(surface, patch, found, core, turn, center, extent, best_key, plane)
        key = _key(stop[0] - radius, stop[1])
        if key < best_key:
            best_key, best, plane = key, stop, _support_plane(surface, core, turn, center, stop[2])
    for of_faces in (True, False):
        node = 0
        while node < int(surface[N_NODES]):
            at = node_at(surface, node)
            outside = math.sqrt(box_square(surface, at, center)) - extent > best_key
            if outside or _above_box(surface, at, plane) > best_key or not has_patch(surface, at, patch):
                node = int(surface[at + SKIP])
                continue
            for i in range(int(surface[at + N_MEMBERS])):
                member = member_of(surface, at, i)
                if (member < n_triangles) != of_faces:
                    continue
                stop, bound = _evaluate(surface, patch, member, core, turn, center, extent, best_key, plane)
                if math.isnan(stop[0]):
                    least_failed = min(least_failed, bound)
                    continue
                key = _key(stop[0] - radius, stop[1])
                is_tie = key < best_key + round_off and stop[1] <= 0.0
                if key < best_key - round_off or (is_tie and (best[1] > 0.0 or member < found)):
                    best_key, best, found = key, stop, member
                    plane = _support_plane(surface, core, turn, center, stop[2])
            node += 1
    if not least_failed >= best_key:
        best = math.nan, best[1], best[2], best[3]
    kind, number, _ = feature_of(surface, found)
    return best, kind, number
