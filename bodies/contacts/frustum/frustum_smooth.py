"""Contact of a cylinder, a cone or a disc with a body that has a smooth support function.

The gap is the largest value of n . (p - q) over all unit normals n, for the points p and q of smooth body and frustum
that are extreme along n.  Each part of the frustum (cap, side, rim) has a range of normals.
:mod:`bodies.contacts.frustum.frustum_stops` searches one part for a local maximum.  Bodies that are apart have only one
local maximum, because both are convex.  Bodies that overlap may have several; the largest gives the shortest
translation that separates the bodies.

Points and normals are in the axes of the frustum, from its centre; the arguments of the searches
are those of :class:`bodies.contacts.frustum.frustum_stops.Pair`.
"""

from __future__ import annotations

import math
from typing import ClassVar, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import SIDE_A, SIDE_B
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.types import Floats

from ...rotations import relative_rotation, rotated, rotated_back
from ...shapes.frustum import COS, HIGH, LOW, LOW_RADIUS, SIDE, SIN, SWEEP, Frustum
from ...shapes.smooth import SmoothShape
from ...vectors import minus, opposite, plus, plus_scaled, vector_at
from ..features.frames import point_in_world
from ..features.writing import write_contact
from ..smooth.inscribed import is_least_overlap
from ..smooth.overlap_proof import do_overlap
from ..smooth.round_search import up_hills
from ..smooth.smooth_core import CENTER, POINT, RADIUS, Cores, NearestPoint, axes_in_world, largest_semi_axis, spread
from ..smooth.smooth_newton import write_surface
from .frustum import FLANK, HIGH_CAP, HIGH_RIM, LOW_CAP, LOW_RIM, nearest_part, part_number, rim_of
from .frustum_features import part_names
from .frustum_placed import placed
from .frustum_stops import ON_BORDER, Pair, by_search, from_rim, on_cap, on_flank, on_rim
from .frustum_writing import Spot, write_spot

_SHALLOW = 1e-8
"""Overlap up to which the first local maximum of the gap found is taken as the largest, relative to the size."""
_CLOSE = 1e-12
"""Least distance of the smooth body's centre from the frustum's axis, relative to the size of both bodies.

Below it the direction from the axis to the centre is round-off, and the search starts at the first axis instead.
"""
_LARGER = 1e-14
"""Least difference of two local maxima of the gap, relative to the size; a smaller difference is round-off."""
_TURNS = 8
"""Number of directions around the axis at which searches start, if the direction to the core's centre fails."""


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
def _nearest(pair: Pair) -> tuple[NearestPoint, int]:
    """Return the largest gap found over all normals, with point and normal, and the part of the frustum it belongs to.

    The first result holds the gap of the cores [m], the smooth body's point [m] and the normal.  The part is a cap, the
    side or a rim, such as ``LOW_CAP``.  The gap is nan if no local maximum was found, or if the bodies are not proved
    to overlap as a negative gap says.

    All parts are searched, from several starts, until a local maximum is proved to be the largest, or until all starts
    are done.  The proofs of an overlap are balls inside of one of the bodies that touch its surface at the contact
    point, with the depth as radius (:func:`_contains_ball`, :mod:`bodies.contacts.smooth.inscribed`).
    """
    frustum, place, size = pair.frustum, pair.cores.center, pair.size
    x, y, z = place
    away = math.sqrt(x * x + y * y)
    # direction from the axis at which the searches start
    direction = (x / away, y / away) if away > _CLOSE * size else (1.0, 0.0)
    _, _, _, first_part = nearest_part(frustum, z, away)
    if z > frustum[HIGH] or z < frustum[LOW]:
        part = HIGH_CAP if z > frustum[HIGH] else LOW_CAP
        found = on_cap(pair, part, ON_BORDER * size)
        if found[0] >= 0.0:
            return found, part
    best: NearestPoint = (math.nan, place, (0.0, 0.0, 1.0))
    best_part = LOW_CAP
    for start in range(_TURNS + 4):
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
            if not is_rim and (start == 2 or start == 3):
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
                if found[0] >= -_SHALLOW * size or _contains_ball(pair, part, found):
                    return best, best_part
                if is_least_overlap(pair.cores, found):
                    return best, best_part
    if not best[0] >= 0.0:
        # the local maximum with the smallest depth may have been missed, as next to a ridge or a tip of the core
        found, part = _on_rims(pair)
        if not math.isnan(found[0]) and not found[0] <= best[0] + _LARGER * size:
            best, best_part = found, part
    if not best[0] >= 0.0 and not do_overlap(pair.low, frustum[LOW], pair.high, frustum[HIGH], pair.cores):
        best = math.nan, best[1], best[2]
    return best, best_part


@compiled
def _on_rims(pair: Pair) -> tuple[NearestPoint, int]:
    """Return the largest local maximum of the gap over the normals of both rims, by ascents, and this rim.

    The ascents start from several normals (:func:`bodies.contacts.smooth.round_search.up_hills`).  A rim of radius 0 is
    an apex.  The gap is nan if no maximum was found.
    """
    frustum = pair.frustum
    best: NearestPoint = (math.nan, pair.cores.center, (0.0, 0.0, 1.0))
    best_part = LOW_RIM
    for part in (LOW_RIM, HIGH_RIM):
        if part == HIGH_RIM and frustum[SIDE] == 0.0:
            continue
        _, height, up = rim_of(frustum, part)
        # the normals of a rim end at the normal of the side; a disc has none, so that all normals are allowed
        limit, side = (frustum[COS], frustum[SIN], pair.size), up if frustum[SIDE] > 0.0 else 0.0
        gap, p, n = up_hills(from_rim(pair, part), side, limit)
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
    one = placed(a, first)
    place = rotated_back(axes_a, minus(point_in_world(b, vector_at(second, CENTER)), one.center))
    turn = relative_rotation(axes_a, axes_b)
    size = spread(place) + largest_semi_axis(second) + first[LOW_RADIUS] + first[HIGH] - first[LOW]
    (core_gap, p, n), part = _nearest(Pair(first, low, high, Cores(point, second, turn, place), size))
    gap, normal = core_gap - second[RADIUS] - first[SWEEP], rotated(axes_a, n)
    point_b = plus_scaled(plus(one.center, rotated(axes_a, p)), -second[RADIUS], normal)
    write_contact(a, out, gap, 0.0, part_number(first, part), normal, point_b, True)
    write_surface(out, SIDE_B, second, axes_b, rotated_back(turn, opposite(n)), rotated_back(turn, minus(p, place)))
    radial = math.sqrt(n[0] * n[0] + n[1] * n[1])
    ex, ey = (n[0] / radial, n[1] / radial) if radial > 0.0 else (1.0, 0.0)
    # distance of the frustum's contact point from the axis: exact on a rim
    away = max(ex * p[0] + ey * p[1] - core_gap * radial, 0.0)
    if part == LOW_RIM or part == HIGH_RIM:
        away, _, _ = rim_of(first, part)
    write_spot(out, SIDE_A, Spot(one, part, rotated(axes_a, (ex, ey, 0.0)), away), normal)


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
