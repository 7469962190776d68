"""Writes the geometry block of contacts in which a side or rim of a frustum crosses an edge or another frustum.

It also computes the distance of such a contact past the boundary of its features: the ends of an edge or of a side, and
the fan of normals of an edge or a rim.  An edge belongs to the second body: a sharp or rounded polyhedron, or a
capsule.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import COS, SIN, SWEEP, Frustum
from ...shapes.polyhedron import SweptPolytope
from ...vectors import Vector3, ahead, dot, minus, put, size_of, vector_at
from ..features.edge_crossing import ASTRAY, PARALLEL, edge_astray
from ..features.frames import across, point_in_world, vector_in_world, write_tangent
from ..features.polytope_tables import ALONG, START
from ..features.vertex_face import REACH
from ..features.writing import write_principal, write_sweep
from ..smooth.smooth_core import Axes, back, forth
from .frustum import (
    axis_in_world,
    center_in_world,
    middle_in_world,
    separation_by,
    separation_over_caps,
    separation_over_faces,
    write_part,
)

Point: TypeAlias = tuple[float, float, float]


@compiled
def past_border(over: float, astray: float, size: float) -> float:
    """Return the distance of a contact of two frustums past the boundary of its features [m]; negative if it is valid.

    ``over`` is the distance past the ends of both features [m].  ``astray`` is the sine of the angle between the
    contact normal and the fans of normals of the features.
    """
    return max(over - REACH * size, size * (astray - ASTRAY))


@compiled
def past_depth(a: Floats, first: Floats, b: Floats, second: Floats, gap: float, size: float) -> float:
    """Return a length [m] that is positive if two cores overlap less than by ``gap`` [m] along another direction.

    The directions are those of :func:`bodies.contacts.frustum.frustum.separation_by`.
    """
    if gap >= -REACH * size:
        return -size
    best = max(separation_by(a, first, b, second), separation_by(b, second, a, first))
    return float(best - gap - REACH * size)


@compiled
def past_disc(
    one: Floats,
    first: Floats,
    other: Floats,
    second: Floats,
    up: float,
    gap: float,
    p: Point,
    is_tip: bool,
    size: float,
) -> float:
    """Return the distance of a contact of a disc's face past its boundary [m]; negative if it is valid.

    The face is that of the disc ``second`` towards its axis if ``up`` is 1, else the other one.  ``p`` is the point of
    the frustum ``one`` that is lowest over the face, or the tip of a foot or cone (``is_tip``); ``gap`` is its height
    [m].  If p lies below the face, the line from p to the middle of the frustum must lead back through the disc, and
    the rim of the disc must lie below that line.  Discs in one plane touch with the faces of both sides; the engine
    takes those that met.
    """
    axis, own_axis = axis_in_world(other, second), axis_in_world(one, first)
    center, middle = center_in_world(other, second), middle_in_world(one, first)
    height, to_middle = up * dot(axis, minus(middle, center)), minus(middle, p)
    # the middle of a frustum is above its lowest point; the end of a frustum with a tip must face the disc
    if height < gap - REACH * size or (is_tip and up * dot(to_middle, own_axis) * dot(own_axis, axis) < 0.0):
        return size
    if gap >= -REACH * size:
        return -size
    # rounded bodies on the other side of the plane are apart
    if height <= REACH * size or first[SWEEP] + second[SWEEP] > 0.0:
        return size
    _, away, _ = across(minus(ahead(p, gap / (gap - height), to_middle), center), axis)
    # the rim of a disc that only touches the frustum lies below its surface by round-off
    return float(REACH * size - (second[0] - away) * (height - gap) / size_of(to_middle))


@compiled
def astray_of_rim(frustum: Floats, up: float, radial: float, axial: float, flat: bool) -> float:
    """Return the sine of the angle between a contact normal and the fan of normals of a rim; negative inside this fan.

    The contact normal points out of the frustum; ``radial`` and ``axial`` are its components away from the axis and
    along it.  The fan lies between the normals of side and cap.  ``up`` is 1 for the upper rim and -1 for the lower
    one; ``flat`` means a disc, which has no side.
    """
    if flat:
        return -radial
    return float(max(-radial, -up * (frustum[COS] * axial - frustum[SIN] * radial)))


@compiled
def write_two(
    a: Floats,
    out: Floats,
    swap: float,
    one: Floats,
    two: Floats,
    distance: float,
    past: float,
    normal: Vector3,
    p: Vector3,
) -> None:
    """Write the geometry block of two frustums, except the curvature matrices.

    ``distance`` is the distance of the cores [m] along ``normal``, from the point p on the core of ``one`` to the core
    of ``two``.  ``one`` is the first body, or the second if ``swap`` is 1.  ``past`` is the distance past the boundary
    of the features [m].  A contact with a positive ``past`` is not valid, so it gets a positive gap.
    """
    (nx, ny, nz), (px, py, pz) = normal, p
    sweep = one[SWEEP]
    gap = distance - sweep - two[SWEEP]
    if past > 0.0:
        gap = math.sqrt(gap * gap + past * past)
    px, py, pz = px + sweep * nx, py + sweep * ny, pz + sweep * nz
    sign = 1.0 - 2.0 * swap
    own, other = 7 + int(3.0 * swap), 10 - int(3.0 * swap)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    put(out, NORMAL, (sign * nx, sign * ny, sign * nz))
    put(out, own, (px, py, pz))
    put(out, other, (px + gap * nx, py + gap * ny, pz + gap * nz))
    write_tangent(a, out)


@compiled
def write_side(
    out: Floats, second: float, frustum: Floats, part: int, axis: Vector3, place: Vector3, normal: Vector3, away: float
) -> None:
    """Write the curvature matrices of a part of a frustum, the second body if ``second`` is 1, else the first.

    ``part`` is the number of the part, such as ``FLANK``.  ``place`` is a vector from the axis of the frustum towards
    the contact point, of any length.  ``normal`` is the outward normal there, ``away`` the distance of the point from
    the axis [m].
    """
    (ax, ay, az), (x, y, z), (nx, ny, nz) = axis, place, normal
    along = x * ax + y * ay + z * az
    x, y, z = x - along * ax, y - along * ay, z - along * az
    length = math.sqrt(x * x + y * y + z * z)
    radial = 0.0
    if length > 0.0:
        x, y, z = x / length, y / length, z / length
        radial = nx * x + ny * y + nz * z
    side = SIDE_B if second == 1.0 else SIDE_A
    write_part(out, side, part, axis, (x, y, z), radial, away)
    write_sweep(out, side, frustum[SWEEP])


def size_of_both(first: Frustum, second: SweptPolytope) -> float:
    """Return the size of the larger body [m]."""
    return max(second.core.size + 2.0 * second.sweep, 2.0 * first.extent)


@compiled
def edge_in_frustum(
    b: Floats, edge: Floats, axes: Axes, cx: float, cy: float, cz: float
) -> tuple[float, float, float, float, float, float]:
    """Return the start of an edge [m] and its unit vector, from the centre and in the axes of the frustum."""
    x, y, z = point_in_world(b, vector_at(edge, START))
    x, y, z = back(axes, (x - cx, y - cy, z - cz))
    dx, dy, dz = vector_in_world(b, vector_at(edge, ALONG))
    dx, dy, dz = back(axes, (dx, dy, dz))
    return x, y, z, dx, dy, dz


@compiled
def astray_of_edge(b: Floats, edge: Floats, axes: Axes, nx: float, ny: float, nz: float) -> float:
    """Return the sine of the angle between a contact normal and an edge's fan of normals; negative inside the fan.

    The contact normal (nx, ny, nz), in the axes of the frustum, points from the frustum to the edge.  The fan lies
    between the normals of the two faces of the edge.
    """
    nx, ny, nz = forth(axes, (nx, ny, nz))
    return float(edge_astray(b, edge, 0, -1.0, nx, ny, nz))


@compiled
def past_end(
    a: Floats,
    b: Floats,
    frustum: Floats,
    n_faces: float,
    faces: Floats,
    n_vertices: float,
    vertices: Floats,
    gap: float,
    over: float,
    sine: float,
    astray: float,
    size: float,
) -> float:
    """Return the distance of a crossing past the boundary of its two features [m]; negative if the crossing is valid.

    The features are an edge, and a rim or a side.  ``gap`` is the gap of the cores, ``over`` the distance past the ends
    of the edge and of the rim or side [m].  ``sine`` is the sine of the angle between the two features.  ``astray`` is
    the sine of the angle between the contact normal and the fans of normals of the features.  A crossing below zero is
    not valid if the cores overlap less along the normal of a cap of the frustum or of one of the ``faces`` of the core
    with the edge.  A core that need not be convex has no vertices here.
    """
    past = max(over - REACH * size, size * max(PARALLEL - sine, astray - ASTRAY))
    if past <= 0.0 and gap < -REACH * size and n_vertices > 0.0:
        best = separation_over_faces(a, b, frustum, n_faces, faces)
        best = max(best, separation_over_caps(a, b, frustum, n_vertices, vertices))
        past = max(past, best - gap - REACH * size)
    return past


@compiled
def write_crossing(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    axes: Axes,
    edge: Floats,
    radius: float,
    distance: float,
    past: float,
    sine: float,
    normal: Vector3,
    p: Vector3,
) -> None:
    """Write the geometry block of an edge that crosses a rim or a side, except the curvature matrices of the frustum.

    ``distance`` is the distance of the cores [m], ``past`` the distance past the boundary of edge and rim or side [m].
    p is the point on the core of the frustum in the world.  ``sine`` is the sine of the angle between both features.
    If it is small, the point of crossing moves 1 / sine times as fast as the bodies.  Past the boundary, the gap is
    therefore hypot(gap, sine * past): its rate stays of the order of the bodies' velocities.
    """
    (nx, ny, nz), (px, py, pz) = normal, p
    sweep = frustum[SWEEP]
    gap = distance - radius - sweep
    if past > 0.0:
        gap = math.hypot(gap, max(PARALLEL, sine) * past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    put(out, NORMAL, forth(axes, (nx, ny, nz)))
    put(out, POINT_A, (px + sweep * out[NORMAL], py + sweep * out[NORMAL + 1], pz + sweep * out[NORMAL + 2]))
    for i in range(3):
        out[POINT_B + i] = out[POINT_A + i] + gap * out[NORMAL + i]
    write_tangent(a, out)
    ex, ey, ez = vector_in_world(b, vector_at(edge, ALONG))
    write_principal(out, SIDE_B, ex, ey, ez, 0.0, 1.0, 1.0, radius)
