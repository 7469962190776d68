"""Search for pairs of features of two surfaces that are near each other and may touch before the next search."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, minus, norm, plus_scaled, scaled, vector_at, write_vector
from ..features.bounds import squared_distance_of_segments
from ..features.edge_crossing import CONE_MARGIN, sine_off_cones
from ..features.edge_row import ALONG, LENGTH, Edge, direction_of
from ..features.frames import point_seen_from, vector_seen_from
from .surface_near import (
    EDGE_ACROSS,
    OVER_FIRST,
    OVER_SECOND,
    Near,
    patches_round,
    patches_under,
    room_ahead,
)
from .surface_tables import N_EDGES, N_NODES, ON_CORNER, ON_EDGE, SKIP, SWEEP, UPPER, Solid, corner_at, feature_of
from .surface_tree import ANY_PATCH, members_at, next_leaf, node_at

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
def _may_cross(a: Edge, b: Edge, turn: float) -> bool:
    """Return whether the normals of two edges face each other, or may do so after a rotation by ``turn`` [rad]."""
    n = cross(direction_of(a), direction_of(b))
    sine = norm(n)
    if sine <= _ALONG:
        return True
    n = divided(n, sine)
    # a rotation by `turn` turns the normals of an edge by `turn`, the common normal of both by at most 2 turn / sine
    return min(sine_off_cones(a, b, n), sine_off_cones(b, a, n)) <= CONE_MARGIN + turn * (1.0 + 2.0 / sine)


@compiled
def _edges_across(first: Solid, edge: Edge, number: int, near: Near, n: int) -> int:
    """Append the edges of the first body that are near an edge of the second one; return the new number of candidates.

    ``number`` is that of the edge of the second body; ``n`` candidates are known before.
    """
    surface, start = first.surface, point_seen_from(first.frame, edge.frame, vector_at(edge.row, 0))
    f, q, node = vector_seen_from(first.frame, edge.frame, vector_at(edge.row, ALONG)), edge.row[LENGTH], 0
    while node < int(surface[N_NODES]) and n <= near.most:
        at = node_at(surface, node)
        if not _passes_box(surface, at, start, scaled(q, f), near.reach):
            # nothing in the subtree of this box is near
            node = int(surface[at + SKIP])
            continue
        leaf = members_at(surface, at, node + 1)
        for i in range(leaf.begin, leaf.end):
            kind, own, row = feature_of(surface, int(surface[i]))
            if kind != ON_EDGE or n > near.most:
                continue
            w, e, p = minus(start, vector_at(row, 0)), vector_at(row, ALONG), row[LENGTH]
            is_near = squared_distance_of_segments(w, e, p, f, q) <= near.reach * near.reach
            if is_near and _may_cross(Edge(first.frame, row), edge, near.turn):
                write_vector(near.out, 1 + 3 * n, (near.kind, float(own), float(number)))
                n += 1
        node = leaf.after
    return n


@compiled
def _is_box_near(solid: Solid, other: Solid, at: int, reach: float) -> bool:
    """Return False only if the box of the other body's node at index ``at`` is farther than ``reach`` [m] from a solid.

    A ball encloses the box.
    """
    corner = vector_at(other.surface, at)
    diagonal = minus(vector_at(other.surface, at + UPPER), corner)
    middle = point_seen_from(solid.frame, other.frame, plus_scaled(corner, 0.5, diagonal))
    radius = 0.5 * norm(diagonal) + reach
    leaf = next_leaf(solid.surface, 0, ANY_PATCH, middle, radius * radius)
    return leaf.begin < leaf.end


@compiled
def _features_near(solid: Solid, other: Solid, near: Near, n: int) -> int:
    """Append pairs of a feature of the other body and a near one of the solid; return the new number of candidates.

    The features are two edges, or a corner and a patch, by the kind of the candidates.  ``n`` candidates are known
    before.
    """
    parts, node, is_sharp = other.surface, 0, solid.surface[SWEEP] + other.surface[SWEEP] == 0.0
    while node < int(parts[N_NODES]) and n <= near.most:
        at = node_at(parts, node)
        if not _is_box_near(solid, other, at, near.reach):
            node = int(parts[at + SKIP])
            continue
        leaf = members_at(parts, at, node + 1)
        for i in range(leaf.begin, leaf.end):
            kind, number, row = feature_of(parts, int(parts[i]))
            if kind == ON_EDGE and near.kind == EDGE_ACROSS:
                n = _edges_across(solid, Edge(other.frame, row), number, near, n)
            elif kind == ON_CORNER and near.kind != EDGE_ACROSS and is_sharp:
                n = patches_under(solid, other.frame, corner_at(parts, number), near, float(number), n)
            elif kind == ON_CORNER and near.kind != EDGE_ACROSS:
                n = patches_round(solid, other, number, near, n)
        node = leaf.after
    return n


def find_near_features(
    a: Floats, b: Floats, out: Floats, surface_a: Floats, surface_b: Floats, most: float, turning: float, narrow: float
) -> None:
    """Write near pairs to ``out`` as candidates: corners of b over patches of a, those of a over b, and two edges.

    Parameters
    ----------
    a, b : Floats
        Frame blocks of both bodies.
    out : Floats
        On entry ``out[0]`` is the largest gap of a pair [m], on return the number of candidates, which follow.
    surface_a, surface_b : Floats
        Surfaces of both bodies (:mod:`bodies.contacts.surface.surface_tables`).
    most : float
        Largest number of candidates; one more is written if there are more.
    turning : float
        Largest relative rotation of the bodies until the next search, per metre of the largest gap [rad/m].
    narrow : float
        Largest gap up to which the candidates may fill all contacts [m]
        (:func:`bodies.contacts.surface.surface_near.room_ahead`).
    """
    margin, limit = out[0], room_ahead(out[0], narrow, int(most))
    # distances are measured between the cores
    reach, turn = margin + surface_a[SWEEP] + surface_b[SWEEP], turning * margin
    first, second = Solid(a, surface_a), Solid(b, surface_b)
    n = _features_near(first, second, Near(out, OVER_FIRST, margin, reach, turn, limit), 0)
    if surface_b[N_EDGES] > 0.0:
        n = _features_near(second, first, Near(out, OVER_SECOND, margin, reach, turn, limit), n)
        n = _features_near(first, second, Near(out, EDGE_ACROSS, margin, reach, turn, limit), n)
    out[0] = float(n) if n <= limit else most + 1.0
