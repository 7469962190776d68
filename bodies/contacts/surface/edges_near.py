"""Search, by trees of boxes, for pairs of edges of two bodies that are near each other and may touch."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, minus, norm, scaled, vector_at, write_vector
from ..features.bounds import squared_distance_of_segments
from ..features.edge_crossing import CONE_MARGIN, sine_off_cone
from ..features.frames import vector_in_body, vector_in_world
from .surface_near import Near, seen_from
from .surface_search import ON_EDGE, feature_of, member_of, node_at
from .surface_tables import N_NODES

_ALONG = 1e-3
"""Sine of the angle between two edges below which their common normal is too inexact to exclude the pair."""


@compiled
def _passes_box(surface: Floats, at: int, start: Vector3, way: Vector3, reach: float) -> bool:
    """Return whether a segment from ``start`` meets the box of a node, enlarged by ``reach`` [m] to all sides."""
    low, high = 0.0, 1.0
    for i in range(3):
        one, two, d = surface[at + i] - reach - start[i], surface[at + 3 + i] + reach - start[i], way[i]
        if d < 0.0:
            one, two, d = -two, -one, -d
        if one > d or two < 0.0:
            return False
        if one > 0.0:
            low = max(low, one / d)
        if two < d:
            high = min(high, two / d)
    return low <= high


@compiled
def _may_cross(a: Floats, b: Floats, surface_a: Floats, one: int, surface_b: Floats, two: int, turn: float) -> bool:
    """Return whether the normals of two edges face each other, or may do so after a rotation by ``turn`` [rad]."""
    n = cross(vector_in_world(a, vector_at(surface_a, one + 3)), vector_in_world(b, vector_at(surface_b, two + 3)))
    sine = norm(n)
    if sine <= _ALONG:
        return True
    n = divided(n, sine)
    ahead = max(sine_off_cone(a, surface_a, one, 1.0, n), sine_off_cone(b, surface_b, two, -1.0, n))
    behind = max(sine_off_cone(a, surface_a, one, -1.0, n), sine_off_cone(b, surface_b, two, 1.0, n))
    # a rotation by `turn` turns the normals of an edge by `turn`, the common normal of both by at most 2 turn / sine
    return bool(min(ahead, behind) <= CONE_MARGIN + turn * (1.0 + 2.0 / sine))


@compiled
def edges_across(
    a: Floats,
    b: Floats,
    surface: Floats,
    edges: Floats,
    two: int,
    number: float,
    near: Near,
    kind: float,
    out: Floats,
    n: int,
) -> int:
    """Append candidates: pairs of an edge of the first body's surface and one near edge of the second body.

    Return the number of candidates after that.  The row of the second body's edge begins at index ``two`` of ``edges``;
    ``number`` is the number of this edge, the third number of each candidate; ``kind`` is the first number.  ``out``
    holds ``n`` candidates.
    """
    reach, turn, most = near
    start = seen_from(a, b, vector_at(edges, two))
    f = vector_in_body(a, vector_in_world(b, vector_at(edges, two + 3)))
    q = edges[two + 6]
    node = 0
    while node < int(surface[N_NODES]) and n <= most:
        at = node_at(surface, node)
        if not _passes_box(surface, at, start, scaled(q, f), reach):
            node = int(surface[at + 6])
            continue
        for m in range(int(surface[at + 8])):
            what, own, one = feature_of(surface, member_of(surface, at, m))
            if what != ON_EDGE or n > most:
                continue
            e, p = vector_at(surface, one + 3), surface[one + 6]
            square = squared_distance_of_segments(minus(start, vector_at(surface, one)), e, p, f, q)
            if square <= reach * reach and _may_cross(a, b, surface, one, edges, two, turn):
                write_vector(out, 1 + 3 * n, (kind, float(own), number))
                n += 1
        node += 1
    return n
