"""Gap of a convex polyhedron or segment and a body with a smooth support function.

The signed distance of a point from a convex body is a convex function, so that it has one minimum over the polytope.
The search for it, the walk, goes from feature to feature: faces, edges, vertices.  On each feature, Newton's method on
the support function finds the minimum over the feature's plane or line.  This minimum is called a stop.

1. If the stop is outside of its feature, the walk continues on the edge or vertex of the border that it crossed.
2. If the distance decreases from the stop into a neighbouring feature, the walk continues on this neighbour.
3. Otherwise the stop is the minimum over the polytope.

Every stop has a smaller distance than the stop before, so that the walk ends.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.polytope import Polytope
from ...shapes.support_function import is_round, support_of
from ...vectors import put, vector_at
from ..features.frames import point_in_body, point_in_world, tangent_of, vector_in_world, write_tangent
from ..features.writing import write_flat, write_principal, write_round
from .boxy_newton import Answer
from .inscribed import gauge
from .round_search import along_segment, up_hills
from .smooth_core import RADIUS, Axes, axes_in_world, axes_of, back, between_axes, forth
from .smooth_newton import widest_from, write_surface

Numbers = tuple[float, ...]

COUNTS, VERTICES, EDGES, FACES, LOOPS, STARS, LISTS = 6, 9, 10, 11, 12, 13, 14
"""Indices in the head of a polytope's numbers.

At ``COUNTS`` is the number of vertices; the numbers of edges and of faces follow.  At ``VERTICES``, ``EDGES``,
``FACES``, ``LOOPS``, ``STARS`` and ``LISTS`` is the index at which the list of this name begins.  ``LISTS`` are the
lists of the edges of each vertex.
"""
EDGE, FACE = 4, 6
"""Length of the row of an edge and of the row of a face, respectively.

An edge: both vertices, the face on its left, the face on its right (-1 for none).  A face: outward normal, distance of
its plane from the origin [m], beginning and length of its loop.
"""
_HEADER = 15


def polyhedron_numbers(polytope: Polytope, radius: float = 0.0) -> Numbers:
    """Numbers of a polyhedron, with a radius about it [m].

    They begin like the numbers of a point (:func:`bodies.shapes.smooth.core_numbers`), because searches treat a vertex
    as a point: three semi-axes 0, two powers, the radius.  Then come the numbers of vertices, edges and faces, and the
    offsets of the six lists.  The lists are, in the frame of the body: vertices, edges, faces, loops (the vertices of a
    face, each with the edge that leaves it), stars (for every vertex, beginning and length of its list of edges), and
    these lists of edges.
    """
    return _numbers(polytope.vertices, polytope.faces, polytope.planes, polytope.edges, radius)


def segment_numbers(ends: Sequence[tuple[float, float, float]], radius: float) -> Numbers:
    """Numbers of a capsule, a segment with a radius about it [m]; see :func:`polyhedron_numbers`."""
    return _numbers(ends, (), (), ((0, 1, -1, -1),), radius)


def _numbers(
    vertices: Sequence[tuple[float, float, float]],
    faces: Sequence[tuple[int, ...]],
    planes: Sequence[tuple[float, float, float, float]],
    edges: Sequence[tuple[int, int, int, int]],
    radius: float,
) -> Numbers:
    number = {pair: i for i, (one, two, _, _) in enumerate(edges) for pair in ((one, two), (two, one))}
    loops = [(one, number[one, two]) for face in faces for one, two in zip(face, (*face[1:], face[0]), strict=True)]
    begins = itertools.accumulate((len(face) for face in faces), initial=0)
    rows = [(*plane, 2 * begin, len(face)) for plane, begin, face in zip(planes, begins, faces, strict=False)]
    own: list[list[int]] = [[] for _ in vertices]
    for i, edge in enumerate(edges):
        for vertex in edge[:2]:
            own[vertex].append(i)
    begins = itertools.accumulate((len(one) for one in own), initial=0)
    stars = [(begin, len(one)) for begin, one in zip(begins, own, strict=False)]
    parts = [list(itertools.chain(*part)) for part in (vertices, edges, rows, loops, stars, own)]
    offsets = itertools.accumulate((len(part) for part in parts[:-1]), initial=_HEADER)
    head = (0, 0, 0, 2, 2, radius, len(vertices), len(edges), len(faces), *offsets)
    return tuple(float(x) for x in (*head, *itertools.chain(*parts)))


_HERE, _VERTEX, _EDGE, _FACE = -1, 0, 1, 2
"""Kind of the feature on which the walk continues; ``_HERE``: the walk ends, on the present feature."""
_ON_BORDER = 1e-14
"""Tolerance for round-off: a point or unit normal this far outside still belongs to a feature.

For the point it is the distance past the feature's border, relative to the size.  For the normal it is the sine of the
angle past the range of the feature's normals.
"""
_SHALLOW = 1e-6
"""Overlap of the cores, relative to the size, up to which the walk's final stop is accepted without further tests.

A deeper overlap can have several locally shortest separations, so that its stop is tested and compared with others.
"""
_ROUND = 8
"""Number of directions about a segment from which Newton's method starts, if the segment is deep in the body."""

Point: TypeAlias = tuple[float, float, float]
Stop: TypeAlias = tuple[float, float, float, float, int, int, Point]
Nearest: TypeAlias = tuple[float, float, float, float, int, Point]


@compiled
def _vertex(hull: Floats, i: int) -> tuple[float, float, float]:
    at = int(hull[VERTICES]) + 3 * i
    found: Point = vector_at(hull, at)
    return found


@compiled
def _edge(hull: Floats, i: int) -> tuple[float, float, float, float]:
    """Return the unit vector from the first to the second vertex of an edge, and its length."""
    at = int(hull[EDGES]) + EDGE * i
    ax, ay, az = _vertex(hull, int(hull[at]))
    bx, by, bz = _vertex(hull, int(hull[at + 1]))
    x, y, z = bx - ax, by - ay, bz - az
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length, length


@compiled
def _point_along(
    core: Floats, turn: Axes, x: float, y: float, z: float, nx: float, ny: float, nz: float
) -> tuple[float, float, float]:
    """Return the smooth body's farthest point in the direction -(nx, ny, nz) [m], in the axes of the polytope."""
    mx, my, mz = back(turn, (-nx, -ny, -nz))
    s = support_of(core, (mx, my, mz))
    px, py, pz = forth(turn, (s[1], s[2], s[3]))
    return x + px, y + py, z + pz


@compiled
def _exit(
    hull: Floats, face: int, near: float, fx: float, fy: float, fz: float, tx: float, ty: float, tz: float
) -> int:
    """Return the number of the face's edge that the line from f to t crosses first, or -1 if it crosses none.

    Both points are in the plane of the face, f on the face.  A point up to ``near`` past an edge [m] is on the face.
    """
    at = int(hull[FACES]) + FACE * face
    nx, ny, nz = vector_at(hull, at)
    loop, count = int(hull[LOOPS]) + int(hull[at + 4]), int(hull[at + 5])
    found, least = -1, 2.0
    for i in range(count):
        vx, vy, vz = _vertex(hull, int(hull[loop + 2 * i]))
        wx, wy, wz = _vertex(hull, int(hull[loop + 2 * ((i + 1) % count)]))
        ex, ey, ez = wx - vx, wy - vy, wz - vz
        length = math.sqrt(ex * ex + ey * ey + ez * ez)
        ox, oy, oz = (ey * nz - ez * ny) / length, (ez * nx - ex * nz) / length, (ex * ny - ey * nx) / length
        before = (fx - vx) * ox + (fy - vy) * oy + (fz - vz) * oz
        after = (tx - vx) * ox + (ty - vy) * oy + (tz - vz) * oz
        if after > near and after > before:
            part = max(-before, 0.0) / (after - before)
            if part < least:
                found, least = int(hull[loop + 2 * i + 1]), part
    return found


@compiled
def _best_face(hull: Floats, core: Floats, turn: Axes, x: float, y: float, z: float) -> int:
    """Return the face whose plane has the largest gap to the smooth body, or -1 if the polytope is a segment."""
    best, widest = -1, -math.inf
    for i in range(int(hull[COUNTS + 2])):
        at = int(hull[FACES]) + FACE * i
        nx, ny, nz = vector_at(hull, at)
        px, py, pz = _point_along(core, turn, x, y, z, nx, ny, nz)
        wide = nx * px + ny * py + nz * pz - hull[at + 3]
        if wide > widest:
            best, widest = i, wide
    return best


@compiled
def _look_at_face(
    hull: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, near: float, number: int, way: Point
) -> Stop:
    at = int(hull[FACES]) + FACE * number
    nx, ny, nz = vector_at(hull, at)
    px, py, pz = _point_along(core, turn, x, y, z, nx, ny, nz)
    g = nx * px + ny * py + nz * pz - hull[at + 3]
    edge = _exit(hull, number, near, way[0], way[1], way[2], px - g * nx, py - g * ny, pz - g * nz)
    return g, nx, ny, nz, _HERE if edge < 0 else _EDGE, edge, way


@compiled
def _look_at_edge(
    hull: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, near: float, number: int, begin: Point
) -> Stop:
    at = int(hull[EDGES]) + EDGE * number
    one, two = int(hull[at]), int(hull[at + 1])
    vx, vy, vz = _vertex(hull, one)
    ex, ey, ez, length = _edge(hull, number)
    g, px, py, pz, nx, ny, nz = widest_from(
        hull, core, turn, (x - vx, y - vy, z - vz), (ex, ey, ez), (begin[0], begin[1], begin[2])
    )
    s = px * ex + py * ey + pz * ez
    if s < -near or s > length + near:
        return g, nx, ny, nz, _VERTEX, one if s < 0.0 else two, begin
    side, most = -1, _ON_BORDER
    for i in range(2):
        face = int(hull[at + 2 + i])
        if face >= 0:
            # into the face, whose loop runs along the edge on its left, against it on its right
            f = int(hull[FACES]) + FACE * face
            fx, fy, fz = vector_at(hull, f)
            into = nx * (fy * ez - fz * ey) + ny * (fz * ex - fx * ez) + nz * (fx * ey - fy * ex)
            into = into if i == 0 else -into
            if into > most:
                side, most = face, into
    return g, nx, ny, nz, _HERE if side < 0 else _FACE, side, (vx + s * ex, vy + s * ey, vz + s * ez)


@compiled
def _look_at_vertex(
    hull: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, number: int, begin: Point
) -> Stop:
    vx, vy, vz = _vertex(hull, number)
    g, _, _, _, nx, ny, nz = widest_from(
        hull, core, turn, (x - vx, y - vy, z - vz), (0.0, 0.0, 0.0), (begin[0], begin[1], begin[2])
    )
    star = int(hull[STARS]) + 2 * number
    steepest, most = -1, _ON_BORDER
    for i in range(int(hull[star + 1])):
        edge = int(hull[int(hull[LISTS]) + int(hull[star]) + i])
        ex, ey, ez, _ = _edge(hull, edge)
        away = nx * ex + ny * ey + nz * ez
        if int(hull[int(hull[EDGES]) + EDGE * edge]) != number:
            away = -away
        if away > most:
            steepest, most = edge, away
    return g, nx, ny, nz, _HERE if steepest < 0 else _EDGE, steepest, (vx, vy, vz)


@compiled
def _middle(hull: Floats, face: int) -> Point:
    at = int(hull[FACES]) + FACE * face
    loop, count = int(hull[LOOPS]) + int(hull[at + 4]), int(hull[at + 5])
    x = y = z = 0.0
    for i in range(count):
        vx, vy, vz = _vertex(hull, int(hull[loop + 2 * i]))
        x, y, z = x + vx / count, y + vy / count, z + vz / count
    return x, y, z


@compiled
def _nearest(hull: Floats, core: Floats, turn: Axes, x: float, y: float, z: float) -> Nearest:
    """Return the gap of the cores [m], the normal, the polytope's nearest feature and a point of this feature.

    The number of the feature counts faces first, then edges, then vertices.  On an edge or a vertex, the point is the
    polytope's nearest point.  All vectors are in the frame of the polytope; (x, y, z) is the centre of the smooth
    body's core.  The gap is nan if no nearest feature was found.
    """
    n_edges, n_faces = int(hull[COUNTS + 1]), int(hull[COUNTS + 2])
    vx, vy, vz = _vertex(hull, 0)
    size = abs(x) + abs(y) + abs(z) + max(core[0], core[1], core[2]) + abs(vx) + abs(vy) + abs(vz)
    near = _ON_BORDER * size
    kind, number, way = _EDGE, 0, (vx, vy, vz)
    if n_faces > 0:
        kind, number = _FACE, _best_face(hull, core, turn, x, y, z)
        way = _middle(hull, number)
    best, bx, by, bz, feature, base = math.nan, 0.0, 0.0, 1.0, 0, way
    # on edges and vertices Newton's method starts with the direction to the smooth body's centre
    for _ in range(n_edges + 4):
        if kind == _FACE:
            g, nx, ny, nz, after, where, way = _look_at_face(hull, core, turn, x, y, z, near, number, way)
        elif kind == _EDGE:
            vx, vy, vz = _vertex(hull, int(hull[int(hull[EDGES]) + EDGE * number]))
            begin = (x - vx, y - vy, z - vz)
            g, nx, ny, nz, after, where, way = _look_at_edge(hull, core, turn, x, y, z, near, number, begin)
        else:
            vx, vy, vz = _vertex(hull, number)
            begin = (x - vx, y - vy, z - vz)
            g, nx, ny, nz, after, where, way = _look_at_vertex(hull, core, turn, x, y, z, number, begin)
        if after == _HERE and g >= -_SHALLOW * size:
            return g, nx, ny, nz, _feature(hull, kind, number), way
        # a final stop is valid only if the smooth body's centre is on the outer side of the feature
        if after == _HERE and nx * (x - way[0]) + ny * (y - way[1]) + nz * (z - way[2]) > 0.0:
            # if the polytope's point lies in the smooth body (gauge below 1), the overlap is proved
            px, py, pz = _point_along(core, turn, x, y, z, nx, ny, nz)
            px, py, pz = back(turn, (px - g * nx - x, py - g * ny - y, pz - g * nz - z))
            if gauge(core, px, py, pz) < 1.0:
                return g, nx, ny, nz, _feature(hull, kind, number), way
            best, bx, by, bz, feature, base = g, nx, ny, nz, _feature(hull, kind, number), way
        if g != g or after == _HERE:
            break
        kind, number = after, where
    found: Answer = (math.nan, x, y, z, 0.0, 0.0, 1.0)
    on_segment = way
    if n_faces == 0:
        # a segment: search along it
        vx, vy, vz = _vertex(hull, 0)
        ex, ey, ez, length = _edge(hull, 0)
        found, s = along_segment(core, turn, x - vx, y - vy, z - vz, ex, ey, ez, length)
        number = n_edges if s == 0.0 else n_edges + 1 if s == length else 0
        on_segment = vx + s * ex, vy + s * ey, vz + s * ez
        if found[0] >= 0.0:
            return found[0], found[4], found[5], found[6], number, on_segment
    g, nx, ny, nz, feature_of_all, way = _best_of_all(hull, core, turn, x, y, z, near)
    if best == best and not g > best:
        return best, bx, by, bz, feature, base
    if g != g and found[0] == found[0]:
        # the trial of all features found nothing: return the overlap that the search along the segment found
        return found[0], found[4], found[5], found[6], number, on_segment
    if g != g and n_faces == 0:
        end: Nearest = _deep_segment(hull, core, turn, x, y, z, size)
        return end
    return g, nx, ny, nz, feature_of_all, way


@compiled
def _deep_segment(hull: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, size: float) -> Nearest:
    """Return gap, normal, feature and point as `_nearest` does, for a segment deep in the smooth body.

    Searches start uphill from both ends, and from ``_ROUND`` directions round the segment.
    """
    best, bx, by, bz, feature, base = math.nan, 0.0, 0.0, 1.0, 0, (0.0, 0.0, 0.0)
    for end in range(2):
        vx, vy, vz = _vertex(hull, end)
        ex, ey, ez, _ = _edge(hull, 0)
        lean = (1.0, 0.0, size)
        g, _, _, _, nx, ny, nz = up_hills((0.0, 0.0, 0.0, 2.0, 2.0, 0.0), core, turn, x - vx, y - vy, z - vz, 0.0, lean)
        ahead = nx * ex + ny * ey + nz * ez
        if (ahead <= 0.0 if end == 0 else ahead >= 0.0) and g == g and not g <= best:
            best, bx, by, bz, feature, base = g, nx, ny, nz, _feature(hull, _VERTEX, end), (vx, vy, vz)
    ex, ey, ez, _ = _edge(hull, 0)
    tx, ty, tz = tangent_of((ex, ey, ez))
    for i in range(_ROUND):
        c, s = math.cos(2.0 * math.pi * i / _ROUND), math.sin(2.0 * math.pi * i / _ROUND)
        begin = (
            c * tx + s * (ey * tz - ez * ty),
            c * ty + s * (ez * tx - ex * tz),
            c * tz + s * (ex * ty - ey * tx),
        )
        g, nx, ny, nz, after, _, way = _look_at_edge(hull, core, turn, x, y, z, _ON_BORDER * size, 0, begin)
        if after == _HERE and g == g and not g <= best:
            best, bx, by, bz, feature, base = g, nx, ny, nz, _feature(hull, _EDGE, 0), way
    return best, bx, by, bz, feature, base


@compiled
def _best_of_all(hull: Floats, core: Floats, turn: Axes, x: float, y: float, z: float, near: float) -> Nearest:
    """Return gap, normal, feature and point as `_nearest` does, by Newton's method on every feature of the polytope.

    It is used for overlaps in which the walk does not lead to a proved solution.  The result is the final stop with the
    largest gap.  Newton's method starts from an outward direction.  At an edge it is the sum of the normals of its
    faces, at a vertex the sum of the unit vectors opposite to its edges.
    """
    best, bx, by, bz, feature, base = math.nan, 0.0, 0.0, 1.0, 0, (0.0, 0.0, 0.0)
    for kind in (_FACE, _EDGE, _VERTEX):
        for number in range(int(hull[COUNTS + kind])):
            if kind == _FACE:
                way = _middle(hull, number)
                g, nx, ny, nz, after, _, way = _look_at_face(hull, core, turn, x, y, z, near, number, way)
            elif kind == _EDGE:
                begin = _outward_of_edge(hull, number, x, y, z)
                g, nx, ny, nz, after, _, way = _look_at_edge(hull, core, turn, x, y, z, near, number, begin)
            else:
                begin = _outward_of_vertex(hull, number)
                g, nx, ny, nz, after, _, way = _look_at_vertex(hull, core, turn, x, y, z, number, begin)
            if after == _HERE and g == g and not g <= best:
                best, bx, by, bz, feature, base = g, nx, ny, nz, _feature(hull, kind, number), way
    return best, bx, by, bz, feature, base


@compiled
def _outward_of_edge(hull: Floats, number: int, x: float, y: float, z: float) -> Point:
    """Return a direction out of the polytope at an edge, of any length: the sum of the normals of its two faces.

    A segment has no faces: there it is the vector from its start to the smooth body's centre (x, y, z) [m].
    """
    at = int(hull[EDGES]) + EDGE * number
    if hull[at + 2] < 0.0:
        vx, vy, vz = _vertex(hull, int(hull[at]))
        return x - vx, y - vy, z - vz
    x = y = z = 0.0
    for i in range(2):
        face = int(hull[at + 2 + i])
        if face >= 0:
            f = int(hull[FACES]) + FACE * face
            x, y, z = x + hull[f], y + hull[f + 1], z + hull[f + 2]
    return x, y, z


@compiled
def _outward_of_vertex(hull: Floats, number: int) -> Point:
    x = y = z = 0.0
    star = int(hull[STARS]) + 2 * number
    for i in range(int(hull[star + 1])):
        edge = int(hull[int(hull[LISTS]) + int(hull[star]) + i])
        ex, ey, ez, _ = _edge(hull, edge)
        sign = -1.0 if int(hull[int(hull[EDGES]) + EDGE * edge]) == number else 1.0
        x, y, z = x + sign * ex, y + sign * ey, z + sign * ez
    return x, y, z


@compiled
def _feature(hull: Floats, kind: int, number: int) -> int:
    if kind == _FACE:
        return number
    return number + int(hull[COUNTS + 2]) + (int(hull[COUNTS + 1]) if kind == _VERTEX else 0)


def evaluate_polytope_smooth(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats) -> None:
    """Write the geometry block of the contact between a polytope and a smooth body.

    ``first`` holds the numbers of the polytope (:func:`polyhedron_numbers`), ``second`` the numbers of the smooth body
    (:func:`bodies.shapes.smooth.core_numbers`).  The gap is nan if no nearest feature was found.
    """
    axes_a, axes_b = axes_of(a), axes_in_world(b, second)
    bx, by, bz = point_in_world(b, vector_at(second, 6))
    x, y, z = point_in_body(a, (bx, by, bz))
    turn = between_axes(axes_a, axes_b)
    g, nx, ny, nz, feature, base = _nearest(first, second, turn, x, y, z)
    px, py, pz = _point_along(second, turn, x, y, z, nx, ny, nz)
    n_faces, n_edges = int(first[COUNTS + 2]), int(first[COUNTS + 1])
    if feature >= n_faces and not is_round(second):
        # on a flat place of the smooth body the normal does not determine the point: use the polytope's point
        px, py, pz = base[0] + g * nx, base[1] + g * ny, base[2] + g * nz
    out[GAP] = g - first[RADIUS] - second[RADIUS]
    put(out, NORMAL, vector_in_world(a, (nx, ny, nz)))
    put(out, POINT_B, point_in_world(a, (px, py, pz)))
    for i in range(3):
        out[POINT_B + i] -= second[RADIUS] * out[NORMAL + i]
        out[POINT_A + i] = out[POINT_B + i] - out[GAP] * out[NORMAL + i]
    out[FEATURE] = feature
    write_tangent(a, out)
    mx, my, mz = back(turn, (-nx, -ny, -nz))
    px, py, pz = back(turn, (px - x, py - y, pz - z))
    write_surface(out, SIDE_B, second, axes_b, (mx, my, mz), (px, py, pz))
    if feature < n_faces:
        write_flat(out, SIDE_A)
    elif feature < n_faces + n_edges:
        ex, ey, ez, _ = _edge(first, feature - n_faces)
        ex, ey, ez = vector_in_world(a, (ex, ey, ez))
        write_principal(out, SIDE_A, ex, ey, ez, 0.0, 1.0, 1.0, first[RADIUS])
    else:
        write_round(out, SIDE_A, first[RADIUS])
