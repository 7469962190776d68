"""Two edges that cross: their nearest points, their common normal, and how far they are from facing each other."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.numerics.tolerances import ADJACENT, GAP, RELATIVE_GAP
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, dot, minus, norm, opposite, plus_scaled, scaled, vector_at
from .edge_row import ALONG, INTO_FIRST, INTO_SECOND, LENGTH
from .frames import point_in_world, tangent_of, vector_in_body, vector_in_world

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
Crossing: TypeAlias = tuple[Vector3, Vector3, Vector3, Vector3, float, float, float]
"""Crossing of two edges, in the world: see :func:`cross_edges`."""


@compiled
def sine_off_cone(frame: Floats, edge: Floats, at: int, sign: float, n: Vector3) -> float:
    """Return the sine of the angle from the unit vector ``sign`` n to the range of normals of an edge.

    The normals of an edge lie between the normals of its two faces.  The result is not positive within this range.  The
    row of the edge begins at index ``at`` of ``edge``.
    """
    x, y, z = n
    n = vector_in_body(frame, (sign * x, sign * y, sign * z))
    return float(max(dot(n, vector_at(edge, at + INTO_FIRST)), dot(n, vector_at(edge, at + INTO_SECOND))))


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
def cross_edges(
    a: Floats,
    b: Floats,
    edge_a: Floats,
    at_a: int,
    edge_b: Floats,
    at_b: int,
    parallel: float,
    margin: float,
    size: float,
) -> Crossing:
    """Return the crossing of an edge of each body, in the world.

    The crossing is: nearest point of the first line [m], unit vectors along both lines, normal, gap along the normal,
    distance of the nearest points past the ends of the edges, and distance past the boundary of the features [m].

    The normal is perpendicular to both edges, with the sign for which it is nearer to the normals of the edges.  Edges
    without faces have no sign, so their gap is positive.  The distance past the boundary is positive if a nearest point
    is past the end of its edge by more than ``margin`` [m], if the sine of the angle between the edges is below
    ``parallel``, or if the normal is farther than ``CONE_MARGIN`` from the normals of an edge.  The rows of the edges
    begin at the indices ``at_a`` and ``at_b``.
    """
    start = point_in_world(a, vector_at(edge_a, at_a))
    e, f = vector_in_world(a, vector_at(edge_a, at_a + ALONG)), vector_in_world(b, vector_at(edge_b, at_b + ALONG))
    w = minus(point_in_world(b, vector_at(edge_b, at_b)), start)
    # e x f = e x (f - e): the short vector f - e keeps its digits, so the normal of nearly parallel edges is accurate
    n = cross(e, _across_of(e, f))
    sine = norm(n)
    s, t, past_ends, past = 0.0, 0.0, 0.0, size
    if sine > 1e-3 * parallel:
        n = divided(n, sine)
        # s and t: distances of the nearest points along the lines, s = (w x f) . n / sine and t = (w x e) . n / sine,
        # with the unit vectors e and f of the lines and the vector w from the start of the first to that of the second
        s, t = dot(n, cross(w, f)) / sine, dot(n, cross(w, e)) / sine
        past_ends = max(max(-s, s - edge_a[at_a + LENGTH]), max(-t, t - edge_b[at_b + LENGTH]))
        past = max(past_ends - margin, size * (1.0 - sine / parallel))
    else:
        n = minus(w, scaled(dot(w, e), e))
        apart = norm(n)
        n = divided(n, apart) if apart > 0.0 else tangent_of(e)
    # measured between the nearest points, so that the length of the edges does not multiply the error of the normal
    gap = dot(minus(plus_scaled(w, t, f), scaled(s, e)), n)
    off_cone = max(sine_off_cone(a, edge_a, at_a, 1.0, n), sine_off_cone(b, edge_b, at_b, -1.0, n))
    reversed_off_cone = max(sine_off_cone(a, edge_a, at_a, -1.0, n), sine_off_cone(b, edge_b, at_b, 1.0, n))
    if reversed_off_cone < off_cone or (reversed_off_cone == off_cone and gap < 0.0):
        n, gap, off_cone = opposite(n), -gap, reversed_off_cone
    return plus_scaled(start, s, e), e, f, n, gap, past_ends, max(past, size * (off_cone - CONE_MARGIN))
