"""Walks over the tree of bounding boxes of a surface: the leaves near a point, one after another."""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3
from .surface_tables import BITS, FIRST_MEMBER, MEMBERS, N_MEMBERS, N_NODES, N_PATCHES, NODE, NODES, PATCH_BITS, SKIP

ANY_PATCH = -1.0
"""Number of a patch for a walk over the leaves of all patches."""


class Leaf(NamedTuple):
    """A leaf that a walk has reached; without members, it is the end of the walk."""

    begin: int
    """Index in the surface's numbers at which the list of its members begins."""
    end: int
    """Index after this list."""
    after: int
    """Number of the node at which the walk continues."""


@compiled
def node_at(surface: Floats, node: int) -> int:
    """Return the index at which the row of a node of the tree begins."""
    return int(surface[NODES]) + NODE * node


@compiled
def members_at(surface: Floats, at: int, after: int) -> Leaf:
    """Return the members of the node at index ``at`` as a leaf; the walk continues at the node ``after``."""
    begin = int(surface[MEMBERS]) + int(surface[at + FIRST_MEMBER])
    return Leaf(begin, begin + int(surface[at + N_MEMBERS]), after)


@compiled
def box_square(surface: Floats, at: int, point: Vector3) -> float:
    """Return the square of the distance of a point from the box of the node at index ``at`` [m^2]."""
    x, y, z = point
    dx = max(max(surface[at] - x, x - surface[at + 3]), 0.0)
    dy = max(max(surface[at + 1] - y, y - surface[at + 4]), 0.0)
    dz = max(max(surface[at + 2] - z, z - surface[at + 5]), 0.0)
    return float(dx * dx + dy * dy + dz * dz)


@compiled
def has_patch(surface: Floats, at: int, patch: float) -> bool:
    """Return whether the node at index ``at`` may hold features of a patch."""
    return patch == ANY_PATCH or surface[N_PATCHES] > BITS or (int(surface[at + PATCH_BITS]) >> int(patch)) & 1 == 1


@compiled
def first_leaf(surface: Floats, patch: float, point: Vector3) -> Leaf:
    """Return the leaf in which the search for a patch's nearest feature to a point begins.

    Its box is near the point, so that the distance found there excludes most other leaves.  The walk over the whole
    tree follows, which visits this leaf again.
    """
    node = 0
    while surface[node_at(surface, node) + N_MEMBERS] == 0.0:
        # the left subtree follows its parent, the right one follows the left
        left = node + 1
        right = int(surface[node_at(surface, left) + SKIP])
        row_left, row_right = node_at(surface, left), node_at(surface, right)
        is_nearer = box_square(surface, row_left, point) <= box_square(surface, row_right, point)
        takes_left = has_patch(surface, row_left, patch) and (is_nearer or not has_patch(surface, row_right, patch))
        node = left if takes_left else right
    return members_at(surface, node_at(surface, node), 0)


@compiled
def next_leaf(surface: Floats, node: int, patch: float, point: Vector3, square: float) -> Leaf:
    """Return the first leaf from a node on that is near a point; one without members if there is none.

    The squared distance of the box from the point is at most ``square`` [m^2], and the leaf may hold features of the
    patch.
    """
    while node < int(surface[N_NODES]):
        at = node_at(surface, node)
        if box_square(surface, at, point) > square or not has_patch(surface, at, patch):
            # nothing in the subtree of this box is near
            node = int(surface[at + SKIP])
        elif surface[at + N_MEMBERS] == 0.0:
            node += 1
        else:
            return members_at(surface, at, node + 1)
    return Leaf(0, 0, node)
