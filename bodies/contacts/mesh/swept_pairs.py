"""Contacts of a surface and a rounded polyhedron or a capsule: of all pairs of features, or of near ones."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from nonsmooth.compiled import block_at, compiled
from nonsmooth.interfaces import CandidateSearch, FeaturePair
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.patches import Patches, patches_for_ball
from ...shapes.polyhedron import SweptPolytope
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import minus, norm, opposite, plus, plus_scaled, scaled, vector_at, write_vector
from ..features.bounds import edges_bound
from ..features.frames import vector_in_body, vector_in_world
from ..features.polytope_tables import N_EDGES as N_CORE_EDGES
from ..features.polytope_tables import N_FACES, N_STAR, N_VERTICES, STAR, SWEEP, core_numbers, vertex_at
from ..features.polytope_tables import edge_at as core_edge_at
from ..features.polytope_tables import part_names as parts_of_core
from ..features.swept_vertex import write_vertex
from ..features.vertex_face import nearest_of_core
from ..features.writing import NO_CANDIDATE, write_apart
from ..surface.edges_near import edges_across
from ..surface.surface_ball import write_ball
from ..surface.surface_edges import crossing_of, past_surface, write_edges
from ..surface.surface_near import NARROW, Near, patches_near, room_ahead, seen_from
from ..surface.surface_pairs import MOST_NEAR
from ..surface.surface_search import FAR, ON_CORNER, corner_at, edge_at, feature_of, member_of, node_at, steepest
from ..surface.surface_tables import N_MEMBERS, N_NODES, SKIP, UPPER, part_names, surface_numbers

BALL, UNDER, ACROSS = 1.0, 2.0, 3.0
"""Kinds of candidates, the first of a candidate's three numbers; the numbers of its features follow.

BALL: a vertex of the rounded body, with its radius, over a patch of the mesh.  UNDER: a corner of the mesh under the
rounded body.  ACROSS: an edge of the mesh and an edge of the rounded body.
"""


@compiled
def corners_over(a: Floats, b: Floats, surface: Floats, core: Floats, near: Near, out: Floats, n: int) -> int:
    """Append the corners of the first body's surface that may soon touch the second body's core; return the new number.

    A corner touches if a face of the core is nearest to it, or if none of its edges leads towards the nearest point of
    the core.  A corner is a candidate if one of these may hold before the next search.  ``near`` holds the distance
    from the rounded core up to which features are near [m], the largest rotation until the next search [rad], and the
    largest number of candidates.  ``out`` holds ``n`` candidates.
    """
    (reach, turn, most), sweep, node = near, core[SWEEP], 0
    while node < int(surface[N_NODES]) and n <= most:
        at = node_at(surface, node)
        half = scaled(0.5, minus(vector_at(surface, at + UPPER), vector_at(surface, at)))
        # a ball about the box of the node: distance of its middle from the core
        nearest = nearest_of_core(core, seen_from(b, a, plus(vector_at(surface, at), half)))
        if nearest[1] > sweep + reach + norm(half):
            node = int(surface[at + SKIP])
            continue
        for i in range(int(surface[at + N_MEMBERS])):
            kind, corner, row = feature_of(surface, member_of(surface, at, i))
            if kind != ON_CORNER or n > most:
                continue
            number, distance, x, y, z, _ = nearest_of_core(core, seen_from(b, a, vector_at(surface, row)))
            if distance > sweep + reach:
                continue
            to_core = opposite(vector_in_body(a, vector_in_world(b, (x, y, z))))
            # the unit vector to the core's nearest point, times the distance, changes by at most reach + turn *
            # distance
            is_over_face = number < int(core[N_FACES]) or distance <= 0.0
            if is_over_face or distance * steepest(surface, row, to_core) <= reach + turn * distance:
                write_vector(out, 1 + 3 * n, (UNDER, float(corner), 0.0))
                n += 1
        node += 1
    return n


def find_near_swept(
    a: Floats, b: Floats, out: Floats, surface: Floats, core: Floats, most: float, turning: float, narrow: float
) -> None:
    """Find pairs that may soon touch: patch and vertex, corner and core, edge and edge, of the mesh and of the core.

    On entry, ``out[0]`` is the distance up to which features are near [m]; on return, it is the number of pairs found,
    or ``most`` + 1 if there are too many.  ``turning`` is the largest relative rotation of the bodies until the next
    search, per metre of ``out[0]`` [rad/m].  ``most`` is the largest number of pairs; if ``out[0]`` exceeds ``narrow``
    [m], the limit is smaller (:func:`bodies.contacts.surface.surface_near.room_ahead`).
    """
    reach, limit, n = out[0], room_ahead(out[0], narrow, int(most)), 0
    turn, core_reach = turning * reach, core[SWEEP] + reach
    for i in range(int(core[N_VERTICES])):
        point = seen_from(a, b, vector_at(core, vertex_at(core, i)))
        n = patches_near(surface, point, core_reach, BALL, float(i), out, n, limit)
    n = corners_over(a, b, surface, core, (reach, turn, limit), out, n)
    for j in range(int(core[N_CORE_EDGES])):
        row, near = core_edge_at(core, j), (core_reach, turn, limit)
        n = edges_across(a, b, surface, core, row, float(j), near, ACROSS, out, n)
    out[0] = float(n) if n <= limit else most + 1.0


@compiled
def _write_crossing(
    a: Floats, b: Floats, out: Floats, surface: Floats, row_a: int, core: Floats, row_b: int, size: float
) -> None:
    """Write the geometry block of an edge of the first body's surface and an edge of the second body's core.

    The rows of the edges begin at the indices ``row_a`` and ``row_b``; ``size`` is the size of the bodies [m].
    """
    sweep = core[SWEEP]
    crossing = crossing_of(a, b, surface, row_a, core, row_b, sweep, size)
    p, _, _, n, gap, _, past = crossing
    if gap < 0.0 and past <= 0.0:
        # an overlap is real only if the core's point is inside of the surface's body
        past = max(past, past_surface(a, b, surface, core, row_b, (0.0, 0.0), -gap, plus_scaled(p, gap, n)))
    write_edges(a, out, crossing, past, sweep)


def evaluate_swept_features(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface: Floats, core: Floats, size: float
) -> None:
    """Write the geometry block of a feature of a surface and one of a rounded core.

    ``candidate`` holds the kind of the pair, the numbers of its features, and the distance up to which it is valid [m].
    Without a candidate, the contact is written as wide open.
    """
    kind, i, j, sweep = candidate[0], int(candidate[1]), int(candidate[2]), core[SWEEP]
    if kind == BALL:
        row, reach = vertex_at(core, j), sweep + candidate[3]
        n_star, star = core[row + N_STAR], block_at(core, int(core[row + STAR]))
        write_ball(a, b, out, surface, float(i), sweep, vector_at(core, row), n_star, star, size, reach)
    elif kind == UNDER:
        write_vertex(a, b, out, 1.0, core, (0.0, block_at(core, 0)), *corner_at(surface, i), 0.0, size)
    elif kind == ACROSS:
        _write_crossing(a, b, out, surface, edge_at(surface, i), core, core_edge_at(core, j), size)
    else:
        write_apart(a, out, size)


def bound_of_swept_features(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface: Floats, core: Floats, size: float
) -> None:
    """Write by how much the bodies must move before two edges, or a corner and the rounded body, touch [m].

    For edges this includes the turning that is needed (:func:`bodies.contacts.features.bounds.edges_bound`).  For a
    corner it is the distance from the core.  The radius about the core is subtracted from both.  ``candidate`` holds
    the kind, ``ACROSS`` or ``UNDER``, and the numbers of the features; a ``BALL`` has no bound.
    """
    i = int(candidate[1])
    if candidate[0] == ACROSS:
        row = core_edge_at(core, candidate[2])
        out[0] = edges_bound(a, b, surface, edge_at(surface, i), core, row) - core[SWEEP]
    else:
        place, _, _ = corner_at(surface, i)
        out[0] = nearest_of_core(core, seen_from(b, a, place))[1] - core[SWEEP]


def _values(first: TriangleMesh, second: SweptPolytope) -> tuple[dict[str, Value], Patches]:
    """Return the parameters of the evaluator, without a candidate, and the patches of the mesh."""
    own, core, sweep = first.features, second.core, second.sweep
    patches, size = patches_for_ball(own, sweep), max(own.size, core.size + 2.0 * sweep)
    return {"surface": surface_numbers(own, patches, 0.0), "core": core_numbers(core, sweep), "size": size}, patches


def contacts_each(first: TriangleMesh, second: SweptPolytope) -> Iterator[FeaturePair]:
    """Yield the contacts of pairs of edges, then of the second body's vertices, then of the mesh's corners."""
    (values, patches), own, core = _values(first, second), first.features, second.core
    parts, bound = parts_of_core(core), bound_of_swept_features

    def of_pair(kind: float, i: int, j: int) -> dict[str, Value]:
        """Return the parameters for one pair of features, without a limit of the distance."""
        return {**values, "candidate": (kind, float(i), float(j), FAR)}

    # the edge of a capsule's segment is its side
    side = [f"edge {j}" for j in range(len(core.edges))] if core.planes else ["side"]
    for i, j in itertools.product(range(len(own.edges)), range(len(core.edges))):
        edges = (f"edge {i} and {side[j]}",)
        yield FeaturePair(evaluate_swept_features, of_pair(ACROSS, i, j), edges, None, bound)
    for j, i in itertools.product(range(len(core.vertices)), range(patches.count)):
        names = tuple(f"{part} and vertex {j}" for part in part_names(own))
        yield FeaturePair(evaluate_swept_features, of_pair(BALL, i, j), names)
    for i in range(len(own.corners)):
        names = tuple(f"corner {i} and {part}" for part in parts)
        yield FeaturePair(evaluate_swept_features, of_pair(UNDER, i, 0), names, bound=bound)


def contacts_near(first: TriangleMesh, second: SweptPolytope) -> tuple[FeaturePair, ...]:
    """Return contacts to which a search assigns pairs of near features, as the bodies move."""
    (values, patches), own, core = _values(first, second), first.features, second.core
    extents = first.extent, second.extent
    search_values = {
        **{key: values[key] for key in ("surface", "core")},
        "most": float(MOST_NEAR),
        "turning": 0.5 / extents[0] + 0.5 / extents[1],
        "narrow": NARROW * min(extents),
    }
    counts = {
        BALL: (patches.count, len(core.vertices)),
        UNDER: (len(own.corners), 1),
        ACROSS: (len(own.edges), len(core.edges)),
    }
    search = CandidateSearch(find_near_swept, search_values, counts)
    n = max(len(own.planes) + len(own.edges) + len(own.corners), len(parts_of_core(core)))
    names = tuple(f"feature {i}" for i in range(n))
    return (FeaturePair(evaluate_swept_features, {**values, "candidate": NO_CANDIDATE}, names, search),) * MOST_NEAR
