"""A vertex of a body: a corner of a surface, or a foot or the apex of a frustum."""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, vector_at


class Vertex(NamedTuple):
    """A vertex of a body, in the axes of the body."""

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
