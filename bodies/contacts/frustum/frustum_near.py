"""Tests whether a face, edge or corner of a surface is near a cylinder, cone or disc, and may soon touch it."""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import HIGH_RADIUS, LOW, LOW_RADIUS, SIDE, SIN
from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.edge_row import ALONG, INTO_FIRST, INTO_SECOND, LENGTH
from ..features.ends import CLOSED
from ..features.vertex import steepest
from ..surface.surface_search import distance_from_triangle
from ..surface.surface_tables import FACE_NUMBER, SWEEP, corner_at, normal_of
from .frustum import (
    FLANK,
    HIGH_CAP,
    LOW_CAP,
    Placed,
    from_axis,
    nearest_part,
    normal_of_part,
    off_cone_of_rim,
    over_part,
)
from .over_faces import lowest_on_rim

_HALVINGS = 40
"""Largest number of halvings of an edge: the rest is shorter than round-off of its length."""
_PIECES = 16
"""Largest number of pieces of an edge, each of which is compared with a rim."""
_SHARP = 1e-3
"""Margin for round-off of angles [rad], and length of the sum of two unit normals below which it has no direction."""


class Search(NamedTuple):
    """A search for features of a surface that may soon touch a frustum, in the axes of the surface."""

    surface: Floats
    """The surface (:mod:`bodies.contacts.surface.surface_tables`)."""
    frustum: Placed
    """The frustum."""
    reach: float
    """Distance from the frustum's core up to which features are near [m]."""
    turn: float
    """Largest relative rotation of the bodies until the next search [rad]."""
    size: float
    """Size of the bodies [m]."""


class _Segment(NamedTuple):
    """An edge: its start [m], unit vector and length [m]."""

    start: Vector3
    along: Vector3
    length: float


@compiled
def _from_rim(frustum: Placed, upper: int, point: Vector3) -> float:
    """Return the distance of a point from a rim of the core [m]; ``upper`` is 1 for the upper rim, 0 for the lower."""
    along, away, _ = from_axis(frustum, point)
    return math.hypot(along - frustum.numbers[LOW + upper], away - frustum.numbers[LOW_RADIUS + upper])


@compiled
def _swing(radial: float, turn: float) -> float:
    """Return a bound of the displacement of a rim's lowest point, relative to the rim's radius, if the normal turns.

    The normal has the component ``radial`` across the rim's axis and turns by at most ``turn`` [rad].  So its radial
    direction turns by at most asin(turn / radial) <= pi turn / (2 radial).  The bound is at most 2, a diameter.
    """
    return 2.0 if turn >= radial else min(2.0, 0.5 * math.pi * turn / radial)


@compiled
def _lowest(frustum: Placed, upper: int, n: Vector3) -> tuple[Vector3, float, float]:
    """Return a rim's farthest point along n [m], the radial component of n, and a sine.

    n points into the surface, so that this is the rim's lowest point over it.  The sine is that of the angle between n
    and the normal cone of the rim, negative inside this cone.  ``upper`` is 1 for the upper rim, 0 for the lower.
    """
    numbers, center, axis = frustum
    # for an axis along n all points of the rim are lowest: take a point within a diameter, the bound of :func:`_swing`
    axial, radial, outward = lowest_on_rim(n, axis, (1.0, 0.0, 0.0))
    off_cone = off_cone_of_rim(numbers, 2.0 * upper - 1.0, radial, axial)
    lowest = plus_scaled(plus_scaled(center, numbers[LOW + upper], axis), numbers[LOW_RADIUS + upper], outward)
    return lowest, radial, off_cone


@compiled
def rim_is_near(search: Search, row: Floats, upper: int) -> bool:
    """Return whether a rim may touch a triangle, at its point that is lowest over it, before the next search.

    ``row`` is the row of the triangle; ``upper`` is 1 for the upper rim, 0 for the lower.
    """
    surface, frustum, reach, turn, _ = search
    n = opposite(normal_of(surface, int(row[FACE_NUMBER])))
    lowest, radial, off_cone = _lowest(frustum, upper, n)
    if off_cone > CONE_MARGIN + turn:
        return False
    # a cheap test first: the whole rim and a ball about the triangle
    p, q, r = vector_at(row, 0), vector_at(row, 3), vector_at(row, 6)
    middle = divided(plus(plus(p, q), r), 3.0)
    radius = max(norm(minus(p, middle)), norm(minus(q, middle)), norm(minus(r, middle)))
    if _from_rim(frustum, upper, middle) > reach + radius:
        return False
    most = reach + frustum.numbers[LOW_RADIUS + upper] * _swing(radial, turn)
    return distance_from_triangle(row, lowest) <= most


@compiled
def _edge_comes_near(frustum: Placed, edge: _Segment, reach: float) -> bool:
    """Return whether a point of an edge is within the signed distance ``reach`` [m] of the core.

    A negative ``reach`` is a depth inside the core.  The distance from a convex body is a convex function along a line,
    so that halvings find its minimum.
    """
    low, high = 0.0, edge.length
    for _ in range(_HALVINGS):
        s, half = 0.5 * (low + high), 0.5 * (high - low)
        along, away, outward = from_axis(frustum, plus_scaled(edge.start, s, edge.along))
        distance, radial, axial, _ = nearest_part(frustum.numbers, along, away)
        if distance <= reach:
            return True
        # the distance changes by at most the length of half of the interval
        if distance - half > reach:
            return False
        if radial * dot(outward, edge.along) + axial * dot(frustum.axis, edge.along) > 0.0:
            high = s
        else:
            low = s
    return True


@compiled
def _edge_normal(edge: Floats) -> tuple[Vector3, float]:
    """Return the inward unit vector opposite to the mean normal of an edge's faces, and half of their angle [rad].

    ``edge`` is the row of the edge.  If the outward normals of both faces are nearly opposite, they have no
    mean: the result is the first face's inward normal, and pi, which allows all normals.
    """
    along = vector_at(edge, ALONG)
    left = cross(along, vector_at(edge, INTO_FIRST))
    right = cross(vector_at(edge, INTO_SECOND), along)
    n = plus(left, right)
    length = norm(n)
    if length <= _SHARP:
        return opposite(left), math.pi
    return divided(opposite(n), length), math.acos(min(0.5 * length, 1.0))


@compiled
def _rim_crosses(search: Search, upper: int, normal: Vector3, most_angle: float, edge: _Segment) -> bool:
    """Return whether an edge may touch a rim at the rim's farthest point along a normal near ``normal``.

    All normals within ``most_angle`` [rad] of ``normal`` are considered.  ``upper`` is 1 for the upper rim, 0 for the
    lower one.
    """
    frustum, reach, (start, along, length) = search.frustum, search.reach, edge
    lowest, radial, off_cone = _lowest(frustum, upper, normal)
    if off_cone > most_angle:
        return False
    # the edge must be near the lowest point, which moves round the rim as the normal turns
    radius = frustum.numbers[LOW_RADIUS + upper]
    most = reach + radius * _swing(radial, most_angle)
    s = min(max(dot(minus(lowest, start), along), 0.0), length)
    apart = minus(plus_scaled(start, s, along), lowest)
    if dot(apart, apart) > most * most:
        return False
    # and a piece of the edge must be near the rim: pieces of a quarter of the rim's radius, if these are not too many
    pieces = min(_PIECES, 1 + int(4.0 * length / radius))
    half = 0.5 * length / pieces
    for i in range(pieces):
        if _from_rim(frustum, upper, plus_scaled(start, (2 * i + 1) * half, along)) <= reach + half:
            return True
    return False


@compiled
def edge_is_near(search: Search, row: Floats) -> tuple[bool, bool, bool]:
    """Return whether an edge may touch the side, the lower rim and the upper rim before the next search.

    ``row`` is the row of the edge.  An edge that passes through the frustum may touch each
    part that the frustum has, at any angle between the normals, because the bodies overlap.
    """
    frustum = search.frustum
    numbers = frustum.numbers
    edge = _Segment(vector_at(row, 0), vector_at(row, ALONG), row[LENGTH])
    has_side = numbers[SIDE] > 0.0
    has_upper = has_side and numbers[HIGH_RADIUS] > 0.0
    if not _edge_comes_near(frustum, edge, search.reach):
        return False, False, False
    # a disc has no inside
    if _edge_comes_near(frustum, edge, -CLOSED * search.size if has_side else 0.0):
        return has_side, True, has_upper
    # an edge touches with the normals between those of its faces
    n, half = _edge_normal(row)
    most_angle = half + search.turn + _SHARP
    flank = has_side and abs(dot(n, frustum.axis) - numbers[SIN]) <= most_angle
    upper = has_upper and _rim_crosses(search, 1, n, most_angle, edge)
    return flank, _rim_crosses(search, 0, n, most_angle, edge), upper


@compiled
def corner_is_near(search: Search, corner: int) -> bool:
    """Return whether a corner may touch the frustum before the next search.

    If a body is rounded, a corner touches only if none of its edges leads towards the point of the frustum's core that
    is nearest to the corner.  The vector from the corner to this point changes by at most the displacement of the
    corner.  A sharp corner touches a cap or the side of a sharp frustum only if none of its edges leads into the
    frustum more steeply than ``CONE_MARGIN``.
    """
    surface, frustum, reach, turn, size = search
    numbers, _, axis = frustum
    vertex, sweep = corner_at(surface, corner), numbers[FRUSTUM_SWEEP] + surface[SWEEP]
    along, away, outward = from_axis(frustum, vertex.place)
    distance, radial, axial, _ = nearest_part(numbers, along, away)
    if distance > reach:
        return False
    if distance < -CLOSED * size:
        return True
    if sweep > 0.0:
        # the corner moves by at most the margin of the search
        inward, displacement = opposite(normal_of_part(axis, outward, radial, axial)), reach - sweep
        return bool(distance <= 0.0 or distance * steepest(vertex, inward) <= displacement + turn * distance)
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        height, past, radial, axial = over_part(numbers, part, along, away)
        most_angle = turn
        if part == FLANK:
            # as the corner moves by up to ``reach``, the side's normal turns round the axis: add a bound of the angle
            most_angle += 2.0 if reach >= away else 0.5 * math.pi * reach / away
        inward = opposite(normal_of_part(axis, outward, radial, axial))
        if abs(height) <= reach and past <= reach and steepest(vertex, inward) <= CONE_MARGIN + most_angle:
            return True
    return False
