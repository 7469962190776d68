"""Contact of a cylinder, a cone or a disc with a body that has a smooth support function.

The gap is the largest value of n . (p - q) over all unit normals n, for the points p and q of smooth body and frustum
that are extreme along n.  Each part of the frustum (cap, side, rim) has a range of normals.
:mod:`bodies.contacts.frustum.frustum_stops` searches one part for a local maximum.  Bodies that are apart have only one
local maximum, because both are convex.  Bodies that overlap may have several; the largest gives the shortest
translation that separates the bodies.

Points and normals are in the axes of the frustum, from its centre; the arguments are those of :data:`Bodies`.
"""

from __future__ import annotations

import math
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, LOW, LOW_RADIUS, SIDE, SIN, SWEEP, Frustum
from ...shapes.smooth import SmoothShape
from ...vectors import Vector3, dot, minus, opposite, plus, plus_scaled, vector_at
from ..features.frames import point_in_world
from ..features.writing import write_sweep
from ..smooth.inscribed import gauge, is_least_overlap
from ..smooth.overlap_proof import do_overlap
from ..smooth.round_search import up_hills
from ..smooth.smooth_core import (
    CENTER,
    POINT,
    RADIUS,
    Cores,
    NearestPoint,
    axes_in_world,
    largest_semi_axis,
    relative_rotation,
    rotated,
    rotated_back,
    spread,
)
from ..smooth.smooth_newton import write_surface
from ..smooth.smooth_starts import local_maximum, starts_of
from .frustum import (
    FLANK,
    HIGH_CAP,
    HIGH_RIM,
    LOW_CAP,
    LOW_RIM,
    cap_of,
    center_in_world,
    nearest_part,
    part_names,
    part_number,
    rim_of,
    write_part,
)
from .frustum_stops import ON_BORDER, Pair, by_search, from_rim, on_cap, on_flank, on_rim
from .frustum_writing import write_contact

_SHALLOW, _SHALLOW_OF_SHARP = 1e-6, 1e-8
"""Overlap up to which the first local maximum of the gap found is taken as the largest, relative to the size.

``_SHALLOW`` is for smooth bodies without ridges, the smaller one for bodies with ridges (a power of the core above 2).
"""
_CLOSE = 1e-12
"""Least distance of the smooth body's centre from the frustum's axis, relative to the size of both bodies.

Below it the direction from the axis to the centre is round-off, and the search starts at the first axis instead.
"""
_SAMPLES = 8
"""Number of equal parts into which the line between both contact points is divided, to find a common point."""
_ON_SURFACE = 1e-12
"""Round-off by which the gauge of a core (1 on its surface) may exceed 1 at a point inside of the core."""
_LARGER = 1e-14
"""Least difference of two local maxima of the gap, relative to the size; a smaller difference is round-off."""
_NEARBY = 1e-3
"""Angle to a maximum of the gap at which the ascent may end [rad], because Newton's method continues from there."""
_DEEP = 0.9
"""Gauge of the core below which an overlap is deep, at the frustum's point nearest to the core's centre.

The gauge is 0 at the centre and 1 on the surface.  At a deep overlap some searches are left out, because they may end
at a smaller local maximum of the gap.
"""
_TURNS = 8
"""Number of directions around the axis at which searches start, if the direction to the core's centre fails."""


@compiled
def _is_centre_outside(pair: Pair, found: NearestPoint) -> bool:
    """True if the frustum's contact point is in the core and the core's centre outside of the tangent plane there.

    If the core has no ridges, such an overlap is taken as the one with the smallest depth.
    """
    g, p, n = found
    from_centre = minus(plus_scaled(p, -g, n), pair.place)
    return bool(dot(n, from_centre) < 0.0 and gauge(pair.core, rotated_back(pair.turn, from_centre)) < 1.0)


@compiled
def is_over_cap(frustum: Floats, part: int, place: Vector3, found: NearestPoint) -> bool:
    """True if the gap found over a cap is proved to be the largest over all normals.

    It always is if the bodies are apart.  At an overlap of depth d, two points of the smooth body prove it.  The first
    is the lowest point, at the depth d below the cap.  The second lies on the line from there to the body's centre, at
    the height d above the cap.  If both are at least d inside of the rim, in any direction one of the two is at least d
    behind a point of the rim, so that no translation by less than d separates the bodies.
    """
    gap, (px, py, _), _ = found
    if gap >= 0.0:
        return True
    x, y, z = place
    radius, cap_height, up = cap_of(frustum, part)
    height, most_away = up * (z - cap_height), radius + gap
    if math.isnan(gap) or height < -gap or most_away < 0.0:
        return False
    # the second point, at this fraction of the line from the lowest point to the centre
    fraction = -2.0 * gap / (height - gap)
    qx, qy = px + fraction * (x - px), py + fraction * (y - py)
    return bool(max(px * px + py * py, qx * qx + qy * qy) <= most_away * most_away)


@compiled
def _contains_ball(pair: Pair, part: int, found: NearestPoint) -> bool:
    """True if the gap found over a cap or the side is proved to be the largest over all normals.

    The proof is a ball about the smooth body's point, with the depth of the overlap as its radius: if the ball lies
    inside of the frustum, no translation by less than the depth moves the point out.
    """
    if part == LOW_RIM or part == HIGH_RIM:
        return False
    x, y, z = found[1]
    outside, _, _, _ = nearest_part(pair.frustum, z, math.sqrt(x * x + y * y))
    return bool(outside <= found[0] + ON_BORDER * pair.size)


@compiled
def _gauge_near(pair: Pair, point: Vector3) -> float:
    """Return the gauge of the core at the frustum's point nearest to a point [1]; a point inside is its own."""
    x, y, z = point
    away = math.sqrt(x * x + y * y)
    distance, radial, axial, _ = nearest_part(pair.frustum, z, away)
    if distance > 0.0:
        # relative change of the distance from the axis
        inwards = distance * radial / away if away > 0.0 else 0.0
        point = x - inwards * x, y - inwards * y, z - distance * axial
    return float(gauge(pair.core, rotated_back(pair.turn, minus(point, pair.place))))


@compiled
def _has_common_point(pair: Pair, found: NearestPoint) -> bool:
    """Return whether a point of the frustum, nearest to a point between both contact points, is in the core."""
    g, q, n = found
    for i in range(_SAMPLES + 1):
        if _gauge_near(pair, plus_scaled(q, -(g * i / _SAMPLES), n)) <= 1.0 + _ON_SURFACE:
            return True
    return False


@compiled
def _nearest(pair: Pair) -> tuple[NearestPoint, int]:
    """Return the largest gap found over all normals, with point and normal, and the part of the frustum it belongs to.

    The first result holds the gap of the cores [m], the smooth body's point [m] and the normal.  The part is a cap, the
    side or a rim, such as ``LOW_CAP``.  The gap is nan if no local maximum was found, or if the bodies are not proved
    to overlap as a negative gap says.

    All parts are searched, from several starts, until a local maximum is proved to be the largest, or until all starts
    are done.
    """
    frustum, core, place, size = pair.frustum, pair.core, pair.place, pair.size
    x, y, z = place
    away = math.sqrt(x * x + y * y)
    # direction from the axis at which the searches start
    direction = (x / away, y / away) if away > _CLOSE * size else (1.0, 0.0)
    _, _, _, first_part = nearest_part(frustum, z, away)
    if z > frustum[HIGH] or z < frustum[LOW]:
        part = HIGH_CAP if z > frustum[HIGH] else LOW_CAP
        found = on_cap(pair, part, ON_BORDER * size)
        if is_over_cap(frustum, part, place, found):
            return found, part
    best: NearestPoint = (math.nan, place, (0.0, 0.0, 1.0))
    best_part = LOW_CAP
    is_deep, is_sharp = False, max(core[3], core[4]) > 2.0
    shallow = _SHALLOW_OF_SHARP * size if is_sharp else _SHALLOW * size
    for start in range(_TURNS + 4):
        if start == 1:
            is_deep = _gauge_near(pair, place) < _DEEP
        # start 0: normals towards the centre; 1: the searches of `by_search`; 2, 3: normals near the side's, near the
        # cap's; from 4 on: directions all around the axis
        tilt = -0.5 if start == 0 else 0.05 if start == 2 else 0.95 if start == 3 else 0.5
        if start > 3:
            # if the bodies overlap, the contact may be on the side of the axis away from the smooth body's centre
            angle = 2.0 * math.pi * start / _TURNS
            direction = math.cos(angle), math.sin(angle)
        for i in range(9):
            # first the part nearest to the centre, then the others in the order of their distance from this part
            part = first_part + ((i + 1) // 2 if i % 2 == 1 else -(i // 2))
            is_rim = part == LOW_RIM or part == HIGH_RIM
            if part < LOW_CAP or part > HIGH_CAP or (frustum[SIDE] == 0.0 and (part == FLANK or part == HIGH_RIM)):
                continue
            if (not is_rim and (start == 2 or start == 3)) or (start == 1 and is_deep):
                # at a deep overlap the gap has several maxima, of which `by_search` may find a smaller one
                continue
            if start == 1:
                found = by_search(pair, direction, part)
            elif part == LOW_CAP or part == HIGH_CAP:
                found = on_cap(pair, part, ON_BORDER * size)
            elif part == FLANK:
                found = on_flank(pair, direction)
            else:
                found = on_rim(pair, direction, part, tilt)
            # a comparison with nan is false, so that the first maximum replaces the gap nan
            if not math.isnan(found[0]) and not found[0] <= best[0]:
                best, best_part = found, part
                if found[0] >= -shallow or _contains_ball(pair, part, found):
                    return best, best_part
                if not is_sharp and _is_centre_outside(pair, found):
                    return best, best_part
        if is_sharp and (best[0] >= -_SHALLOW * size or _is_centre_outside(pair, best)):
            # a tip or ridge of the core next to a rim or apex: another local maximum may have a smaller depth
            is_rim = best_part == LOW_RIM or best_part == HIGH_RIM
            if is_rim and (is_deep or _gauge_near(pair, place) < _DEEP):
                return best, best_part
            return _larger_gap(pair, best, best_part)
    if is_sharp and not is_deep and best[0] < 0.0:
        # the local maximum with the smallest depth may have been missed: search for larger gaps
        best, best_part = _larger_gap(pair, best, best_part)
    if not math.isnan(best[0]) and (_has_common_point(pair, best) or _do_overlap(pair)):
        return best, best_part
    # the searches missed the largest gap: ascend the gap of the rims, then that of the side from the apex
    best, best_part = _on_rims(pair)
    if is_sharp and math.isnan(best[0]) and frustum[SIDE] > 0.0:
        best, best_part = _beside_apex(pair), FLANK
    return (best if best[0] >= 0.0 or _do_overlap(pair) else (math.nan, best[1], best[2])), best_part


@compiled
def _do_overlap(pair: Pair) -> bool:
    """Return whether both bodies are proved to have a common point."""
    cores = Cores(pair.low, pair.core, pair.turn, pair.place)
    return bool(do_overlap(pair.low, pair.frustum[LOW], pair.high, pair.frustum[HIGH], cores))


@compiled
def _larger_gap(pair: Pair, best: NearestPoint, best_part: int) -> tuple[NearestPoint, int]:
    """Return the larger of the gap ``best`` and the gaps of further local maxima, and the part it belongs to.

    No further search is made if a ball inside of the smooth body proves that ``best`` is the largest
    (:func:`bodies.contacts.smooth.inscribed.is_least_overlap`).
    """
    if not is_least_overlap(Cores(pair.point, pair.core, pair.turn, pair.place), best):
        found, part = _on_rims(pair)
        if found[0] > best[0] + _LARGER * pair.size:
            best, best_part = found, part
        if pair.frustum[SIDE] > 0.0:
            found = _beside_apex(pair)
            if found[0] > best[0] + _LARGER * pair.size:
                best, best_part = found, FLANK
    return best, best_part


@compiled
def _beside_apex(pair: Pair) -> NearestPoint:
    """Return gap, point and normal of the largest local maximum of the gap over the side beside the apex.

    Searches start at the normals with a maximal gap over the apex.  The gap is nan if no maximum was found.
    """
    cores = from_rim(pair, HIGH_RIM)
    best: NearestPoint = (math.nan, pair.place, (0.0, 0.0, 1.0))
    for start in starts_of(cores):
        _, (x, y, _) = local_maximum(cores, start, _NEARBY)
        away = math.sqrt(x * x + y * y)
        if away > 0.0:
            found = on_flank(pair, (x / away, y / away))
            if not math.isnan(found[0]) and not found[0] <= best[0]:
                best = found
    return best


@compiled
def _on_rims(pair: Pair) -> tuple[NearestPoint, int]:
    """Return the largest local maximum of the gap over the normals of both rims, by ascents, and this rim.

    The ascents start from several normals (:func:`bodies.contacts.smooth.round_search.up_hills`).  A rim of radius 0 is
    an apex.  The gap is nan if no maximum was found.
    """
    frustum = pair.frustum
    best: NearestPoint = (math.nan, pair.place, (0.0, 0.0, 1.0))
    best_part = LOW_RIM
    for part in (LOW_RIM, HIGH_RIM):
        if part == HIGH_RIM and frustum[SIDE] == 0.0:
            continue
        _, height, up = rim_of(frustum, part)
        # the normals of a rim end at the normal of the side; a disc has none, so that all normals are allowed
        limit, side = (frustum[COS], frustum[SIN], pair.size), up if frustum[SIDE] > 0.0 else 0.0
        circle, core, turn, center = from_rim(pair, part)
        gap, p, n = up_hills(circle, core, turn, center, side, limit)
        if not math.isnan(gap) and not gap <= best[0]:
            best, best_part = (gap, (p[0], p[1], p[2] + height), n), part
    return best, best_part


def evaluate_frustum_smooth(
    a: Floats, b: Floats, out: Floats, first: Floats, low: Floats, high: Floats, point: Floats, second: Floats
) -> None:
    """Write the geometry block of a frustum ``first`` and a smooth body with the core ``second``.

    ``low``, ``high`` and ``point`` are the rims and a point as cores.  The gap is nan if no part is proved to be the
    nearest.  The pair has one contact, which has no boundary.
    """
    axes_a, axes_b = axes_in_world(a, first), axes_in_world(b, second)
    center = center_in_world(a, first)
    place = rotated_back(axes_a, minus(point_in_world(b, vector_at(second, CENTER)), center))
    turn = relative_rotation(axes_a, axes_b)
    size = spread(place) + largest_semi_axis(second) + first[LOW_RADIUS] + first[HIGH] - first[LOW]
    (core_gap, p, n), part = _nearest(Pair(first, low, high, point, second, turn, place, size))
    gap, normal = core_gap - second[RADIUS] - first[SWEEP], rotated(axes_a, n)
    point_b = plus_scaled(plus(center, rotated(axes_a, p)), -second[RADIUS], normal)
    write_contact(a, out, gap, 0.0, part_number(first, part), normal, point_b, True)
    write_surface(out, SIDE_B, second, axes_b, rotated_back(turn, opposite(n)), rotated_back(turn, minus(p, place)))
    radial = math.sqrt(n[0] * n[0] + n[1] * n[1])
    ex, ey = (n[0] / radial, n[1] / radial) if radial > 0.0 else (1.0, 0.0)
    # distance of the frustum's contact point from the axis: exact on a rim
    away = max(ex * p[0] + ey * p[1] - core_gap * radial, 0.0)
    if part == LOW_RIM or part == HIGH_RIM:
        away, _, _ = rim_of(first, part)
    write_part(out, SIDE_A, part, (axes_a[2], axes_a[5], axes_a[8]), rotated(axes_a, (ex, ey, 0.0)), radial, away)
    write_sweep(out, SIDE_A, first[SWEEP])


@final
class FrustumSmooth(ContactKinematics):
    """One contact of a smooth body with a cap, a rim or the side of a cylinder, a cone or a disc, not with the feet."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, SmoothShape)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the single contact of the two: each part of the frustum, from the lower cap to the upper one."""
        assert isinstance(first, Frustum)
        assert isinstance(second, SmoothShape)
        frustum = first.frustum
        # the rims as cores: flat ellipsoids, or a point
        low, high = ((radius, radius, 0.0, 2.0, 2.0, 0.0) for radius in frustum[:LOW])
        values = {"first": frustum, "low": low, "high": high, "point": POINT}
        names = tuple(f"{part} and smooth" for part in part_names(frustum))
        return (FeaturePair(evaluate_frustum_smooth, {**values, "second": second.core}, names),)
