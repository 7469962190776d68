"""Contacts of two sharp surfaces: corners over patches, and edges across edges, of all features or of near ones."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.interfaces import CandidateSearch, FeaturePair
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.features import Features, features_of
from ...meshes.patches import patches_for_ball
from ...shapes.polytope import Polytope
from ...vectors import plus_scaled
from ..features.bounds import edges_bound
from ..features.writing import NO_CANDIDATE, write_apart
from .edges_near import edges_across
from .mesh_point import write_over
from .surface_edges import crossing_of, past_surface, write_edges
from .surface_near import EDGE_ACROSS, OVER_FIRST, OVER_SECOND, Near, is_node_near, patches_under
from .surface_search import FAR, ON_CORNER, ON_EDGE, beyond_ends, corner_at, edge_at, feature_of, member_of, node_at
from .surface_tables import N_MEMBERS, N_NODES, SKIP, surface_numbers

MOST_NEAR = 256
"""Largest number of pairs of features of two bodies that may be near each other at a time."""


@compiled
def _features_near(
    frame: Floats, other: Floats, surface: Floats, parts: Floats, near: Near, kind: float, out: Floats, n: int
) -> int:
    """Append pairs of a feature of the other body and a near one of the surface in ``frame``; return their new number.

    The features are two edges, or a corner and a patch, by the ``kind`` of the candidates.  ``parts`` are the numbers
    of the surface of the other body.  ``out`` holds ``n`` candidates.
    """
    (reach, turn, most), node = near, 0
    while node < int(parts[N_NODES]) and n <= most:
        at = node_at(parts, node)
        if not is_node_near(frame, other, surface, parts, at, reach):
            node = int(parts[at + SKIP])
            continue
        for i in range(int(parts[at + N_MEMBERS])):
            what, number, row = feature_of(parts, member_of(parts, at, i))
            third = float(number)
            if what == ON_EDGE and kind == EDGE_ACROSS:
                n = edges_across(frame, other, surface, parts, row, third, near, kind, out, n)
            elif what == ON_CORNER and kind != EDGE_ACROSS:
                corner = corner_at(parts, number)
                n = patches_under(frame, other, surface, *corner, reach, turn, kind, third, out, n, most)
        node += 1
    return n


def find_near_features(
    a: Floats, b: Floats, out: Floats, surface_a: Floats, surface_b: Floats, most: float, turning: float
) -> None:
    """Write near pairs to ``out`` as candidates: corners of b over patches of a, those of a over b, and two edges.

    At most ``most`` + 1 candidates are written, one more than there are contacts.  On entry ``out[0]`` is the largest
    distance of a pair [m], on return the number of candidates.  The largest relative rotation of the bodies until the
    next search is ``turning`` [rad/m] times this distance.
    """
    near = out[0], turning * out[0], int(most)
    n = _features_near(a, b, surface_a, surface_b, near, OVER_FIRST, out, 0)
    n = _features_near(b, a, surface_b, surface_a, near, OVER_SECOND, out, n)
    out[0] = float(_features_near(a, b, surface_a, surface_b, near, EDGE_ACROSS, out, n))


@compiled
def _write_crossing(
    a: Floats, b: Floats, out: Floats, surface_a: Floats, row_a: int, surface_b: Floats, row_b: int, size: float
) -> None:
    """Write the geometry block of two sharp edges that cross; their rows begin at the indices ``row_a`` and ``row_b``.

    Edges that overlap between their ends touch only if no face of the other body is less deep below either edge: else
    that face is the contact, and this one is past its end.  ``size`` is the size of the bodies [m].
    """
    crossing = crossing_of(a, b, surface_a, row_a, surface_b, row_b, 0.0, size)
    p, _, _, n, gap, _, past = crossing
    if gap < 0.0 and past <= 0.0:
        past = max(past, past_surface(b, a, surface_b, surface_a, row_a, beyond_ends(surface_a, row_a), -gap, p))
        q = plus_scaled(p, gap, n)
        past = max(past, past_surface(a, b, surface_a, surface_b, row_b, beyond_ends(surface_b, row_b), -gap, q))
    write_edges(a, out, crossing, past, 0.0)


def evaluate_surface_features(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface_a: Floats, surface_b: Floats, size: float
) -> None:
    """Write the geometry block of a corner over a patch, or of two edges.

    ``candidate`` holds the kind of the pair, the numbers of its two features, and the distance up to which it is valid
    [m].  The surfaces are those of :mod:`bodies.contacts.surface.surface_tables`; ``size`` is the size of the larger
    body [m].
    """
    kind, i, j, reach = candidate[0], int(candidate[1]), int(candidate[2]), candidate[3]
    if kind == OVER_FIRST:
        write_over(a, b, out, 0.0, surface_a, float(i), *corner_at(surface_b, j), reach, 0.0)
    elif kind == OVER_SECOND:
        write_over(a, b, out, 1.0, surface_b, float(i), *corner_at(surface_a, j), reach, 0.0)
    elif kind == EDGE_ACROSS:
        _write_crossing(a, b, out, surface_a, edge_at(surface_a, i), surface_b, edge_at(surface_b, j), size)
    else:
        write_apart(a, out, size)


def bound_of_surface_edges(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface_a: Floats, surface_b: Floats, size: float
) -> None:
    """Write by how much the bodies must move before the two edges of a candidate touch [m]."""
    one, two = edge_at(surface_a, int(candidate[1])), edge_at(surface_b, int(candidate[2]))
    out[0] = edges_bound(a, b, surface_a, one, surface_b, two)


def _values(one: Features, two: Features) -> tuple[dict[str, Value], int, int]:
    """Return the surfaces and the size by the names of the evaluator's arguments, and the numbers of patches."""
    divided = [patches_for_ball(features, 0.0) for features in (one, two)]
    surfaces = surface_numbers(one, divided[0], 0.0), surface_numbers(two, divided[1], 0.0)
    values: dict[str, Value] = {"surface_a": surfaces[0], "surface_b": surfaces[1], "size": max(one.size, two.size)}
    return values, divided[0].count, divided[1].count


def count_pairs(one: Features, two: Features) -> int:
    """Return the number of pairs of features of two surfaces."""
    over = sum(len(own.corners) * patches_for_ball(other, 0.0).count for own, other in ((one, two), (two, one)))
    return len(one.edges) * len(two.edges) + over


def contacts_each(one: Features, two: Features) -> Iterator[FeaturePair]:
    """Yield the contacts of pairs of edges, then of the second surface's corners, then of the first's corners."""
    values, *counts = _values(one, two)
    for i, j in itertools.product(range(len(one.edges)), range(len(two.edges))):
        numbers = {**values, "candidate": (EDGE_ACROSS, float(i), float(j), FAR)}
        edges = (f"edge {i} and edge {j}",)
        yield FeaturePair(evaluate_surface_features, numbers, edges, None, bound_of_surface_edges)
    for kind, own, other, count in ((OVER_FIRST, one, two, counts[0]), (OVER_SECOND, two, one, counts[1])):
        for j, i in itertools.product(range(len(other.corners)), range(count)):
            names = tuple(f"face {face} and vertex {j}" for face in range(len(own.planes)))
            numbers = {**values, "candidate": (kind, float(i), float(j), FAR)}
            yield FeaturePair(evaluate_surface_features, numbers, names)


def contacts_near(one: Features, two: Features, extents: tuple[float, float]) -> tuple[FeaturePair, ...]:
    """Return contacts to which a search assigns pairs of near features, as the bodies move.

    Parameters
    ----------
    one, two : Features
        The surfaces.
    extents : tuple of float
        Radii about the frames of the bodies [m].
    """
    values, *counts = _values(one, two)
    surfaces = {key: values[key] for key in ("surface_a", "surface_b")}
    search = CandidateSearch(
        find_near_features,
        {**surfaces, "most": float(MOST_NEAR), "turning": 0.5 / extents[0] + 0.5 / extents[1]},
        {
            OVER_FIRST: (counts[0], len(two.corners)),
            OVER_SECOND: (counts[1], len(one.corners)),
            EDGE_ACROSS: (len(one.edges), len(two.edges)),
        },
    )
    # a face under a corner, by its number in either surface, or two edges
    names = tuple(f"face {i}" for i in range(max(len(one.planes), len(two.planes))))
    numbers = {**values, "candidate": NO_CANDIDATE}
    return (FeaturePair(evaluate_surface_features, numbers, names, search),) * MOST_NEAR


def features_of_core(core: Polytope) -> Features:
    """Return the surface of a polyhedron."""
    return features_of(np.array(core.vertices), np.array(core.triangles))
