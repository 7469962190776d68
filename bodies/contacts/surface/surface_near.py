"""Search, by trees of boxes, for patches of a surface near a point or a vertex."""

from __future__ import annotations

from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats

from ...vectors import Vector3, dot, minus, norm, plus_scaled, vector_at, write_vector
from ..features.edge_crossing import CONE_MARGIN
from ..features.frames import point_in_body, point_in_world, vector_in_body, vector_in_world
from .surface_search import (
    ON_FACE,
    box_square,
    corner_at,
    face_at,
    feature_of,
    in_triangle,
    member_of,
    nearest_in_patch,
    node_at,
    patch_of,
)
from .surface_tables import FACE_PATCH, N_MEMBERS, N_NODES, SKIP, SWEEP, UPPER
from .surface_vertex import descent

OVER_FIRST, OVER_SECOND, EDGE_ACROSS = 1.0, 2.0, 3.0
"""Kinds of candidates, the first of a candidate's three numbers.

In this order: corner of the second body over a patch of the first, corner of the first body over a patch of the second,
two edges.  The numbers of patch and corner, or of the edges of the first and the second body, follow.
"""
Near: TypeAlias = tuple[float, float, int]
"""Largest distance of near features [m], largest rotation of the bodies until the next search [rad], and largest number
of candidates."""
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
    return point_in_body(frame, point_in_world(other, point))


@compiled
def _is_near(surface: Floats, point: Vector3, reach: float) -> bool:
    """Return True if the box of any leaf of the surface's tree is within ``reach`` [m] of a point."""
    node = 0
    while node < int(surface[N_NODES]):
        at = node_at(surface, node)
        if box_square(surface, at, point) > reach * reach:
            node = int(surface[at + SKIP])
        elif surface[at + N_MEMBERS] > 0.0:
            return True
        else:
            node += 1
    return False


@compiled
def _add_patch(patch: float, kind: float, third: float, first: int, out: Floats, n: int) -> int:
    """Append the candidate (kind, patch, third) to the ``n`` candidates in ``out``; return their new number.

    It is not appended if a candidate from number ``first`` on already has this patch.  ``third`` is the number of the
    feature that is over the patch.
    """
    for known in range(first, n):
        if out[2 + 3 * known] == patch:
            return n
    write_vector(out, 1 + 3 * n, (kind, patch, third))
    return n + 1


@compiled
def patches_near(
    surface: Floats,
    point: Vector3,
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
    point, reach : Vector3, float
        The point in the axes of the surface, and the largest distance from it [m].
    kind, third : float
        The first and the third number of the candidates that are appended.
    out : Floats
        Three numbers of each candidate, from index 1 on.
    n, most : int
        Number of candidates so far, and the number after which the search stops.
    """
    first, node = n, 0
    while node < int(surface[N_NODES]) and n <= most:
        at = node_at(surface, node)
        if box_square(surface, at, point) > reach * reach:
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            if n <= most:
                n = _add_patch(patch_of(surface, member_of(surface, at, i)), kind, third, first, out, n)
        node += 1
    return n


@compiled
def is_node_near(frame: Floats, other: Floats, surface: Floats, parts: Floats, at: int, reach: float) -> bool:
    """Return False only if a node of the other body's tree is farther than ``reach`` [m] from a surface.

    The node is at index ``at`` of the other body's numbers ``parts``; ``surface`` belongs to the body ``frame``.
    """
    diagonal = minus(vector_at(parts, at + UPPER), vector_at(parts, at))
    middle = seen_from(frame, other, plus_scaled(vector_at(parts, at), 0.5, diagonal))
    return bool(_is_near(surface, middle, 0.5 * norm(diagonal) + reach))


@compiled
def patches_round(
    frame: Floats,
    other: Floats,
    surface: Floats,
    own: Floats,
    corner: int,
    near: Near,
    kind: float,
    out: Floats,
    n: int,
) -> int:
    """Append the patches that a corner of the other body may soon touch, if one of the two bodies is rounded.

    The corner, a ball, touches a patch if a face is nearest to it, or if none of its edges leads towards the nearest
    point of the patch.  A patch is a candidate if one of these may hold before the next search.  Return the number of
    candidates after that.

    Parameters
    ----------
    frame, other : Floats
        Frame blocks of the body with the surface, and of the body with the corner.
    surface, own, corner : Floats, Floats, int
        The surface, that of the body with the corner, and the number of the corner.
    near : tuple
        Largest gap [m], largest rotation until the next search [rad], largest number of candidates.
    kind : float
        First number of each candidate; the numbers of patch and corner follow.
    out, n : Floats, int
        Candidates so far, and their number.
    """
    place, n_star, star = corner_at(own, corner)
    (margin, turn, most), point, first = near, seen_from(frame, other, place), n
    reach = margin + surface[SWEEP] + own[SWEEP]
    end = patches_near(surface, point, reach, kind, float(corner), out, n, most)
    if end > most:
        # there are more than there is room for, so that not all are known
        return end
    # of all patches within reach, keep in place those that may be touched; patch i is at 2 + 3 i
    for i in range(first, end):
        distance, _, what, _, x, y, z = nearest_in_patch(surface, out[2 + 3 * i], point, reach)
        to_patch = vector_in_body(other, vector_in_world(frame, minus((x, y, z), point)))
        # no product with a unit vector is less
        towards = -distance
        for k in range(int(n_star)):
            towards = max(towards, dot(to_patch, vector_at(star, 3 * k)))
        # the vector to the nearest point of the patch changes by at most margin + turn * distance
        if distance < reach and (what == ON_FACE or distance <= 0.0 or towards <= margin + turn * distance):
            out[2 + 3 * n] = out[2 + 3 * i]
            n += 1
    # the first and the third number of all these candidates are equal
    return n


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
    if a rotation by ``turn`` [rad] can turn all edges of the vertex out of the face (within ``CONE_MARGIN``).
    ``place`` is the vertex in the frame of its body [m], ``star`` holds unit vectors along its edges.  The other
    arguments are those of :func:`patches_near`.
    """
    point = seen_from(frame, other, place)
    first, node = n, 0
    while node < int(surface[N_NODES]) and n <= most:
        at = node_at(surface, node)
        if box_square(surface, at, point) > reach * reach:
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            what, face, t = feature_of(surface, member_of(surface, at, i))
            if what != ON_FACE or n > most:
                continue
            f = face_at(surface, face)
            px, py, pz, _ = in_triangle(surface, t, point)
            apart = minus(point, (px, py, pz))
            is_close = dot(apart, apart) <= reach * reach
            if is_close and descent(frame, other, surface, f, n_star, star) <= CONE_MARGIN + turn:
                n = _add_patch(surface[f + FACE_PATCH], kind, third, first, out, n)
        node += 1
    return n
