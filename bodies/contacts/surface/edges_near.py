"""Search, by trees of boxes, for pairs of edges of two bodies that are near each other and may touch."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import vector_at
from ..features.bounds import square_of_lines
from ..features.edge_crossing import ASTRAY, edge_astray
from ..features.frames import vector_in_body, vector_in_world
from .surface_near import is_node_near, seen_from
from .surface_tables import EDGE, EDGES, MEMBERS, N_EDGES, N_NODES, N_TRIANGLES, NODE, NODES

_ALONG = 1e-3
"""Sine of the angle between two edges below which their common normal is too inexact to exclude the pair."""


@compiled
def _passes_box(
    surface: Floats, at: int, px: float, py: float, pz: float, dx: float, dy: float, dz: float, reach: float
) -> bool:
    """Return whether the segment from p to p + d meets the box of a node, enlarged by ``reach`` [m] to all sides."""
    low, high = 0.0, 1.0
    for i in range(3):
        p, d = (px, dx) if i == 0 else (py, dy) if i == 1 else (pz, dz)
        one, two = surface[at + i] - reach - p, surface[at + 3 + i] + reach - p
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
    ex, ey, ez = vector_in_world(a, vector_at(surface_a, one + 3))
    fx, fy, fz = vector_in_world(b, vector_at(surface_b, two + 3))
    x, y, z = ey * fz - ez * fy, ez * fx - ex * fz, ex * fy - ey * fx
    sine = math.sqrt(x * x + y * y + z * z)
    if sine <= _ALONG:
        return True
    x, y, z = x / sine, y / sine, z / sine
    plus = max(edge_astray(a, surface_a, one, 1.0, x, y, z), edge_astray(b, surface_b, two, -1.0, x, y, z))
    minus = max(edge_astray(a, surface_a, one, -1.0, x, y, z), edge_astray(b, surface_b, two, 1.0, x, y, z))
    # a rotation by `turn` turns the normals of an edge by `turn`, the common normal of both by at most 2 turn / sine
    return bool(min(plus, minus) <= ASTRAY + turn * (1.0 + 2.0 / sine))


@compiled
def edges_across(
    a: Floats,
    b: Floats,
    surface: Floats,
    edges: Floats,
    two: int,
    number: float,
    reach: float,
    turn: float,
    kind: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Append candidates: pairs of an edge of the first body's surface and one near edge of the second body.

    Return the number of candidates after that.  The row of the second body's edge begins at index ``two`` of ``edges``;
    ``number`` is the number of this edge, the third number of each candidate.  The other arguments are those of
    :func:`edges_near`.
    """
    first, members = int(surface[N_TRIANGLES]), int(surface[MEMBERS])
    px, py, pz = seen_from(a, b, edges[two], edges[two + 1], edges[two + 2])
    fx, fy, fz = vector_in_world(b, vector_at(edges, two + 3))
    fx, fy, fz = vector_in_body(a, (fx, fy, fz))
    q = edges[two + 6]
    node = 0
    while node < int(surface[N_NODES]) and n <= most:
        at = int(surface[NODES]) + NODE * node
        if not _passes_box(surface, at, px, py, pz, q * fx, q * fy, q * fz, reach):
            node = int(surface[at + 6])
            continue
        for m in range(int(surface[at + 8])):
            e = int(surface[members + int(surface[at + 7]) + m]) - first
            if e < 0 or e >= int(surface[N_EDGES]) or n > most:
                continue
            one = int(surface[EDGES]) + EDGE * e
            wx, wy, wz = px - surface[one], py - surface[one + 1], pz - surface[one + 2]
            ex, ey, ez, p = surface[one + 3], surface[one + 4], surface[one + 5], surface[one + 6]
            square = square_of_lines((wx, wy, wz), (ex, ey, ez), p, (fx, fy, fz), q)
            if square <= reach * reach and _may_cross(a, b, surface, one, edges, two, turn):
                out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = kind, float(e), number
                n += 1
        node += 1
    return n


@compiled
def edges_near(
    a: Floats,
    b: Floats,
    surface_a: Floats,
    surface_b: Floats,
    reach: float,
    turn: float,
    kind: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Append the pairs of near edges of both bodies to the ``n`` candidates; return the new number of candidates.

    The arguments are those of :func:`bodies.contacts.surface.surface_near.corners_near`.
    """
    first, members, node = int(surface_b[N_TRIANGLES]), int(surface_b[MEMBERS]), 0
    while node < int(surface_b[N_NODES]) and n <= most:
        at = int(surface_b[NODES]) + NODE * node
        if not is_node_near(a, b, surface_a, surface_b, at, reach):
            node = int(surface_b[at + 6])
            continue
        for i in range(int(surface_b[at + 8])):
            j = int(surface_b[members + int(surface_b[at + 7]) + i]) - first
            if 0 <= j < int(surface_b[N_EDGES]):
                two = int(surface_b[EDGES]) + EDGE * j
                n = edges_across(a, b, surface_a, surface_b, two, float(j), reach, turn, kind, out, n, most)
        node += 1
    return n
