"""Gap of a surface, convex or not, and a body with a smooth support function.

For each face, convex edge and corner, the smooth body's nearest point to the feature's plane, line or corner is found.
For a plane this point follows from the support function, for lines and corners from Newton's method on this function.
The body may touch the feature if the opposite point lies on the feature, and if the common normal is a normal of the
feature.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import PAST_END, SIDE_A
from nonsmooth.types import Floats

from ...shapes.support_function import OF_FUNCTION, Core, is_round, support_of
from ...vectors import Vector3, divided, dot, minus, norm, opposite, plus, scaled, vector_at
from ..features.edge_row import ALONG, INTO_FIRST, INTO_SECOND, LENGTH
from ..features.ends import REACH
from ..features.frames import point_in_body, point_in_world
from ..smooth.boxy_line import across_line
from ..smooth.smooth_core import RADIUS, Axes, axes_in_world, axes_of, facing_point, relative_rotation, rotated_back
from ..smooth.smooth_newton import widest_from, write_smooth
from .surface_ball import write_feature
from .surface_search import (
    ON_CORNER,
    ON_EDGE,
    ON_FACE,
    box_square,
    edge_at,
    face_at,
    face_height,
    feature_of,
    has_patch,
    in_triangle,
    member_of,
    nearest_in_patch,
    node_at,
    past_edge,
    past_edges,
    patch_of,
    steepest,
)
from .surface_tables import (
    FACE_NUMBER,
    N_EDGES,
    N_MEMBERS,
    N_NODES,
    N_PATCHES,
    N_TRIANGLES,
    OFFSET,
    SIZE,
    SKIP,
    UPPER,
)

_SAME = 1e-15
"""Difference of two distances that is round-off, relative to the size of the bodies."""
SupportPlane: TypeAlias = tuple[Vector3, float]
"""Supporting plane below the smooth body: unit normal towards the body, offset from the origin along it [m].

The body lies above the plane, so a point at a height h below it is at least h from the body.  A plane at -inf excludes
nothing.
"""
FeatureDistance: TypeAlias = tuple[float, float, Vector3]
"""Distance of the core from a feature [m], distance past the end of the contact [m], unit normal to the core.

The distance of the core is nan if the search failed.
"""


@compiled
def _extent(core: Core) -> float:
    """Return an upper bound of the distance of the body's farthest point from its centre [m].

    For round cores it is the largest semi-axis plus the radius.  For other cores, and for cores given by a function, it
    is half of the diagonal of the bounding box.
    """
    if is_round(core) and core[3] != OF_FUNCTION:
        return float(max(core[0], core[1], core[2]) + core[RADIUS])
    return math.sqrt(core[0] * core[0] + core[1] * core[1] + core[2] * core[2])


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
def _on_face(surface: Floats, t: int, core: Core, turn: Axes, center: Vector3) -> FeatureDistance:
    """Evaluate the core and the plane of a triangle, whose row begins at index ``t``.

    The distance past the end is positive if the core's nearest point to the plane is past the border of the triangle's
    face, or if the centre of the body is below the plane.
    """
    f = face_at(surface, int(surface[t + FACE_NUMBER]))
    n = vector_at(surface, f)
    p = facing_point(core, turn, center, n)[0]
    height = dot(n, p) - surface[f + OFFSET]
    beyond, past = past_edges(surface, t, 0.0, p)
    if beyond > REACH * surface[SIZE]:
        foot = minus(p, scaled(height, n))
        x, y, z, _ = in_triangle(surface, t, foot)
        past = norm(minus(foot, (x, y, z)))
    past = max(past, -surface[SIZE])
    # if the body's centre is below the plane, the body is past the end of the face
    return height, max(past, surface[f + OFFSET] - n[0] * center[0] - n[1] * center[1] - n[2] * center[2]), n


@compiled
def _on_edge(
    surface: Floats, e: int, core: Core, point: Core, turn: Axes, center: Vector3, size: float
) -> FeatureDistance:
    """Evaluate the core and the line of an edge, whose row begins at index ``e``.

    The distance past the end is positive if the nearest point is past an end of the edge, or if the normal, from the
    edge to the core, is not a normal of the edge.
    """
    w, along = minus(center, vector_at(surface, e)), vector_at(surface, e + ALONG)
    g, _, n = widest_from(point, core, turn, w, along, w)
    s = dot(facing_point(core, turn, w, n)[0], along)
    past = max(-s, s - surface[e + LENGTH])
    past = max(past, size * dot(n, vector_at(surface, e + INTO_FIRST)))
    past = max(past, size * dot(n, vector_at(surface, e + INTO_SECOND)))
    return g, max(past, -dot(n, w)), n


@compiled
def _on_corner(
    surface: Floats, c: int, core: Core, point: Core, turn: Axes, center: Vector3, size: float
) -> FeatureDistance:
    """Evaluate the core and a corner, whose row begins at index ``c``.

    The distance past the end is positive if an edge of the corner is nearer to the core than the corner itself.
    """
    w = minus(center, vector_at(surface, c))
    g, _, n = widest_from(point, core, turn, w, (0.0, 0.0, 0.0), w)
    return g, max(-dot(n, w), size * steepest(surface, c, n)), n


@compiled
def _above(surface: Floats, at: int, plane: SupportPlane) -> float:
    """Return the height of the smooth body's supporting plane over the surface's point at index ``at`` [m]."""
    normal, offset = plane
    return float(offset - normal[0] * surface[at] - normal[1] * surface[at + 1] - normal[2] * surface[at + 2])


@compiled
def _above_box(surface: Floats, at: int, plane: SupportPlane) -> float:
    """Return the height of the smooth body's supporting plane over the highest corner of a node's box [m].

    The row of the node begins at index ``at``.
    """
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
    point: Core,
    turn: Axes,
    center: Vector3,
    best: float,
    plane: SupportPlane,
) -> tuple[float, float, Vector3, float]:
    """Evaluate the core and one feature of the surface; the last number is a lower bound of the gap [m].

    The distance of the core is infinite if the feature belongs to another patch or cannot be nearer than ``best`` [m];
    it is nan if the search failed.  ``member`` is the number of the feature in the tree: triangles, then convex edges,
    then corners.  ``plane`` is the body's supporting plane for the nearest feature so far.
    """
    kind, number, at = feature_of(surface, member)
    size, excluded = _extent(core), (math.inf, 0.0, (0.0, 0.0, 1.0), -math.inf)
    if patch_of(surface, member) != patch:
        return excluded
    if kind == ON_FACE:
        least = face_height(surface, face_at(surface, number), center) - size
        lowest = min(_above(surface, at, plane), min(_above(surface, at + 3, plane), _above(surface, at + 6, plane)))
        if least > best or lowest > best:
            return excluded
        g, past, n = _on_face(surface, at, core, turn, center)
    elif kind == ON_EDGE:
        least = _above(surface, at, plane) - max(
            surface[at + LENGTH] * dot(plane[0], vector_at(surface, at + ALONG)), 0.0
        )
        if least > best:
            return excluded
        least = _least(core, turn, minus(center, past_edge(surface, at, center)[1]))
        if least > best:
            return excluded
        g, past, n = _on_edge(surface, at, core, point, turn, center, size)
    else:
        if _above(surface, at, plane) > best:
            return excluded
        least = _least(core, turn, minus(center, vector_at(surface, at)))
        if least > best:
            return excluded
        g, past, n = _on_corner(surface, at, core, point, turn, center, size)
    return g, past - REACH * surface[SIZE], n, least


@compiled
def _support_plane(surface: Floats, core: Core, turn: Axes, center: Vector3, normal: Vector3) -> SupportPlane:
    """Return the smooth body's supporting plane across the unit vector ``normal``.

    The plane is raised by round-off: features in one plane then get the same bound, and none of them is excluded.
    """
    p = facing_point(core, turn, center, normal)[0]
    none = _SAME * (abs(p[0]) + abs(p[1]) + abs(p[2]) + surface[SIZE])
    return normal, dot(normal, p) - core[RADIUS] + none


@compiled
def _key(gap: float, past: float) -> float:
    """Return the gap of a feature that the body may touch, else the hypotenuse of gap and distance past its end [m]."""
    return gap if past <= 0.0 else math.sqrt(gap * gap + past * past)


@compiled
def _nearest(
    surface: Floats, patch: float, core: Core, point: Core, turn: Axes, center: Vector3, reach: float
) -> tuple[float, float, int, int, Vector3]:
    """Return distance of the core [m], distance past the end [m], kind and number of a patch's feature, and normal.

    It is the feature with the least key (:func:`_key`).  A feature that the body may touch wins over another one with
    the same key within round-off: on the border of a face, the face wins over its edge.  The gap is the distance of the
    core less its radius.  If no key is below ``reach`` [m], both distances are those of a gap of ``reach``.  The
    distance of the core is nan if the search failed for a feature whose key may be less.

    ``point`` is the core of a point, ``turn`` converts components along the axes of the core to those along the axes of
    the surface, and ``center`` is the centre of the core in the axes of the surface [m].
    """
    n_triangles, size = int(surface[N_TRIANGLES]), _extent(core)
    round_off = _SAME * (size + surface[SIZE])
    best_key, least_failed, found = reach, math.inf, 0
    distance, past, normal = reach + core[RADIUS], reach, (0.0, 0.0, 1.0)
    plane: SupportPlane = (0.0, 0.0, 0.0), -math.inf
    # first evaluate the feature nearest to the centre, then all faces, which cost least; their distances exclude most
    # edges and corners from the search
    _, _, kind, number, _, _, _ = nearest_in_patch(surface, patch, center, reach + size)
    if kind != ON_FACE:
        found = number + n_triangles + (int(surface[N_EDGES]) if kind == ON_CORNER else 0)
        core_distance, beyond, n, _ = _evaluate(surface, patch, found, core, point, turn, center, best_key, plane)
        key = _key(core_distance - core[RADIUS], beyond)
        if key < best_key:
            best_key, distance, past, normal = key, core_distance, beyond, n
            plane = _support_plane(surface, core, turn, center, n)
    for of_faces in (True, False):
        node = 0
        while node < int(surface[N_NODES]):
            at = node_at(surface, node)
            outside = math.sqrt(box_square(surface, at, center)) - size > best_key
            if outside or _above_box(surface, at, plane) > best_key or not has_patch(surface, at, patch):
                node = int(surface[at + SKIP])
                continue
            for i in range(int(surface[at + N_MEMBERS])):
                member = member_of(surface, at, i)
                if (member < n_triangles) != of_faces:
                    continue
                core_distance, beyond, n, bound = _evaluate(
                    surface, patch, member, core, point, turn, center, best_key, plane
                )
                if math.isnan(core_distance):
                    least_failed = min(least_failed, bound)
                    continue
                key = _key(core_distance - core[RADIUS], beyond)
                is_tie = key < best_key + round_off and beyond <= 0.0
                if key < best_key - round_off or (is_tie and (past > 0.0 or member < found)):
                    best_key, distance, past, found, normal = key, core_distance, beyond, member, n
                    plane = _support_plane(surface, core, turn, center, n)
            node += 1
    if not least_failed >= best_key:
        distance = math.nan
    kind, number, _ = feature_of(surface, found)
    return distance, past, kind, number, normal


@compiled
def write_surface_smooth(
    a: Floats, b: Floats, out: Floats, surface: Floats, patch: float, second: Floats, point: Floats, reach: float
) -> None:
    """Write the geometry block of a patch of a surface and a smooth body; the gap is nan if the search failed.

    ``reach`` is the largest distance of features that are searched [m].
    """
    axes_a, axes_b = axes_of(a), axes_in_world(b, second)
    center = point_in_body(a, point_in_world(b, vector_at(second, 6)))
    turn = relative_rotation(axes_a, axes_b)
    g, past, kind, number, n = _nearest(surface, patch, second, point, turn, center, reach)
    gap = g - second[RADIUS]
    if past > 0.0:
        gap = math.hypot(gap, past)
    p = facing_point(second, turn, center, n)[0]
    if kind == ON_EDGE and not is_round(second):
        e = edge_at(surface, number)
        start, along = vector_at(surface, e), vector_at(surface, e + ALONG)
        _, p, _ = across_line(second, turn, minus(center, start), along, n, 1.0, 0.0, 0.0)
        p = plus(p, start)
    # if there is one patch only, it is the whole surface, which has no end
    out[PAST_END] = past if surface[N_PATCHES] > 1.0 else 0.0
    write_smooth(a, out, gap, second, axes_b, turn, center, n, p)
    write_feature(a, out, SIDE_A, surface, kind, number)
