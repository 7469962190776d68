"""Contact of the sides of two cylinders or cones that cross each other, in closed form."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.frustum import COS, LOW, LOW_RADIUS, SIDE, SIN, SWEEP
from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus, plus_scaled, scaled
from ..features.edge_crossing import least_round_sine
from ..features.frames import tangent_of
from .frustum import FLANK, axis_in_world, center_in_world
from .frustum_writing import past_border, past_depth, write_rounded_part, write_two


@compiled
def _across_both(a: Vector3, b: Vector3) -> tuple[Vector3, float]:
    """Return the unit vector along the product a x b of two unit vectors, and the sine of the angle between a and b.

    If they are parallel, the sine is 0, and the vector is any unit vector perpendicular to them.
    """
    v = cross(a, b)
    # the components of a small product along a are round-off
    v = plus_scaled(v, -dot(v, a), a)
    size = norm(v)
    return (divided(v, size), size) if size > 0.0 else (tangent_of(a), 0.0)


@compiled
def _line(frustum: Floats, center: Vector3, axis: Vector3, n: Vector3) -> tuple[Vector3, Vector3]:
    """Return the straight line of the side with the outward normal n: its lower end [m] and unit vector upwards.

    ``center`` and ``axis`` are those of the frustum; all vectors are in the world.
    """
    cosine, sine = frustum[COS], frustum[SIN]
    outward = divided(plus_scaled(n, -sine, axis), cosine)
    low = plus_scaled(plus_scaled(center, frustum[LOW], axis), frustum[LOW_RADIUS], outward)
    return low, plus_scaled(scaled(cosine, axis), -sine, outward)


def evaluate_sides(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, size: float) -> None:
    """Write the geometry block of the crossing of the sides of two frustums, which must have no feet.

    The common normal n of both sides has a fixed angle to each axis.  This leaves two mirror images of n; bodies apart
    are separated along the one with the larger gap.  On each side the points with the normal n are a straight line.
    The contact points are those at which both lines cross.  If no such normal exists, or the lines are nearly parallel,
    there is no crossing: the middle of a line is written, past the end of the features by ``size``, the size of the
    bodies [m].
    """
    axis_a, axis_b = axis_in_world(a, first), axis_in_world(b, second)
    center_a, center_b = center_in_world(a, first), center_in_world(b, second)
    # n = n_a a + n_e e + n_c c, with the axis a, and unit vectors c along a x b and e = c x a. The sines of the sides
    # give n . a and -n . b, and |n| = 1 gives n_c
    c, sine = _across_both(axis_a, axis_b)
    e, n_a = cross(c, axis_a), first[SIN]
    n_e = (-second[SIN] - dot(axis_a, axis_b) * n_a) / sine if sine > 0.0 else 0.0
    n_c_squared = 1.0 - n_a * n_a - n_e * n_e
    n_c = math.sqrt(max(n_c_squared, 0.0))
    gap, n = -math.inf, (1.0, 0.0, 0.0)
    # support functions of the infinite cones of both sides, along n and -n
    support_a = first[COS] * first[LOW_RADIUS] + first[SIN] * first[LOW]
    support_b = second[COS] * second[LOW_RADIUS] + second[SIN] * second[LOW]
    for sign in (-1.0, 1.0):
        candidate = plus_scaled(plus(scaled(n_a, axis_a), scaled(n_e, e)), sign * n_c, c)
        candidate = divided(candidate, norm(candidate))
        separation = dot(candidate, minus(center_b, center_a)) - support_a - support_b
        if separation > gap:
            gap, n = separation, candidate
    p, u = _line(first, center_a, axis_a, n)
    q, v = _line(second, center_b, axis_b, opposite(n))
    w, crossing = minus(q, p), dot(n, cross(u, v))
    # distances of the contact points along the lines, from their lower ends
    s, t, past_ends = 0.5 * first[SIDE], 0.5 * second[SIDE], size
    round_radius = first[LOW_RADIUS] + second[LOW_RADIUS] + first[SWEEP] + second[SWEEP]
    if n_c_squared >= 0.0 and abs(crossing) > least_round_sine(round_radius, size):
        s, t = dot(n, cross(w, v)) / crossing, dot(n, cross(w, u)) / crossing
        past_ends = max(max(-s, s - first[SIDE]), max(-t, t - second[SIDE]))
        # the distance along n of the points that cross: an error of n hardly changes it
        gap = dot(n, plus_scaled(plus_scaled(w, t, v), -s, u))
    p = plus_scaled(p, s, u)
    q = plus_scaled(p, gap, n)
    # distances of the contact points from the axes, for the curvature: not negative past an apex
    away_a, away_b = first[LOW_RADIUS] - first[SIN] * s, second[LOW_RADIUS] - second[SIN] * t
    past = max(past_border(past_ends, 0.0, size), past_depth(a, first, b, second, gap, size))
    write_two(a, out, 0.0, first, second, gap, past, n, p)
    write_rounded_part(out, 0.0, first, FLANK, axis_a, minus(p, center_a), n, max(away_a, 0.0))
    write_rounded_part(out, 1.0, second, FLANK, axis_b, minus(q, center_b), opposite(n), max(away_b, 0.0))
