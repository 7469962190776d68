"""Proof of the depth of an overlap: a polytope of points of the difference of two parts that holds the origin.

It is the expanding polytope algorithm (G. van den Bergen, "Proximity queries and penetration depth computation on 3D
game objects", Game Developers Conference, 2001). The differences of points of both parts are a convex set, and the
depth is the distance from the origin to its boundary. The polytope is within this set, so its face nearest to the
origin bounds the depth from below. The support point along the normal of this face bounds it from above, and is the
next point of the polytope. So the search also finds the direction of least overlap among all.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.support import closest_difference
from nonsmooth.engine.memory.layout import MOST_FACES, MOST_POINTS
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, minus, opposite
from nonsmooth.engine.pairs.separation import ROUND_OFF, unit

_EXACT = 1e-6
"""Relative error of the depth at which the search ends."""
_FLAT = 1e-10
"""Thickness of the first tetrahedron, relative to the size of the pair, below which the difference has no inside."""


@kernel("v3(ws, i8)")
def _point(ws: Workspace, i: int) -> Vector:
    """Point ``i`` of the polytope [m]."""
    first = ws.problem.polytope.start + 3 * i
    return ws.floats[first], ws.floats[first + 1], ws.floats[first + 2]


@kernel("v3(ws, i8, i8, v3)")
def _put_support(ws: Workspace, number: int, i: int, direction: Vector) -> Vector:
    """Make the support point of the difference along a unit vector point ``i`` of the polytope, and return it [m].

    Its height is the depth along that direction. If it is less than the depth so far, the pair gets the direction.
    """
    pair, first = ws.pairs[number], ws.problem.polytope.start + 3 * i
    found = closest_difference(ws, number, opposite(direction))
    ws.floats[first], ws.floats[first + 1], ws.floats[first + 2] = found
    # the separation is along the opposite direction
    if -dot(direction, found) > pair.separation:
        pair.separation, pair.measured = -dot(direction, found), opposite(direction)
    return found


@kernel("void(ws, i8, i8, i8, i8)")
def _put_face(ws: Workspace, face: int, i: int, j: int, m: int) -> None:
    """Make the triangle of three points, counter-clockwise seen from outside, a face of the polytope."""
    a = _point(ws, i)
    normal = unit(cross(minus(_point(ws, j), a), minus(_point(ws, m), a)), (0.0, 0.0, 0.0))
    numbers, points = ws.problem.faces.start + 4 * face, 3 * face
    # a face without area is never the nearest
    ws.floats[numbers] = dot(normal, a) if dot(normal, normal) > 0.0 else math.inf
    ws.floats[numbers + 1], ws.floats[numbers + 2], ws.floats[numbers + 3] = normal
    ws.problem.face_points[points], ws.problem.face_points[points + 1], ws.problem.face_points[points + 2] = i, j, m


@kernel("void(ws, i8, i8)")
def _move_face(ws: Workspace, face: int, source: int) -> None:
    """Copy a face to the place ``face`` of the list."""
    for i in range(4):
        ws.problem.faces[4 * face + i] = ws.problem.faces[4 * source + i]
    for i in range(3):
        ws.problem.face_points[3 * face + i] = ws.problem.face_points[3 * source + i]


@kernel("f8(ws, i8, i8, v3, v3)")
def _put_farther(ws: Workspace, number: int, i: int, direction: Vector, base: Vector) -> float:
    """Make the farther one of the support points along a unit vector and its opposite point ``i`` of the polytope.

    Returns its distance from ``base`` along that vector [m].
    """
    behind = abs(dot(direction, minus(_put_support(ws, number, i, opposite(direction)), base)))
    ahead = abs(dot(direction, minus(_put_support(ws, number, i, direction), base)))
    if behind > ahead:
        _put_support(ws, number, i, opposite(direction))
    return max(ahead, behind)


@kernel("v3(v3)")
def _across(v: Vector) -> Vector:
    """A unit vector normal to ``v``."""
    x, y, z = abs(v[0]), abs(v[1]), abs(v[2])
    axis = (1.0, 0.0, 0.0) if x <= y and x <= z else (0.0, 1.0, 0.0) if y <= z else (0.0, 0.0, 1.0)
    return unit(cross(v, axis), axis)


@kernel("b1(ws, i8)")
def _put_tetrahedron(ws: Workspace, number: int) -> bool:
    """Make the polytope a tetrahedron. False if all differences of points are in one plane: they have no inside."""
    pair = ws.pairs[number]
    least = _FLAT * pair.size
    a = _put_support(ws, number, 0, opposite(pair.measured))
    along = pair.measured
    for i in range(1, 4):
        if _put_farther(ws, number, i, along, a) <= least:
            return False
        edge = minus(_point(ws, 1), a)
        if i == 1:
            along = _across(edge)
            # the difference may have no width along one of the two directions across the edge
            other = unit(cross(edge, along), along)
            if _put_farther(ws, number, 2, along, a) < _put_farther(ws, number, 3, other, a):
                along = other
        elif i == 2:
            along = unit(cross(edge, minus(_point(ws, 2), a)), along)
    b, c = minus(_point(ws, 1), a), minus(_point(ws, 2), a)
    # seen from outside, the first three points must be counter-clockwise
    is_turned = dot(cross(b, c), minus(_point(ws, 3), a)) > 0.0
    second, third = (2, 1) if is_turned else (1, 2)
    _put_face(ws, 0, 0, second, third)
    _put_face(ws, 1, 0, third, 3)
    _put_face(ws, 2, 0, 3, second)
    _put_face(ws, 3, second, 3, third)
    return True


@kernel("i8(ws, i8)")
def _nearest_face(ws: Workspace, n_faces: int) -> int:
    """Number of the face whose plane is nearest to the origin, or lowest if the origin is outside."""
    found = 0
    for face in range(1, n_faces):
        if ws.problem.faces[4 * face] < ws.problem.faces[4 * found]:
            found = face
    return found


@kernel("v3(ws, i8)")
def _normal(ws: Workspace, face: int) -> Vector:
    """Outward unit normal of a face."""
    first = ws.problem.faces.start + 4 * face
    return ws.floats[first + 1], ws.floats[first + 2], ws.floats[first + 3]


@kernel("i8(ws, i8, i8, i8)")
def _toggle_rim(ws: Workspace, n_rim: int, i: int, j: int) -> int:
    """Add the edge from point ``i`` to ``j`` to the rim, or remove its opposite. Returns the number of edges."""
    rim = ws.problem.rim
    for edge in range(n_rim):
        if rim[2 * edge] == j and rim[2 * edge + 1] == i:
            rim[2 * edge], rim[2 * edge + 1] = rim[2 * n_rim - 2], rim[2 * n_rim - 1]
            return n_rim - 1
    if n_rim == MOST_FACES:
        return n_rim
    rim[2 * n_rim], rim[2 * n_rim + 1] = i, j
    return n_rim + 1


@kernel("i8(ws, i8, i8, f8)")
def _push_out(ws: Workspace, top: int, n_faces: int, least: float) -> int:
    """Replace the faces that see point ``top`` by faces to that point. Returns the number of faces, 0 if too many.

    A face sees the point if it is more than ``least`` [m] in front of it.
    """
    point, n_kept, n_rim = _point(ws, top), 0, 0
    for face in range(n_faces):
        if dot(_normal(ws, face), point) - ws.problem.faces[4 * face] <= least:
            _move_face(ws, n_kept, face)
            n_kept += 1
            continue
        for i in range(3):
            start, end = ws.problem.face_points[3 * face + i], ws.problem.face_points[3 * face + (i + 1) % 3]
            n_rim = _toggle_rim(ws, n_rim, start, end)
    # round-off can spoil the surface
    if n_kept + n_rim > MOST_FACES or n_rim == 0:
        return 0
    for edge in range(n_rim):
        _put_face(ws, n_kept + edge, ws.problem.rim[2 * edge], ws.problem.rim[2 * edge + 1], top)
    return n_kept + n_rim


@kernel("f8(ws, i8)")
def proved_depth(ws: Workspace, number: int) -> float:
    """Lower bound of the least translation that separates the parts of pair ``number`` [m]; 0 if they may be apart.

    The pair gets the direction of least overlap and its separation, if they are better than those it has.
    """
    size = ws.pairs[number].size
    if not _put_tetrahedron(ws, number):
        return 0.0
    n_faces, depth = 4, 0.0
    for top in range(4, MOST_POINTS):
        nearest = _nearest_face(ws, n_faces)
        height, normal = ws.problem.faces[4 * nearest], _normal(ws, nearest)
        depth = max(depth, height)
        reach = dot(normal, _put_support(ws, number, top, normal))
        # the support plane shows that the parts are apart, or the nearest face is on the boundary
        if reach <= ROUND_OFF * size or reach - height <= max(_EXACT * height, ROUND_OFF * size):
            break
        n_faces = _push_out(ws, top, n_faces, ROUND_OFF * size)
        if n_faces == 0:
            break
    # round-off must not put the bound above the depth that was found
    return min(depth, max(0.0, -ws.pairs[number].separation))
