"""Depth of the overlap of two convex sets, with a lower and an upper bound.

The differences of points of two convex sets form a convex set.  If the sets overlap, it contains the origin, and the
distance of the origin from its boundary is the depth.  A polytope within this set bounds the depth from below: its face
nearest to the origin is pushed out until it is on the boundary.  Every support plane bounds the depth from above
(G. van den Bergen, "Proximity queries and penetration depth computation on 3D game objects", Game Developers
Conference, 2001).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces.solid import Vector
from tests.solids.separation import Piece, Point, as_point, combined, cross, dot, minus

_CLOSE = 1e-3
"""Largest relative error of the computed depth."""
_ROUND_OFF = 1e-14
_MOST = 400
"""Largest number of steps of a search for the depth of an overlap. If the search ends at this number, the lower bound
of the depth that it returns is valid, but less tight."""

_Face = tuple[float, Point, int, int, int]
"""Face of a polytope: distance of its plane from the origin [m], outward normal, and the numbers of its three corners.

Seen from outside, the corners are counter-clockwise.
"""


@final
@dataclass(frozen=True)
class Penetration:
    """Shortest translation that separates two convex sets.

    Attributes
    ----------
    lower, upper : float
        Bounds of the translation's length [m]. No translation shorter than ``lower`` separates the sets. A translation
        along the normal by ``upper`` separates them.
    normal : Vector
        Unit vector of the translation of the second set, shape [3].
    first, second : Vector
        Point of each set that is deepest in the other set [m], shape [3] each.
    """

    lower: float
    upper: float
    normal: Vector
    first: Vector
    second: Vector


def penetration(one: Piece, two: Piece, tolerance: float) -> Penetration | None:
    """Shortest translation that separates two convex sets; None if they overlap by at most ``tolerance``.

    The bounds of its length differ by at most 1e-3 of the length.  For curved sets the search may end before this
    accuracy is reached; the bounds are valid in any case.

    Parameters
    ----------
    one, two : Piece
        The sets, in the same axes.
    tolerance : float
        Largest overlap that is treated as touching [m].
    """
    points: dict[Point, tuple[Vector, Vector]] = {}
    best: list[tuple[float, Point]] = []

    def farthest(direction: Vector) -> Vector:
        size = float(np.linalg.norm(direction))
        first, second = one.support(direction), two.support(-direction)
        found = first - second
        points[as_point(found)] = first, second
        best.append((float(direction @ found) / size, as_point(direction / size)))
        return found

    corners = _tetrahedron(farthest, tolerance)
    if not corners:
        return None
    lower, corner, unit = _expanded(corners, farthest, tolerance, _CLOSE)
    if lower == 0.0:
        return None
    upper, normal = min(best)
    # `corner` are the corners of the face nearest to the origin, and `lower` is the distance of this face. Each corner
    # is the difference of a point of the first set and a point of the second set. The weighted mean of the corners that
    # is the face's point nearest to the origin gives, with the same weights, one point of each set
    first, second = combined(lower * np.array(unit), corner, (points[point] for point in corner))
    return Penetration(min(lower, upper), upper, np.array(normal), first, second)


def _tetrahedron(farthest: Callable[[Vector], Vector], tolerance: float) -> list[Point]:
    """Corners of a tetrahedron with which the search for the depth starts; empty if the sets do not overlap.

    Each corner is the difference of a point of the first set and a point of the second set.  Seen from outside of the
    tetrahedron, the first three corners are counter-clockwise.
    """
    points: list[Vector] = []
    while len(points) < 4:
        best, most = np.zeros(3), 0.0
        for direction in _across(points):
            found = farthest(direction)
            height = float(direction @ found)
            if height <= tolerance:
                return []
            off = height - (float(direction @ points[0]) if points else 0.0)
            if not points or off > most:
                best, most = found, off
        if points and most <= _ROUND_OFF * float(np.linalg.norm(best)):
            # all differences of points of the two sets are in one plane, so the sets have no volume in common
            return []
        points.append(best)
    a, b, c, d = points
    if float(np.cross(b - a, c - a) @ (d - a)) > 0.0:
        b, c = c, b
    return [as_point(x) for x in (a, b, c, d)]


def _across(points: list[Vector]) -> Iterable[Vector]:
    """Unit vectors normal to the plane through three points, or to the line through two points, each with both signs.

    For fewer than two points, the vectors are those of the coordinate axes.
    """
    if len(points) == 3:
        normal = np.cross(points[1] - points[0], points[2] - points[0])
        ways = [normal / np.linalg.norm(normal)]
    elif len(points) == 2:
        along = (points[1] - points[0]) / np.linalg.norm(points[1] - points[0])
        first = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
        first /= np.linalg.norm(first)
        ways = [first, np.cross(along, first)]
    else:
        ways = list(np.eye(3))
    return [sign * way for way in ways for sign in (1.0, -1.0)]


def _expanded(
    corners: list[Point], farthest: Callable[[Vector], Vector], tolerance: float, exact: float
) -> tuple[float, list[Point], Point]:
    """Depth of an overlap [m], by a polytope that grows inside the set of differences (EPA).

    Returns the depth, and corners and normal of the polytope's face nearest to the origin.  A depth of at most
    ``tolerance`` [m] is returned as 0.  The relative error of the depth is at most ``exact``, unless the search reaches
    its largest number of steps.
    """
    points = list(corners)
    faces = [_face(points, *trio) for trio in ((0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2))]
    size = max(math.hypot(*point) for point in points)
    for _ in range(_MOST):
        height, normal, *_ = min(faces)
        found = as_point(farthest(np.array(normal)))
        reach = dot(normal, found)
        if reach <= tolerance:
            return 0.0, [], normal
        if reach - height <= max(exact * reach if height > tolerance else 0.0, _ROUND_OFF * size):
            break
        points.append(found)
        size = max(size, math.hypot(*found))
        faces = _pushed_out(points, faces, _ROUND_OFF * size)
    height, normal, *trio = min(faces)
    return (height if height > tolerance else 0.0), [points[i] for i in trio], normal


def _pushed_out(points: list[Point], faces: list[_Face], least: float) -> list[_Face]:
    """Add the last of ``points``, which is outside of a convex polytope, as a corner; return the faces of the new hull.

    A face of the polytope is replaced if the point is more than ``least`` [m] in front of it.
    """
    top = points[-1]
    kept: list[_Face] = []
    rims: set[tuple[int, int]] = set()
    for face in faces:
        if dot(face[1], top) - face[0] <= least:
            kept.append(face)
            continue
        _, _, i, j, k = face
        for edge in ((i, j), (j, k), (k, i)):
            if edge[::-1] in rims:
                rims.remove(edge[::-1])
            else:
                rims.add(edge)
    return kept + [_face(points, i, j, len(points) - 1) for i, j in rims]


def _face(points: list[Point], i: int, j: int, k: int) -> _Face:
    nx, ny, nz = normal = cross(minus(points[j], points[i]), minus(points[k], points[i]))
    size = math.sqrt(dot(normal, normal))
    if size == 0.0:
        return math.inf, (0.0, 0.0, 0.0), i, j, k
    normal = nx / size, ny / size, nz / size
    return dot(normal, points[i]), normal, i, j, k
