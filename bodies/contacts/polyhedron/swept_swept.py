"""Contacts of two rounded polyhedra or capsules: crossing edges, and the list of all contacts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.engine.memory.blocks import FEATURE, GAP, NORMAL, PAST_END, POINT_A, POINT_B, SIDE_A, SIDE_B
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...shapes.polyhedron import SweptPolytope
from ..features.bounds import edges_bound
from ..features.edge_crossing import ASTRAY, PARALLEL, cross_edges
from ..features.frames import write_tangent
from ..features.overlap_corners import common_direction, crossing_past_corner, part_of_overlap
from ..features.polytope_tables import EDGE, ConvexCore
from ..features.swept_vertex import END, SweptVertex, size_of
from ..features.writing import write_principal
from .convex_cores import cross_convex_edges

MOST_CONTACTS = 4000
"""Largest number of contacts of two shapes without a search.

Two sharp polyhedra with more pairs of features use a search for near pairs.  Rounded polyhedra and frustums with more
are refused.
"""


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
    radius_a: float,
    radius_b: float,
    size: float,
) -> None:
    at_a, at_b = EDGE * int(edge_a), EDGE * int(edge_b)
    # the margin ``size`` skips the test of the ends of the edges, which follows below
    p, e, f, n, gap, over, past = cross_edges(a, b, edges_a, at_a, edges_b, at_b, PARALLEL, size, size)
    if gap < 0.0:
        found = cross_convex_edges(
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
            PARALLEL,
            -END * size,
            size,
        )
        past = found[6]
    elif past <= 0.0:
        past, u = over + END * size, common_direction(a, b, n_faces_a, faces_a, n_faces_b, faces_b, *n)
        # bodies on springs overlap: then the corners of the overlap touch, else the nearest features
        part = part_of_overlap(radius_a + radius_b - gap, size)
        if part > 0.0 and u[0] * u[0] + u[1] * u[1] + u[2] * u[2] > 0.0:
            beyond = crossing_past_corner(a, b, u, edges_a, at_a, edges_b, at_b, p, e, f, n, gap, size)
            # a tilt moves the nearest points of nearly parallel edges far past the ends: farther than a quarter of the
            # gap of the cores, the contact ends
            past = (1.0 - part) * past + part * max(beyond, over - ASTRAY * gap)
    gap -= radius_a + radius_b
    if past > 0.0 and gap >= 0.0:
        gap = math.hypot(gap, past)
    out[GAP], out[FEATURE], out[PAST_END] = gap, 0.0, past
    for i in range(3):
        out[NORMAL + i], out[POINT_A + i] = n[i], p[i] + radius_a * n[i]
        out[POINT_B + i] = out[POINT_A + i] + gap * n[i]
    write_tangent(a, out)
    write_principal(out, SIDE_A, *e, 0.0, 1.0, 1.0, radius_a)
    write_principal(out, SIDE_B, *f, 0.0, 1.0, 1.0, radius_b)


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
    radius_a: float,
    radius_b: float,
    size: float,
) -> None:
    distance = edges_bound(a, b, edges_a, EDGE * int(edge_a), edges_b, EDGE * int(edge_b))
    out[0] = distance - radius_a - radius_b


@final
@dataclass(frozen=True)
class SweptSwept(ContactKinematics):
    """Contact of a rounded edge of the first shape that crosses a rounded edge of the second.

    Rounded shapes touch if the distance of their cores is the sum of their radii.  The nearest points belong to a
    vertex and a face, a vertex and an edge, two vertices, or two edges that cross.  So every vertex and every pair of
    edges is a contact of its own, whose features never change.  A face on a face, or an edge on a face, has several
    contacts at once.  A contact whose features are not the nearest ones is open: its distance past the feature's
    boundary is positive.

    Attributes
    ----------
    cores : tuple of ConvexCore
        Faces, vertices and edges of both cores.
    number_a, number_b : int
        Numbers of the edges in their shapes.
    radius_a, radius_b : float
        Radii about the edges [m].
    size : float
        Size of the bodies [m].
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (SweptPolytope, SweptPolytope)
    cores: tuple[ConvexCore, ConvexCore]
    number_a: int
    number_b: int
    radius_a: float
    radius_b: float
    size: float

    def parameters(self) -> dict[str, Value]:
        """Return edges, cores, radii and size."""
        return {
            "edge_a": float(self.number_a),
            "edge_b": float(self.number_b),
            **self.cores[0].values_with_edges("_a"),
            **self.cores[1].values_with_edges("_b"),
            "radius_a": self.radius_a,
            "radius_b": self.radius_b,
            "size": self.size,
        }

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of pairs of edges, then of the second body's vertices, then of the first's vertices."""
        assert isinstance(first, SweptPolytope)
        assert isinstance(second, SweptPolytope)
        one, two = first.core, second.core
        n = len(one.edges) * len(two.edges) + len(one.vertices) + len(two.vertices)
        if n > MOST_CONTACTS:
            raise InvalidInput(
                "contact of two polyhedra",
                f"must have at most {MOST_CONTACTS} pairs of features",
                f"{len(one.edges)} edges against {len(two.edges)} make {n}",
                "Take polyhedra with fewer edges, or a smooth shape.",
            )
        cores, radii = (ConvexCore.of(one), ConvexCore.of(two)), (first.sweep, second.sweep)
        size = size_of(first, second)
        crossings = (cls(cores, i, j, *radii, size) for i in range(len(one.edges)) for j in range(len(two.edges)))
        return *crossings, *SweptVertex.between(first, second)

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
        """Name of the only pair of features."""
        return (f"edge {self.number_a} and edge {self.number_b}",)
