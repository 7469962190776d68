"""Caps, rims, side, apex and feet of a frustum: where a point lies, where contacts end, and their geometry blocks.

A frustum is the tuple of :func:`bodies.shapes.frustum.frustum_numbers`.  Its parts are numbered along the axis: lower
cap, lower rim, side, upper rim, upper cap.  The functions here use its core: callers add the rounding radius.
``frame`` is the frame block of a body.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.types import Floats, ReadFloats

from ...shapes.frustum import (
    AXIS,
    CENTER,
    COS,
    HIGH,
    HIGH_RADIUS,
    LOW,
    LOW_RADIUS,
    SIDE,
    SIN,
    SWEEP,
    Frustum,
    Point,
    frustum_numbers,
)
from ...vectors import Vector3, cross, dot, minus, norm, opposite, plus, plus_scaled, scaled, vector_at
from ..features.edge_crossing import CONE_MARGIN, PARALLEL
from ..features.ends import END, REACH, gap_past_end
from ..features.frames import across, point_in_world, vector_in_world
from ..features.writing import write_contact, write_flat, write_principal, write_round, write_sweep
from ..surface.surface_tables import Numbers

LOW_CAP, LOW_RIM, FLANK, HIGH_RIM, HIGH_CAP = 0, 1, 2, 3, 4
"""Part numbers of a frustum, in the direction of its axis: lower cap, lower rim, side, upper rim, upper cap."""
FLATTEST = 1e-9
"""Least sine of the angle between a rim and a face at which the rim has a lowest point over the face.

The speed of this point along the rim is inversely proportional to the sine.  A flatter rim rests on feet.
"""


def part_names(numbers: Sequence[float]) -> tuple[str, ...]:
    """Return the names of the parts that a frustum has, in the order of :func:`part_number`."""
    if numbers[SIDE] == 0.0:
        return "face -", "rim", "face +"
    if numbers[HIGH_RADIUS] == 0.0:
        return "base", "rim", "side", "apex"
    return "cap -", "rim -", "side", "rim +", "cap +"


@compiled
def part_number(frustum: Floats, part: int) -> float:
    """Return the index of a part in :func:`part_names`; the upper face of a disc, which has one rim, is 2, not 4."""
    return 2.0 if frustum[SIDE] == 0.0 and part == HIGH_CAP else float(part)


@compiled
def rim_of(frustum: ReadFloats, part: float) -> tuple[float, float, float]:
    """Return radius [m], height over the centre [m] and side, 1 or -1 for an upper or a lower one, of a rim or cap."""
    if part > FLANK:
        return frustum[HIGH_RADIUS], frustum[HIGH], 1.0
    return frustum[LOW_RADIUS], frustum[LOW], -1.0


class Placed(NamedTuple):
    """A frustum in the axes of the world or of a body: its numbers, its centre [m] and its unit axis."""

    numbers: Floats
    center: Vector3
    axis: Vector3


@compiled
def placed(frame: Floats, frustum: Floats) -> Placed:
    """Return a frustum in the world."""
    axis = vector_in_world(frame, (frustum[AXIS], frustum[AXIS + 3], frustum[AXIS + 6]))
    return Placed(frustum, point_in_world(frame, vector_at(frustum, CENTER)), axis)


@compiled
def from_axis(frustum: Placed, point: Vector3) -> tuple[float, float, Vector3]:
    """Return a point's coordinate along the axis from the centre, its distance from the axis [m], and its direction.

    The direction is the unit vector from the axis towards the point, across the axis.
    """
    return across(minus(point, frustum.center), frustum.axis)


@compiled
def along_side(frustum: ReadFloats, along: float, away: float) -> tuple[float, float]:
    """Return the height of a point over the side, continued past its rims, and its coordinate up the side [m].

    The height is positive outside; the coordinate is 0 at the lower rim.  ``along`` is the coordinate of the point
    along the axis from the centre, ``away`` its distance from the axis [m].
    """
    dr, dz = away - frustum[LOW_RADIUS], along - frustum[LOW]
    return frustum[COS] * dr + frustum[SIN] * dz, frustum[COS] * dz - frustum[SIN] * dr


@compiled
def over_part(frustum: ReadFloats, part: int, along: float, away: float) -> tuple[float, float, float, float]:
    """Return height of a point over a cap's plane or the side's cone, distance past its border [m], and the normal.

    The height is positive outside, the distance past the border is negative over the part.  The normal is given by two
    components: radial, away from the axis, and axial.  The point is given as for :func:`along_side`.  A part that the
    frustum does not have, the side of a disc or the upper cap of a cone, is infinitely far above the point.
    """
    if part == LOW_CAP:
        return frustum[LOW] - along, away - frustum[LOW_RADIUS], 0.0, -1.0
    if (frustum[SIDE] if part == FLANK else frustum[HIGH_RADIUS]) == 0.0:
        return -math.inf, math.inf, 0.0, 1.0
    if part == HIGH_CAP:
        return along - frustum[HIGH], away - frustum[HIGH_RADIUS], 0.0, 1.0
    height, up = along_side(frustum, along, away)
    return height, max(-up, up - frustum[SIDE]), frustum[COS], frustum[SIN]


@compiled
def nearest_part(frustum: ReadFloats, along: float, away: float) -> tuple[float, float, float, int]:
    """Return the part of a frustum nearest to a point: signed distance [m], outward normal there, and part.

    The distance is negative inside.  The arguments and the components of the normal are those of :func:`over_part`.  In
    the plane through the axis and the point, the frustum is a trapezium, whose sides and corners are the parts.
    """
    best, radial, axial, nearest = -math.inf, 0.0, 0.0, FLANK
    for part in (FLANK, HIGH_CAP, LOW_CAP):
        height, past, n_radial, n_axial = over_part(frustum, part, along, away)
        if height > 0.0 and past < 0.0:
            return height, n_radial, n_axial, part
        if height > best:
            best, radial, axial, nearest = height, n_radial, n_axial, part
    over_side, up_side = along_side(frustum, along, away)
    if best <= 0.0 and over_side <= 0.0:
        # inside, the largest, least negative height counts
        return best, radial, axial, nearest
    # a disc has one rim, the lower one
    part = LOW_RIM if up_side <= 0.0 or frustum[SIDE] == 0.0 else HIGH_RIM
    radius, height, _ = rim_of(frustum, part)
    dr, dz = away - radius, along - height
    distance = math.sqrt(dr * dr + dz * dz)
    return distance, dr / distance, dz / distance, part


@compiled
def from_core(frustum: Placed, point: Vector3) -> float:
    """Return the signed distance of a point from the frustum's core [m]; negative inside."""
    along, away, _ = from_axis(frustum, point)
    return float(nearest_part(frustum.numbers, along, away)[0])


@compiled
def normal_of_part(axis: Vector3, outward: Vector3, radial: float, axial: float) -> Vector3:
    """Return the normal with the components ``radial`` along the unit vector ``outward``, ``axial`` along the axis."""
    return plus(scaled(radial, outward), scaled(axial, axis))


@compiled
def past_of_rim(past: float, radius: float, sine: float) -> float:
    """Return a displacement [m] that bodies need before the lowest point of a rim is inside a face's border again.

    ``past`` is the distance of the point past the border [m]; if it is not positive, it is the result.  ``sine`` is the
    sine of the angle between the planes of rim and face, ``radius`` the radius of the rim [m].  If the bodies rotate by
    an angle, the point moves round the rim by up to this angle over the sine: far, while the bodies hardly move.

    Use this displacement for bodies that are apart.  If they touch, the contact ends at ``past`` itself.
    """
    # the least sine keeps the result positive past the border, also for a rim parallel to the face
    return past if past <= 0.0 or radius == 0.0 else max(sine, PARALLEL) * min(past, radius)


@compiled
def least_height(frustum: Floats, height: float, axis: Vector3, normal: Vector3) -> float:
    """Return the least height of a frustum over a plane [m], that of the lowest point of one of its rims.

    ``height`` is the height of the frustum's centre [m], ``axis`` its unit axis, ``normal`` the unit normal of the
    plane.  Axis and normal are in the same axes, those of the world or of a body.
    """
    # the root of 1 - cosine^2 would be wrong by up to 1e-8 for an axis along the normal
    cosine, sine = dot(axis, normal), norm(cross(axis, normal))
    low, high = cosine * frustum[LOW], cosine * frustum[HIGH]
    return float(height + min(low - sine * frustum[LOW_RADIUS], high - sine * frustum[HIGH_RADIUS]))


@compiled
def separation_along(first: Placed, second: Placed, n: Vector3) -> float:
    """Return the separation of two frustums along the unit vector ``n`` from the first to the second [m].

    It is the width of the gap between two planes with the normal n, each of which touches one frustum.  It is negative
    if the frustums overlap along n.
    """
    height = dot(n, minus(second.center, first.center))
    height = least_height(first.numbers, height, first.axis, opposite(n))
    return float(least_height(second.numbers, height, second.axis, n))


@compiled
def separation_by_second(first: Placed, second: Placed) -> float:
    """Return the largest separation of two frustums along normals of the second one's surface [m].

    It is a lower bound of their separation, which may be larger along another direction.  The normals are those of both
    caps, and that of the side where the side faces the first centre.  All directions lead from the first frustum to the
    second, so they point into the second one.
    """
    axis, numbers = second.axis, second.numbers
    _, _, radial = across(minus(second.center, first.center), axis)
    best = max(separation_along(first, second, axis), separation_along(first, second, opposite(axis)))
    best = max(best, separation_along(first, second, radial))
    # the radial direction is the normal of a cylinder's side, not of a cone's
    if numbers[SIN] != 0.0:
        best = max(
            best, separation_along(first, second, plus_scaled(scaled(numbers[COS], radial), -numbers[SIN], axis))
        )
    return float(best)


@compiled
def past_border(past_ends: float, off_cone: float, size: float) -> float:
    """Return the distance of a contact past the boundary of its features [m]; negative if it is valid.

    ``past_ends`` is the distance past the ends of both features [m].  ``off_cone`` is the sine of the angle between the
    contact normal and the normal cones of the features, negative inside of them.  Both have a margin, so that neither
    round-off nor a small rotation ends the contact.  ``size`` is the size of the bodies [m].
    """
    return max(past_ends - REACH * size, size * (off_cone - CONE_MARGIN))


@compiled
def past_depth(first: Placed, second: Placed, gap: float, size: float) -> float:
    """Return a length [m] that is positive if two cores overlap by less than -``gap`` along another direction.

    The contact is then not valid, because another one separates the bodies by a shorter translation.  The directions
    are those of :func:`bodies.contacts.frustum.frustum.separation_by_second` for either frustum.  ``gap`` is the gap of
    the cores [m].  If it is not negative, up to round-off, the result is negative.
    """
    if gap >= -REACH * size:
        return -size
    return float(max(separation_by_second(first, second), separation_by_second(second, first)) - gap - REACH * size)


@compiled
def past_apex(frustum: Floats, distance: float, axial: float, size: float) -> float:
    """Return the distance of the other body's nearest point past the apex [m], less the tolerance ``2 END size``.

    It is the coordinate of this point along a straight line on the cone's side, from the apex downwards.  If the result
    is positive, the side is nearer to the point than the apex.  The point lies at ``distance`` [m] from the apex;
    ``axial`` is the component, along the cone's axis, of the unit vector from the apex to the point.  ``size`` is the
    size of the bodies [m].
    """
    radial = math.sqrt(max(1.0 - axial * axial, 0.0))
    return float(max(distance * (frustum[SIN] * radial - frustum[COS] * axial), -size) - 2.0 * END * size)


class Spot(NamedTuple):
    """A contact point on the core of a frustum."""

    frustum: Placed
    """The frustum in the world."""
    part: int
    """Number of the part, such as ``FLANK``; an apex is a rim of radius 0."""
    offset: Vector3
    """Vector of any length from a point of the axis towards the contact point, in the world."""
    away: float
    """Distance of the point from the axis [m]."""


@compiled
def off_side(of_rim: Spot, n: Vector3) -> float:
    """Return the sine of the angle from the side's normal to a contact normal n at a rim; 1 for a disc without a side.

    The contact normal points out of the frustum.  The sine is positive towards the normal of the cap.
    """
    (numbers, _, axis), part, outward, _ = of_rim
    if numbers[SIDE] == 0.0:
        return 1.0
    sine = numbers[COS] * dot(n, axis) - numbers[SIN] * dot(n, outward)
    return sine if part == HIGH_RIM else -sine


@compiled
def off_cone_of_rim(of_rim: Spot, n: Vector3) -> float:
    """Return the sine of the angle between a contact normal n and the normal cone of a rim; negative inside this cone.

    The cone lies between the normals of side and cap, or of both caps of a disc.  ``of_rim.offset`` must be a unit
    vector across the axis.
    """
    return float(max(-dot(n, of_rim.offset), -off_side(of_rim, n)))


@compiled
def write_spot(out: Floats, side: int, spot: Spot, normal: Vector3) -> None:
    """Write the curvature matrices of a rounded frustum at a contact point, with its outward unit ``normal`` there.

    ``side`` is ``SIDE_A`` or ``SIDE_B``.  ``out`` must already hold the contact's normal and first tangent; the
    matrices are explained in :func:`bodies.contacts.features.writing.write_principal`.
    """
    (numbers, _, axis), part, offset, away = spot
    if part == LOW_CAP or part == HIGH_CAP:
        write_flat(out, side)
    elif part != FLANK and away == 0.0:
        write_round(out, side, 0.0)
    else:
        # if the point moves round the axis by an angle, the normal turns by this angle times its component along
        # ``outward``. A normal along the axis does not turn; the least value keeps the matrices regular
        _, _, outward = across(offset, axis)
        radial = dot(normal, outward)
        flank, slide = 1.0 if part == FLANK else 0.0, radial if abs(radial) > FLATTEST else FLATTEST
        write_principal(out, side, cross(axis, outward), slide, away, 1.0 - flank, flank)
    write_sweep(out, side, numbers[SWEEP])


@compiled
def write_pair(
    a: Floats, out: Floats, swap: float, gap: float, past: float, normal: Vector3, p: Vector3, own: Spot, other: Spot
) -> None:
    """Write the geometry block of two frustums, with the contact points ``own`` and ``other``; the feature is 0.

    ``gap`` is the distance of the cores [m] along the unit vector ``normal``, from the point p on the core of ``own``
    to the core of ``other``; vectors are in the world.  If ``swap`` is 1, ``own`` belongs to the second body, so that
    the contact normal is opposite to ``normal``.  ``past`` is the distance past the boundary of the features [m].
    """
    sweep, is_swapped = own.frustum.numbers[SWEEP], swap == 1.0
    gap = gap_past_end(gap - sweep - other.frustum.numbers[SWEEP], past, True)
    write_contact(a, out, gap, past, 0.0, scaled(1.0 - 2.0 * swap, normal), plus_scaled(p, sweep, normal), is_swapped)
    write_spot(out, SIDE_B if is_swapped else SIDE_A, own, normal)
    write_spot(out, SIDE_A if is_swapped else SIDE_B, other, opposite(normal))


_N_EDGES = 12
"""Number of unit vectors that represent edges of an apex (down the side of the cone) or of a foot (along the cap).

An apex or a foot is treated as a corner with these edges, evenly spaced around the axis.  A face can touch it only if
no edge points into the face steeper than :data:`bodies.contacts.features.edge_crossing.CONE_MARGIN`.  The steepest of
12 edges along a cap has at least cos(15 deg) = 0.966 of the largest sine over all directions.
"""


def set_back(first: Frustum) -> Numbers:
    """Return the numbers of a frustum whose rims are set back by the height of its feet, so that only feet protrude.

    The rims have their radii and centres for contacts with faces (:attr:`bodies.shapes.frustum.Frustum.standing_rims`).
    A rim that rolls from a face over the face's edge then keeps its height.
    """
    own = first.frustum
    center, axis = np.array(own[CENTER : CENTER + 3]), np.array(own[AXIS : AXIS + 7 : 3])
    # a disc has one rim, which is its lower and its upper one
    rims = first.standing_rims if len(first.standing_rims) > 1 else 2 * first.standing_rims
    heights = [float((np.array(place) - center) @ axis) for _, place in rims]
    x, y, z = center.tolist()
    return frustum_numbers(
        [radius for radius, _ in rims], heights, (x, y, z), (axis[0], axis[1], axis[2]), 0.0, own[SWEEP]
    )


def rims_of(numbers: Numbers) -> tuple[int, ...]:
    """Return the numbers of the rims of a frustum; a disc has one rim, an apex is not a rim."""
    return (LOW_RIM, HIGH_RIM) if numbers[SIDE] > 0.0 and numbers[HIGH_RADIUS] > 0.0 else (LOW_RIM,)


def tips_of(first: Frustum, is_sharp: bool) -> Iterator[tuple[Point, Numbers]]:
    """Yield position [m] and unit vectors along :data:`_N_EDGES` edges of each foot and, if ``is_sharp``, of an apex.

    The edges of a foot lie in the plane of the cap, those of an apex on the side.  All vectors are in the body frame;
    the three components of each edge follow one another.
    """
    for foot in first.feet:
        yield foot, _edges_around(first, 1.0, 0.0)
    for radius, place in first.standing_rims:
        if radius == 0.0 and is_sharp:
            yield place, _edges_around(first, first.frustum[SIN], -first.frustum[COS])


def _edges_around(first: Frustum, radial: float, axial: float) -> Numbers:
    """Return ``_N_EDGES`` unit vectors at even angles around the axis in the body frame, three components for each.

    Each has the component ``radial`` away from the axis and ``axial`` along it.
    """
    axes = np.array(first.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    angles = [2.0 * math.pi * i / _N_EDGES for i in range(_N_EDGES)]
    edges = [axes @ np.array([radial * math.cos(angle), radial * math.sin(angle), axial]) for angle in angles]
    return tuple(float(x) for edge in edges for x in edge)
