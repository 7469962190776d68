"""Nearest feature of a surface, convex or not, to a point, by a tree of bounding boxes."""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, minus, norm, plus, plus_scaled, scaled, vector_at
from ..features.edge_vertex import ALONG, INTO_FIRST, INTO_SECOND, LENGTH, steepest
from ..features.ends import REACH
from .surface_tables import (
    BORDERS,
    CONCAVE,
    EDGE_PLANES,
    INSIDE,
    N_PATCHES,
    ON_CORNER,
    ON_EDGE,
    ON_FACE,
    SIZE,
    corner_at,
    edge_at,
    face_height,
    feature_of,
    normal_of,
    patch_of,
)
from .surface_tree import ANY_PATCH, box_square, first_leaf, next_leaf, node_at

_SAME = 1e-14
"""Largest relative difference of squared distances that are treated as equal: round-off."""
FAR = 1e150
"""Distance for a search without limit [m]."""


class Found(NamedTuple):
    """The nearest feature of a surface to a point, in the axes of the surface."""

    distance: float
    """Signed distance of the point from the feature [m], negative inside of the body."""
    past: float
    """Distance past the end of the feature [m]; a ball about the point may touch the feature if it is not positive."""
    kind: int
    """Kind of the feature: ``ON_FACE``, ``ON_EDGE`` or ``ON_CORNER``."""
    number: int
    """Number of the feature among those of its kind."""
    nearest: Vector3
    """Point of the feature nearest to the point [m]."""


@compiled
def past_edges(triangle: Floats, height: float, point: Vector3) -> tuple[float, float]:
    """Return two distances of a point past edges of a triangle [m]; negative if the point is inside of all of them.

    The first is the largest distance past any of the three edges.  The second is the largest one past the edges on the
    border of the triangle's face.  Both are measured in the plane of the triangle, and are -inf if no edge counts.
    Below the plane a face does not end at a concave edge: a point inside of the body near an inner corner is below both
    faces.

    ``triangle`` is the row of the triangle, ``height`` the height of the point over its plane [m].
    """
    past_any, past_border = -math.inf, -math.inf
    for i in range(3):
        border = triangle[BORDERS + i]
        if height < 0.0 and border == CONCAVE:
            continue
        plane = EDGE_PLANES + 4 * i
        past = dot(vector_at(triangle, plane), point) - triangle[plane + 3]
        past_any = max(past_any, past)
        if border != INSIDE:
            past_border = max(past_border, past)
    return past_any, past_border


@compiled
def in_triangle(triangle: Floats, point: Vector3) -> tuple[Vector3, int]:
    """Return a triangle's point nearest to ``point``, and 0 if it is inside, 1 to 3 on an edge, 4 to 6 at a vertex.

    ``triangle`` is its row.  By the regions of C. Ericson, "Real-Time Collision Detection" (Morgan Kaufmann, 2005),
    section 5.1.5.
    """
    a = vector_at(triangle, 0)
    b, c = minus(vector_at(triangle, 3), a), minus(vector_at(triangle, 6), a)
    p = minus(point, a)
    d1, d2 = dot(b, p), dot(c, p)
    if d1 <= 0.0 and d2 <= 0.0:
        return a, 4
    bb, bc, cc = dot(b, b), dot(b, c), dot(c, c)
    d3, d4 = d1 - bb, d2 - bc
    if d3 >= 0.0 and d4 <= d3:
        return plus(a, b), 5
    d5, d6 = d1 - bc, d2 - cc
    if d6 >= 0.0 and d5 <= d6:
        return plus(a, c), 6
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return plus_scaled(a, d1 / (d1 - d3), b), 1
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return plus_scaled(a, d2 / (d2 - d6), c), 3
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 >= d3 and d5 >= d6:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return plus_scaled(plus(a, b), w, minus(c, b)), 2
    return plus_scaled(plus_scaled(a, vb / (va + vb + vc), b), vc / (va + vb + vc), c), 0


@compiled
def distance_from_triangle(triangle: Floats, point: Vector3) -> float:
    """Return the distance of a point from the triangle with this row [m]."""
    return norm(minus(point, in_triangle(triangle, point)[0]))


@compiled
def outward_of(surface: Floats, face: int, triangle: Floats, point: Vector3) -> tuple[float, float]:
    """Return the squared distance of a point from a triangle [m^2], and a number that is negative inside of the body.

    The sign is that of the body if the triangle is the nearest one.  It comes from the normal at the nearest point; on
    edges and at vertices, from normals weighted by angles: J. A. Baerentzen, H. Aanaes, "Signed distance computation
    using the angle weighted pseudonormal", IEEE Transactions on Visualization and Computer Graphics 11 (2005) 243-253.
    ``triangle`` is the row of the triangle, ``face`` the number of its face.
    """
    nearest, region = in_triangle(triangle, point)
    apart = minus(point, nearest)
    n = vector_at(triangle, BORDERS + 3 * region) if region > 0 else normal_of(surface, face)
    return dot(apart, apart), dot(apart, n)


@compiled
def signed_distance(surface: Floats, point: Vector3) -> float:
    """Return the distance of a point, in the axes of the surface, from the surface [m]; negative inside of the body."""
    least, side = math.inf, 0.0
    leaf = first_leaf(surface, ANY_PATCH, point)
    while leaf.begin < leaf.end:
        for i in range(leaf.begin, leaf.end):
            kind, face, row = feature_of(surface, int(surface[i]))
            if kind == ON_FACE:
                square, outward = outward_of(surface, face, row, point)
                if square < least:
                    least, side = square, outward
        leaf = next_leaf(surface, leaf.after, ANY_PATCH, point, least)
    return float(-(least**0.5) if side < 0.0 else least**0.5)


@compiled
def depth_inside(surface: Floats, point: Vector3) -> float:
    """Return how far a point is inside of the body [m], 0 outside."""
    if box_square(surface, node_at(surface, 0), point) > 0.0:
        return 0.0
    return max(-signed_distance(surface, point), 0.0)


@compiled
def past_edge(edge: Floats, point: Vector3) -> tuple[float, Vector3]:
    """Return how far a point is past the ends and normals of an edge [m], and the edge's point nearest to it.

    ``edge`` is the row of the edge.
    """
    w, along = minus(point, vector_at(edge, 0)), vector_at(edge, ALONG)
    s = dot(w, along)
    past = max(-s, s - edge[LENGTH])
    w = minus(w, scaled(min(max(s, 0.0), edge[LENGTH]), along))
    past = max(past, max(dot(w, vector_at(edge, INTO_FIRST)), dot(w, vector_at(edge, INTO_SECOND))))
    return past, minus(point, w)


@compiled
def nearest_in_patch(surface: Floats, patch: float, point: Vector3, reach: float) -> Found:
    """Return the nearest feature of a patch that a ball about a ``point``, in the axes of the surface, may touch.

    A ball may touch a feature if no neighbouring point of the surface is nearer: the distance past the feature's end is
    then not positive.  If the ball may touch no feature, the result is the feature with the least sum of two squares,
    of the distance and of the distance past the end.  Within the margin at the border of a face and its edge, or of an
    edge and its corner, the ball may touch both; the face is preferred to the edge, the edge to the corner.  If no
    feature is nearer than ``reach`` [m], distance and distance past the end are ``reach``.
    """
    # the only patch has no end
    margin = REACH * surface[SIZE] if surface[N_PATCHES] > 1.0 else 0.0
    # difference of squared distances that are equal within the margins of two features
    same = 4.0 * margin * margin
    best, found = reach * reach, Found(reach, reach, ON_FACE, 0, plus_scaled(point, -reach, (0.0, 0.0, 1.0)))
    # the least deep face above the point, if the point is inside of the body
    depth, depth_past, depth_face = math.inf, 0.0, -1
    leaf = first_leaf(surface, patch, point)
    while leaf.begin < leaf.end:
        for i in range(leaf.begin, leaf.end):
            member, tie = int(surface[i]), same + _SAME * best
            kind, number, row = feature_of(surface, member)
            if patch_of(surface, member) != patch:
                continue
            if kind == ON_FACE:
                height = face_height(surface, number, point)
                if height * height > best + tie:
                    continue
                past_any, past_border = past_edges(row, height, point)
                if past_any <= margin and height < 0.0 and -height < depth:
                    depth, depth_past, depth_face = -height, past_border - margin, number
                if past_any <= margin and height >= 0.0:
                    past, p = max(past_border, -surface[SIZE]), plus_scaled(point, -height, normal_of(surface, number))
                else:
                    past, p = max(past_any, -height + 2.0 * margin), in_triangle(row, point)[0]
            elif kind == ON_EDGE:
                past, p = past_edge(row, point)
            else:
                corner = corner_at(surface, number)
                past, p = steepest(corner, minus(point, corner.place)), corner.place
            past -= margin
            apart = minus(point, p)
            square = dot(apart, apart)
            key = square + max(past, 0.0) * max(past, 0.0)
            is_tie = key < best + tie and past <= 0.0
            if key < best - tie or (is_tie and (found.past > 0.0 or kind < found.kind)):
                best, found = key, Found(square**0.5, past, kind, number, p)
        leaf = next_leaf(surface, leaf.after, patch, point, best + same + _SAME * best)
    if depth_face >= 0 and depth * depth < best and depth_inside(surface, point) > 0.0:
        foot = plus_scaled(point, depth, normal_of(surface, depth_face))
        return Found(-depth, depth_past, ON_FACE, depth_face, foot)
    return found


@compiled
def distance_from_ends(surface: Floats, found: Found) -> float:
    """Return the distance of a nearest point from the nearer end of its edge [m]: 0 at a corner, infinite on a face."""
    if found.kind != ON_EDGE:
        return 0.0 if found.kind == ON_CORNER else math.inf
    edge = edge_at(surface, found.number)
    along = dot(minus(found.nearest, vector_at(edge, 0)), vector_at(edge, ALONG))
    return float(min(along, edge[LENGTH] - along))
