"""Stops of a smooth body: the minimum of its distance over the plane of a face, the line of an edge, or a corner.

Over a plane the minimum follows from the support function of the body, over a line or a corner from Newton's method on
this function.  The body may touch the feature if the stop's point lies on the feature, and if the stop's normal is a
normal of the feature.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...shapes.support_function import Core
from ...vectors import Vector3, dot, minus, norm, plus_scaled, vector_at
from ..features.edge_row import ALONG, INTO_FIRST, INTO_SECOND, LENGTH
from ..smooth.smooth_core import Axes, facing_point
from ..smooth.smooth_newton import widest_from
from .surface_search import face_at, in_triangle, past_edges, steepest
from .surface_tables import FACE_NUMBER, OFFSET, SIZE, TRIANGLE

Stop: TypeAlias = tuple[float, float, Vector3, Vector3]
"""A stop: distance of the core [m], distance past the end of the feature [m], unit normal to the core, point [m].

The body may touch the feature if the distance past the end is not positive.  The point is one of the plane or line.
The distance of the core is nan if the search failed.
"""
Nearest: TypeAlias = tuple[Stop, int, int]
"""Result of a search: the stop, kind and number of its feature."""


@compiled
def over_face(surface: Floats, triangle: int, count: int, core: Core, turn: Axes, center: Vector3) -> Stop:
    """Return the stop over the plane of a face, of which ``count`` triangles from row ``triangle`` on are searched.

    The distance past the end is the distance of the stop's point from these triangles.  ``turn`` and ``center`` are
    those of :mod:`bodies.contacts.smooth.smooth_core`, in the axes of the surface.
    """
    f = face_at(surface, int(surface[triangle + FACE_NUMBER]))
    n = vector_at(surface, f)
    p = facing_point(core, turn, center, n)[0]
    height = dot(n, p) - surface[f + OFFSET]
    foot, least = plus_scaled(p, -height, n), math.inf
    for i in range(count):
        t = triangle + TRIANGLE * i
        beyond, past = past_edges(surface, t, 0.0, p)
        if beyond > 0.0:
            x, y, z, _ = in_triangle(surface, t, foot)
            past = norm(minus(foot, (x, y, z)))
        least = min(least, past)
        if least <= 0.0:
            break
    return height, max(least, -surface[SIZE]), n, foot


@compiled
def over_edge(surface: Floats, edge: int, core: Core, turn: Axes, center: Vector3, start: Vector3, size: float) -> Stop:
    """Return the stop over the line of the edge at row ``edge``; the search starts with the normal ``start``.

    The distance past the end is the largest of the distance past an end of the edge and of ``size`` times the component
    of the normal into a face of the edge.
    """
    begin, along = vector_at(surface, edge), vector_at(surface, edge + ALONG)
    # a start nearly along the edge loses digits in this difference; Newton's method takes its part along the edge again
    start = plus_scaled(start, -dot(start, along), along)
    g, p, n = widest_from(core, turn, minus(center, begin), along, start)
    s = dot(p, along)
    into = max(dot(n, vector_at(surface, edge + INTO_FIRST)), dot(n, vector_at(surface, edge + INTO_SECOND)))
    return g, max(max(-s, s - surface[edge + LENGTH]), size * into), n, plus_scaled(begin, s, along)


@compiled
def over_corner(
    surface: Floats, corner: int, core: Core, turn: Axes, center: Vector3, start: Vector3, size: float
) -> Stop:
    """Return the stop over the corner at row ``corner``; the search starts with the normal ``start``.

    The distance past the end is ``size`` times the largest component of the normal along an edge of the corner.
    """
    place = vector_at(surface, corner)
    g, _, n = widest_from(core, turn, minus(center, place), (0.0, 0.0, 0.0), start)
    return g, size * steepest(surface, corner, n), n, place
