"""Caps, rims, side, apex and feet of a frustum: the part nearest to a point, its curvature, and frustums on feet.

A frustum is the tuple of :func:`bodies.shapes.frustum.frustum_numbers`.  Its parts are numbered along the axis: lower
cap, lower rim, side, upper rim, upper cap.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import POSITION
from nonsmooth.types import Floats, ReadFloats

from ...shapes.frustum import (
    AXIS,
    CENTER,
    COS,
    HIGH,
    LOW,
    SIDE,
    SIN,
    SWEEP,
    Frustum,
    Point,
    frustum_numbers,
    without_feet,
)
from ...shapes.polyhedron import SweptPolytope
from ...shapes.polytope import Polytope
from ...vectors import Vector3, cross, dot, minus, norm, opposite, plus_scaled, scaled, vector_at
from ..features.edge_crossing import PARALLEL
from ..features.frames import across, point_in_body, point_in_world, vector_in_body, vector_in_world
from ..features.polytope_tables import FACE, FACES, N_FACES, N_VERTICES, vertex_at
from ..features.vertex_face import plane_height
from ..features.writing import write_flat, write_principal, write_round
from ..surface.mesh_point import Corner
from ..surface.surface_tables import Numbers

LOW_CAP, LOW_RIM, FLANK, HIGH_RIM, HIGH_CAP = 0, 1, 2, 3, 4
"""Part numbers of a frustum, in the direction of its axis: lower cap, lower rim, side, upper rim, upper cap."""
FLATTEST = 1e-9
"""Least sine of the angle between a rim and a face for which the rim has a lowest point.

The speed of this point along the rim is inversely proportional to the sine.  Feet carry a flatter rim.
"""
RIM_NAMES = {LOW_RIM: "rim 0", HIGH_RIM: "rim 1"}
"""Names of the rims in the names of features."""


def part_names(numbers: Sequence[float]) -> tuple[str, ...]:
    """Return the names of the parts that a frustum has, in the order of :func:`part_number`."""
    if numbers[SIDE] == 0.0:
        return "face -", "rim", "face +"
    if numbers[1] == 0.0:
        return "base", "rim", "side", "apex"
    return "cap -", "rim -", "side", "rim +", "cap +"


@compiled
def part_number(frustum: Floats, part: int) -> float:
    """Return the number of a part among the parts that the frustum has: a disc has one rim and no side."""
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
    """Return the point of the axis of a frustum at a height over its centre, in the world [m]."""
    return plus_scaled(center_in_world(frame, frustum), height, axis_in_world(frame, frustum))


@compiled
def rim_of(frustum: Floats, rim: float) -> tuple[float, float, float]:
    """Return radius [m], height over the centre [m] and side of a rim: 1 for ``HIGH_RIM``, -1 for ``LOW_RIM``."""
    if rim > LOW_RIM:
        return frustum[1], frustum[HIGH], 1.0
    return frustum[0], frustum[LOW], -1.0


@compiled
def cap_of(frustum: Floats, cap: float) -> tuple[float, float, float]:
    """Return radius [m], height over the centre [m] and side of a cap: 1 for ``HIGH_CAP``, -1 for ``LOW_CAP``."""
    if cap > LOW_CAP:
        return frustum[1], frustum[HIGH], 1.0
    return frustum[0], frustum[LOW], -1.0


@compiled
def nearest_part(frustum: ReadFloats, along: float, away: float) -> tuple[float, float, float, int]:
    """Return the part nearest to a point: signed distance [m], normal (across and along the axis), and part.

    Parameters
    ----------
    frustum : Floats
        Numbers of the frustum.
    along, away : float
        Coordinate of the point along the axis from the centre, and its distance from the axis [m].
    """
    under, over = frustum[LOW] - along, along - frustum[HIGH]
    dr, dz = away - frustum[0], along - frustum[LOW]
    beside = frustum[COS] * dr + frustum[SIN] * dz
    up = frustum[COS] * dz - frustum[SIN] * dr
    if over > 0.0 and away < frustum[1]:
        return over, 0.0, 1.0, HIGH_CAP
    if under > 0.0 and away < frustum[0]:
        return under, 0.0, -1.0, LOW_CAP
    if under <= 0.0 and over <= 0.0 and beside <= 0.0:
        # inside, the nearest part is the side or a cap
        if beside >= under and beside >= over:
            return beside, frustum[COS], frustum[SIN], FLANK
        if over >= under:
            return over, 0.0, 1.0, HIGH_CAP
        return under, 0.0, -1.0, LOW_CAP
    if 0.0 < up < frustum[SIDE]:
        return beside, frustum[COS], frustum[SIN], FLANK
    part = LOW_RIM if up <= 0.0 or frustum[SIDE] == 0.0 else HIGH_RIM
    if part == HIGH_RIM:
        dr, dz = away - frustum[1], over
    distance = math.sqrt(dr * dr + dz * dz)
    return distance, dr / distance, dz / distance, part


@compiled
def past_of_rim(past: float, radius: float, sine: float) -> float:
    """Return a length [m] by which bodies must move before the lowest point of a rim is no longer past a border.

    ``past`` is the distance of the point past the border [m], and the result if it is negative.  ``sine`` is that of
    the angle between the rim and the face.  If the bodies turn by an angle, the point moves round the rim by up to this
    angle over the sine.  So it may come from afar while the bodies hardly move.  This length is for bodies that are
    apart, whose contacts are sought.  Where they touch, the distance itself tells whether the contact ends.  Below
    ``PARALLEL`` the sine counts as this: the length must be positive past the border.
    """
    return past if past <= 0.0 or radius == 0.0 else max(sine, PARALLEL) * min(past, radius)


@compiled
def least_height(frustum: Floats, height: float, axis: Vector3, normal: Vector3) -> float:
    """Return the least height of a frustum over a plane [m].

    ``height`` is the height of its centre [m], ``axis`` its unit axis, ``normal`` the unit normal of the plane.
    """
    # the root of 1 - cosine^2 would be wrong by up to 1e-8 for an axis along the normal
    cosine, sine = dot(axis, normal), norm(cross(axis, normal))
    return float(height + min(cosine * frustum[LOW] - sine * frustum[0], cosine * frustum[HIGH] - sine * frustum[1]))


@compiled
def separation_over_faces(a: Floats, b: Floats, frustum: Floats, core: Floats) -> float:
    """Return the largest separation of a frustum in ``a`` and a core in ``b`` along the normals of its faces [m].

    It is negative if none of the planes of the faces separates the bodies.
    """
    axis, center = vector_in_body(b, axis_in_world(a, frustum)), point_in_body(b, center_in_world(a, frustum))
    best = -math.inf
    for i in range(int(core[N_FACES])):
        f = int(core[FACES]) + FACE * i
        best = max(best, least_height(frustum, plane_height(core, f, center), axis, vector_at(core, f)))
    return best


@compiled
def least_over(b: Floats, core: Floats, normal: Vector3, place: Vector3) -> float:
    """Return the least height of the vertices of a core in ``b`` over the plane through ``place`` with a normal [m]."""
    base = dot(normal, minus(vector_at(b, POSITION), place))
    own, least = vector_in_body(b, normal), math.inf
    for i in range(int(core[N_VERTICES])):
        least = min(least, dot(own, vector_at(core, vertex_at(core, i))))
    return float(base + least)


@compiled
def separation_over_caps(a: Floats, b: Floats, frustum: Floats, core: Floats) -> float:
    """Return the largest separation of a frustum in ``a`` and a core in ``b`` along the normals of the caps [m]."""
    axis, place = axis_in_world(a, frustum), center_in_world(a, frustum)
    best = least_over(b, core, opposite(axis), place) + frustum[LOW]
    if frustum[1] > 0.0:
        best = max(best, least_over(b, core, axis, place) - frustum[HIGH])
    return float(best)


@compiled
def separation_along(a: Floats, first: Floats, b: Floats, second: Floats, n: Vector3) -> float:
    """Return the separation of two frustums along the unit vector ``n`` from the first to the second [m]."""
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
        The unit axis, and the unit vector from the axis towards the point, perpendicular to the axis.
    radial : float
        Component of the outward normal along ``outward``.
    away : float
        Distance of the point from the axis [m].
    """
    if part == LOW_CAP or part == HIGH_CAP:
        write_flat(out, side)
    elif part != FLANK and away == 0.0:
        write_round(out, side, 0.0)
    else:
        # if the point moves around the axis by an angle, the normal turns by ``radial`` times this angle
        flank, turn = 1.0 if part == FLANK else 0.0, radial if abs(radial) > FLATTEST else FLATTEST
        write_principal(out, side, cross(axis, outward), turn, away, 1.0 - flank, flank)


@compiled
def tip_past_rim(
    b: Floats, n_star: float, star: Floats, lengths: Floats, p: Vector3, n: Vector3, depth: float, radius: float
) -> float:
    """Return a length [m] that is negative if a vertex behind a disc went through the disc.

    The vertex p, relative to the centre of the disc, lies behind the disc's plane at ``depth`` [m], in the direction
    -n.  Each edge of the vertex that leads back through the plane crosses it at a distance from the centre.  The result
    is the least of these distances, minus ``radius``, plus ``depth``; it is infinite if no edge crosses the plane.  A
    negative result means that an edge crosses the disc inside of the rim by more than ``depth``.  Otherwise the edges
    pass the rim from the side.  Edges that cross the plane farther from the vertex than their midpoint are ignored.
    """
    least = math.inf
    for i in range(int(n_star)):
        edge = vector_in_world(b, vector_at(star, 3 * i))
        rise = dot(n, edge)
        if rise * lengths[i] <= 2.0 * depth:
            continue
        at = plus_scaled(p, depth / rise, edge)
        along = dot(n, at)
        least = min(least, math.sqrt(max(dot(at, at) - along * along, 0.0)) - radius)
    return least + depth


_WAYS = 12
"""Number of unit vectors that stand for edges of an apex (down the side of the cone) or of a foot (along the cap).

An apex or a foot is treated as a corner with these edges, evenly spaced around the axis.  A face can touch it only if
no edge points into the face steeper than :data:`bodies.contacts.features.edge_crossing.CONE_MARGIN`.  The steepest of
12 edges along a cap has at least cos(15 deg) = 0.966 of the largest sine over all directions.
"""


def set_back(first: Frustum) -> Numbers:
    """Return the numbers of a frustum whose rims are set back by the height of its feet, so that only feet protrude.

    A rim that rolls over the edge of a face then keeps its height.
    """
    own = first.frustum
    center, axis = np.array(own[CENTER : CENTER + 3]), np.array(own[AXIS : AXIS + 7 : 3])
    rims = first.standing_rims if len(first.standing_rims) > 1 else 2 * first.standing_rims
    heights = [float((np.array(place) - center) @ axis) for _, place in rims]
    x, y, z = center.tolist()
    return frustum_numbers(
        [radius for radius, _ in rims], heights, (x, y, z), (axis[0], axis[1], axis[2]), 0.0, own[SWEEP]
    )


def size_of_both(first: Frustum, second: SweptPolytope) -> float:
    """Return the size of the larger body [m]."""
    return max(second.core.size + 2.0 * second.sweep, 2.0 * first.extent)


def rims_of(numbers: Numbers) -> tuple[int, ...]:
    """Return the numbers of the rims of a frustum; a disc has one rim, an apex is not a rim."""
    return (LOW_RIM, HIGH_RIM) if numbers[SIDE] > 0.0 and numbers[1] > 0.0 else (LOW_RIM,)


def rims_and_tips(first: Frustum, is_sharp: bool) -> Iterator[tuple[float, Point, str]]:
    """Yield radius [m], place [m] and name of each rim, of the apex of sharp bodies and of each foot.

    The apex of rounded bodies is a sphere, which has contacts of its own.
    """
    for has_radius in (True, False):
        for i, (radius, place) in enumerate(first.standing_rims):
            if (radius > 0.0) == has_radius and (has_radius or is_sharp):
                yield radius, place, f"rim {i}" if has_radius else "apex"
    for i, foot in enumerate(first.feet):
        yield 0.0, foot, f"foot {i}"


def seen_by(first: Frustum, core: Polytope) -> Numbers:
    """Return the numbers of a frustum for the contacts with a core: set back by the feet if the core has faces.

    A face lies on the feet, so the rest of the body must not touch first. A line has no face, and ignores the feet.
    """
    return set_back(first) if core.faces else without_feet(first.frustum)


def apex_of(first: Frustum) -> Iterator[Corner]:
    """Yield position [m], edges (:data:`_WAYS` unit vectors down the side, flattened) and name of the apex of a cone.

    Other frustums, which have no apex, yield nothing.
    """
    sine, cosine = first.frustum[SIN], first.frustum[COS]
    for radius, place in first.standing_rims:
        if radius == 0.0:
            yield place, _round(first, sine, -cosine), "apex"


def feet_of(first: Frustum) -> Iterator[Corner]:
    """Yield position [m], edges (:data:`_WAYS` unit vectors in the cap's plane, flattened) and name of each foot."""
    for i, foot in enumerate(first.feet):
        yield foot, _round(first, 1.0, 0.0), f"foot {i}"


def _round(first: Frustum, away: float, along: float) -> Numbers:
    """Return ``_WAYS`` unit vectors at even angles around the axis, flattened: three components for each vector.

    Each has the component ``away`` perpendicular to the axis and ``along`` along it.
    """
    axes = np.array(first.frustum[AXIS - 2 : AXIS + 7]).reshape(3, 3)
    angles = [2.0 * math.pi * i / _WAYS for i in range(_WAYS)]
    ways = [axes @ np.array([away * math.cos(angle), away * math.sin(angle), along]) for angle in angles]
    return tuple(float(x) for way in ways for x in way)
