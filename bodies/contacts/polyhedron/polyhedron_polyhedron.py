"""Contacts of two polyhedra: an edge of one with an edge of the other, and a vertex with the other body's faces."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import final

from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B, TANGENT
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polyhedron import Polyhedron
from ...vectors import plus_scaled, write_vector
from ..features.bounds import edges_bound
from ..features.edge_crossing import cross_edges, least_sine
from ..features.polytope_tables import core_numbers, edge_at
from ..features.vertex_face import CLOSED
from ..features.writing import write_principal
from ..surface.surface_pairs import contacts_near, features_of_core
from .convex_cores import past_if_convex
from .polyhedron_point import vertex_over_faces
from .swept_swept import MOST_CONTACTS, SweptSwept


def evaluate_convex_edges(
    a: Floats, b: Floats, out: Floats, core_a: Floats, core_b: Floats, edge_a: float, edge_b: float, size: float
) -> None:
    """Write the geometry block of two sharp edges of convex cores that cross; ``size`` is the size of the bodies [m].

    The cores are those of :func:`bodies.contacts.features.polytope_tables.core_numbers`.
    """
    row_a, row_b, margin, parallel = edge_at(core_a, edge_a), edge_at(core_b, edge_b), CLOSED * size, least_sine(size)
    crossing = cross_edges(a, b, core_a, row_a, core_b, row_b, parallel, margin, size)
    p, e, f, n, gap, _, past = crossing
    past = past_if_convex(a, b, core_a, row_a, core_b, row_b, crossing, past, parallel, margin)
    # past the boundary the gap is the distance to the feature; a negative gap is kept, for another contact takes over
    if past > 0.0 and gap >= 0.0:
        gap = math.hypot(gap, past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    write_vector(out, NORMAL, n)
    write_vector(out, POINT_A, p)
    write_vector(out, POINT_B, plus_scaled(p, gap, n))
    # take the edge as tangent: it is fixed to a body. If both edges lie in a face, round-off turns the normal, and a
    # tangent that is computed from the normal would turn with it
    write_vector(out, TANGENT, e)
    write_principal(out, SIDE_A, e, 0.0, 1.0, 1.0, 0.0)
    write_principal(out, SIDE_B, f, 0.0, 1.0, 1.0, 0.0)


def bound_of_convex_edges(
    a: Floats, b: Floats, out: Floats, core_a: Floats, core_b: Floats, edge_a: float, edge_b: float, size: float
) -> None:
    """Write by how much the bodies must move before two edges touch [m]."""
    out[0] = edges_bound(a, b, core_a, edge_at(core_a, edge_a), core_b, edge_at(core_b, edge_b))


@final
class PolyhedronPolyhedron(ContactKinematics):
    """Contacts of two polyhedra: pairs of edges that cross, and vertices over the faces of the other body.

    A face on a face is several such contacts at once.  So every vertex over the other body's faces, and every pair of
    edges, is a contact of its own.  Its features never change.  A contact whose features do not face each other is
    open.  Rounded polyhedra have the contacts of :class:`bodies.SweptSwept`.  If there are thousands of pairs, a search
    assigns near pairs to the contacts.
    """

    pair = Polyhedron, Polyhedron

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of pairs of edges, then of the second body's vertices, then of the first body's."""
        assert isinstance(first, Polyhedron)
        assert isinstance(second, Polyhedron)
        if first.rounding > 0.0 or second.rounding > 0.0:
            return SweptSwept.between(first, second)
        core_a, core_b = first.core, second.core
        if len(core_a.edges) * len(core_b.edges) + len(core_a.vertices) + len(core_b.vertices) > MOST_CONTACTS:
            return contacts_near(features_of_core(core_a), features_of_core(core_b), (first.extent, second.extent))
        return tuple(_each_pair(first, second))


def _each_pair(first: Polyhedron, second: Polyhedron) -> Iterator[FeaturePair]:
    """Yield the contacts of two sharp polyhedra, in the order of :meth:`PolyhedronPolyhedron.between`."""
    core_a, core_b = first.core, second.core
    numbers, size = (core_numbers(core_a), core_numbers(core_b)), max(core_a.size, core_b.size)
    values: dict[str, Value] = {"core_a": numbers[0], "core_b": numbers[1], "size": size}
    for i, j in itertools.product(range(len(core_a.edges)), range(len(core_b.edges))):
        edge_values = {**values, "edge_a": float(i), "edge_b": float(j)}
        names = (f"edge {i} and edge {j}",)
        yield FeaturePair(evaluate_convex_edges, edge_values, names, None, bound_of_convex_edges)
    for i in range(len(core_b.vertices)):
        yield vertex_over_faces(0, numbers[0], len(core_a.planes), numbers[1], i, size)
    for i in range(len(core_a.vertices)):
        yield vertex_over_faces(1, numbers[1], len(core_b.planes), numbers[0], i, size)
