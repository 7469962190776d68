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
    one, two, within, parallel = edge_at(core_a, edge_a), edge_at(core_b, edge_b), CLOSED * size, least_sine(size)
    crossing = cross_edges(a, b, core_a, one, core_b, two, parallel, within, size)
    p, e, f, n, gap, _, past = crossing
    past = past_if_convex(a, b, core_a, one, core_b, two, crossing, past, parallel, within)
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
        one, two = first.core, second.core
        if len(one.edges) * len(two.edges) + len(one.vertices) + len(two.vertices) > MOST_CONTACTS:
            return contacts_near(features_of_core(one), features_of_core(two), (first.extent, second.extent))
        return tuple(_each_pair(first, second))


def _each_pair(first: Polyhedron, second: Polyhedron) -> Iterator[FeaturePair]:
    one, two = first.core, second.core
    cores, size = (core_numbers(one), core_numbers(two)), max(one.size, two.size)
    values: dict[str, Value] = {"core_a": cores[0], "core_b": cores[1], "size": size}
    for i, j in itertools.product(range(len(one.edges)), range(len(two.edges))):
        numbers = {**values, "edge_a": float(i), "edge_b": float(j)}
        names = (f"edge {i} and edge {j}",)
        yield FeaturePair(evaluate_convex_edges, numbers, names, None, bound_of_convex_edges)
    for i in range(len(two.vertices)):
        yield vertex_over_faces(0, cores[0], len(one.planes), cores[1], i, size)
    for i in range(len(one.vertices)):
        yield vertex_over_faces(1, cores[1], len(two.planes), cores[0], i, size)
