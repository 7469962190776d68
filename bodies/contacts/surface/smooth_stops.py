"""Stops of a smooth body: the minimum of its distance over the plane of a face, the line of an edge, or a corner.

Over a plane the minimum follows from the support function of the body, over a line or a corner from Newton's method on
this function.  The body may touch the feature if the stop's point lies on the feature, and if the stop's normal is a
normal of the feature.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import block_at, compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, plus_scaled, vector_at
from ..features.edge_vertex import ALONG, INTO_FIRST, INTO_SECOND, LENGTH, START, Vertex, steepest
from ..smooth.smooth_core import Cores, at_place, facing_point
from ..smooth.smooth_newton import widest_from
from .surface_search import distance_from_triangle, past_edges
from .surface_tables import SIZE, TRIANGLE, face_height, normal_of


class SmoothOver(NamedTuple):
    """A smooth body over a surface, in the axes of the surface."""

    surface: Floats
    """The surface."""
    cores: Cores
    """A point at the origin of the surface, and the body."""
    size: float
    """Size of the body, or of both [m]; a sine off the normals of a feature times it is a distance past its end."""


class Stop(NamedTuple):
    """The minimum of the distance of a smooth body over the plane of a face, the line of an edge, or a corner."""

    gap: float
    """Distance of the core [m]; nan if the search failed."""
    past: float
    """Distance past the end of the feature [m]; the body may touch the feature if it is not positive."""
    normal: Vector3
    """Unit normal from the surface to the core."""
    point: Vector3
    """Point of the plane or line [m]."""


class Nearest(NamedTuple):
    """Result of a search: a stop and its feature."""

    stop: Stop
    """The stop."""
    kind: int
    """Kind of the feature, as ``ON_FACE``."""
    number: int
    """Number of the feature among those of its kind."""


@compiled
def over_face(body: SmoothOver, face: int, triangle: Floats, count: int) -> Stop:
    """Return the stop over the plane of a face, of which ``count`` triangles from row ``triangle`` on are searched.

    The distance past the end is the distance of the stop's point from these triangles.
    """
    n = normal_of(body.surface, face)
    p = facing_point(body.cores, n)[0]
    height, least = face_height(body.surface, face, p), math.inf
    foot = plus_scaled(p, -height, n)
    for i in range(count):
        row = block_at(triangle, TRIANGLE * i)
        past_any, past_border = past_edges(row, 0.0, p)
        least = min(least, distance_from_triangle(row, foot) if past_any > 0.0 else past_border)
        if least <= 0.0:
            break
    return Stop(height, max(least, -body.surface[SIZE]), n, foot)


@compiled
def over_edge(body: SmoothOver, edge: Floats, start: Vector3) -> Stop:
    """Return the stop over the line of the edge with the row ``edge``; the search starts with the normal ``start``.

    The distance past the end is the largest of the distance past an end of the edge and of the size times the component
    of the normal into a face of the edge.
    """
    begin, along = vector_at(edge, START), vector_at(edge, ALONG)
    # a start nearly along the edge loses digits here; Newton's method removes what is left of its part along the edge
    start = plus_scaled(start, -dot(start, along), along)
    g, p, n = widest_from(at_place(body.cores, begin), along, start)
    s = dot(p, along)
    into = max(dot(n, vector_at(edge, INTO_FIRST)), dot(n, vector_at(edge, INTO_SECOND)))
    return Stop(g, max(max(-s, s - edge[LENGTH]), body.size * into), n, plus_scaled(begin, s, along))


@compiled
def over_corner(body: SmoothOver, corner: Vertex, start: Vector3) -> Stop:
    """Return the stop over a corner; the search starts with the normal ``start``.

    The distance past the end is the size times the largest component of the normal along an edge of the corner.
    """
    g, _, n = widest_from(at_place(body.cores, corner.place), (0.0, 0.0, 0.0), start)
    return Stop(g, body.size * steepest(corner, n), n, corner.place)
