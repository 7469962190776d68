"""Search, by trees of boxes, for pairs of edges of two bodies that are near each other and may touch."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, minus, norm, scaled, vector_at, write_vector
from ..features.bounds import squared_distance_of_segments
from ..features.edge_crossing import CONE_MARGIN, sine_off_cone
from ..features.edge_row import ALONG, LENGTH
from ..features.frames import vector_in_body, vector_in_world
from .surface_near import Near, seen_from
from .surface_search import ON_EDGE, feature_of, member_of, node_at
from .surface_tables import N_MEMBERS, N_NODES, SKIP

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
def _may_cross(a: Floats, b: Floats, surface_a: Floats, row_a: int, edges: Floats, row_b: int, turn: float) -> bool:
    """Return whether the normals of two edges face each other, or may do so after a rotation by ``turn`` [rad].

    The rows of the edges begin at the indices ``row_a`` and ``row_b``.
    """
    e = vector_in_world(a, vector_at(surface_a, row_a + ALONG))
    n = cross(e, vector_in_world(b, vector_at(edges, row_b + ALONG)))
    sine = norm(n)
    if sine <= _ALONG:
        return True
    n = divided(n, sine)
    along = max(sine_off_cone(a, surface_a, row_a, 1.0, n), sine_off_cone(b, edges, row_b, -1.0, n))
    opposed = max(sine_off_cone(a, surface_a, row_a, -1.0, n), sine_off_cone(b, edges, row_b, 1.0, n))
    # a rotation by `turn` turns the normals of an edge by `turn`, the common normal of both by at most 2 turn / sine
    return bool(min(along, opposed) <= CONE_MARGIN + turn * (1.0 + 2.0 / sine))


@compiled
def edges_across(
    a: Floats,
    b: Floats,
    surface: Floats,
    edges: Floats,
    row_b: int,
    edge_b: float,
    near: Near,
    kind: float,
    out: Floats,
    n: int,
) -> int:
    """Append the edges of the first body's surface that are near one edge of the second body; return the new number.

    A candidate is three numbers: ``kind``, edge of the first body, edge of the second body.  ``out`` holds ``n``
    candidates, after one number for their count.  The search ends at one candidate more than ``near`` allows; this one
    tells that there are too many.

    Parameters
    ----------
    a, b : Floats
        Frame blocks of both bodies.
    surface : Floats
        Tables of the first body (:mod:`bodies.contacts.surface.surface_tables`).
    edges, row_b, edge_b : Floats, int, float
        Table with the row of the second body's edge, the index at which it begins, and the number of the edge.
    near : tuple
        Largest distance [m], largest rotation until the next search [rad], largest number of candidates.
    kind : float
        First number of each candidate.
    out, n : Floats, int
        Candidates so far, and their number.
    """
    reach, turn, most = near
    start = seen_from(a, b, vector_at(edges, row_b))
    f = vector_in_body(a, vector_in_world(b, vector_at(edges, row_b + ALONG)))
    q = edges[row_b + LENGTH]
    node = 0
    while node < int(surface[N_NODES]) and n <= most:
        at = node_at(surface, node)
        if not _passes_box(surface, at, start, scaled(q, f), reach):
            # nothing in the subtree of this box is near
            node = int(surface[at + SKIP])
            continue
        for m in range(int(surface[at + N_MEMBERS])):
            feature_kind, edge_a, row_a = feature_of(surface, member_of(surface, at, m))
            if feature_kind != ON_EDGE or n > most:
                continue
            e, p = vector_at(surface, row_a + ALONG), surface[row_a + LENGTH]
            square = squared_distance_of_segments(minus(start, vector_at(surface, row_a)), e, p, f, q)
            if square <= reach * reach and _may_cross(a, b, surface, row_a, edges, row_b, turn):
                write_vector(out, 1 + 3 * n, (kind, float(edge_a), edge_b))
                n += 1
        node += 1
    return n
