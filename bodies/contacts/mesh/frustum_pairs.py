"""A cylinder, cone or disc against a mesh of many features: only features that are near each other are contacts."""

from __future__ import annotations

import itertools

from nonsmooth.compiled import block_at, compiled
from nonsmooth.interfaces import CandidateSearch, FeaturePair
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.patches import patches_for_ball
from ...shapes.frustum import HIGH, HIGH_RADIUS, SIDE, SWEEP, Frustum
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import minus, norm, plus_scaled, vector_at
from ..features.writing import NO_CANDIDATE, write_apart
from ..frustum.frustum import HIGH_RIM, LOW_RIM, apex_of, feet_of, set_back
from ..frustum.frustum_swept import write_rounded_vertex
from ..surface.surface_near import NARROW, patches_near, patches_under, room_ahead
from ..surface.surface_pairs import MOST_NEAR
from ..surface.surface_search import ON_EDGE, ON_FACE, edge_at, feature_of, member_of, node_at
from ..surface.surface_tables import (
    CORNER,
    CORNERS,
    N_MEMBERS,
    N_NODES,
    N_STAR,
    SKIP,
    STAR,
    STARS,
    UPPER,
    star_lengths,
    surface_numbers,
)
from ..surface.surface_vertex import write_sharp_corner
from .apex_mesh import write_apex
from .frustum_corner import write_corner
from .frustum_near import FrustumPose, corner_is_near, edge_is_near, from_core, frustum_in_surface, rim_is_near
from .mesh_crossing import write_across_rim, write_across_side
from .surface_rim import rim_in_surface, rim_over, write_rim

RIM, POINT, APEX, UNDER, ACROSS_FLANK, ACROSS_BACK, ACROSS_FRONT = 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0
"""Kinds of candidates, the first of a candidate's three numbers.

In this order: rim over a face, point over a patch, round apex over a patch, corner of the surface, edge of the surface
across the side, edge across the first half of a rim, edge across the second half.
"""
POINT_ROW, N_DIRECTIONS = 4, 3
"""Floats in the row of a point (foot or apex) before its unit vectors: position (3) [m], number of unit vectors.

``N_DIRECTIONS`` is the offset of this number, which all points of a frustum have in common.
"""


@compiled
def _add(kind: float, second: float, third: float, out: Floats, n: int, most: int) -> int:
    """Append a candidate to the ``n`` candidates in ``out``, unless n exceeds ``most``; return the new number.

    ``kind``, ``second`` and ``third`` are the three numbers of the candidate: its kind and its two features.  One
    candidate more than ``most`` may be appended; it means that there are too many.
    """
    if n > most:
        return n
    out[1 + 3 * n], out[2 + 3 * n], out[3 + 3 * n] = kind, second, third
    return n + 1


@compiled
def _add_face(face: float, upper: float, out: Floats, n: int, most: int) -> int:
    """Append a rim over a face to the ``n`` candidates, unless it is one of them; return their new number.

    A face of several triangles is found once for each of them.  ``upper`` is 1 for the upper rim, 0 for the lower one.
    """
    for i in range(n):
        if out[1 + 3 * i] == RIM and out[2 + 3 * i] == face and out[3 + 3 * i] == upper:
            return n
    return int(_add(RIM, face, upper, out, n, most))


@compiled
def _add_halves(edge: float, rim: int, out: Floats, n: int, most: int) -> int:
    """Append two candidates, an edge of the surface with each half of a rim, to the ``n`` candidates in ``out``.

    ``rim`` is ``LOW_RIM`` or ``HIGH_RIM``.  Nothing is appended if n exceeds ``most``.  Return the new number of
    candidates.
    """
    n = _add(ACROSS_BACK, edge, float(rim), out, n, most)
    return int(_add(ACROSS_FRONT, edge, float(rim), out, n, most))


@compiled
def _member_near(
    surface: Floats,
    member: int,
    frustum: Floats,
    pose: FrustumPose,
    reach: float,
    turn: float,
    size: float,
    out: Floats,
    n: int,
    most: int,
) -> int:
    """Append the candidates of one triangle, edge or corner of the surface that may soon touch the frustum.

    ``member`` counts triangles first, then edges, then corners.  A feature may touch if it is within ``reach`` [m] of
    the core, the frustum without its rounding, and if its normals agree with those of the frustum after a rotation by
    up to ``turn`` [rad], the largest until the next search.  ``size`` is the size of the bodies [m].  ``out`` holds
    ``n`` candidates.  Return the new number of candidates; a number above ``most`` means that there are too many.
    """
    kind, number, row = feature_of(surface, member)
    if kind == ON_FACE:
        for upper in range(2 if frustum[SIDE] > 0.0 and frustum[HIGH_RADIUS] > 0.0 else 1):
            if rim_is_near(surface, row, frustum, upper, pose, reach, turn):
                n = _add_face(float(number), float(upper), out, n, most)
        return n
    if kind == ON_EDGE:
        flank, lower, upper_rim = edge_is_near(surface, row, frustum, pose, reach, turn, size)
        if flank:
            n = _add(ACROSS_FLANK, float(number), 0.0, out, n, most)
        if lower:
            n = _add_halves(float(number), LOW_RIM, out, n, most)
        if upper_rim:
            n = _add_halves(float(number), HIGH_RIM, out, n, most)
        return n
    if corner_is_near(surface, number, frustum, pose, reach, turn, size):
        n = _add(UNDER, float(number), 0.0, out, n, most)
    return n


def find_near_frustum(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    n_points: float,
    points: Floats,
    surface: Floats,
    size: float,
    most: float,
    turning: float,
    narrow: float,
) -> None:
    """Find near features: faces with rims, patches with points and apex, corners, edges with side and rims.

    On entry, ``out[0]`` is the distance up to which features are near [m]; on return, it is the number of candidates
    found, or ``most`` + 1 if there are too many.  A rim has candidates with faces, not with patches, because a patch
    for a body as large as the rim would hold a single face.  ``turning`` is the largest relative rotation of the bodies
    until the next search, per metre of ``out[0]`` [rad/m].  ``most`` is the largest number of candidates; if ``out[0]``
    exceeds ``narrow`` [m], the limit is smaller (:func:`bodies.contacts.surface.surface_near.room_ahead`).
    """
    reach, limit, n, node = out[0], room_ahead(out[0], narrow, int(most)), 0, 0
    turn, sweep = turning * reach, frustum[SWEEP]
    # distances are measured from the core
    core_reach = sweep + reach
    pose = frustum_in_surface(a, b, frustum)
    while node < int(surface[N_NODES]) and n <= limit:
        at = node_at(surface, node)
        corner = vector_at(surface, at)
        diagonal = minus(vector_at(surface, at + UPPER), corner)
        # a ball about the box of the node
        if from_core(frustum, pose, plus_scaled(corner, 0.5, diagonal)) > core_reach + 0.5 * norm(diagonal):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            member = member_of(surface, at, i)
            n = _member_near(surface, member, frustum, pose, core_reach, turn, size, out, n, limit)
        node += 1
    for i in range(int(n_points)):
        row = (POINT_ROW + 3 * int(points[N_DIRECTIONS])) * i
        place, n_star, star = vector_at(points, row), points[row + N_DIRECTIONS], block_at(points, row + POINT_ROW)
        n = patches_under(b, a, surface, place, n_star, star, core_reach, turn, POINT, float(i), out, n, limit)
    # the apex of a rounded cone is a sphere
    if sweep > 0.0 and frustum[SIDE] > 0.0 and frustum[HIGH_RADIUS] == 0.0:
        n = patches_near(surface, plus_scaled(pose[0], frustum[HIGH], pose[1]), core_reach, APEX, 0.0, out, n, limit)
    out[0] = float(n) if n <= limit else most + 1.0


def evaluate_frustum_and_candidate(
    a: Floats,
    b: Floats,
    out: Floats,
    candidate: Floats,
    frustum: Floats,
    rims: Floats,
    points: Floats,
    surface: Floats,
    lengths: Floats,
    size: float,
) -> None:
    """Write the geometry block of a feature of a frustum and a feature of a mesh that is currently near it.

    Parameters
    ----------
    a, b, out, candidate : Floats
        Frame blocks of both bodies, the geometry block, and the pair of features.
    frustum : Floats
        The first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    rims : Floats
        Radius and centre of each rim in the body frame [m].
    points : Floats
        Rows of the feet and of a sharp apex (:data:`POINT_ROW`).
    surface : Floats
        The surface of the second body (:mod:`bodies.contacts.surface.surface_tables`).
    lengths : Floats
        For a disc, lengths of the edges of the surface's corners, one corner after the other [m]; else a single 0.
    size : float
        Size of the larger body [m].
    """
    # kind, numbers of the two features, and distance from the core up to which the candidate is valid
    kind, i, j, reach = candidate[0], int(candidate[1]), int(candidate[2]), frustum[SWEEP] + candidate[3]
    if kind == RIM:
        # the numbers of a rim: radius, centre
        radius, place = rims[4 * j], vector_at(rims, 4 * j + 1)
        gap, past = rim_over(surface, i, frustum, radius, 2.0 * j - 1.0, rim_in_surface(a, b, frustum, place), reach)
        write_rim(a, b, out, frustum, radius, place, surface, i, gap, past)
    elif kind == POINT:
        row = (POINT_ROW + 3 * int(points[N_DIRECTIONS])) * j
        place, n, star = vector_at(points, row), points[row + N_DIRECTIONS], block_at(points, row + POINT_ROW)
        write_sharp_corner(a, b, out, 1.0, surface, float(i), place, n, star, reach, frustum[SWEEP])
    elif kind == APEX:
        write_apex(a, b, out, frustum, surface, float(i), size, reach)
    elif kind == UNDER:
        row = int(surface[CORNERS]) + CORNER * i
        corner, n = block_at(surface, row), surface[row + N_STAR]
        star = block_at(surface, int(surface[STARS]) + int(surface[row + STAR]))
        if frustum[SWEEP] > 0.0:
            write_rounded_vertex(a, b, out, frustum, 0.0, corner, n, star, size)
        else:
            # only a disc uses the lengths of the edges at its corner; for other frustums the table is a single 0
            own = block_at(lengths, int(surface[row + STAR]) // 3 if frustum[SIDE] == 0.0 else 0)
            write_corner(a, b, out, frustum, corner, n, star, own, surface, size)
    elif kind == ACROSS_FLANK:
        write_across_side(a, b, out, frustum, block_at(surface, edge_at(surface, i)), surface, size)
    elif kind == ACROSS_BACK or kind == ACROSS_FRONT:
        edge, half = block_at(surface, edge_at(surface, i)), -1.0 if kind == ACROSS_BACK else 1.0
        write_across_rim(a, b, out, frustum, float(j), half, edge, surface, size)
    else:
        write_apart(a, out, size)


def frustum_pairs(first: Frustum, second: TriangleMesh) -> tuple[FeaturePair, ...]:
    """Return the contacts of a frustum and a mesh: ``MOST_NEAR`` of them, to which a search assigns near pairs."""
    numbers, own, extents = set_back(first), second.features, (first.extent, second.extent)
    points = [*feet_of(first), *(apex_of(first) if numbers[SWEEP] == 0.0 else ())]
    patches = patches_for_ball(own, numbers[SWEEP])
    rows = [(*place, len(star) // 3, *star) for place, star, _ in points]
    lengths = [x for i in range(len(own.corners)) for x in star_lengths(own, i)] if not numbers[SIDE] else []
    values: dict[str, Value] = {
        "frustum": numbers,
        "n_points": float(len(rows)),
        "points": SharedNumbers([*itertools.chain(*rows)] or [0.0]),
        "surface": surface_numbers(own, patches, 0.0),
        "size": max(own.size, 2.0 * first.extent),
        "most": float(MOST_NEAR),
        "turning": 0.5 / extents[0] + 0.5 / extents[1],
        "narrow": NARROW * min(extents),
    }
    n_edges = len(own.edges)
    counts = {
        RIM: (len(own.planes), len(first.standing_rims)),
        POINT: (patches.count, len(rows)),
        APEX: (patches.count, 1),
        UNDER: (len(own.corners), 1),
        ACROSS_FLANK: (n_edges, 1),
        ACROSS_BACK: (n_edges, HIGH_RIM + 1),
        ACROSS_FRONT: (n_edges, HIGH_RIM + 1),
    }
    rims = tuple(x for radius, center in first.standing_rims for x in (radius, *center))
    own_values = {**values, "candidate": NO_CANDIDATE, "rims": rims, "lengths": SharedNumbers(lengths or [0.0])}
    names = tuple(f"feature {i}" for i in range(len(own.planes) + n_edges + len(own.corners)))
    search = CandidateSearch(find_near_frustum, values, counts)
    return tuple(FeaturePair(evaluate_frustum_and_candidate, own_values, names, search) for _ in range(MOST_NEAR))
