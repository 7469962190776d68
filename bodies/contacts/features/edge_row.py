"""Edges of bodies, as compiled functions take them."""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, vector_at
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
