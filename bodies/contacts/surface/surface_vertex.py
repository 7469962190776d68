"""Gap of a vertex of one body over a patch of the surface of another body, convex or not."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import POSITION
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, minus, opposite, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.edge_vertex import Vertex, steepest
from ..features.ends import CLOSED, REACH
from ..features.frames import point_in_body, point_seen_from, vector_seen_from
from .overlap_corners import FLUSH
from .surface_search import in_triangle, outward_of, past_edges
from .surface_tables import (
    N_CORNERS,
    N_FACES,
    ON_FACE,
    SIZE,
    Solid,
    corner_at,
    face_height,
    feature_of,
    normal_of,
    patch_of,
)
from .surface_tree import ANY_PATCH, first_leaf, next_leaf


@compiled
def descent(solid: Solid, other: Floats, face: int, vertex: Vertex) -> float:
    """Return the sine of the angle at which the steepest edge of the other body's vertex descends below a face.

    It is negative if all edges ascend from the face of the solid, -1 without edges.  ``other`` is the frame block of
    the other body.
    """
    n = vector_seen_from(other, solid.frame, normal_of(solid.surface, face))
    return max(-1.0, steepest(vertex, opposite(n)))


@compiled
def over_triangle(
    triangle: Floats, height: float, least: float, margin: float, point: Vector3
) -> tuple[float, float, float, float]:
    """Return four numbers for a vertex and a triangle of the surface.

    1. Distance past the edges of the triangle [m].
    2. Distance past those of its edges that are on the border of its face [m].
    3. Distance past the triangle by which faces are compared [m].  Over the triangle it is number 2.  Above the plane
       and beside the triangle it is measured in the plane: about a corner the distances of all faces are equal.  Below
       the plane it is the distance from the triangle, so that a vertex outside of the body prefers faces that it is
       above.
    4. Squared distance of the vertex from the triangle [m^2].

    Parameters
    ----------
    triangle : Floats
        Row of the triangle.
    height : float
        Height of the vertex over the plane of the triangle [m].
    least : float
        Least value of the three distances [m]: positive if an edge of the vertex descends too steeply below the face.
    margin : float
        Distance past an edge up to which the vertex is still over the triangle [m].
    point : tuple of float
        The vertex in the axes of the surface [m].
    """
    past_any, past_border = past_edges(triangle, height, point)
    past_any, past_border = max(past_any - margin, least), max(past_border - margin, least)
    past, square = past_border, height * height
    if past_any > 0.0 or height < 0.0:
        apart = minus(point, in_triangle(triangle, point)[0])
        square = dot(apart, apart)
        past_square = square - height * height if height > 0.0 else square
        past = max(math.sqrt(max(past_square, 0.0)) - margin, past_any)
    return past_any, past_border, past, square


@compiled
def past_depth(
    solid: Solid, other: Floats, vertex: Vertex, ends: tuple[Vector3, Vector3], depth: float, point: Vector3
) -> float:
    """Return by how much the depth of an overlap exceeds what a surface allows [m]; not positive for a real overlap.

    The overlap at a feature of the other body is no deeper than the least deep face that the feature may touch: through
    that face the bodies separate on a shorter way.  The result is the larger of two numbers: the ``depth`` less the
    depth of this face, and the distance of the point outside of the body, less what the margin ``CLOSED`` and the angle
    ``FLUSH`` of flush faces allow.

    A face is as deep as the largest of three lengths: how far either end is below its plane, and how far the point is
    from its triangles.  Only faces that the feature may touch count, however near others are: bodies with flush faces
    on springs are pressed deeper into each other than their sides are apart.  A feature may touch a face if none of its
    edges descends below it by more than the sine ``CONE_MARGIN``.

    Parameters
    ----------
    solid, other : Solid, Floats
        The body with the surface, and the frame block of the other body.
    vertex : Vertex
        The feature of the other body; an edge has unit vectors into its two faces in place of those along edges.
    ends : tuple of Vector3
        The ends of the feature in the axes of the surface [m].
    depth : float
        Depth of the overlap [m].
    point : Vector3
        The point of the feature, in the axes of the surface [m].
    """
    surface = solid.surface
    margin = CLOSED * surface[SIZE]
    # depths within the margin are round-off: the point may be on a border
    if depth <= margin:
        return -margin
    least, side, least_deep = math.inf, 0.0, depth * (1.0 + REACH)
    leaf = first_leaf(surface, ANY_PATCH, point)
    while leaf.begin < leaf.end:
        for i in range(leaf.begin, leaf.end):
            kind, face, row = feature_of(surface, int(surface[i]))
            if kind != ON_FACE:
                continue
            square, outward = outward_of(surface, face, row, point)
            if square < least:
                least, side = square, outward
            deep = max(-face_height(surface, face, ends[0]), -face_height(surface, face, ends[1]))
            deep = max(deep, math.sqrt(square))
            if deep < least_deep and descent(solid, other, face, vertex) <= CONE_MARGIN:
                least_deep = deep
        leaf = next_leaf(surface, leaf.after, ANY_PATCH, point, max(least, least_deep * least_deep))
    outside = math.sqrt(least) if side >= 0.0 else 0.0
    return max(depth - (1.0 + REACH) * least_deep, outside - margin - FLUSH * depth)


@compiled
def separation_of_faces(solid: Solid, other: Solid) -> float:
    """Return the largest separation of two convex bodies along the normals of the first one's faces [m].

    It is negative if none of the planes of the faces separates the bodies, -inf without faces.
    """
    best, origin = -math.inf, point_in_body(solid.frame, vector_at(other.frame, POSITION))
    for face in range(int(solid.surface[N_FACES])):
        least, n = math.inf, vector_seen_from(other.frame, solid.frame, normal_of(solid.surface, face))
        base = face_height(solid.surface, face, origin)
        for corner in range(int(other.surface[N_CORNERS])):
            least = min(least, base + dot(n, corner_at(other.surface, corner).place))
            if least < best:
                break
        best = max(best, least)
    return best


@compiled
def face_under(
    solid: Solid, other: Floats, patch: float, vertex: Vertex, reach: float, is_convex: bool
) -> tuple[int, float, float]:
    """Return face, gap and distance past the end [m] for a vertex of the other body and a patch of a solid.

    The distance past the end is positive if the vertex may not touch the face.  It may touch the face if it is over the
    face and none of its edges descends below the face.  A vertex inside of the body belongs to the nearest face that it
    may touch.  If the vertex may not touch the face, the gap is hypot(distance, past); a negative one is kept if both
    bodies are convex (``is_convex``).  If no face is within ``reach`` [m], gap and distance past the end are ``reach``.

    ``other`` is the frame block of the other body.
    """
    surface, point = solid.surface, point_seen_from(solid.frame, other, vertex.place)
    size = surface[SIZE]
    # a point by itself has no edges beside it
    margin = (CLOSED if vertex.n_star > 0.0 else REACH) * size
    best, height_best, apart, past, found = reach * reach, 0.0, reach, reach, 0
    # the least deep face above the vertex, if it is inside of the body
    depth, depth_past, depth_face = math.inf, 0.0, -1
    leaf = first_leaf(surface, patch, point)
    while leaf.begin < leaf.end:
        for i in range(leaf.begin, leaf.end):
            kind, face, row = feature_of(surface, int(surface[i]))
            if kind != ON_FACE or patch_of(surface, int(surface[i])) != patch:
                continue
            height = face_height(surface, face, point)
            if height * height > best:
                continue
            least = size * (descent(solid, other, face, vertex) - CONE_MARGIN)
            past_any, past_border, past_part, square = over_triangle(row, height, least, margin, point)
            if past_any <= 0.0 and height < 0.0 and -height < depth:
                depth, depth_past, depth_face = -height, past_border, face
            key = square + max(past_part, 0.0) * max(past_part, 0.0)
            if key < best:
                best, height_best, apart, past, found = key, height, math.sqrt(square), past_part, face
        leaf = next_leaf(surface, leaf.after, patch, point, best)
    is_below = depth_face >= 0 and depth * depth < best
    if is_below and past_depth(solid, other, vertex, (point, point), depth, point) <= 0.0:
        return depth_face, -depth, depth_past
    return found, height_best if past <= 0.0 or (height_best < 0.0 and is_convex) else math.hypot(apart, past), past
