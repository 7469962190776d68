"""Search, by trees of boxes, for patches of a surface near a point or a vertex."""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, minus, write_vector
from ..features.edge_crossing import CONE_MARGIN
from ..features.frames import point_seen_from, vector_seen_from
from ..features.vertex import Vertex, steepest
from .surface_search import distance_from_triangle, nearest_in_patch
from .surface_tables import ON_FACE, Solid, corner_at, feature_of, patch_of
from .surface_tree import ANY_PATCH, next_leaf
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
