"""Gap of a vertex of one body over a patch of the surface of another body, convex or not."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, POSITION, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, minus, scaled, vector_at, write_vector
from ..features.edge_crossing import CONE_MARGIN
from ..features.ends import CLOSED, REACH
from ..features.frames import point_in_body, point_in_world, vector_in_body, vector_in_world, write_tangent
from ..features.writing import write_flat, write_round
from .overlap_corners import FLUSH
from .surface_search import (
    ON_FACE,
    box_square,
    face_at,
    face_height,
    feature_of,
    first_leaf,
    has_patch,
    in_triangle,
    member_of,
    node_at,
    outward_of,
    past_edges,
)
from .surface_tables import CORNER, CORNERS, FACE_PATCH, N_CORNERS, N_FACES, N_MEMBERS, N_NODES, SIZE, SKIP


@compiled
def descent(frame: Floats, other: Floats, surface: Floats, row: int, n_star: float, star: Floats) -> float:
    """Return the sine of the angle at which the steepest edge of the other body's vertex descends below a face.

    It is negative if all edges ascend from the face, whose row begins at index ``row``.  The vertex has ``n_star``
    edges; ``star`` holds unit vectors along them, in the axes of the other body.
    """
    n = vector_in_body(other, vector_in_world(frame, vector_at(surface, row)))
    down = -1.0
    for i in range(int(n_star)):
        down = max(down, -dot(n, vector_at(star, 3 * i)))
    return down


@compiled
def over_triangle(
    surface: Floats, triangle: int, height: float, least: float, margin: float, point: Vector3
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
    surface, triangle : Floats, int
        The surface, and the index at which the row of the triangle begins.
    height : float
        Height of the vertex over the plane of the triangle [m].
    least : float
        Least value of the three distances [m]: positive if an edge of the vertex descends too steeply below the face.
    margin : float
        Distance past an edge up to which the vertex is still over the triangle [m].
    point : tuple of float
        The vertex in the axes of the surface [m].
    """
    past_any, past_border = past_edges(surface, triangle, height, point)
    past_any, past_border = max(past_any - margin, least), max(past_border - margin, least)
    past, square = past_border, height * height
    if past_any > 0.0 or height < 0.0:
        qx, qy, qz, _ = in_triangle(surface, triangle, point)
        apart = minus(point, (qx, qy, qz))
        square = dot(apart, apart)
        past_square = square - height * height if height > 0.0 else square
        past = max(math.sqrt(max(past_square, 0.0)) - margin, past_any)
    return past_any, past_border, past, square


@compiled
def past_depth(
    frame: Floats,
    other: Floats,
    surface: Floats,
    n_star: float,
    star: Floats,
    ends: tuple[Vector3, Vector3],
    depth: float,
    point: Vector3,
) -> float:
    """Return by how much the depth of an overlap exceeds what a surface allows [m]; not positive for a real overlap.

    The overlap at a feature of the other body is no deeper than the least deep face that the feature may touch: through
    that face the bodies separate on a shorter way.  The result is the larger of two numbers: the ``depth`` less the
    depth of this face, and the distance of the point outside of the body, less what the margin ``CLOSED`` and the angle
    ``FLUSH`` of flush faces allow.

    Only faces that the feature may touch count, however near others are: bodies with flush faces on springs are pressed
    deeper into each other than their sides are apart.  An edge of the feature that leads below a face, or an end below
    it, excludes this face.

    Parameters
    ----------
    frame, other : Floats
        Frame blocks of the body with the surface, and of the other body.
    surface : Floats
        The surface.
    n_star, star : float and Floats
        Unit vectors from the feature into its body, in the axes of the other body: along the edges of a vertex, into
        the faces of an edge.
    ends : tuple of Vector3
        The ends of the feature in the axes of the surface [m].
    depth : float
        Depth of the overlap [m].
    point : Vector3
        The point of the feature, in the axes of the surface [m].
    """
    margin = CLOSED * surface[SIZE]
    # depths within the margin are round-off: the point may be on a border
    if depth <= margin:
        return -margin
    least, side, least_deep = math.inf, 0.0, depth * (1.0 + REACH)
    first = first_leaf(surface, -1.0, point)
    node = -1
    while node < int(surface[N_NODES]):
        at = node_at(surface, first if node < 0 else node)
        if node >= 0 and box_square(surface, at, point) > max(least, least_deep * least_deep):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            what, face, t = feature_of(surface, member_of(surface, at, i))
            if what != ON_FACE:
                continue
            square, outward = outward_of(surface, face, t, point)
            if square < least:
                least, side = square, outward
            f = face_at(surface, face)
            # depth of a face: of both ends below its plane, and of the point below its triangle, the largest
            deep = max(-face_height(surface, f, ends[0]), -face_height(surface, f, ends[1]))
            deep = max(deep, math.sqrt(square))
            if deep < least_deep and descent(frame, other, surface, f, n_star, star) <= CONE_MARGIN:
                least_deep = deep
        node += 1
    outside = math.sqrt(least) if side >= 0.0 else 0.0
    return max(depth - (1.0 + REACH) * least_deep, outside - margin - FLUSH * depth)


@compiled
def separation_of_faces(frame: Floats, other: Floats, surface: Floats, own: Floats) -> float:
    """Return the largest separation of two convex bodies along the normals of the first one's faces [m].

    It is negative if none of the planes of the faces separates the bodies, -inf without faces.  The surface belongs to
    the body ``frame``; ``own`` is that of the body ``other``.
    """
    best = -math.inf
    for i in range(int(surface[N_FACES])):
        row, least = face_at(surface, i), math.inf
        n = vector_in_body(other, vector_in_world(frame, vector_at(surface, row)))
        base = face_height(surface, row, point_in_body(frame, vector_at(other, POSITION)))
        for corner in range(int(own[N_CORNERS])):
            least = min(least, base + dot(n, vector_at(own, int(own[CORNERS]) + CORNER * corner)))
            if least < best:
                break
        best = max(best, least)
    return best


@compiled
def face_under(
    frame: Floats,
    other: Floats,
    surface: Floats,
    patch: float,
    place: Vector3,
    n_star: float,
    star: Floats,
    reach: float,
    is_convex: bool,
) -> tuple[int, float, float]:
    """Return face, gap and distance past the end [m] for a vertex of the other body and a patch in ``frame``.

    The distance past the end is positive if the vertex may not touch the face.  It may touch the face if it is over the
    face and none of its edges descends below the face.  A vertex inside of the body belongs to the nearest face that it
    may touch.  If the vertex may not touch the face, the gap is hypot(distance, past); a negative one is kept if both
    bodies are convex (``is_convex``).  If no face is within ``reach`` [m], gap and
    distance past the end are ``reach``.

    ``place`` is the vertex in the axes of its body [m]; ``star`` holds unit vectors along its ``n_star`` edges.
    """
    point = point_in_body(frame, point_in_world(other, place))
    size = surface[SIZE]
    # a point by itself has no edges beside it
    margin = (CLOSED if n_star > 0.0 else REACH) * size
    best, height_best, apart, past, found = reach * reach, 0.0, reach, reach, 0
    # the least deep face above the vertex, if it is inside of the body
    depth, depth_past, depth_face = math.inf, 0.0, -1
    first = first_leaf(surface, patch, point)
    node = -1
    while node < int(surface[N_NODES]):
        at = node_at(surface, first if node < 0 else node)
        if node >= 0 and (box_square(surface, at, point) > best or not has_patch(surface, at, patch)):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            what, face, t = feature_of(surface, member_of(surface, at, i))
            if what != ON_FACE:
                continue
            f = face_at(surface, face)
            height = face_height(surface, f, point)
            if surface[f + FACE_PATCH] != patch or height * height > best:
                continue
            least = size * (descent(frame, other, surface, f, n_star, star) - CONE_MARGIN)
            past_any, past_border, past_part, square = over_triangle(surface, t, height, least, margin, point)
            if past_any <= 0.0 and height < 0.0 and -height < depth:
                depth, depth_past, depth_face = -height, past_border, face
            key = square + max(past_part, 0.0) * max(past_part, 0.0)
            if key < best:
                best, height_best, apart, past, found = key, height, math.sqrt(square), past_part, face
        node += 1
    is_below = depth_face >= 0 and depth * depth < best
    if is_below and past_depth(frame, other, surface, n_star, star, (point, point), depth, point) <= 0.0:
        return depth_face, -depth, depth_past
    return found, height_best if past <= 0.0 or (height_best < 0.0 and is_convex) else math.hypot(apart, past), past


@compiled
def write_sharp_corner(
    a: Floats,
    b: Floats,
    out: Floats,
    swap: float,
    surface: Floats,
    patch: float,
    place: Vector3,
    n_star: float,
    star: Floats,
    reach: float,
    is_convex: bool,
) -> None:
    """Write the geometry block of a sharp vertex over a patch of the other body's surface.

    The vertex belongs to the first body if ``swap`` is 1, else to the second.  The other arguments are those of
    :func:`face_under`.
    """
    own, other = (a, b) if swap == 1.0 else (b, a)
    near, far = (POINT_A, POINT_B) if swap == 1.0 else (POINT_B, POINT_A)
    face, gap, past = face_under(other, own, surface, patch, place, n_star, star, reach, is_convex)
    sign = 1.0 - 2.0 * swap
    normal = vector_in_world(other, scaled(sign, vector_at(surface, face_at(surface, face))))
    out[GAP], out[FEATURE], out[PAST_END] = gap, float(face), past
    write_vector(out, NORMAL, normal)
    write_vector(out, near, point_in_world(own, place))
    write_vector(out, far, minus(vector_at(out, near), scaled(sign * gap, normal)))
    write_tangent(a, out)
    write_round(out, SIDE_A if swap == 1.0 else SIDE_B, 0.0)
    write_flat(out, SIDE_B if swap == 1.0 else SIDE_A)
