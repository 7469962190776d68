"""Contact of the apex of a cone with another frustum, if one of the two is rounded; a rounded apex is a sphere."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FEATURE, SIDE_A, SIDE_B
from nonsmooth.types import Floats

from ...shapes.frustum import COS, HIGH, HIGH_RADIUS, LOW, LOW_RADIUS, SIDE, SIN, SWEEP
from ...vectors import dot, minus, opposite, plus_scaled, scaled
from ..features.ends import END, NEAR
from ..features.frames import across
from ..features.writing import write_round
from .frustum import HIGH_RIM, LOW_RIM, axis_in_world, center_in_world, nearest_part, on_axis_in_world, part_number
from .frustum_writing import write_rounded_part, write_two


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


def evaluate_apex_over_frustum(
    a: Floats, b: Floats, out: Floats, swap: float, first: Floats, second: Floats, size: float
) -> None:
    """Write the geometry block of the apex of a body and the nearest part of the other.

    ``first`` is the frustum with the apex, that of the second body if ``swap`` is 1; ``second`` is the other frustum.
    ``size`` is the size of the bodies [m].  The contact ends if the side of the cone is nearer than the apex.
    """
    own, other = (b, a) if swap == 1.0 else (a, b)
    axis, other_axis = axis_in_world(own, first), axis_in_world(other, second)
    p = on_axis_in_world(own, first, first[HIGH])
    along, away, outward = across(minus(p, center_in_world(other, second)), other_axis)
    distance, radial, axial, part = nearest_part(second, along, away)
    n = plus_scaled(scaled(-radial, outward), -axial, other_axis)
    past = past_apex(first, distance, dot(n, axis), size)
    if distance - first[SWEEP] - second[SWEEP] > NEAR * size:
        # the apex sphere is part of the body: its gap is an upper bound, so at a large gap the contact stays valid
        past = min(past, -END * size)
    if swap == 1.0 and second[HIGH_RADIUS] == 0.0:
        # two apices have one contact, that of the first body's apex: this contact ends before the other apex. ``up`` is
        # the coordinate of the point along the other side, from the lower rim
        up = second[COS] * (along - second[LOW]) - second[SIN] * (away - second[LOW_RADIUS])
        past = max(past, END * size - (second[SIDE] - up))
    write_two(a, out, swap, first, second, distance, past, n, p)
    out[FEATURE] = part_number(second, part)
    # distance of the other contact point from its axis: exact on a rim
    point_away = away - distance * radial
    if part == LOW_RIM or part == HIGH_RIM:
        point_away = second[LOW_RADIUS] if part == LOW_RIM else second[HIGH_RADIUS]
    write_round(out, SIDE_B if swap == 1.0 else SIDE_A, first[SWEEP])
    write_rounded_part(out, 1.0 - swap, second, part, other_axis, outward, opposite(n), max(point_away, 0.0))
