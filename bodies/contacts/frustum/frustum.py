"""Caps, rims, side, apex and feet of a frustum: the part nearest to a point, its curvature, and frustums on feet.

A frustum is the tuple of :func:`bodies.shapes.frustum.frustum_numbers`.  Its parts are numbered along the axis: lower
cap, lower rim, side, upper rim, upper cap.  The functions here use its core: callers add the rounding radius.
``frame`` is the frame block of a body.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from nonsmooth.compiled import compiled
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
from ...vectors import Vector3, cross, dot, minus, norm, opposite, plus_scaled, scaled, vector_at
from ..features.edge_crossing import PARALLEL
from ..features.frames import across, point_in_world, vector_in_world
from ..features.writing import write_flat, write_principal, write_round
from ..surface.surface_tables import Numbers

LOW_CAP, LOW_RIM, FLANK, HIGH_RIM, HIGH_CAP = 0, 1, 2, 3, 4
"""Part numbers of a frustum, in the direction of its axis: lower cap, lower rim, side, upper rim, upper cap."""
FLATTEST = 1e-9
"""Least sine of the angle between a rim and a face at which the rim has a lowest point over the face.

The speed of this point along the rim is inversely proportional to the sine.  A flatter rim rests on feet.
"""
RIM_NAMES = {LOW_RIM: "rim 0", HIGH_RIM: "rim 1"}
"""Words for the rims in the names of features."""


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
def center_in_world(frame: Floats, frustum: Floats) -> Vector3:
    """Return the centre of a frustum in the world [m]."""
    return point_in_world(frame, vector_at(frustum, CENTER))


@compiled
def axis_in_world(frame: Floats, frustum: Floats) -> Vector3:
    """Return the unit axis of a frustum in world axes."""
    return vector_in_world(frame, (frustum[AXIS], frustum[AXIS + 3], frustum[AXIS + 6]))


@compiled
def on_axis_in_world(frame: Floats, frustum: Floats, height: float) -> Vector3:
    """Return the point of the axis at ``height`` [m] over the centre of a frustum, in the world [m]."""
    return plus_scaled(center_in_world(frame, frustum), height, axis_in_world(frame, frustum))


@compiled
def rim_of(frustum: Floats, rim: float) -> tuple[float, float, float]:
    """Return radius [m], height over the centre [m] and side of a rim: 1 for ``HIGH_RIM``, -1 for ``LOW_RIM``."""
    if rim > LOW_RIM:
        return frustum[HIGH_RADIUS], frustum[HIGH], 1.0
    return frustum[LOW_RADIUS], frustum[LOW], -1.0


@compiled
def cap_of(frustum: Floats, cap: float) -> tuple[float, float, float]:
    """Return radius [m], height over the centre [m] and side of a cap: 1 for ``HIGH_CAP``, -1 for ``LOW_CAP``."""
    if cap > LOW_CAP:
        return frustum[HIGH_RADIUS], frustum[HIGH], 1.0
    return frustum[LOW_RADIUS], frustum[LOW], -1.0


@compiled
def nearest_part(frustum: ReadFloats, along: float, away: float) -> tuple[float, float, float, int]:
    """Return the part of a frustum nearest to a point: signed distance [m], outward normal there, and part.

    The distance is negative inside.  The normal is given by two components: radial, away from the axis, and axial.  The
    plane through the axis and the point shows a trapezium, whose sides and corners are the parts.

    Parameters
    ----------
    frustum : Floats
        Numbers of the frustum.
    along, away : float
        Coordinate of the point along the axis from the centre, and its distance from the axis [m].
    """
    # heights of the point over the planes of both caps and over the side, continued past its rims
    over_low, over_high = frustum[LOW] - along, along - frustum[HIGH]
    dr, dz = away - frustum[LOW_RADIUS], along - frustum[LOW]
    over_side = frustum[COS] * dr + frustum[SIN] * dz
    # coordinate of the point along the side, from the lower rim upwards
    up_side = frustum[COS] * dz - frustum[SIN] * dr
    if over_high > 0.0 and away < frustum[HIGH_RADIUS]:
        return over_high, 0.0, 1.0, HIGH_CAP
    if over_low > 0.0 and away < frustum[LOW_RADIUS]:
        return over_low, 0.0, -1.0, LOW_CAP
    if over_low <= 0.0 and over_high <= 0.0 and over_side <= 0.0:
        # inside, the nearest part is the side or a cap: the one with the largest, least negative height
        if over_side >= over_low and over_side >= over_high:
            return over_side, frustum[COS], frustum[SIN], FLANK
        if over_high >= over_low:
            return over_high, 0.0, 1.0, HIGH_CAP
        return over_low, 0.0, -1.0, LOW_CAP
    if 0.0 < up_side < frustum[SIDE]:
        return over_side, frustum[COS], frustum[SIN], FLANK
    # a disc has one rim, the lower one
    part = LOW_RIM if up_side <= 0.0 or frustum[SIDE] == 0.0 else HIGH_RIM
    if part == HIGH_RIM:
        dr, dz = away - frustum[HIGH_RADIUS], over_high
    distance = math.sqrt(dr * dr + dz * dz)
    return distance, dr / distance, dz / distance, part


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
def separation_along(a: Floats, first: Floats, b: Floats, second: Floats, n: Vector3) -> float:
    """Return the separation of two frustums along the unit vector ``n`` from the first to the second [m].

    It is the width of the gap between two planes with the normal n, each of which touches one frustum.  It is negative
    if the frustums overlap along n.  ``n`` is in the world.
    """
    height = dot(n, minus(center_in_world(b, second), center_in_world(a, first)))
    height = least_height(first, height, axis_in_world(a, first), opposite(n))
    return float(least_height(second, height, axis_in_world(b, second), n))


@compiled
def separation_by_second(a: Floats, first: Floats, b: Floats, second: Floats) -> float:
    """Return the largest separation of two frustums along normals of the second one's surface [m].

    It is a lower bound of their separation, which may be larger along another direction.  The normals are those of both
    caps, and that of the side where the side faces the first centre.  All directions lead from the first frustum to the
    second, so they point into the second one.
    """
    axis = axis_in_world(b, second)
    _, _, radial = across(minus(center_in_world(b, second), center_in_world(a, first)), axis)
    best = separation_along(a, first, b, second, axis)
    best = max(best, separation_along(a, first, b, second, opposite(axis)))
    best = max(best, separation_along(a, first, b, second, radial))
    # the radial direction is the normal of a cylinder's side, not of a cone's
    if second[SIN] != 0.0:
        inward = plus_scaled(scaled(second[COS], radial), -second[SIN], axis)
        best = max(best, separation_along(a, first, b, second, inward))
    return float(best)


@compiled
def write_part(out: Floats, side: int, part: int, axis: Vector3, outward: Vector3, radial: float, away: float) -> None:
    """Write the curvature matrices (slide, turn) of a part of a frustum at the contact point to the geometry block.

    They are explained in :func:`bodies.contacts.features.writing.write_principal`.  The caller has already written the
    normal and the first tangent to ``out``.

    Parameters
    ----------
    out, side : Floats, int
        The geometry block, and the index at which the matrices begin.
    part : int
        Number of the part, such as ``FLANK``.
    axis, outward : Vector3
        The unit axis, and the unit vector from the axis towards the point, perpendicular to the axis, in the world.
    radial : float
        Component of the outward normal along ``outward``.
    away : float
        Distance of the point from the axis [m].
    """
    # the apex, a rim of radius 0, has the curvature of a point
    if part == LOW_CAP or part == HIGH_CAP:
        write_flat(out, side)
    elif part != FLANK and away == 0.0:
        write_round(out, side, 0.0)
    else:
        # if the point moves around the axis by an angle, the normal turns by ``radial`` times this angle. A normal
        # along the axis does not turn; the least value keeps the matrices regular
        flank, slide = 1.0 if part == FLANK else 0.0, radial if abs(radial) > FLATTEST else FLATTEST
        write_principal(out, side, cross(axis, outward), slide, away, 1.0 - flank, flank)


@compiled
def tip_past_rim(
    b: Floats, n_star: float, star: Floats, lengths: Floats, p: Vector3, n: Vector3, depth: float, radius: float
) -> float:
    """Return a length [m] that is negative if a vertex behind a disc went through the disc.

    Each edge of the vertex that leads back through the disc's plane crosses it at a distance from the disc's centre.
    The result is the least of these distances, minus ``radius``, plus ``depth``; it is infinite if no edge crosses the
    plane.  A negative result means that an edge crosses the disc inside of the rim by more than ``depth``.  Otherwise
    the edges pass the rim from the side.

    Parameters
    ----------
    b : Floats
        Frame block of the body with the vertex.
    n_star, star, lengths : float, Floats, Floats
        Number of edges of the vertex, unit vectors along them in the body frame, and their lengths [m].
    p, n : Vector3
        The vertex, from the centre of the disc [m], and the unit normal of the disc, in the world.
    depth, radius : float
        Distance of the vertex from the disc's plane, in the direction -n, and radius of the disc [m].
    """
    least = math.inf
    for i in range(int(n_star)):
        edge = vector_in_world(b, vector_at(star, 3 * i))
        rise = dot(n, edge)
        # ignore edges that do not lead back, or that cross the plane only in their far half, next to another vertex
        if rise * lengths[i] <= 2.0 * depth:
            continue
        crossing = plus_scaled(p, depth / rise, edge)
        along = dot(n, crossing)
        least = min(least, math.sqrt(max(dot(crossing, crossing) - along * along, 0.0)) - radius)
    return least + depth


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


def rims_and_tips(first: Frustum, is_sharp: bool) -> Iterator[tuple[float, Point, str]]:
    """Yield radius [m], centre in the body frame [m] and name of each rim, of the apex and of each foot.

    Apex and feet have the radius 0.  The apex is left out unless ``is_sharp``: if a body of the pair is rounded, the
    apex is a sphere, which has contacts of its own.
    """
    for has_radius in (True, False):
        for i, (radius, place) in enumerate(first.standing_rims):
            if (radius > 0.0) == has_radius and (has_radius or is_sharp):
                yield radius, place, f"rim {i}" if has_radius else "apex"
    for i, foot in enumerate(first.feet):
        yield 0.0, foot, f"foot {i}"


def apex_of(first: Frustum) -> Iterator[tuple[Point, Numbers]]:
    """Yield position [m] and edges (:data:`_N_EDGES` unit vectors down the side) of a cone's apex.

    Other frustums, which have no apex, yield nothing.  All vectors are in the body frame; the three components of each
    edge follow one another.
    """
    sine, cosine = first.frustum[SIN], first.frustum[COS]
    for radius, place in first.standing_rims:
        if radius == 0.0:
            yield place, _edges_around(first, sine, -cosine)


def feet_of(first: Frustum) -> Iterator[tuple[Point, Numbers]]:
    """Yield position [m] and edges (:data:`_N_EDGES` unit vectors in the cap's plane) of each foot."""
    for foot in first.feet:
        yield foot, _edges_around(first, 1.0, 0.0)


def _edges_around(first: Frustum, radial: float, axial: float) -> Numbers:
    """Return ``_N_EDGES`` unit vectors at even angles around the axis in the body frame, three components for each.

    Each has the component ``radial`` away from the axis and ``axial`` along it.
    """
    axes = np.array(first.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    angles = [2.0 * math.pi * i / _N_EDGES for i in range(_N_EDGES)]
    edges = [axes @ np.array([radial * math.cos(angle), radial * math.sin(angle), axial]) for angle in angles]
    return tuple(float(x) for edge in edges for x in edge)
