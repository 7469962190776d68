"""Contacts of two rounded polyhedra or capsules: crossing edges, and the list of all contacts."""

from __future__ import annotations

import itertools
import math
from typing import final

from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polyhedron import SweptPolytope
from ...vectors import dot, plus_scaled, write_vector
from ..features.bounds import edges_bound
from ..features.edge_crossing import CONE_MARGIN, cross_edges, least_round_sine
from ..features.frames import write_tangent
from ..features.overlap_corners import common_direction, crossing_past_corner, part_of_overlap
from ..features.polytope_tables import SWEEP, core_numbers, edge_at, faces_of
from ..features.swept_vertex import END, size_of_both, vertices_over_swept
from ..features.writing import write_principal
from .convex_cores import past_if_convex

MOST_CONTACTS = 4000
"""Largest number of contacts of two shapes without a search.

Two sharp polyhedra with more pairs of features use a search for near pairs.  Rounded polyhedra and frustums with more
are refused.
"""


def evaluate_swept_edges(
    a: Floats, b: Floats, out: Floats, core_a: Floats, core_b: Floats, edge_a: float, edge_b: float, size: float
) -> None:
    """Write the geometry block of two rounded edges of convex cores that cross.

    The cores are those of :func:`bodies.contacts.features.polytope_tables.core_numbers`; ``size`` is the size of the
    bodies [m].
    """
    row_a, row_b, radius_a, radius_b = edge_at(core_a, edge_a), edge_at(core_b, edge_b), core_a[SWEEP], core_b[SWEEP]
    parallel = least_round_sine(radius_a + radius_b, size)
    # the margin ``size`` skips the test of the ends of the edges, which follows below
    crossing = cross_edges(a, b, core_a, row_a, core_b, row_b, parallel, size, size)
    p, e, f, n, gap, past_ends, past = crossing
    if gap < 0.0:
        past = max(past, past_ends + END * size)
        past = past_if_convex(a, b, core_a, row_a, core_b, row_b, crossing, past, parallel, END * size)
    elif past <= 0.0:
        past, direction = past_ends + END * size, common_direction(a, b, *faces_of(core_a), *faces_of(core_b), n)
        # bodies on springs overlap: then the corners of the overlap touch, else the nearest features
        fraction = part_of_overlap(radius_a + radius_b - gap, size)
        if fraction > 0.0 and dot(direction, direction) > 0.0:
            past_corner = crossing_past_corner(a, b, direction, core_a, row_a, core_b, row_b, p, e, f, n, gap, size)
            # a tilt moves the nearest points of nearly parallel edges far past the ends: farther than a quarter of the
            # gap of the cores, the contact ends
            past = (1.0 - fraction) * past + fraction * max(past_corner, past_ends - CONE_MARGIN * gap)
    gap -= radius_a + radius_b
    if past > 0.0 and gap >= 0.0:
        gap = math.hypot(gap, past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    write_vector(out, NORMAL, n)
    write_vector(out, POINT_A, plus_scaled(p, radius_a, n))
    write_vector(out, POINT_B, plus_scaled(plus_scaled(p, radius_a, n), gap, n))
    write_tangent(a, out)
    write_principal(out, SIDE_A, e, 0.0, 1.0, 1.0, radius_a)
    write_principal(out, SIDE_B, f, 0.0, 1.0, 1.0, radius_b)


def bound_of_swept_edges(
    a: Floats, b: Floats, out: Floats, core_a: Floats, core_b: Floats, edge_a: float, edge_b: float, size: float
) -> None:
    """Write by how much the bodies must move before two rounded edges touch [m]."""
    distance = edges_bound(a, b, core_a, edge_at(core_a, edge_a), core_b, edge_at(core_b, edge_b))
    out[0] = distance - core_a[SWEEP] - core_b[SWEEP]


@final
class SweptSwept(ContactKinematics):
    """Contacts of two rounded shapes: pairs of edges that cross, and vertices over the other shape.

    Rounded shapes touch if the distance of their cores is the sum of their radii.  The nearest points belong to a
    vertex and a face, a vertex and an edge, two vertices, or two edges that cross.  So every vertex and every pair of
    edges is a contact of its own, whose features never change.  A face on a face, or an edge on a face, has several
    contacts at once.  A contact whose features are not the nearest ones is open: its distance past the feature's
    boundary is positive.
    """

    pair = SweptPolytope, SweptPolytope

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of pairs of edges, then of the second body's vertices, then of the first's vertices."""
        assert isinstance(first, SweptPolytope)
        assert isinstance(second, SweptPolytope)
        core_a, core_b = first.core, second.core
        if len(core_a.edges) * len(core_b.edges) + len(core_a.vertices) + len(core_b.vertices) > MOST_CONTACTS:
            raise InvalidInput(
                "contact of two polyhedra",
                f"must have at most {MOST_CONTACTS} pairs of features",
                f"{len(core_a.edges)} edges against {len(core_b.edges)} make {len(core_a.edges) * len(core_b.edges)}",
                "Take polyhedra with fewer edges, or a smooth shape.",
            )
        cores = core_numbers(core_a, first.sweep), core_numbers(core_b, second.sweep)
        values: dict[str, Value] = {"core_a": cores[0], "core_b": cores[1], "size": size_of_both(first, second)}
        crossings = (
            FeaturePair(
                evaluate_swept_edges,
                {**values, "edge_a": float(i), "edge_b": float(j)},
                (f"edge {i} and edge {j}",),
                bound=bound_of_swept_edges,
            )
            for i, j in itertools.product(range(len(core_a.edges)), range(len(core_b.edges)))
        )
        return *crossings, *vertices_over_swept(first, second)
