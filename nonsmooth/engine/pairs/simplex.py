"""The point of a simplex of up to four corners that is nearest to the origin, by its faces and edges one after another.

The corners stand in ``simplex``, three numbers each, and behind them the parts with which they make up the point.
"""

from __future__ import annotations

import math

from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, minus, scaled

CORNERS = 4
WEIGHTS = 3 * CORNERS
"""Where the parts begin."""
_FLAT_TRIANGLE = 1e-24
"""Of a triangle with less than this square of the sine between two edges only the edges are looked at."""
_FLAT_TETRAHEDRON = 1e-15
"""A tetrahedron with less than this part of the cube of its size has no inside."""


@kernel("v3(ws, i8)")
def corner(ws: Workspace, i: int) -> Vector:
    """Return a corner of the simplex."""
    at = ws.problem.simplex.start + 3 * i
    return ws.floats[at], ws.floats[at + 1], ws.floats[at + 2]


@kernel("void(ws, i8, v3)")
def put_corner(ws: Workspace, i: int, place: Vector) -> None:
    """Write corner ``i`` of the simplex [m]."""
    at = ws.problem.simplex.start + 3 * i
    ws.floats[at], ws.floats[at + 1], ws.floats[at + 2] = place


@kernel()
def _clear_weights(ws: Workspace) -> None:
    for i in range(CORNERS):
        ws.problem.simplex[WEIGHTS + i] = 0.0


@kernel("f8(ws, i8, i8, f8)")
def _try_edge(ws: Workspace, i: int, j: int, best: float) -> float:
    """Take the nearest point of an edge if its square is below ``best``; return the lesser square."""
    a, b = corner(ws, i), corner(ws, j)
    way = minus(b, a)
    square = dot(way, way)
    part = min(1.0, max(0.0, -dot(a, way) / square)) if square > 0.0 else 0.0
    x, y, z = scaled(part, way)
    point = a[0] + x, a[1] + y, a[2] + z
    found = dot(point, point)
    if found >= best:
        return best
    _clear_weights(ws)
    ws.problem.simplex[WEIGHTS + i], ws.problem.simplex[WEIGHTS + j] = 1.0 - part, part
    return float(found)


@kernel("f8(ws, i8, i8, i8, f8)")
def _try_face(ws: Workspace, i: int, j: int, m: int, best: float) -> float:
    """Take the nearest point of a triangle if its square is below ``best``; return the lesser square."""
    a, b, c = corner(ws, i), corner(ws, j), corner(ws, m)
    u, v = minus(b, a), minus(c, a)
    normal = cross(u, v)
    square = dot(normal, normal)
    if square > _FLAT_TRIANGLE * dot(u, u) * dot(v, v):
        height = dot(normal, a) / square
        foot = scaled(height, normal)
        a, b, c = minus(a, foot), minus(b, foot), minus(c, foot)
        of_a, of_b, of_c = dot(normal, cross(b, c)), dot(normal, cross(c, a)), dot(normal, cross(a, b))
        if of_a >= 0.0 and of_b >= 0.0 and of_c >= 0.0:
            if height * height * square >= best:
                return best
            _clear_weights(ws)
            whole = of_a + of_b + of_c
            parts = ws.problem.simplex.start + WEIGHTS
            ws.floats[parts + i], ws.floats[parts + j], ws.floats[parts + m] = of_a / whole, of_b / whole, of_c / whole
            return float(height * height * square)
    best = _try_edge(ws, i, j, best)
    best = _try_edge(ws, j, m, best)
    return float(_try_edge(ws, m, i, best))


@kernel("f8(ws, i8, i8, i8, i8)")
def _volume(ws: Workspace, i: int, j: int, m: int, top: int) -> float:
    """Return six times the signed volume of a tetrahedron."""
    a = corner(ws, i)
    return dot(cross(minus(corner(ws, j), a), minus(corner(ws, m), a)), minus(corner(ws, top), a))


@kernel("f8(ws, i8, i8, i8)")
def _volume_to_origin(ws: Workspace, i: int, j: int, m: int) -> float:
    """Return six times the signed volume of a triangle with the origin for a top."""
    a = corner(ws, i)
    return -dot(cross(minus(corner(ws, j), a), minus(corner(ws, m), a)), a)


@kernel("f8(ws, f8)")
def _try_tetrahedron(ws: Workspace, size: float) -> float:
    """Take the nearest point of a tetrahedron; return its square, 0 where the origin is inside."""
    flat = abs(_volume(ws, 0, 1, 2, 3)) <= _FLAT_TETRAHEDRON * size * size * size
    best = math.inf
    for top in range(CORNERS):
        i, j, m = (top + 1) % CORNERS, (top + 2) % CORNERS, (top + 3) % CORNERS
        if flat or _volume_to_origin(ws, i, j, m) * _volume(ws, i, j, m, top) <= 0.0:
            best = _try_face(ws, i, j, m, best)
    return 0.0 if best == math.inf else best


@kernel("i8(ws, i8, f8)")
def reduce_to_nearest(ws: Workspace, n: int, size: float) -> int:
    """Keep of ``n`` corners those that hold the point nearest to the origin; return how many; 0 if that is inside."""
    _clear_weights(ws)
    parts = ws.problem.simplex.start + WEIGHTS
    if n == 1:
        ws.floats[parts] = 1.0
    elif n == 2:
        _try_edge(ws, 0, 1, math.inf)
    elif n == 3:
        _try_face(ws, 0, 1, 2, math.inf)
    elif _try_tetrahedron(ws, size) == 0.0:
        return 0
    kept = 0
    for i in range(n):
        if ws.floats[parts + i] > 0.0:
            put_corner(ws, kept, corner(ws, i))
            ws.floats[parts + kept] = ws.floats[parts + i]
            kept += 1
    return kept


@kernel("v3(ws, i8)")
def nearest_point(ws: Workspace, n: int) -> Vector:
    """Return the point that the ``n`` corners make up with their parts."""
    x, y, z = 0.0, 0.0, 0.0
    for i in range(n):
        a = corner(ws, i)
        part = ws.problem.simplex[WEIGHTS + i]
        x, y, z = x + part * a[0], y + part * a[1], z + part * a[2]
    return x, y, z
