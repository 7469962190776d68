"""Tests whether a face, edge or corner of a surface is near a cylinder, cone or disc, and may soon touch it."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import LOW, SIDE, SIN, SWEEP
from ...vectors import Vector3, vector_at
from ..features.edge_crossing import ASTRAY
from ..features.frames import across, point_in_body, vector_in_body
from ..features.vertex_face import CLOSED
from ..frustum.frustum import FLANK, HIGH_CAP, LOW_CAP, axis_in_world, center_in_world, nearest_part
from ..frustum.frustum_writing import astray_of_rim
from ..surface.surface_search import in_triangle
from ..surface.surface_tables import CORNER, CORNERS, FACE, FACES
from .frustum_corner import over_part
from .surface_rim import lowest_on_rim
from .swept_pairs import steepest

FrustumPose: TypeAlias = tuple[float, float, float, float, float, float]
"""Centre [m] and axis of a frustum in the axes of a surface."""
_HALVINGS = 40
_PIECES = 16
"""Largest number of pieces of an edge, each of which is compared with a rim."""
_SHARP = 1e-3
"""Sine of the angle between two normals that is allowed for round-off."""


@compiled
def frustum_in_surface(a: Floats, b: Floats, frustum: Floats) -> FrustumPose:
    """Return centre [m] and axis of the first body's frustum in the axes of the second body."""
    ax, ay, az = axis_in_world(a, frustum)
    cx, cy, cz = center_in_world(a, frustum)
    ax, ay, az = vector_in_body(b, (ax, ay, az))
    cx, cy, cz = point_in_body(b, (cx, cy, cz))
    return cx, cy, cz, ax, ay, az


@compiled
def from_core(frustum: Floats, pose: FrustumPose, x: float, y: float, z: float) -> float:
    """Return the signed distance of the point (x, y, z) from the frustum [m], without its rounding."""
    cx, cy, cz, ax, ay, az = pose
    along, away, _ = across((x - cx, y - cy, z - cz), (ax, ay, az))
    return float(nearest_part(frustum, along, away)[0])


@compiled
def _from_rim(frustum: Floats, upper: int, pose: FrustumPose, x: float, y: float, z: float) -> float:
    """Return the distance of a point from the lower or the upper rim [m]."""
    cx, cy, cz, ax, ay, az = pose
    along, away, _ = across((x - cx, y - cy, z - cz), (ax, ay, az))
    return math.hypot(along - frustum[LOW + upper], away - frustum[upper])


@compiled
def _swing(radial: float, turn: float) -> float:
    """Return a bound of the displacement of a rim's lowest point, relative to the rim's radius, if the normal turns.

    The point is the lowest against a normal with the component ``radial`` across the rim's axis.  The normal turns by
    at most ``turn`` [rad].
    """
    return 2.0 if turn >= radial else min(2.0, 0.5 * math.pi * turn / radial)


@compiled
def _lowest(
    frustum: Floats, upper: int, pose: FrustumPose, nx: float, ny: float, nz: float
) -> tuple[float, float, float, float, float]:
    """Return a rim's farthest point along a normal [m], the normal's radial component, and a sine.

    The sine is that of the angle between the normal and the fan of normals of the rim, negative inside this fan.
    """
    cx, cy, cz, ax, ay, az = pose
    axial, radial, ex, ey, ez = lowest_on_rim(nx, ny, nz, ax, ay, az, 1.0, 0.0, 0.0)
    height, radius = frustum[LOW + upper], frustum[upper]
    astray = astray_of_rim(frustum, 2.0 * upper - 1.0, radial, axial, frustum[SIDE] == 0.0)
    x, y, z = cx + height * ax + radius * ex, cy + height * ay + radius * ey, cz + height * az + radius * ez
    return x, y, z, radial, astray


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
    t, f = triangle, int(surface[FACES]) + FACE * int(surface[triangle + 9])
    x, y, z, radial, astray = _lowest(frustum, upper, pose, -surface[f], -surface[f + 1], -surface[f + 2])
    if astray > ASTRAY + turn:
        return False
    px = (surface[t] + surface[t + 3] + surface[t + 6]) / 3.0
    py = (surface[t + 1] + surface[t + 4] + surface[t + 7]) / 3.0
    pz = (surface[t + 2] + surface[t + 5] + surface[t + 8]) / 3.0
    wide = 0.0
    for i in range(3):
        dx, dy, dz = surface[t + 3 * i] - px, surface[t + 3 * i + 1] - py, surface[t + 3 * i + 2] - pz
        wide = max(wide, math.sqrt(dx * dx + dy * dy + dz * dz))
    if _from_rim(frustum, upper, pose, px, py, pz) > reach + wide:
        return False
    px, py, pz, _ = in_triangle(surface, t, x, y, z)
    way = reach + frustum[upper] * _swing(radial, turn)
    return bool((x - px) * (x - px) + (y - py) * (y - py) + (z - pz) * (z - pz) <= way * way)


@compiled
def _edge_comes_near(
    frustum: Floats, pose: FrustumPose, start: Vector3, direction: Vector3, length: float, reach: float
) -> bool:
    """Return whether a point of an edge is within the signed distance ``reach`` [m] of the core.

    ``reach`` may be negative.  The distance from a convex body is a convex function along a line, so that halvings find
    its minimum.
    """
    (x, y, z), (dx, dy, dz) = start, direction
    cx, cy, cz, ax, ay, az = pose
    low, high = 0.0, length
    for _ in range(_HALVINGS):
        s, half = 0.5 * (low + high), 0.5 * (high - low)
        along, away, (ex, ey, ez) = across((x + s * dx - cx, y + s * dy - cy, z + s * dz - cz), (ax, ay, az))
        distance, radial, axial, _ = nearest_part(frustum, along, away)
        if distance <= reach:
            return True
        if distance - half > reach:
            return False
        slope = radial * (ex * dx + ey * dy + ez * dz) + axial * (ax * dx + ay * dy + az * dz)
        if slope > 0.0:
            high = s
        else:
            low = s
    return True


@compiled
def edge_normal(surface: Floats, edge: int) -> tuple[float, float, float, float]:
    """Return the unit vector opposite to the mean normal of an edge's two faces, and half of the angle between them."""
    dx, dy, dz = vector_at(surface, edge + 3)
    ux, uy, uz = vector_at(surface, edge + 7)
    vx, vy, vz = vector_at(surface, edge + 10)
    lx, ly, lz = dy * uz - dz * uy, dz * ux - dx * uz, dx * uy - dy * ux
    rx, ry, rz = vy * dz - vz * dy, vz * dx - vx * dz, vx * dy - vy * dx
    nx, ny, nz = lx + rx, ly + ry, lz + rz
    norm = math.sqrt(nx * nx + ny * ny + nz * nz)
    if norm <= _SHARP:
        return -lx, -ly, -lz, math.pi
    return -nx / norm, -ny / norm, -nz / norm, math.acos(min(0.5 * norm, 1.0))


@compiled
def edge_is_near(
    surface: Floats, edge: int, frustum: Floats, pose: FrustumPose, reach: float, turn: float, size: float
) -> tuple[bool, bool, bool]:
    """Return whether an edge may touch the side, the lower rim and the upper rim before the next search.

    The arguments are those of :func:`rim_is_near`; the row of the edge begins at index ``edge``.  An edge that passes
    through the frustum may touch each part that the frustum has, at any angle between the normals, because the bodies
    overlap.
    """
    e = edge
    x, y, z, dx, dy, dz, length = (
        surface[e],
        surface[e + 1],
        surface[e + 2],
        surface[e + 3],
        surface[e + 4],
        surface[e + 5],
        surface[e + 6],
    )
    has_upper = frustum[SIDE] > 0.0 and frustum[1] > 0.0
    if not _edge_comes_near(frustum, pose, (x, y, z), (dx, dy, dz), length, reach):
        return False, False, False
    deep = 0.0 if frustum[SIDE] == 0.0 else -CLOSED * size
    if _edge_comes_near(frustum, pose, (x, y, z), (dx, dy, dz), length, deep):
        return frustum[SIDE] > 0.0, True, has_upper
    nx, ny, nz, half = edge_normal(surface, e)
    off = half + turn + _SHARP
    axial = nx * pose[3] + ny * pose[4] + nz * pose[5]
    flank = frustum[SIDE] > 0.0 and abs(axial - frustum[SIN]) <= off
    lower = _rim_crosses(frustum, 0, pose, (nx, ny, nz), off, (x, y, z), (dx, dy, dz), length, reach)
    upper = has_upper and _rim_crosses(frustum, 1, pose, (nx, ny, nz), off, (x, y, z), (dx, dy, dz), length, reach)
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
    (nx, ny, nz), (x, y, z), (dx, dy, dz) = normal, start, along
    px, py, pz, radial, astray = _lowest(frustum, upper, pose, nx, ny, nz)
    if astray > off:
        return False
    way = reach + frustum[upper] * _swing(radial, off)
    s = min(max((px - x) * dx + (py - y) * dy + (pz - z) * dz, 0.0), length)
    px, py, pz = x + s * dx - px, y + s * dy - py, z + s * dz - pz
    if px * px + py * py + pz * pz > way * way:
        return False
    pieces = min(_PIECES, 1 + int(4.0 * length / frustum[upper]))
    half = 0.5 * length / pieces
    for i in range(pieces):
        s = (2 * i + 1) * half
        if _from_rim(frustum, upper, pose, x + s * dx, y + s * dy, z + s * dz) <= reach + half:
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
    cx, cy, cz, ax, ay, az = pose
    along, away, (ex, ey, ez) = across((surface[c] - cx, surface[c + 1] - cy, surface[c + 2] - cz), (ax, ay, az))
    distance, radial, axial, _ = nearest_part(frustum, along, away)
    if distance > reach:
        return False
    if distance < -CLOSED * size:
        return True
    if frustum[SWEEP] > 0.0:
        nx, ny, nz = radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az
        way = reach - frustum[SWEEP]
        return bool(distance <= 0.0 or distance * steepest(surface, c, -nx, -ny, -nz) <= way + turn * distance)
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        if (part == FLANK and frustum[SIDE] == 0.0) or (part == HIGH_CAP and frustum[1] == 0.0):
            continue
        height, beyond, radial, axial = over_part(frustum, part, along, away)
        slack = turn
        if part == FLANK:
            # as the corner moves by up to ``reach``, the side's normal turns round the axis: add a bound of the angle
            slack += 2.0 if reach >= away else 0.5 * math.pi * reach / away
        nx, ny, nz = radial * ex + axial * ax, radial * ey + axial * ay, radial * ez + axial * az
        if abs(height) <= reach and beyond <= reach and steepest(surface, c, -nx, -ny, -nz) <= ASTRAY + slack:
            return True
    return False
