"""Contacts of two polyhedra: an edge of one with an edge of the other, and a vertex with the other body's faces."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B, TANGENT
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polyhedron import Polyhedron
from ..features.bounds import edges_bound
from ..features.edge_crossing import least_sine
from ..features.polytope_tables import EDGE, ConvexCore
from ..features.vertex_face import CLOSED
from ..features.writing import write_principal
from ..surface.surface_pairs import SurfacePairs, features_of_core
from .convex_cores import cross_convex_edges
from .polyhedron_point import PointPolyhedron, PolyhedronPoint
from .swept_swept import MOST_CONTACTS, SweptSwept


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    edge_a: float,
    edge_b: float,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    n_edges_a: float,
    edges_a: Floats,
    n_edges_b: float,
    edges_b: Floats,
    size: float,
) -> None:
    p, e, f, n, gap, _, past = cross_convex_edges(
        a,
        b,
        edge_a,
        edge_b,
        n_faces_a,
        faces_a,
        n_faces_b,
        faces_b,
        n_vertices_a,
        vertices_a,
        n_vertices_b,
        vertices_b,
        n_edges_a,
        edges_a,
        n_edges_b,
        edges_b,
        least_sine(size),
        CLOSED * size,
        size,
    )
    if past > 0.0 and gap >= 0.0:
        gap = math.hypot(gap, past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    for i in range(3):
        out[NORMAL + i], out[POINT_A + i] = n[i], p[i]
        out[POINT_B + i] = p[i] + gap * n[i]
        # take the edge as tangent: it is fixed to a body. If both edges lie in a face, round-off turns the normal, and
        # a tangent that is computed from the normal would turn with it
        out[TANGENT + i] = e[i]
    write_principal(out, SIDE_A, *e, 0.0, 1.0, 1.0, 0.0)
    write_principal(out, SIDE_B, *f, 0.0, 1.0, 1.0, 0.0)


def _bound(
    a: Floats,
    b: Floats,
    out: Floats,
    edge_a: float,
    edge_b: float,
    n_faces_a: float,
    faces_a: Floats,
    n_faces_b: float,
    faces_b: Floats,
    n_vertices_a: float,
    vertices_a: Floats,
    n_vertices_b: float,
    vertices_b: Floats,
    n_edges_a: float,
    edges_a: Floats,
    n_edges_b: float,
    edges_b: Floats,
    size: float,
) -> None:
    out[0] = edges_bound(a, b, edges_a, EDGE * int(edge_a), edges_b, EDGE * int(edge_b))


@final
@dataclass(frozen=True)
class PolyhedronPolyhedron(ContactKinematics):
    """Contact of an edge of the first polyhedron that crosses an edge of the second.

    Two polyhedra touch with a vertex on a face or with crossing edges; a face on a face is several such contacts at
    once.  So every vertex over the other body's faces, and every pair of edges, is a contact of its own.  Its features
    never change.  A contact whose features do not face each other is open.

    Attributes
    ----------
    cores : tuple of ConvexCore
        Faces, vertices and edges of both bodies.
    number_a, number_b : int
        Numbers of the edges in their bodies.
    size : float
        Size of the larger body [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Polyhedron, Polyhedron)
    departures: ClassVar[Mapping[str, str]] = MappingProxyType(
        dict.fromkeys(
            ("gap rate", "second-order terms"),
            "two given edges face each other in hardly any random pose; the tests make poses from edges that cross",
        )
    )
    cores: tuple[ConvexCore, ConvexCore]
    number_a: int
    number_b: int
    size: float

    def parameters(self) -> dict[str, Value]:
        """Return edges, cores and size."""
        return {
            "edge_a": float(self.number_a),
            "edge_b": float(self.number_b),
            **self.cores[0].values_with_edges("_a"),
            **self.cores[1].values_with_edges("_b"),
            "size": self.size,
        }

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of pairs of edges, then of the second body's vertices, then of the first body's vertices.

        If one of the two is rounded, return the contacts of :class:`bodies.SweptSwept`.  If there are thousands of
        pairs, return contacts that a search assigns to near pairs
        (:class:`bodies.contacts.surface.surface_pairs.SurfacePairs`).
        """
        assert isinstance(first, Polyhedron)
        assert isinstance(second, Polyhedron)
        if first.rounding > 0.0 or second.rounding > 0.0:
            return SweptSwept.between(first, second)
        one, two = first.core, second.core
        size = max(one.size, two.size)
        n = len(one.edges) * len(two.edges) + len(one.vertices) + len(two.vertices)
        if n > MOST_CONTACTS:
            return SurfacePairs.of_surfaces(features_of_core(one), features_of_core(two), (first.extent, second.extent))
        cores = ConvexCore.of(one), ConvexCore.of(two)
        crossings = (cls(cores, i, j, size) for i in range(len(one.edges)) for j in range(len(two.edges)))
        return *crossings, *PolyhedronPoint.of_vertices(cores, size), *PointPolyhedron.of_vertices(cores, size)

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def bound(self) -> Callable[..., None]:
        """Distance of the edges, and of their normals."""
        return _bound

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features, an edge of each body."""
        return (f"edge {self.number_a} and edge {self.number_b}",)
