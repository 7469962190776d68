"""Two edges that cross: their nearest points, their common normal, and how far they are from facing each other."""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.engine.numerics.tolerances import ADJACENT, GAP, RELATIVE_GAP

from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus_scaled, scaled, vector_at
from .edge_vertex import INTO_FIRST, INTO_SECOND, LENGTH, Edge, direction_of, start_of
from .frames import tangent_of, vector_in_body

CONE_MARGIN = 0.25
"""Sine of the largest angle between a contact normal and the normals of its features: 14 degrees.

An edge, a rim or a corner has a range of outward normals, between the normals of its adjacent surfaces.  The margin
lets a contact be followed before it can close, and a spring before it lets go.
"""
PARALLEL = 1e-6
"""Least sine of the angle between a rim or a side and a feature that it crosses.

At a smaller angle the ends of the features touch instead. Their gaps exceed that of the crossing by at most the square
of the angle times the size: far less than the gap tolerance.
"""


class Crossing(NamedTuple):
    """Crossing of the lines of two edges; points and vectors are those of the world."""

    point: Vector3
    """Nearest point of the first line [m]."""
    e: Vector3
    """Unit vector along the first line."""
    f: Vector3
    """Unit vector along the second line."""
    normal: Vector3
    """Unit vector perpendicular to both lines, from the first body to the second."""
    gap: float
    """Gap along the normal [m]."""
    past_ends: float
    """Distance of the nearest points past the ends of the edges [m]."""
    past: float
    """Distance past the boundary of the features [m]: negative if the normal is one of both edges."""


@compiled
def sine_off_cone(edge: Edge, sign: float, n: Vector3) -> float:
    """Return the sine of the angle from the unit vector ``sign`` n [world axes] to the range of normals of an edge.

    The normals of an edge lie between the normals of its two faces.  The result is not positive within this range.
    """
    n = vector_in_body(edge.frame, scaled(sign, n))
    return float(max(dot(n, vector_at(edge.row, INTO_FIRST)), dot(n, vector_at(edge.row, INTO_SECOND))))


@compiled
def sine_off_cones(a: Edge, b: Edge, n: Vector3) -> float:
    """Return the larger sine of the angles from n to the normals of one edge, and from -n to those of the other."""
    return max(sine_off_cone(a, 1.0, n), sine_off_cone(b, -1.0, n))


@compiled
def _across_of(e: Vector3, f: Vector3) -> Vector3:
    """Return the shorter of the vectors f - e and f + e of two unit vectors."""
    return minus(f, scaled(1.0 if dot(e, f) > 0.0 else -1.0, e))


@compiled
def least_sine(size: float) -> float:
    """Return the least sine of the angle at which sharp edges of bodies of a ``size`` [m] cross.

    At this sine the ends of the edges are aside by the default gap tolerance.
    """
    return min(GAP / size, RELATIVE_GAP)


@compiled
def least_round_sine(radius: float, size: float) -> float:
    """Return the least sine of the angle at which round features of bodies of a ``size`` [m] cross.

    Round features are the sides of cylinders, or edges with a rounding; ``radius`` is the sum of both radii [m].  At a
    distance x from the crossing, the gap is larger by (sine x)^2 / (2 radius).  At the least sine this is the gap of
    surfaces next to each other (``ADJACENT``) at the distance ``size``: then the ends of the features touch as well as
    the crossing, and they hold the bodies at fixed points.  The crossing would run along them with the least tilt.
    """
    return math.sqrt(2.0 * radius * ADJACENT * min(GAP, RELATIVE_GAP * size)) / size


@compiled
def cross_edges(a: Edge, b: Edge, parallel: float, size: float) -> Crossing:
    """Return the crossing of an edge of each body; ``size`` is the size of the larger body [m].

    The normal has the sign for which it is nearer to the normals of the edges.  Edges without faces have no sign, so
    their gap is positive.  The distance past the boundary is positive if the sine of the angle between the edges is
    below ``parallel``, if the normal is farther than ``CONE_MARGIN`` from the normals of an edge, or if a nearest point
    is past the end of its edge by more than the size.
    """
    start, e, f = start_of(a), direction_of(a), direction_of(b)
    w = minus(start_of(b), start)
    # e x f = e x (f - e): the short vector f - e keeps its digits, so the normal of nearly parallel edges is accurate
    n = cross(e, _across_of(e, f))
    sine = norm(n)
    s, t, past_ends, past = 0.0, 0.0, 0.0, size
    if sine > 1e-3 * parallel:
        n = divided(n, sine)
        # s and t: distances of the nearest points along the lines, s = (w x f) . n / sine and t = (w x e) . n / sine,
        # with the unit vectors e and f of the lines and the vector w from the start of the first to that of the second
        s, t = dot(n, cross(w, f)) / sine, dot(n, cross(w, e)) / sine
        past_ends = max(max(-s, s - a.row[LENGTH]), max(-t, t - b.row[LENGTH]))
        past = max(past_ends - size, size * (1.0 - sine / parallel))
    else:
        n = minus(w, scaled(dot(w, e), e))
        apart = norm(n)
        n = divided(n, apart) if apart > 0.0 else tangent_of(e)
    # measured between the nearest points, so that the length of the edges does not multiply the error of the normal
    gap = dot(minus(plus_scaled(w, t, f), scaled(s, e)), n)
    off_cone, reversed_off_cone = sine_off_cones(a, b, n), sine_off_cones(b, a, n)
    if reversed_off_cone < off_cone or (reversed_off_cone == off_cone and gap < 0.0):
        n, gap, off_cone = opposite(n), -gap, reversed_off_cone
    return Crossing(plus_scaled(start, s, e), e, f, n, gap, past_ends, max(past, size * (off_cone - CONE_MARGIN)))
