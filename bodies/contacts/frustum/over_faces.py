"""A rim, a foot or the apex of a frustum over a face of a surface, and a corner of a surface over a frustum.

The surface, of the second body, need not be convex.  The corner and its frustum are sharp.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import POSITION, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import AXIS, HIGH, LOW_RADIUS, SIDE
from ...shapes.frustum import SWEEP as FRUSTUM_SWEEP
from ...vectors import Vector3, dot, minus, norm, opposite, plus_scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN
from ..features.edge_vertex import Vertex, steepest
from ..features.ends import CLOSED, END, NEAR, OPEN, REACH, gap_at_distance, gap_past_end
from ..features.frames import across, point_in_body, point_in_world, vector_in_body, vector_in_world
from ..features.writing import write_contact, write_flat, write_round
from ..surface.overlap_corners import FLUSH
from ..surface.surface_ball import out_of_surface, write_feature
from ..surface.surface_search import (
    FAR,
    depth_inside,
    distance_from_ends,
    distance_from_triangle,
    nearest_in_patch,
    signed_distance,
)
from ..surface.surface_tables import (
    IS_CONVEX,
    N_FACES,
    N_PATCHES,
    ON_FACE,
    SIZE,
    STAR,
    SWEEP,
    Solid,
    corner_at,
    corner_row,
    face_height,
    feature_of,
    normal_of,
)
from ..surface.surface_tree import ANY_PATCH, next_leaf
from ..surface.surface_vertex import face_under, over_triangle
from .frustum import FLANK, HIGH_CAP, LOW_CAP, normal_of_part, over_part, part_number, rim_of
from .frustum_placed import Placed, from_axis, least_height, placed
from .frustum_writing import Spot, off_cone_of_rim, past_apex, past_of_rim, write_spot

_FLAT = 1e-12
"""Sine of the angle between the planes of rim and face below which the lowest point of the rim is round-off."""


@compiled
def frustum_in_surface(a: Floats, b: Floats, frustum: Floats) -> Placed:
    """Return the first body's frustum in the axes of the second body."""
    one = placed(a, frustum)
    return Placed(frustum, point_in_body(b, one.center), vector_in_body(b, one.axis))


class Lowest(NamedTuple):
    """The point of a rim that is farthest along a unit vector n, which points into the other body."""

    spot: Spot
    """The point on the rim; the offset is a unit vector across the axis."""
    point: Vector3
    """The point [m]."""
    radial: float
    """Component of n across the axis: the sine of the angle between n and the axis."""
    off_cone: float
    """Sine of the angle between n and the normal cone of the rim, negative inside of this cone."""


@compiled
def lowest_on_rim(frustum: Placed, rim: int, n: Vector3, otherwise: Vector3) -> Lowest:
    """Return the point of a rim, ``LOW_RIM`` or ``HIGH_RIM``, that is farthest along n.

    If n is along the axis within round-off, all points are equally far: the result is the one in the direction of the
    unit vector ``otherwise``, across the axis.
    """
    radius, height, _ = rim_of(frustum.numbers, rim)
    _, radial, outward = across(n, frustum.axis)
    spot = Spot(frustum, rim, otherwise if radial < _FLAT else outward, radius)
    point = plus_scaled(plus_scaled(frustum.center, height, frustum.axis), radius, spot.offset)
    return Lowest(spot, point, radial, off_cone_of_rim(spot, n))


@compiled
def past_faces(surface: Floats, frustum: Placed, depth: float, point: Vector3) -> float:
    """Return by how much the depth of a contact exceeds that of the least deep face, less a margin for round-off [m].

    If it is positive, the contact is not valid: through that face the bodies separate on a shorter way.  A face is as
    deep as the frustum is below its plane, or as the contact point is distant from it, if this is more: faces far away
    do not count.  ``depth`` [m] and ``point`` are those of the contact, a rim over a face or an edge that crosses the
    frustum; ``frustum`` and ``point`` are in the axes of the surface.
    """
    numbers, center, axis = frustum
    margin = REACH * (surface[SIZE] + depth)
    least_deep = depth + margin
    leaf = next_leaf(surface, 0, ANY_PATCH, point, least_deep * least_deep)
    while leaf.begin < leaf.end:
        for i in range(leaf.begin, leaf.end):
            kind, face, row = feature_of(surface, int(surface[i]))
            if kind != ON_FACE:
                continue
            deep = -least_height(numbers, face_height(surface, face, center), axis, normal_of(surface, face))
            if deep < least_deep:
                least_deep = min(least_deep, max(deep, distance_from_triangle(row, point)))
        leaf = next_leaf(surface, leaf.after, ANY_PATCH, point, least_deep * least_deep)
    return float(depth - least_deep - margin)


@compiled
def _is_real(surface: Floats, frustum: Placed, depth: float, point: Vector3) -> bool:
    """Return whether a rim's point at a depth below a face [m] is inside of the body, and no other face is less deep.

    Depths within the margin ``CLOSED`` are real without a search.  Outside of the body the point has a margin, too: it
    may be on a border of faces.
    """
    margin = CLOSED * surface[SIZE]
    if depth <= margin:
        return True
    if signed_distance(surface, point) > margin + FLUSH * depth:
        return False
    return past_faces(surface, frustum, depth, point) <= 0.0


@compiled
def _rim_over(surface: Floats, face: int, low: Lowest, reach: float) -> tuple[float, float]:
    """Return gap and distance past the border [m] of a rim over a face; the gap includes the sweeps of both bodies.

    The gap is measured at the point of the rim that is lowest over the face, in the axes of the surface.  A point past
    the border of the face, at the distance ``past``, has the gap hypot(height, past).  If no part of the face is within
    ``reach`` [m] of the point, both results are at least ``reach``, less the sweeps.

    The lowest point of a rim nearly parallel to the face moves far while the bodies hardly move.  Above the face the
    distance past the border is therefore reduced (:func:`bodies.contacts.frustum.frustum_writing.past_of_rim`).
    """
    frustum, point, size = low.spot.frustum, low.point, surface[SIZE]
    sweep = frustum.numbers[FRUSTUM_SWEEP] + surface[SWEEP]
    height, past_cone = face_height(surface, face, point), size * (low.off_cone - CONE_MARGIN)
    least_key, apart, past = reach * reach, reach, reach
    is_under, past_under = False, 0.0
    leaf = next_leaf(surface, 0, ANY_PATCH, point, least_key)
    while leaf.begin < leaf.end:
        for i in range(leaf.begin, leaf.end):
            kind, number, row = feature_of(surface, int(surface[i]))
            if kind != ON_FACE or number != face:
                continue
            past_triangle, past_border, past_part, square = over_triangle(row, height, past_cone, REACH * size, point)
            if past_triangle <= 0.0 and height < 0.0:
                is_under, past_under = True, past_border
            key = square + max(past_part, 0.0) * max(past_part, 0.0)
            if key < least_key:
                least_key, apart, past = key, math.sqrt(square), past_part
        leaf = next_leaf(surface, leaf.after, ANY_PATCH, point, least_key)
    if is_under and _is_real(surface, frustum, -height, point):
        return height - sweep, past_under
    if past <= 0.0:
        return height - sweep, past
    if height > sweep:
        past = past_of_rim(past, low.spot.away, low.radial)
    is_convex = surface[IS_CONVEX] == 1.0
    return gap_past_end((height if height >= 0.0 or is_convex else apart) - sweep, past, is_convex), past


@compiled
def write_rim(a: Floats, out: Floats, frustum: Floats, rim: int, solid: Solid, face: int, reach: float) -> None:
    """Write the geometry block of a rim of the first body, at its lowest point, over a face of the second body.

    ``rim`` is 1 for the lower rim, 3 for the upper one.  The contact is evaluated up to the distance ``reach`` of the
    rim from the face [m].
    """
    b, surface = solid
    one, two, n = placed(a, frustum), frustum_in_surface(a, b, frustum), opposite(normal_of(surface, face))
    # the frustum's first axis, perpendicular to its own
    otherwise = vector_in_world(a, (frustum[AXIS - 2], frustum[AXIS + 1], frustum[AXIS + 4]))
    low = lowest_on_rim(two, rim, n, vector_in_body(b, otherwise))
    # any point of the rim may become the lowest one
    gap, past = _rim_over(surface, face, low, reach + 2.0 * low.spot.away)
    n = vector_in_world(b, n)
    low = lowest_on_rim(one, rim, n, otherwise)
    point = plus_scaled(low.point, frustum[FRUSTUM_SWEEP], n)
    write_contact(a, out, gap, past, float(face), n, point, False)
    write_spot(out, SIDE_A, low.spot, n)
    write_flat(out, SIDE_B)


@compiled
def write_tip(a: Floats, out: Floats, frustum: Floats, tip: Vertex, solid: Solid, patch: float, reach: float) -> None:
    """Write the geometry block of a foot or a sharp apex of the first body, the ``tip``, over a patch of the second.

    Faces are searched up to the distance ``reach`` of the cores [m].
    """
    b, surface = solid
    face, gap, past = face_under(solid, a, patch, tip, reach, False)
    n, place = vector_in_world(b, opposite(normal_of(surface, face))), point_in_world(a, tip.place)
    radius = frustum[FRUSTUM_SWEEP]
    sweep = radius + surface[SWEEP]
    height = face_height(surface, face, point_in_body(b, place)) - sweep
    gap = gap_at_distance(gap, past, sweep)
    if past > 0.0 and height < 0.0 and surface[IS_CONVEX] == 1.0:
        # the depth of a spring at which another contact takes over
        gap = height
    write_contact(a, out, gap, past, float(face), n, plus_scaled(place, radius, n), False)
    write_round(out, SIDE_A, radius)
    write_flat(out, SIDE_B)


@compiled
def write_apex(a: Floats, out: Floats, frustum: Floats, solid: Solid, patch: float, size: float, reach: float) -> None:
    """Write the geometry block of the apex of a cone and the nearest face or edge of one patch of the second body.

    One of the two bodies is rounded.  A corner of the surface has a contact of its own.  ``size`` is the size of the
    bodies [m], ``reach`` the distance of the cores up to which features are searched [m].
    """
    surface, one = solid.surface, placed(a, frustum)
    apex = plus_scaled(one.center, frustum[HIGH], one.axis)
    place = point_in_body(solid.frame, apex)
    # a segment has no face that could stand for features out of reach
    found = nearest_in_patch(surface, patch, place, reach if surface[N_FACES] > 0.0 else FAR)
    # one patch is the whole surface, which has no end
    past = found.past if surface[N_PATCHES] > 1.0 else 0.0
    n = opposite(out_of_surface(solid, found, past, place))
    radius = frustum[FRUSTUM_SWEEP]
    gap = found.distance - radius - surface[SWEEP]
    side_nearer = past_apex(frustum, found.distance, dot(n, one.axis), size)
    # the sphere of the apex is a part of the cone, so that a large gap is valid as a bound of the bodies' gap
    past = max(past, min(side_nearer, -END * size) if gap > NEAR * size else side_nearer)
    # a corner has a contact of its own
    shared = END * size - distance_from_ends(surface, found)
    past = max(past, shared)
    if shared > 0.0:
        # a large gap for a small distance past the end: the contact is open
        gap = math.hypot(max(gap, 0.0), max(past, OPEN * shared))
    else:
        gap = gap_past_end(gap, past, surface[IS_CONVEX] == 1.0)
    write_contact(a, out, gap, past, 0.0, n, plus_scaled(apex, radius, n), False)
    write_round(out, SIDE_A, radius)
    write_feature(out, SIDE_B, solid, found.kind, found.number)


@compiled
def _tip_past_rim(b: Floats, vertex: Vertex, lengths: Floats, disc: Placed, n: Vector3, depth: float) -> float:
    """Return a length [m] that is negative if a vertex behind a disc went through the disc.

    Each edge that crosses the disc's plane in its half next to the vertex does so at a distance from the disc's centre.
    The result is the least of these distances, minus the disc's radius, plus ``depth``; it is infinite if no edge
    crosses the plane.  A negative result means that an edge crosses the disc inside of the rim by more than ``depth``:
    the disc leaves the vertex on a shorter way along its axis.  Otherwise it leaves the edges on the side of its rim.

    The ``vertex`` of body ``b`` has edges of the ``lengths`` [m].  ``depth`` > 0 is its distance from the disc's plane
    [m] in the direction -n, with the unit normal n of the disc in the world.
    """
    p = minus(point_in_world(b, vertex.place), disc.center)
    least = math.inf
    for i in range(int(vertex.n_star)):
        edge = vector_in_world(b, vector_at(vertex.star, 3 * i))
        rise = dot(n, edge)
        # ignore edges that do not lead back, or that cross the plane only in their far half, next to another vertex
        if rise * lengths[i] <= 2.0 * depth:
            continue
        crossing = plus_scaled(p, depth / rise, edge)
        least = min(least, norm(crossing) - disc.numbers[LOW_RADIUS])
    return least + depth


@compiled
def write_corner(
    a: Floats, out: Floats, frustum: Floats, solid: Solid, corner: int, lengths: Floats, size: float
) -> None:
    """Write the geometry block of a corner of the second body and the nearest part of the first, cap or side.

    A cap or the side touches the corner only if no edge of the corner leads below the cap's plane or the side's tangent
    plane; otherwise the edge touches it first.  The nearest part has the least sum of two squares, of the corner's
    height over the part and of its distance past the part's border.

    ``corner`` is the number of the corner.  For a disc, ``lengths`` are those of the edges of all corners, one corner
    after the other [m].  ``size`` is the size of the larger body [m].
    """
    b, surface = solid
    vertex, one = corner_at(surface, corner), placed(a, frustum)
    axis, point = one.axis, point_in_world(b, vertex.place)
    along, away, outward = from_axis(one, point)
    is_disc, margin, highest = frustum[SIDE] == 0.0, REACH * size, -math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        highest = max(highest, over_part(frustum, part, along, away)[0])
    least_key, nearest, gap, past = math.inf, LOW_CAP, 0.0, math.inf
    for part in (LOW_CAP, FLANK, HIGH_CAP):
        height, past_border, radial, axial = over_part(frustum, part, along, away)
        n = normal_of_part(axis, outward, radial, axial)
        if height < 0.0 and not is_disc:
            # a corner below a cap's plane or the side's cone touches it only if the corner is inside of the frustum
            past_border = max(past_border, highest)
        steepness = steepest(vertex, vector_in_body(b, opposite(n)))
        past_border = max(past_border - margin, size * (steepness - CONE_MARGIN))
        if is_disc and height < -CLOSED * size and past_border <= 0.0:
            # a corner behind a disc touches it only if its edges go through the disc, or if the corner's body encloses
            # the point of the disc nearest to the corner
            own_lengths = block_at(lengths, int(corner_row(surface, corner)[STAR]) // 3)
            past_rim = _tip_past_rim(b, vertex, own_lengths, one, n, -height)
            foot = vector_in_body(b, minus(plus_scaled(point, -height, n), vector_at(b, POSITION)))
            if past_rim > 0.0 and depth_inside(surface, foot) == 0.0:
                past_border = min(-height, past_rim)
        key = height * height + max(past_border, 0.0) * max(past_border, 0.0)
        if key < least_key:
            least_key, nearest, gap, past = key, part, height, past_border
    gap = gap_past_end(gap, past, surface[IS_CONVEX] == 1.0)
    _, _, radial, axial = over_part(frustum, nearest, along, away)
    normal = normal_of_part(axis, outward, radial, axial)
    write_contact(a, out, gap, past, part_number(frustum, nearest), normal, point, True)
    write_spot(out, SIDE_A, Spot(one, nearest, outward, max(away - gap * radial, 0.0)), normal)
    write_round(out, SIDE_B, 0.0)
