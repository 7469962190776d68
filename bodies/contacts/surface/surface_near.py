"""Search, by trees of boxes, for patches of a surface near a point, and for corners of another surface near them."""

from __future__ import annotations

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, ahead, dot, minus, put, size_of, vector_at
from ..features.edge_crossing import ASTRAY
from ..features.frames import point_in_body, point_in_world
from .surface_search import box_square, corner_at, in_triangle
from .surface_tables import (
    CORNER,
    CORNERS,
    EDGE,
    EDGES,
    FACE,
    FACES,
    MEMBERS,
    N_EDGES,
    N_NODES,
    N_TRIANGLES,
    NODE,
    NODES,
    TRIANGLE,
    TRIANGLES,
)
from .surface_vertex import leaning

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


@compiled
def room_ahead(reach: float, narrow: float, most: int) -> int:
    """Return the largest number of candidates of a search: ``most`` up to a reach of ``narrow`` [m], else `FEW`."""
    return most if reach <= narrow else min(most, FEW)


@compiled
def seen_from(frame: Floats, other: Floats, point: Vector3) -> Vector3:
    """Return a point of the body ``other`` in the axes of the body ``frame`` [m]."""
    seen: Vector3 = point_in_body(frame, point_in_world(other, point))
    return seen


@compiled
def _is_near(surface: Floats, point: Vector3, reach: float) -> bool:
    """Return True if the box of any leaf of the surface's tree is within ``reach`` [m] of a point."""
    node = 0
    while node < int(surface[N_NODES]):
        at = int(surface[NODES]) + NODE * node
        if box_square(surface, at, *point) > reach * reach:
            node = int(surface[at + 6])
        elif surface[at + 8] > 0.0:
            return True
        else:
            node += 1
    return False


@compiled
def _patch_of(surface: Floats, member: int) -> float:
    """Return the patch of a feature by its number in the tree: triangles, then convex edges, then corners."""
    n_triangles, n_edges = int(surface[N_TRIANGLES]), int(surface[N_EDGES])
    if member < n_triangles:
        t = int(surface[TRIANGLES]) + TRIANGLE * member
        return float(surface[int(surface[FACES]) + FACE * int(surface[t + 9]) + 4])
    if member < n_triangles + n_edges:
        return float(surface[int(surface[EDGES]) + EDGE * (member - n_triangles) + 13])
    return float(surface[int(surface[CORNERS]) + CORNER * (member - n_triangles - n_edges) + 3])


@compiled
def _add_patch(patch: float, kind: float, third: float, first: int, out: Floats, n: int) -> int:
    """Append the candidate (kind, patch, third) to the ``n`` candidates in ``out``; return the number after that.

    It is not appended if a candidate from number ``first`` on already has this patch.
    """
    for known in range(first, n):
        if out[2 + 3 * known] == patch:
            return n
    put(out, 1 + 3 * n, (kind, patch, third))
    return n + 1


@compiled
def patches_near(
    surface: Floats,
    x: float,
    y: float,
    z: float,
    reach: float,
    kind: float,
    third: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Append candidates: the patches with a leaf of the surface's tree within ``reach`` [m] of a point.

    Return the number of candidates after that.  A candidate has three numbers: kind, number of the patch, third number.

    Parameters
    ----------
    surface : Floats
        Numbers of the surface.
    x, y, z, reach : float
        The point in the axes of the surface, and the largest distance from it [m].
    kind, third : float
        The first and the third number of the candidates that are appended.
    out, n, most : Floats, int
        As in :func:`corners_near`.
    """
    members, first, node = int(surface[MEMBERS]), n, 0
    while node < int(surface[N_NODES]) and n <= most:
        at = int(surface[NODES]) + NODE * node
        if box_square(surface, at, x, y, z) > reach * reach:
            node = int(surface[at + 6])
            continue
        for i in range(int(surface[at + 8])):
            if n <= most:
                patch = _patch_of(surface, int(surface[members + int(surface[at + 7]) + i]))
                n = _add_patch(patch, kind, third, first, out, n)
        node += 1
    return n


@compiled
def is_node_near(frame: Floats, other: Floats, surface: Floats, parts: Floats, at: int, reach: float) -> bool:
    """Return False only if a node of the other body's tree is farther than ``reach`` [m] from a surface.

    The node is at index ``at`` of the other body's numbers ``parts``; ``surface`` belongs to the body ``frame``.
    """
    diagonal = minus(vector_at(parts, at + 3), vector_at(parts, at))
    middle = seen_from(frame, other, ahead(vector_at(parts, at), 0.5, diagonal))
    return bool(_is_near(surface, middle, 0.5 * size_of(diagonal) + reach))


@compiled
def patches_under(
    frame: Floats,
    other: Floats,
    surface: Floats,
    place: Vector3,
    n_star: float,
    star: Floats,
    reach: float,
    turn: float,
    kind: float,
    third: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Append the patches of faces that a vertex of the other body may soon touch.

    Return the number of candidates after that.  A face may be touched if it is within ``reach`` [m] of the vertex, and
    if a rotation by ``turn`` [rad] can turn all edges of the vertex out of the face (within ``ASTRAY``).  ``place`` is
    the vertex in the frame of its body [m], ``star`` holds unit vectors along its edges.  The other arguments are those
    of :func:`corners_near` and :func:`patches_near`.
    """
    point = seen_from(frame, other, place)
    members, first, node = int(surface[MEMBERS]), n, 0
    while node < int(surface[N_NODES]) and n <= most:
        at = int(surface[NODES]) + NODE * node
        if box_square(surface, at, *point) > reach * reach:
            node = int(surface[at + 6])
            continue
        for i in range(int(surface[at + 8])):
            member = int(surface[members + int(surface[at + 7]) + i])
            if member >= int(surface[N_TRIANGLES]) or n > most:
                continue
            t = int(surface[TRIANGLES]) + TRIANGLE * member
            f = int(surface[FACES]) + FACE * int(surface[t + 9])
            px, py, pz, _ = in_triangle(surface, t, *point)
            apart = minus(point, (px, py, pz))
            if dot(apart, apart) <= reach * reach and leaning(frame, other, surface, f, n_star, star) <= ASTRAY + turn:
                n = _add_patch(surface[f + 4], kind, third, first, out, n)
        node += 1
    return n


@compiled
def corners_near(
    frame: Floats,
    other: Floats,
    surface: Floats,
    corners: Floats,
    reach: float,
    turn: float,
    kind: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Append candidates: pairs of a corner of the other body and a near patch of the surface in ``frame``.

    Return the number of candidates after that.

    Parameters
    ----------
    frame, other : Floats
        Frame blocks.
    surface, corners : Floats
        Numbers of the surface in ``frame`` and of the surface of the other body.
    reach : float
        Largest distance of corner and patch [m].
    turn : float
        Largest relative rotation of the bodies until the next search [rad].
    kind : float
        The first number of these candidates.
    out : Floats
        Three numbers of each candidate, from index 1 on.
    n, most : int
        Number of candidates so far, and the number after which the search stops.
    """
    first = int(corners[N_TRIANGLES]) + int(corners[N_EDGES])
    members, node = int(corners[MEMBERS]), 0
    while node < int(corners[N_NODES]) and n <= most:
        at = int(corners[NODES]) + NODE * node
        if not is_node_near(frame, other, surface, corners, at, reach):
            node = int(corners[at + 6])
            continue
        for i in range(int(corners[at + 8])):
            corner = int(corners[members + int(corners[at + 7]) + i]) - first
            if corner < 0:
                continue
            n = patches_under(
                frame, other, surface, *corner_at(corners, corner), reach, turn, kind, float(corner), out, n, most
            )
        node += 1
    return n
