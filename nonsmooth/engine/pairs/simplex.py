"""Point of a simplex of up to four corners that is nearest to the origin, by its faces and edges in turn.

``problem.simplex`` holds the corners, three numbers each, and behind them their weights: the nearest point is the
weighted sum of the corners. A corner is the difference of a point of the second part and one of the first. The points
of the first part come last: their sum with the same weights is the point of the first part that is nearest to the
second. All faces are tested by their own projections. The recursion of Johnson is faster, but it loses all digits for
flat simplices.
"""

from __future__ import annotations

import math

from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, minus, scaled

CORNERS = 4
"""Most corners of a simplex in space."""
WEIGHTS = 3 * CORNERS
"""Where the weights of the corners begin."""
FIRST_POINTS = WEIGHTS + CORNERS
"""Where the points of the first part begin."""
_FLAT_TRIANGLE = 1e-24
"""Square of the sine between two edges below which a triangle is treated as its edges."""
_FLAT_TETRAHEDRON = 1e-15
"""Volume below which a tetrahedron has no inside, relative to the cube of its size."""


@kernel("v3(ws, i8)")
def corner(ws: Workspace, i: int) -> Vector:
    """Corner ``i`` of the simplex [m]."""
    first = ws.problem.simplex.start + 3 * i
    return ws.floats[first], ws.floats[first + 1], ws.floats[first + 2]


@kernel("v3(ws, i8)")
def first_point(ws: Workspace, i: int) -> Vector:
    """Point of the first part that belongs to corner ``i`` of the simplex [m]."""
    first = ws.problem.simplex.start + FIRST_POINTS + 3 * i
    return ws.floats[first], ws.floats[first + 1], ws.floats[first + 2]


@kernel("void(ws, i8, v3, v3)")
def put_corner(ws: Workspace, i: int, point: Vector, of_first: Vector) -> None:
    """Make ``point`` [m] corner ``i`` of the simplex. ``of_first`` [m] is its point of the first part."""
    first = ws.problem.simplex.start + 3 * i
    ws.floats[first], ws.floats[first + 1], ws.floats[first + 2] = point
    first += FIRST_POINTS
    ws.floats[first], ws.floats[first + 1], ws.floats[first + 2] = of_first


@kernel()
def _clear_weights(ws: Workspace) -> None:
    """Set all weights to zero."""
    for i in range(CORNERS):
        ws.problem.simplex[WEIGHTS + i] = 0.0


@kernel("f8(ws, i8, i8, f8)")
def _try_edge(ws: Workspace, i: int, j: int, best: float) -> float:
    """Squared distance of the edge from corner ``i`` to ``j`` to the origin [m^2], or ``best`` if that is less.

    If the edge is nearer, the weights of its corners in its nearest point are written.
    """
    a, b = corner(ws, i), corner(ws, j)
    edge = minus(b, a)
    square = dot(edge, edge)
    # fraction of the edge at its nearest point; two equal corners are a point
    part = min(1.0, max(0.0, -dot(a, edge) / square)) if square > 0.0 else 0.0
    x, y, z = scaled(part, edge)
    point = a[0] + x, a[1] + y, a[2] + z
    found = dot(point, point)
    if found >= best:
        return best
    _clear_weights(ws)
    ws.problem.simplex[WEIGHTS + i], ws.problem.simplex[WEIGHTS + j] = 1.0 - part, part
    return float(found)


@kernel("f8(ws, i8, i8, i8, f8)")
def _try_face(ws: Workspace, i: int, j: int, m: int, best: float) -> float:
    """Squared distance of the triangle of corners ``i``, ``j``, ``m`` to the origin [m^2], or ``best`` if that is less.

    If the triangle is nearer, the weights of its corners in its nearest point are written.
    """
    a, b, c = corner(ws, i), corner(ws, j), corner(ws, m)
    u, v = minus(b, a), minus(c, a)
    normal = cross(u, v)
    square = dot(normal, normal)
    if square > _FLAT_TRIANGLE * dot(u, u) * dot(v, v):
        # the projection of the origin is within the triangle if all three partial areas are positive
        height = dot(normal, a) / square
        foot = scaled(height, normal)
        a, b, c = minus(a, foot), minus(b, foot), minus(c, foot)
        of_a, of_b, of_c = dot(normal, cross(b, c)), dot(normal, cross(c, a)), dot(normal, cross(a, b))
        if of_a >= 0.0 and of_b >= 0.0 and of_c >= 0.0:
            # the normal is not of unit length: the distance is its length times the height
            if height * height * square >= best:
                return best
            _clear_weights(ws)
            whole = of_a + of_b + of_c
            parts = ws.problem.simplex.start + WEIGHTS
            ws.floats[parts + i], ws.floats[parts + j], ws.floats[parts + m] = of_a / whole, of_b / whole, of_c / whole
            return float(height * height * square)
    # outside, or without area: the nearest point is on an edge
    best = _try_edge(ws, i, j, best)
    best = _try_edge(ws, j, m, best)
    return float(_try_edge(ws, m, i, best))


@kernel("f8(ws, i8, i8, i8, v3)")
def _volume(ws: Workspace, i: int, j: int, m: int, top: Vector) -> float:
    """Six times the signed volume of the tetrahedron with the base corners ``i``, ``j``, ``m`` and ``top`` [m^3]."""
    a = corner(ws, i)
    return dot(cross(minus(corner(ws, j), a), minus(corner(ws, m), a)), minus(top, a))


@kernel("f8(ws, f8)")
def _try_tetrahedron(ws: Workspace, size: float) -> float:
    """Squared distance of the tetrahedron to the origin [m^2], 0 if the origin is inside. Writes the weights.

    ``size`` [m] is its largest extent. Only the faces whose outside holds the origin are tested, but all faces of a
    flat one, which has no inside.
    """
    is_flat = abs(_volume(ws, 0, 1, 2, corner(ws, 3))) <= _FLAT_TETRAHEDRON * size * size * size
    best = math.inf
    for top in range(CORNERS):
        i, j, m = (top + 1) % CORNERS, (top + 2) % CORNERS, (top + 3) % CORNERS
        # origin and fourth corner are on different sides of the face
        is_outside = _volume(ws, i, j, m, (0.0, 0.0, 0.0)) * _volume(ws, i, j, m, corner(ws, top)) <= 0.0
        if is_flat or is_outside:
            best = _try_face(ws, i, j, m, best)
    # no face has the origin on its outside: it is inside
    return 0.0 if best == math.inf else best


@kernel("i8(ws, i8, f8)")
def reduce_to_nearest(ws: Workspace, n: int, size: float) -> int:
    """Reduce the ``n`` corners to those of the face, edge or corner nearest to the origin, and write their weights.

    Returns their number, or 0 if the origin is inside: the corners are then left as they are. ``size`` [m] is the
    largest extent of the simplex.
    """
    _clear_weights(ws)
    # where the weights begin
    parts = ws.problem.simplex.start + WEIGHTS
    if n == 1:
        ws.floats[parts] = 1.0
    elif n == 2:
        _try_edge(ws, 0, 1, math.inf)
    elif n == 3:
        _try_face(ws, 0, 1, 2, math.inf)
    elif _try_tetrahedron(ws, size) == 0.0:
        return 0
    # corners without weight are dropped, and the others move up
    n_kept = 0
    for i in range(n):
        if ws.floats[parts + i] > 0.0:
            put_corner(ws, n_kept, corner(ws, i), first_point(ws, i))
            ws.floats[parts + n_kept] = ws.floats[parts + i]
            n_kept += 1
    for i in range(n_kept, n):
        ws.floats[parts + i] = 0.0
    return n_kept


@kernel("v3(ws, i8)")
def nearest_point(ws: Workspace, n: int) -> Vector:
    """Point of the simplex of ``n`` corners that is nearest to the origin [m]: the weighted sum of its corners."""
    x, y, z = 0.0, 0.0, 0.0
    for i in range(n):
        a = corner(ws, i)
        part = ws.problem.simplex[WEIGHTS + i]
        x, y, z = x + part * a[0], y + part * a[1], z + part * a[2]
    return x, y, z


@kernel("b1(ws)")
def has_nearest_point(ws: Workspace) -> bool:
    """True if the simplex has a nearest point. It has none if the origin is inside, so that all weights are 0."""
    total = 0.0
    for i in range(CORNERS):
        total += ws.problem.simplex[WEIGHTS + i]
    return total > 0.0


@kernel("v3(ws)")
def nearest_of_first(ws: Workspace) -> Vector:
    """Point of the first part that belongs to the nearest point of the simplex [m]: the same weighted sum."""
    x, y, z = 0.0, 0.0, 0.0
    for i in range(CORNERS):
        part = ws.problem.simplex[WEIGHTS + i]
        if part > 0.0:
            a = first_point(ws, i)
            x, y, z = x + part * a[0], y + part * a[1], z + part * a[2]
    return x, y, z


@kernel("v3(ws)")
def nearest_of_second(ws: Workspace) -> Vector:
    """Point of the second part that belongs to the nearest point of the simplex [m]."""
    x, y, z = nearest_of_first(ws)
    for i in range(CORNERS):
        part = ws.problem.simplex[WEIGHTS + i]
        if part > 0.0:
            a = corner(ws, i)
            x, y, z = x + part * a[0], y + part * a[1], z + part * a[2]
    return x, y, z
