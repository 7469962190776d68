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
from nonsmooth.engine.memory.blocks import GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.support_function import OF_FUNCTION, is_round, support_of
from ...vectors import put, vector_at
from ..features.frames import point_in_body, point_in_world, vector_in_world, write_tangent
from ..features.vertex_face import REACH
from ..smooth.boxy_line import across_line
from ..smooth.smooth_core import RADIUS, Axes, axes_in_world, axes_of, back, between_axes, forth
from ..smooth.smooth_newton import widest_from, write_surface
from .surface_ball import write_feature
from .surface_search import (
    ON_CORNER,
    ON_EDGE,
    ON_FACE,
    Point,
    box_square,
    face_height,
    has_patch,
    in_triangle,
    nearest_in_patch,
    over_ends,
    past_edge,
)
from .surface_tables import (
    CORNER,
    CORNERS,
    EDGE,
    EDGES,
    FACE,
    FACES,
    MEMBERS,
    N_EDGES,
    N_NODES,
    N_PATCHES,
    N_TRIANGLES,
    NODE,
    NODES,
    SIZE,
    STARS,
    TRIANGLE,
    TRIANGLES,
)

_SAME = 1e-15
"""Difference of two distances that is round-off, relative to the size of the bodies."""
Aim: TypeAlias = tuple[float, float, float, float]
"""Supporting plane of the smooth body, below it: unit normal, and the plane's distance from the origin along it [m]."""


@compiled
def _extent(core: Floats) -> float:
    """Return an upper bound of the distance of the body's farthest point from its centre [m].

    For round cores it is the largest semi-axis plus the radius.  For other cores, and for cores given by a function, it
    is half of the diagonal of the bounding box.
    """
    if is_round(core) and core[3] != OF_FUNCTION:
        return float(max(core[0], core[1], core[2]) + core[RADIUS])
    return math.sqrt(core[0] * core[0] + core[1] * core[1] + core[2] * core[2])


@compiled
def _point_against(core: Floats, turn: Axes, center: Point, normal: Point) -> Point:
    """Return the core's farthest point in the direction opposite to a normal [m], in the axes of the surface."""
    mx, my, mz = back(turn, (-normal[0], -normal[1], -normal[2]))
    px, py, pz = forth(turn, support_of(core, (mx, my, mz))[1])
    return center[0] + px, center[1] + py, center[2] + pz


@compiled
def _least(core: Floats, turn: Axes, x: float, y: float, z: float) -> float:
    """Return a lower bound of the smooth body's distance from a convex feature [m].

    The vector (x, y, z) leads from the feature's nearest point to the centre of the body.
    """
    apart = math.sqrt(x * x + y * y + z * z)
    if apart == 0.0:
        return -math.inf
    mx, my, mz = back(turn, (-x / apart, -y / apart, -z / apart))
    return float(apart - support_of(core, (mx, my, mz))[0] - core[RADIUS])


@compiled
def _on_face(
    surface: Floats, member: int, core: Floats, turn: Axes, center: Point
) -> tuple[float, float, float, float, float]:
    """Return distance of the core from a triangle's plane [m], distance past the end of the contact [m], unit normal.

    The distance past the end is positive if the core's nearest point to the plane is past the border of the triangle's
    face, or if the centre of the body is below the plane.
    """
    t = int(surface[TRIANGLES]) + TRIANGLE * member
    f = int(surface[FACES]) + FACE * int(surface[t + 9])
    nx, ny, nz = vector_at(surface, f)
    px, py, pz = _point_against(core, turn, center, (nx, ny, nz))
    height = nx * px + ny * py + nz * pz - surface[f + 3]
    over, past = over_ends(surface, t, px, py, pz)
    if over > REACH * surface[SIZE]:
        fx, fy, fz = px - height * nx, py - height * ny, pz - height * nz
        qx, qy, qz, _ = in_triangle(surface, t, fx, fy, fz)
        past = math.sqrt((fx - qx) * (fx - qx) + (fy - qy) * (fy - qy) + (fz - qz) * (fz - qz))
    past = max(past, -surface[SIZE])
    # if the body's centre is below the plane, the body is past the end of the face
    return height, max(past, surface[f + 3] - nx * center[0] - ny * center[1] - nz * center[2]), nx, ny, nz


@compiled
def _on_edge(
    surface: Floats, e: int, core: Floats, point: Floats, turn: Axes, center: Point, size: float
) -> tuple[float, float, float, float, float]:
    """Return distance of the core from an edge's line [m], distance past the end of the contact [m], unit normal.

    The distance past the end is positive if the nearest point is past an end of the edge, or if the normal, from the
    edge to the core, is not a normal of the edge.  The distance of the core is nan if the search failed.
    """
    wx, wy, wz = center[0] - surface[e], center[1] - surface[e + 1], center[2] - surface[e + 2]
    ex, ey, ez = vector_at(surface, e + 3)
    g, _, (nx, ny, nz) = widest_from(point, core, turn, (wx, wy, wz), (ex, ey, ez), (wx, wy, wz))
    px, py, pz = _point_against(core, turn, (wx, wy, wz), (nx, ny, nz))
    s = px * ex + py * ey + pz * ez
    past = max(-s, s - surface[e + 6])
    past = max(past, size * (nx * surface[e + 7] + ny * surface[e + 8] + nz * surface[e + 9]))
    past = max(past, size * (nx * surface[e + 10] + ny * surface[e + 11] + nz * surface[e + 12]))
    return g, max(past, -(nx * wx + ny * wy + nz * wz)), nx, ny, nz


@compiled
def _on_corner(
    surface: Floats, c: int, core: Floats, point: Floats, turn: Axes, center: Point, size: float
) -> tuple[float, float, float, float, float]:
    """Return distance of the core from a corner [m], distance past the end of the contact [m], unit normal.

    The distance past the end is positive if an edge of the corner is nearer to the core than the corner itself.
    """
    wx, wy, wz = center[0] - surface[c], center[1] - surface[c + 1], center[2] - surface[c + 2]
    g, _, (nx, ny, nz) = widest_from(point, core, turn, (wx, wy, wz), (0.0, 0.0, 0.0), (wx, wy, wz))
    past, star = -(nx * wx + ny * wy + nz * wz), int(surface[STARS]) + int(surface[c + 4])
    for _ in range(int(surface[c + 5])):
        past = max(past, size * (nx * surface[star] + ny * surface[star + 1] + nz * surface[star + 2]))
        star += 3
    return g, past, nx, ny, nz


@compiled
def _above(surface: Floats, at: int, aim: Aim) -> float:
    """Return a lower bound of the smooth body's distance from the surface's point at index ``at`` [m].

    It is the distance of the point below the body's supporting plane ``aim``.
    """
    return float(aim[3] - aim[0] * surface[at] - aim[1] * surface[at + 1] - aim[2] * surface[at + 2])


@compiled
def _above_box(surface: Floats, at: int, aim: Aim) -> float:
    """Return a lower bound of the smooth body's distance from the box of a node of the surface's tree [m].

    It is the least distance of the box, at index ``at``, below the body's supporting plane ``aim``.
    """
    x = surface[at + 3] if aim[0] > 0.0 else surface[at]
    y = surface[at + 4] if aim[1] > 0.0 else surface[at + 1]
    z = surface[at + 5] if aim[2] > 0.0 else surface[at + 2]
    return float(aim[3] - aim[0] * x - aim[1] * y - aim[2] * z)


@compiled
def _look_at(
    surface: Floats,
    patch: float,
    member: int,
    core: Floats,
    point: Floats,
    turn: Axes,
    center: Point,
    best: float,
    aim: Aim,
) -> tuple[float, float, float, float, float, float]:
    """Evaluate one feature of the surface; return six numbers.

    They are the distance of the core from the feature [m], the distance past the end of the contact [m], the three
    components of the unit normal, and a lower bound of the body's distance [m].  The distance of the core is infinite
    if the feature belongs to another patch or cannot be nearer than ``best`` [m]; it is nan if the search failed.
    ``member`` is the number of the feature in the tree: triangles, then convex edges, then corners.  ``aim`` is the
    body's supporting plane for the nearest feature so far.
    """
    x, y, z = center
    n_triangles, n_edges = int(surface[N_TRIANGLES]), int(surface[N_EDGES])
    size = _extent(core)
    if member < n_triangles:
        t = int(surface[TRIANGLES]) + TRIANGLE * member
        f = int(surface[FACES]) + FACE * int(surface[t + 9])
        least = face_height(surface, f, x, y, z) - size
        if surface[f + 4] != patch or least > best:
            return math.inf, 0.0, 0.0, 0.0, 1.0, least
        if min(_above(surface, t, aim), min(_above(surface, t + 3, aim), _above(surface, t + 6, aim))) > best:
            return math.inf, 0.0, 0.0, 0.0, 1.0, least
        g, past, nx, ny, nz = _on_face(surface, member, core, turn, center)
    elif member < n_triangles + n_edges:
        e = int(surface[EDGES]) + EDGE * (member - n_triangles)
        least = _above(surface, e, aim)
        least -= max(
            surface[e + 6] * (aim[0] * surface[e + 3] + aim[1] * surface[e + 4] + aim[2] * surface[e + 5]), 0.0
        )
        if surface[e + 13] != patch or least > best:
            return math.inf, 0.0, 0.0, 0.0, 1.0, least
        _, px, py, pz = past_edge(surface, e, x, y, z)
        least = _least(core, turn, x - px, y - py, z - pz)
        if least > best:
            return math.inf, 0.0, 0.0, 0.0, 1.0, least
        g, past, nx, ny, nz = _on_edge(surface, e, core, point, turn, center, size)
    else:
        c = int(surface[CORNERS]) + CORNER * (member - n_triangles - n_edges)
        least = _above(surface, c, aim)
        if surface[c + 3] != patch or least > best:
            return math.inf, 0.0, 0.0, 0.0, 1.0, least
        least = _least(core, turn, x - surface[c], y - surface[c + 1], z - surface[c + 2])
        if least > best:
            return math.inf, 0.0, 0.0, 0.0, 1.0, least
        g, past, nx, ny, nz = _on_corner(surface, c, core, point, turn, center, size)
    return g, past - REACH * surface[SIZE], nx, ny, nz, least


@compiled
def _aim(surface: Floats, core: Floats, turn: Axes, center: Point, normal: Point) -> Aim:
    """Return the smooth body's supporting plane across the unit vector ``normal``.

    The plane is raised by round-off: features in one plane then get the same bound, and none of them is excluded.
    """
    px, py, pz = _point_against(core, turn, center, normal)
    level = normal[0] * px + normal[1] * py + normal[2] * pz - core[RADIUS]
    none = _SAME * (abs(px) + abs(py) + abs(pz) + surface[SIZE])
    return normal[0], normal[1], normal[2], level + none


@compiled
def _nearest(
    surface: Floats, patch: float, core: Floats, point: Floats, turn: Axes, center: Point, reach: float
) -> tuple[float, float, int, int, float, float, float]:
    """Return distance of the core [m], distance past the end [m], kind and number of a patch's feature, and normal.

    The feature is the nearest one that the body may touch: its distance past the end is not positive.  If there is no
    such feature, it is the one with the least sqrt(gap^2 + past^2), where past is the distance past the end.  If no
    feature is nearer than ``reach`` [m], gap and distance past the end are ``reach``.  The distance is nan if the
    search failed for a feature that may be nearer.
    """
    nodes, members, n_triangles = int(surface[NODES]), int(surface[MEMBERS]), int(surface[N_TRIANGLES])
    x, y, z = center
    size = _extent(core)
    same = _SAME * (size + surface[SIZE])
    best, missed, found = reach, math.inf, 0
    distance, past, bx, by, bz = reach + core[RADIUS], reach, 0.0, 0.0, 1.0
    aim: Aim = (0.0, 0.0, 0.0, -math.inf)
    # first evaluate the feature nearest to the centre, then all faces, which cost least; their distances exclude most
    # edges and corners from the search
    _, _, kind, number, _, _, _ = nearest_in_patch(surface, patch, x, y, z, reach + size)
    if kind != ON_FACE:
        found = number + n_triangles + (int(surface[N_EDGES]) if kind == ON_CORNER else 0)
        g, beyond, nx, ny, nz, _ = _look_at(surface, patch, found, core, point, turn, center, best, aim)
        gap = g - core[RADIUS]
        key = gap if beyond <= 0.0 else math.sqrt(gap * gap + beyond * beyond)
        if key < best:
            best, distance, past, bx, by, bz = key, g, beyond, nx, ny, nz
            aim = _aim(surface, core, turn, center, (nx, ny, nz))
    for stage in range(2):
        node = 0
        while node < int(surface[N_NODES]):
            at = nodes + NODE * node
            far = math.sqrt(box_square(surface, at, x, y, z)) - size > best or _above_box(surface, at, aim) > best
            if far or not has_patch(surface, at, patch):
                node = int(surface[at + 6])
                continue
            for i in range(int(surface[at + 8])):
                member = int(surface[members + int(surface[at + 7]) + i])
                if (member < n_triangles) != (stage == 0):
                    continue
                g, beyond, nx, ny, nz, least = _look_at(surface, patch, member, core, point, turn, center, best, aim)
                if g != g:
                    missed = min(missed, least)
                    continue
                gap = g - core[RADIUS]
                key = gap if beyond <= 0.0 else math.sqrt(gap * gap + beyond * beyond)
                # on the border of a face, the face and its edge have the same distance within round-off: take the face
                alike = key < best + same and beyond <= 0.0
                if key < best - same or (alike and (past > 0.0 or member < found)):
                    best, distance, past, found, bx, by, bz = key, g, beyond, member, nx, ny, nz
                    aim = _aim(surface, core, turn, center, (nx, ny, nz))
            node += 1
    if not missed >= best:
        distance = math.nan
    if found < n_triangles:
        return distance, past, ON_FACE, int(surface[int(surface[TRIANGLES]) + TRIANGLE * found + 9]), bx, by, bz
    found -= n_triangles
    if found < int(surface[N_EDGES]):
        return distance, past, ON_EDGE, found, bx, by, bz
    return distance, past, ON_CORNER, found - int(surface[N_EDGES]), bx, by, bz


@compiled
def write_surface_smooth(
    a: Floats, b: Floats, out: Floats, surface: Floats, patch: float, second: Floats, point: Floats, reach: float
) -> None:
    """Write the geometry block of a patch of a surface and a smooth body; the gap is nan if the search failed.

    ``reach`` is the largest distance of features that are searched [m].
    """
    axes_a, axes_b = axes_of(a), axes_in_world(b, second)
    bx, by, bz = point_in_world(b, vector_at(second, 6))
    x, y, z = point_in_body(a, (bx, by, bz))
    turn = between_axes(axes_a, axes_b)
    g, past, kind, number, nx, ny, nz = _nearest(surface, patch, second, point, turn, (x, y, z), reach)
    gap = g - second[RADIUS]
    if past > 0.0:
        gap = math.hypot(gap, past)
    px, py, pz = _point_against(second, turn, (x, y, z), (nx, ny, nz))
    if kind == ON_EDGE and not is_round(second):
        e = int(surface[EDGES]) + EDGE * number
        ex, ey, ez = vector_at(surface, e + 3)
        wx, wy, wz = x - surface[e], y - surface[e + 1], z - surface[e + 2]
        _, (px, py, pz), _ = across_line(second, turn, (wx, wy, wz), (ex, ey, ez), (nx, ny, nz), 1.0, 0.0, 0.0)
        px, py, pz = px + surface[e], py + surface[e + 1], pz + surface[e + 2]
    # if there is one patch only, it is the whole surface, which has no end
    out[GAP], out[PAST_END] = gap, past if surface[N_PATCHES] > 1.0 else 0.0
    put(out, NORMAL, vector_in_world(a, (nx, ny, nz)))
    put(out, POINT_B, point_in_world(a, (px, py, pz)))
    for i in range(3):
        out[POINT_B + i] -= second[RADIUS] * out[NORMAL + i]
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    write_tangent(a, out)
    mx, my, mz = back(turn, (-nx, -ny, -nz))
    bx, by, bz = back(turn, (px - x, py - y, pz - z))
    write_surface(out, SIDE_B, second, axes_b, (mx, my, mz), (bx, by, bz))
    write_feature(a, out, SIDE_A, surface, kind, number)
