"""Gap of a vertex of one body over a patch of the surface of another body, convex or not."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, minus, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.frames import point_in_body, point_in_world, vector_in_body, vector_in_world
from ..features.overlap_corners import FLUSH
from ..features.vertex_face import CLOSED, REACH
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
from .surface_tables import FACE_PATCH, N_MEMBERS, N_NODES, SIZE, SKIP


@compiled
def leaning(frame: Floats, other: Floats, surface: Floats, face: int, n_star: float, star: Floats) -> float:
    """Return the sine of the angle at which the steepest edge of the other body's vertex descends below a face.

    It is negative if all edges ascend from the face.  The vertex has ``n_star`` edges; ``star`` holds unit vectors
    along them.
    """
    n = vector_in_body(other, vector_in_world(frame, vector_at(surface, face)))
    down = -1.0
    for i in range(int(n_star)):
        down = max(down, -dot(n, vector_at(star, 3 * i)))
    return down


@compiled
def over_face(
    surface: Floats, triangle: int, height: float, lean: float, margin: float, point: Vector3
) -> tuple[float, float, float, float]:
    """Return four numbers for a vertex, ``point``, and a triangle of the surface.

    1. Distance past the edges of the triangle [m].
    2. Distance past those of its edges that are on the border of its face [m].
    3. Distance past the part of the face that the vertex may touch [m].  For a vertex above the plane, it is measured
       in the plane, so that it distinguishes faces about one corner, whose distances are equal.
    4. Squared distance of the vertex from the triangle [m^2].

    Parameters
    ----------
    height : float
        Height of the vertex over the plane of the triangle [m].
    lean : float
        Least value of the three distances [m]: positive if an edge of the vertex descends too steeply below the face.
    margin : float
        Distance past an edge up to which the vertex is still over the triangle [m].
    """
    over, ends = past_edges(surface, triangle, height, point)
    over, ends = max(over - margin, lean), max(ends - margin, lean)
    past, square = ends, height * height
    if over > 0.0 or height < 0.0:
        qx, qy, qz, _ = in_triangle(surface, triangle, point)
        apart = minus(point, (qx, qy, qz))
        square = dot(apart, apart)
        out = square - height * height if height > 0.0 else square
        past = max(math.sqrt(max(out, 0.0)) - margin, over)
    return over, ends, past, square


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
    """Return how far a feature of the other body is from an overlap of this depth with a surface [m].

    The result is positive if a face of the surface is less deep than the ``depth``, or if the point is outside of the
    body by more than the margin ``CLOSED`` and the angle ``FLUSH`` of flush faces allow.  Only faces that the feature
    may touch count, however near others are: bodies with flush faces on springs are pressed deeper into each other than
    their sides are apart.  An edge of the feature that leads below a face, or an end below it, excludes this face.

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
            deep = max(-face_height(surface, f, ends[0]), -face_height(surface, f, ends[1]))
            deep = max(deep, math.sqrt(square))
            if deep < least_deep and leaning(frame, other, surface, f, n_star, star) <= CONE_MARGIN:
                least_deep = deep
        node += 1
    outside = math.sqrt(least) if side >= 0.0 else 0.0
    return max(depth - (1.0 + REACH) * least_deep, outside - margin - FLUSH * depth)


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
) -> tuple[int, float, float]:
    """Return face, gap and distance past the end [m] for a vertex of the other body and a patch in ``frame``.

    ``place`` is the vertex in the frame of its body [m].

    The distance past the end is positive if the vertex may not touch the face.  It may touch the face if it is over the
    face and none of its edges descends below the face.  A vertex inside of the body belongs to the nearest face that it
    may touch.  If the vertex may not touch the face, the gap is positive.

    ``star`` holds unit vectors along the vertex's edges.  If no face is within ``reach`` [m],
    gap and distance past the end are ``reach``.
    """
    x, y, z = point_in_body(frame, point_in_world(other, place))
    size = surface[SIZE]
    # a point by itself has no edges beside it
    margin = (CLOSED if n_star > 0.0 else REACH) * size
    best, height_best, apart, past, found = reach * reach, 0.0, reach, reach, 0
    under, under_past, under_face = math.inf, 0.0, -1
    first = first_leaf(surface, patch, (x, y, z))
    node = -1
    while node < int(surface[N_NODES]):
        at = node_at(surface, first if node < 0 else node)
        if node >= 0 and (box_square(surface, at, (x, y, z)) > best or not has_patch(surface, at, patch)):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            what, face, t = feature_of(surface, member_of(surface, at, i))
            if what != ON_FACE:
                continue
            f = face_at(surface, face)
            height = face_height(surface, f, (x, y, z))
            if surface[f + FACE_PATCH] != patch or height * height > best:
                continue
            lean = size * (leaning(frame, other, surface, f, n_star, star) - CONE_MARGIN)
            over, inside, ends, square = over_face(surface, t, height, lean, margin, (x, y, z))
            if over <= 0.0 and height < 0.0 and -height < under:
                under, under_past, under_face = -height, inside, face
            key = square + max(ends, 0.0) * max(ends, 0.0)
            if key < best:
                best, height_best, apart, past, found = key, height, math.sqrt(square), ends, face
        node += 1
    is_above = under_face >= 0 and under * under < best
    point = x, y, z
    if is_above and past_depth(frame, other, surface, n_star, star, (point, point), under, point) <= 0.0:
        return under_face, -under, under_past
    return found, height_best if past <= 0.0 else math.hypot(apart, past), past
