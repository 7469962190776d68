"""Distance of two convex sets, with a plane that proves it, and their nearest points.

The differences of points of two convex sets form a convex set.  Its point nearest to the origin gives the distance.
The search for this point is that of E. Gilbert, D. Johnson and S. Keerthi, IEEE J. Robotics Automat. 4 (1988) 193.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.solid import Vector


@dataclass(frozen=True)
class Piece:
    """A convex set, known by its support points in Python: a reference for the compiled search.

    Attributes
    ----------
    support : callable
        Returns a point of the set farthest along a direction of any length [m], both of shape [3].
    place : Vector
        A point of the set [m], shape [3].
    """

    support: Callable[[Vector], Vector]
    place: Vector


def piece_of(shape: Shape, position: Vector, rotation: Vector) -> Piece:
    """Return the solid of a convex shape, with its frame at a place."""
    solid = shape.solid
    assert solid is not None
    return Piece(
        lambda n: np.asarray(position + rotation @ solid.support(n @ rotation)),
        position + rotation @ np.mean(solid.bounds, axis=0),
    )


_MOST = 200
Point = tuple[float, float, float]
"""A point or a vector; three floats are faster than an array here."""
_Nearest = tuple[float, Point, tuple[Point, ...]]
"""Squared distance of a simplex from the origin [m^2], the simplex's point nearest to the origin [m], and the corners
of the face, edge or corner that contains this point."""


@final
@dataclass(frozen=True)
class Nearest:
    """Nearest points of two convex sets, with a proved lower bound of their distance.

    Attributes
    ----------
    lower : float
        Lower bound of the distance [m]: two planes across the normal, with this distance between them, separate the
        sets. At most 0 if the sets overlap.
    normal : Vector
        Unit vector from the first to the second, shape [3].
    first, second : Vector
        Nearest point of each set [m], within the accuracy of the search, shape [3] each.
    """

    lower: float
    normal: Vector
    first: Vector
    second: Vector


def separation(one: Piece, two: Piece, way: Vector, margin: float, enough: float) -> tuple[float, Vector]:
    """Lower bound of the distance of two convex sets, minus ``margin`` [m], and a unit normal of planes that prove it.

    Parameters
    ----------
    one, two : Piece
        The sets, in the same axes.
    way : Vector
        Translation of the first set [m], shape [3].
    margin : float
        Distance that is subtracted [m].
    enough : float
        Allowed error of the bound [m]; an error of a thousandth of the bound is allowed in any case.

    Returns
    -------
    bound, normal
        The distance of the sets along the unit vector ``normal``, shape [3], is at least ``bound + margin``.
        If the sets overlap or nearly touch, the bound is at most -margin, and the normal has no meaning.
    """
    found = _search(one, two, way, margin, enough, 1e-3)
    return found.bound - margin, found.normal


def nearest(one: Piece, two: Piece, enough: float) -> Nearest:
    """Nearest points of two convex sets, and a lower bound of their distance.

    Parameters
    ----------
    one, two : Piece
        The sets, in the same axes.
    enough : float
        Allowed error of the lower bound of the distance [m].
    """
    found = _search(one, two, np.zeros(3), 0.0, enough, 0.0)
    if not found.corners:
        return Nearest(found.bound, found.normal, one.place, two.place)
    first, second = combined(np.array(found.point), found.corners, found.points)
    return Nearest(found.bound, found.normal, first, second)


def combined(point: Vector, corners: Sequence[Point], pairs: Iterable[tuple[Vector, Vector]]) -> Iterator[Vector]:
    """Yield the point of the first and of the second set [m], shape [3] each, whose difference is ``point``.

    ``point`` is a weighted mean of ``corners``.  The same weights give the points of the two sets.

    Parameters
    ----------
    point : Vector
        The point, shape [3], in the convex hull of the corners.
    corners : sequence of Point
        Differences of points of the two sets.
    pairs : iterable of tuple of Vector
        For each corner, the point of the first set and of the second set whose difference it is.
    """
    known = np.array(corners)
    # the last row makes the sum of the weights 1, in the scale of the other rows
    rows = np.vstack([known.T, np.full(len(known), np.max(np.abs(known), initial=1e-300))])
    shares = np.linalg.lstsq(rows, np.append(point, rows[3, 0]), rcond=None)[0]
    return (shares @ np.array(points) for points in zip(*pairs, strict=True))


@dataclass(frozen=True)
class _Found:
    """Result of a search for the distance of two sets, that is of their set of differences from the origin.

    Attributes
    ----------
    bound : float
        Lower bound of the distance [m].
    normal : Vector
        Unit vector normal to two planes that separate the sets by the bound.
    point : Point
        Point of the set of differences that is nearest to the origin [m].
    corners : tuple of Point
        Corners of the simplex that contains ``point``.
    points : list of tuple of Vector
        For each corner, the point of the first set and of the second set whose difference it is.
    """

    bound: float
    normal: Vector
    point: Point
    corners: tuple[Point, ...]
    points: list[tuple[Vector, Vector]]


def _search(one: Piece, two: Piece, way: Vector, margin: float, enough: float, part: float) -> _Found:
    nearest = as_point(two.place - one.place - way)
    simplex: tuple[Point, ...] = ()
    origins: dict[Point, tuple[Vector, Vector]] = {}
    best, normal = -math.inf, np.array([0.0, 0.0, 1.0])
    square, size = dot(nearest, nearest), 0.0

    def ended(bound: float) -> _Found:
        return _Found(bound, normal, nearest, simplex, [origins[corner] for corner in simplex])

    for _ in range(_MOST):
        distance = math.sqrt(square)
        if distance <= 1e-15 * size or distance == 0.0:
            break
        unit = np.array(nearest) / distance
        first, second = one.support(unit), two.support(-unit)
        found = as_point(second - first - way)
        bound = dot(as_point(unit), found)
        if bound > best:
            best, normal = bound, unit
        if simplex and (distance - best <= max(part * (best - margin), enough) or found in simplex):
            break
        size = max(size, math.hypot(*found))
        last = square
        origins[found] = first, second
        now, point, kept = _nearest((*simplex, found))
        if len(kept) == 4:
            return ended(min(best, 0.0))
        if simplex and now >= last:
            # no progress but round-off
            break
        square, nearest, simplex = now, point, kept
    return ended(best if best > -math.inf else 0.0)


def _nearest(simplex: tuple[Point, ...]) -> _Nearest:
    if len(simplex) == 1:
        return dot(simplex[0], simplex[0]), simplex[0], simplex
    if len(simplex) == 2:
        return _of_segment(*simplex)
    if len(simplex) == 3:
        return _of_triangle(*simplex)
    return _of_tetrahedron(*simplex)


def _of_segment(a: Point, b: Point) -> _Nearest:
    ab = minus(b, a)
    square = dot(ab, ab)
    part = -dot(a, ab) / square if square > 0.0 else 0.0
    if part <= 0.0:
        return dot(a, a), a, (a,)
    if part >= 1.0:
        return dot(b, b), b, (b,)
    point = a[0] + part * ab[0], a[1] + part * ab[1], a[2] + part * ab[2]
    return dot(point, point), point, (a, b)


def _of_triangle(a: Point, b: Point, c: Point) -> _Nearest:
    normal = _normal(a, b, c)
    square = dot(normal, normal)
    if square > 0.0:
        # the origin projects into the triangle if it is on the inner side of all three edges
        inside = dot(cross(a, b), normal) >= 0.0 and dot(cross(b, c), normal) >= 0.0 and dot(cross(c, a), normal) >= 0.0
        if inside:
            # the height from the corner nearest to the origin has the least round-off
            height = dot(min((a, b, c), key=lambda p: dot(p, p)), normal) / square
            point = height * normal[0], height * normal[1], height * normal[2]
            return dot(point, point), point, (a, b, c)
    return min(_of_segment(a, b), _of_segment(b, c), _of_segment(c, a))


def _normal(a: Point, b: Point, c: Point) -> Point:
    """Normal of a triangle, with twice its area as length, from its two shorter edges.

    In a thin triangle the two long edges are nearly parallel, so that round-off in their product would turn the normal.
    """
    edges = minus(b, a), minus(c, b), minus(a, c)
    longest = max(range(3), key=lambda i: dot(edges[i], edges[i]))
    return cross(edges[(longest + 1) % 3], edges[(longest + 2) % 3])


def _of_tetrahedron(a: Point, b: Point, c: Point, d: Point) -> _Nearest:
    volume = dot(cross(minus(b, a), minus(c, a)), minus(d, a))
    best: _Nearest | None = None
    outside = volume == 0.0
    for p, q, r, opposite in ((a, b, c, d), (a, c, d, b), (a, d, b, c), (b, d, c, a)):
        normal = _normal(p, q, r)
        if volume == 0.0 or dot(p, normal) * dot(minus(p, opposite), normal) < 0.0:
            outside = True
            here = _of_triangle(p, q, r)
            best = here if best is None else min(best, here)
    if best is None or not outside:
        return 0.0, (0.0, 0.0, 0.0), (a, b, c, d)
    return best


def as_point(vector: Vector) -> Point:
    """Three floats from an array."""
    x, y, z = vector.tolist()
    return x, y, z


def minus(one: Point, two: Point) -> Point:
    """Difference of two vectors."""
    return one[0] - two[0], one[1] - two[1], one[2] - two[2]


def dot(one: Point, two: Point) -> float:
    """Scalar product."""
    return one[0] * two[0] + one[1] * two[1] + one[2] * two[2]


def cross(one: Point, two: Point) -> Point:
    """Vector product."""
    return (
        one[1] * two[2] - one[2] * two[1],
        one[2] * two[0] - one[0] * two[2],
        one[0] * two[1] - one[1] * two[0],
    )
