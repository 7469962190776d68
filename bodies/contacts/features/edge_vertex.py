"""Edges and vertices of bodies, as compiled functions take them."""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, vector_at
from .frames import point_in_world, vector_in_world

START, ALONG, LENGTH, INTO_FIRST, INTO_SECOND = 0, 3, 6, 7, 10
"""Offsets in the row of an edge: first end [m], unit vector along the edge, length [m], unit vectors from the edge into
its two faces; vectors are in the axes of the body.  An edge without faces has zeros in place of the last two."""


class Edge(NamedTuple):
    """An edge of a body at its place in the world."""

    frame: Floats
    """Frame block of the body."""
    row: Floats
    """Row of the edge."""


@compiled
def start_of(edge: Edge) -> Vector3:
    """Return the first end of an edge in the world [m]."""
    return point_in_world(edge.frame, vector_at(edge.row, START))


@compiled
def direction_of(edge: Edge) -> Vector3:
    """Return the unit vector along an edge, in world axes."""
    return vector_in_world(edge.frame, vector_at(edge.row, ALONG))


class Vertex(NamedTuple):
    """A vertex of a body, in its axes: a corner of a surface, or a foot or the apex of a frustum."""

    place: Vector3
    """Its position [m]."""
    n_star: float
    """Number of its edges; 0 for a point by itself."""
    star: Floats
    """Unit vectors along its edges, three numbers each."""


@compiled
def steepest(vertex: Vertex, n: Vector3) -> float:
    """Return the largest component of a vector n, in the axes of the body, along an edge of a vertex.

    It is -inf without edges.  If n points below a face, it is the sine of the steepest descent of an edge below it.
    """
    most = -math.inf
    for i in range(int(vertex.n_star)):
        most = max(most, dot(n, vector_at(vertex.star, 3 * i)))
    return most
