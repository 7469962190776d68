"""Search, by trees of boxes, for features of two bodies that are near each other and may touch before the next search.

The features are a corner or a point and a patch of a surface, or two edges.
"""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, cross, divided, minus, norm, plus_scaled, scaled, vector_at, write_vector
from ..features.bounds import squared_distance_of_segments
from ..features.edge_crossing import CONE_MARGIN, sine_off_cones
from ..features.edge_vertex import ALONG, LENGTH, START, Edge, Vertex, direction_of, steepest
from ..features.frames import point_seen_from, vector_seen_from
from .surface_search import distance_from_triangle, nearest_in_patch
from .surface_tables import (
    N_EDGES,
    N_NODES,
    ON_CORNER,
    ON_EDGE,
    ON_FACE,
    SKIP,
    SWEEP,
    UPPER,
    Solid,
    corner_at,
    feature_of,
    patch_of,
)
from .surface_tree import ANY_PATCH, members_at, next_leaf, node_at
from .surface_vertex import descent

OVER_FIRST, OVER_SECOND, EDGE_ACROSS = 1.0, 2.0, 3.0
"""Kinds of candidates, the first of a candidate's three numbers.

In this order: corner of the second body over a patch of the first, corner of the first body over a patch of the second,
two edges.  The numbers of patch and corner, or of the edges of the first and the second body, follow.
"""
FEW = 64
"""Largest number of candidates of a search whose margin (its reach) exceeds ``narrow``; see :func:`room_ahead`.

All candidates are evaluated at every step: more of them cost more than another search with a smaller margin.
"""
NARROW = 1e-2
"""Margin of a search, relative to the smaller body's extent, up to which its candidates may fill all contacts.

With a larger margin, a search lists at most ``FEW`` candidates.
"""
_ALONG = 1e-3
"""Sine of the angle between two edges below which their common normal is too inexact to exclude the pair."""


class Near(NamedTuple):
    """What a search looks for, and the list to which it appends candidates."""

    out: Floats
    """Number of candidates, then three numbers of each: kind, feature, other feature."""
    kind: float
    """Kind of the candidates."""
    margin: float
    """Largest gap, by which the bodies move at most until the next search [m]."""
    reach: float
    """Largest distance of near features: the margin, and the radii of rounded bodies about their cores [m]."""
    turn: float
    """Largest relative rotation of the bodies until the next search [rad]."""
    most: int
    """Largest number of candidates.  A search ends at one more, which means that there are too many."""


@compiled
def room_ahead(reach: float, narrow: float, most: int) -> int:
    """Return the largest number of candidates of a search: ``most`` up to a reach of ``narrow`` [m], else `FEW`."""
    return most if reach <= narrow else min(most, FEW)


@compiled
def _add_patch(near: Near, patch: float, third: float, first: int, n: int) -> int:
    """Append a patch to the ``n`` candidates, unless one from number ``first`` on has it; return their new number.

    ``third`` is the number of the feature that is over the patch.
    """
    for known in range(first, n):
        if near.out[2 + 3 * known] == patch:
            return n
    write_vector(near.out, 1 + 3 * n, (near.kind, patch, third))
    return n + 1


@compiled
def patches_near(surface: Floats, point: Vector3, near: Near, third: float, n: int) -> int:
    """Append the patches with a leaf of the tree within reach of a point; return the new number of candidates.

    The point is in the axes of the surface [m]; ``third`` is the last number of each candidate.  ``n`` candidates are
    known before.
    """
    first, square = n, near.reach * near.reach
    leaf = next_leaf(surface, 0, ANY_PATCH, point, square)
    while leaf.begin < leaf.end and n <= near.most:
        for i in range(leaf.begin, leaf.end):
            if n <= near.most:
                n = _add_patch(near, patch_of(surface, int(surface[i])), third, first, n)
        leaf = next_leaf(surface, leaf.after, ANY_PATCH, point, square)
    return n


@compiled
def patches_round(solid: Solid, other: Solid, corner: int, near: Near, n: int) -> int:
    """Append the patches that a corner of the other body may soon touch, if one of the two bodies is rounded.

    The corner, a ball, touches a patch if a face is nearest to it, or if none of its edges leads towards the nearest
    point of the patch.  A patch is a candidate if one of these may hold before the next search.  ``n`` candidates are
    known before; return their new number.
    """
    vertex, first = corner_at(other.surface, corner), n
    point = point_seen_from(solid.frame, other.frame, vertex.place)
    end = patches_near(solid.surface, point, near, float(corner), n)
    if end > near.most:
        # there are more than there is room for, so that not all are known
        return end
    # of all patches within reach, keep in place those that may be touched; patch i is at 2 + 3 i
    for i in range(first, end):
        found = nearest_in_patch(solid.surface, near.out[2 + 3 * i], point, near.reach)
        to_patch = vector_seen_from(other.frame, solid.frame, minus(found.nearest, point))
        # the vector to the nearest point of the patch changes by at most margin + turn * distance
        is_nearest = steepest(vertex, to_patch) <= near.margin + near.turn * found.distance
        if found.distance < near.reach and (found.kind == ON_FACE or found.distance <= 0.0 or is_nearest):
            near.out[2 + 3 * n] = near.out[2 + 3 * i]
            n += 1
    # the first and the third number of all these candidates are equal
    return n


@compiled
def patches_under(solid: Solid, other: Floats, vertex: Vertex, near: Near, third: float, n: int) -> int:
    """Append the patches of faces that a vertex of the other body may soon touch; return the new number of candidates.

    A face may be touched if it is within reach of the vertex, and if the rotation until the next search can turn all
    edges of the vertex out of the face (within ``CONE_MARGIN``).  ``other`` is the frame block of the other body,
    ``third`` the last number of each candidate.  ``n`` candidates are known before.
    """
    surface, point = solid.surface, point_seen_from(solid.frame, other, vertex.place)
    first, square = n, near.reach * near.reach
    leaf = next_leaf(surface, 0, ANY_PATCH, point, square)
    while leaf.begin < leaf.end and n <= near.most:
        for i in range(leaf.begin, leaf.end):
            kind, face, row = feature_of(surface, int(surface[i]))
            if kind != ON_FACE or n > near.most or distance_from_triangle(row, point) > near.reach:
                continue
            if descent(solid, other, face, vertex) <= CONE_MARGIN + near.turn:
                n = _add_patch(near, patch_of(surface, int(surface[i])), third, first, n)
        leaf = next_leaf(surface, leaf.after, ANY_PATCH, point, square)
    return n


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
    surface, start = first.surface, point_seen_from(first.frame, edge.frame, vector_at(edge.row, START))
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
            w, e, p = minus(start, vector_at(row, START)), vector_at(row, ALONG), row[LENGTH]
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
        Room for candidates; on return ``out[0]`` exceeds it if there are too many.
    turning : float
        Largest relative rotation of the bodies until the next search, per metre of the largest gap [rad/m].
    narrow : float
        Largest gap up to which the candidates may fill this room [m] (:func:`room_ahead`).
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
