"""Tests whether a face, edge or corner of a surface is near a cylinder, cone or disc, and may soon touch it."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import LOW, SIDE, SIN, SWEEP
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.frames import across, point_in_body, vector_in_body
from ..features.polytope_tables import ALONG, INTO_FIRST, INTO_SECOND, LENGTH
from ..features.vertex_face import CLOSED
from ..frustum.frustum import FLANK, HIGH_CAP, LOW_CAP, axis_in_world, center_in_world, nearest_part
from ..frustum.frustum_polyhedron import has_part, normal_of_part, over_part
from ..frustum.frustum_writing import off_cone_of_rim
from ..surface.surface_search import in_triangle, steepest
from ..surface.surface_tables import CORNER, CORNERS, FACE, FACE_NUMBER, FACES
from .surface_rim import lowest_on_rim

FrustumPose: TypeAlias = tuple[Vector3, Vector3]
"""Centre [m] and axis of a frustum in the axes of a surface."""
_HALVINGS = 40
_PIECES = 16
"""Largest number of pieces of an edge, each of which is compared with a rim."""
_SHARP = 1e-3
"""Sine of the angle between two normals that is allowed for round-off."""


@compiled
def frustum_in_surface(a: Floats, b: Floats, frustum: Floats) -> FrustumPose:
    """Return centre [m] and axis of the first body's frustum in the axes of the second body."""
    return point_in_body(b, center_in_world(a, frustum)), vector_in_body(b, axis_in_world(a, frustum))


@compiled
def from_core(frustum: Floats, pose: FrustumPose, point: Vector3) -> float:
    """Return the signed distance of a point from the frustum [m], without its rounding."""
    along, away, _ = across(minus(point, pose[0]), pose[1])
    return float(nearest_part(frustum, along, away)[0])


@compiled
def _from_rim(frustum: Floats, upper: int, pose: FrustumPose, point: Vector3) -> float:
    """Return the distance of a point from the lower or the upper rim [m]."""
    along, away, _ = across(minus(point, pose[0]), pose[1])
    return math.hypot(along - frustum[LOW + upper], away - frustum[upper])


@compiled
def _swing(radial: float, turn: float) -> float:
    """Return a bound of the displacement of a rim's lowest point, relative to the rim's radius, if the normal turns.

    The point is the lowest against a normal with the component ``radial`` across the rim's axis.  The normal turns by
    at most ``turn`` [rad].
    """
    return 2.0 if turn >= radial else min(2.0, 0.5 * math.pi * turn / radial)


@compiled
def _lowest(frustum: Floats, upper: int, pose: FrustumPose, n: Vector3) -> tuple[Vector3, float, float]:
    """Return a rim's farthest point along n [m], the radial component of n, and a sine.

    n points into the surface, so that this is the rim's lowest point over it.  ``upper`` is 1 for the upper rim, 0 for
    the lower one.  The sine is that of the angle between n and the normal cone of the rim, negative inside this cone.
    """
    center, axis = pose
    axial, radial, outward = lowest_on_rim(n, axis, (1.0, 0.0, 0.0))
    off_cone = off_cone_of_rim(frustum, 2.0 * upper - 1.0, radial, axial, frustum[SIDE] == 0.0)
    return plus_scaled(plus_scaled(center, frustum[LOW + upper], axis), frustum[upper], outward), radial, off_cone


@compiled
def rim_is_near(
    surface: Floats, triangle: int, frustum: Floats, upper: int, pose: FrustumPose, reach: float, turn: float
) -> bool:
    """Return whether a rim may touch a triangle, at its point that is lowest over it, before the next search.

    Parameters
    ----------
    surface, triangle : Floats, int
        The surface, and the index at which the row of the triangle begins.
    frustum, upper, pose : Floats, int, tuple
        The frustum, 1 for its upper rim or 0 for the lower one, and its pose in the axes of the surface.
    reach, turn : float
        Distance from the frustum's core up to which features are near [m], and largest relative rotation of the bodies
        until the next search [rad].
    """
    t, n = triangle, opposite(vector_at(surface, int(surface[FACES]) + FACE * int(surface[triangle + FACE_NUMBER])))
    lowest, radial, off_cone = _lowest(frustum, upper, pose, n)
    if off_cone > CONE_MARGIN + turn:
        return False
    one, two, three = vector_at(surface, t), vector_at(surface, t + 3), vector_at(surface, t + 6)
    middle = divided(plus(plus(one, two), three), 3.0)
    wide = max(norm(minus(one, middle)), norm(minus(two, middle)), norm(minus(three, middle)))
    if _from_rim(frustum, upper, pose, middle) > reach + wide:
        return False
    x, y, z, _ = in_triangle(surface, t, lowest)
    off, way = minus(lowest, (x, y, z)), reach + frustum[upper] * _swing(radial, turn)
    return bool(dot(off, off) <= way * way)


@compiled
def _edge_comes_near(
    frustum: Floats, pose: FrustumPose, start: Vector3, direction: Vector3, length: float, reach: float
) -> bool:
    """Return whether a point of an edge is within the signed distance ``reach`` [m] of the core.

    ``reach`` may be negative.  The distance from a convex body is a convex function along a line, so that halvings find
    its minimum.
    """
    center, axis = pose
    low, high = 0.0, length
    for _ in range(_HALVINGS):
        s, half = 0.5 * (low + high), 0.5 * (high - low)
        along, away, outward = across(minus(plus_scaled(start, s, direction), center), axis)
        distance, radial, axial, _ = nearest_part(frustum, along, away)
        if distance <= reach:
            return True
        if distance - half > reach:
            return False
        if radial * dot(outward, direction) + axial * dot(axis, direction) > 0.0:
            high = s
        else:
            low = s
    return True


@compiled
def edge_normal(surface: Floats, edge: int) -> tuple[Vector3, float]:
    """Return the unit vector opposite to the mean normal of an edge's two faces, and half of the angle between them."""
    along = vector_at(surface, edge + ALONG)
    left = cross(along, vector_at(surface, edge + INTO_FIRST))
    right = cross(vector_at(surface, edge + INTO_SECOND), along)
    n = plus(left, right)
    length = norm(n)
    if length <= _SHARP:
        return opposite(left), math.pi
    return divided(opposite(n), length), math.acos(min(0.5 * length, 1.0))


@compiled
def edge_is_near(
    surface: Floats, edge: int, frustum: Floats, pose: FrustumPose, reach: float, turn: float, size: float
) -> tuple[bool, bool, bool]:
    """Return whether an edge may touch the side, the lower rim and the upper rim before the next search.

    The arguments are those of :func:`rim_is_near`; the row of the edge begins at index ``edge``.  An edge that passes
    through the frustum may touch each part that the frustum has, at any angle between the normals, because the bodies
    overlap.
    """
    start, along, length = vector_at(surface, edge), vector_at(surface, edge + ALONG), surface[edge + LENGTH]
    has_upper = frustum[SIDE] > 0.0 and frustum[1] > 0.0
    if not _edge_comes_near(frustum, pose, start, along, length, reach):
        return False, False, False
    deep = 0.0 if frustum[SIDE] == 0.0 else -CLOSED * size
    if _edge_comes_near(frustum, pose, start, along, length, deep):
        return frustum[SIDE] > 0.0, True, has_upper
    n, half = edge_normal(surface, edge)
    off = half + turn + _SHARP
    flank = frustum[SIDE] > 0.0 and abs(dot(n, pose[1]) - frustum[SIN]) <= off
    lower = _rim_crosses(frustum, 0, pose, n, off, start, along, length, reach)
    upper = has_upper and _rim_crosses(frustum, 1, pose, n, off, start, along, length, reach)
    return flank, lower, upper


@compiled
def _rim_crosses(
    frustum: Floats,
    upper: int,
    pose: FrustumPose,
    normal: Vector3,
    off: float,
    start: Vector3,
    along: Vector3,
    length: float,
    reach: float,
) -> bool:
    """Return whether an edge may touch a rim at the rim's farthest point along a normal near ``normal``.

    All normals within the angle ``off`` [rad] of ``normal`` are considered.  The edge is given by its start [m], its
    direction and its length [m].  ``reach`` is the distance from the core up to which features are near [m].
    """
    lowest, radial, off_cone = _lowest(frustum, upper, pose, normal)
    if off_cone > off:
        return False
    way = reach + frustum[upper] * _swing(radial, off)
    s = min(max(dot(minus(lowest, start), along), 0.0), length)
    apart = minus(plus_scaled(start, s, along), lowest)
    if dot(apart, apart) > way * way:
        return False
    pieces = min(_PIECES, 1 + int(4.0 * length / frustum[upper]))
    half = 0.5 * length / pieces
    for i in range(pieces):
        if _from_rim(frustum, upper, pose, plus_scaled(start, (2 * i + 1) * half, along)) <= reach + half:
            return True
    return False


@compiled
def corner_is_near(
    surface: Floats, corner: int, frustum: Floats, pose: FrustumPose, reach: float, turn: float, size: float
) -> bool:
    """Return whether a corner may touch the frustum before the next search; arguments as in :func:`rim_is_near`.

    A corner touches a rounded frustum only if none of its edges leads towards the point of the frustum's core that is
    nearest to the corner.  The vector from the corner to this point changes by at most the displacement of the corner.
    """
    c = int(surface[CORNERS]) + CORNER * corner
    center, axis = pose
    along, away, outward = across(minus(vector_at(surface, c), center), axis)
    distance, radial, axial, _ = nearest_part(frustum, along, away)
    if distance > reach:
        return False
    if distance < -CLOSED * size:
        return True
    if frustum[SWEEP] > 0.0:
        down, way = opposite(normal_of_part(axis, outward, radial, axial)), reach - frustum[SWEEP]
        return bool(distance <= 0.0 or distance * steepest(surface, c, down) <= way + turn * distance)
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if not has_part(frustum, part):
            continue
        height, beyond, radial, axial = over_part(frustum, part, along, away)
        slack = turn
        if part == FLANK:
            # as the corner moves by up to ``reach``, the side's normal turns round the axis: add a bound of the angle
            slack += 2.0 if reach >= away else 0.5 * math.pi * reach / away
        down = opposite(normal_of_part(axis, outward, radial, axial))
        if abs(height) <= reach and beyond <= reach and steepest(surface, c, down) <= CONE_MARGIN + slack:
            return True
    return False
