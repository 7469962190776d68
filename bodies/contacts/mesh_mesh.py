"""Two bodies with flat faces, one or both of them not convex: edges across edges, vertices over faces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, final

import numpy as np

from bodies.contacts.mesh_point import MeshPoint, PointMesh
from bodies.contacts.surface_edges import evaluate_edges
from bodies.contacts.surface_tables import NODE, TRIANGLE, Numbers, edge_row, surface_numbers
from bodies.contacts.swept_swept import MOST_CONTACTS
from bodies.meshes.features import Features, features_of
from bodies.meshes.patches import patches_for_body
from bodies.shapes.polyhedron import Polyhedron
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value

MOST_NUMBERS = 20_000_000
"""Every contact keeps the surfaces that it needs; more numbers in all are refused."""
_DEPARTURES = MappingProxyType(
    dict.fromkeys(
        ("gap rate", "second-order terms"),
        "two given edges face each other in hardly any random pose; the tests make poses from edges that cross",
    )
)


@dataclass(frozen=True)
class _Edges:
    """A convex edge of either body, and their surfaces.

    Attributes
    ----------
    edges : tuple
        The edges (:func:`bodies.contacts.surface_tables.edge_row`).
    surfaces : tuple
        The surfaces (:mod:`bodies.contacts.surface_tables`).
    numbers : tuple of int
        Numbers of the edges.
    size : float
        Size of the larger body [m].
    """

    edges: tuple[Numbers, Numbers]
    surfaces: tuple[Numbers, Numbers]
    numbers: tuple[int, int]
    size: float

    def values(self) -> dict[str, Value]:
        return {
            "edge_a": self.edges[0],
            "edge_b": self.edges[1],
            "surface_a": self.surfaces[0],
            "surface_b": self.surfaces[1],
            "size": self.size,
        }

    @property
    def features(self) -> tuple[str, ...]:
        return (f"edge {self.numbers[0]} and edge {self.numbers[1]}",)


@final
@dataclass(frozen=True)
class MeshMesh(ContactKinematics):
    """Where a convex edge of a mesh crosses one of another mesh.

    Every corner over each patch of the other's faces and every pair of convex edges is a contact of its own.  Which of
    them is one at present is told by what is next to the points alone, so that neither body need be convex.

    Attributes
    ----------
    edges : _Edges
        The edges.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, TriangleMesh)
    departures: ClassVar[Mapping[str, str]] = _DEPARTURES
    edges: _Edges

    def parameters(self) -> dict[str, Value]:
        """Return edges, surfaces and size."""
        return self.edges.values()

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the pairs of edges, then the corners of the second body, then those of the first."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, TriangleMesh)
        one, two = first.features, second.features
        vertices = _vertices(one, two)
        return *(cls(edges) for edges in _crossings(one, two)), *vertices

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_edges

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return self.edges.features


@final
@dataclass(frozen=True)
class MeshPolyhedron(ContactKinematics):
    """Where a convex edge of a mesh crosses an edge of a polyhedron; for the rest as :class:`MeshMesh`.

    Attributes
    ----------
    edges : _Edges
        The edges.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, Polyhedron)
    departures: ClassVar[Mapping[str, str]] = _DEPARTURES
    edges: _Edges

    def parameters(self) -> dict[str, Value]:
        """Return edges, surfaces and size."""
        return self.edges.values()

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the pairs of edges, then the vertices of the second body, then those of the first."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Polyhedron)
        own = second.polytope
        one, two = first.features, features_of(np.array(own.vertices), np.array(own.triangles))
        vertices = _vertices(one, two)
        return *(cls(edges) for edges in _crossings(one, two)), *vertices

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_edges

    @property
    def features(self) -> tuple[str, ...]:
        """The only pair."""
        return self.edges.features


def _vertices(one: Features, two: Features) -> tuple[MeshPoint | PointMesh, ...]:
    """Return the contacts of vertices, if there are not too many contacts in all."""
    crossings = len(one.edges) * len(two.edges)
    if crossings > MOST_CONTACTS:
        raise _too_many(f"{len(one.edges)} convex edges against {len(two.edges)}")
    vertices: tuple[MeshPoint | PointMesh, ...] = (
        *MeshPoint.of_corners(one, two),
        *PointMesh.of_corners(one, two),
    )
    if crossings + len(vertices) > MOST_CONTACTS:
        raise _too_many(f"{crossings} pairs of convex edges and {len(vertices)} of corners and patches")
    numbers = sum(len(vertex.vertex.surface) for vertex in vertices)
    if numbers + crossings * (TRIANGLE + NODE) * (len(one.triangles) + len(two.triangles)) > MOST_NUMBERS:
        raise _too_many(f"{len(one.triangles)} triangles against {len(two.triangles)}")
    return vertices


def _too_many(figure: str) -> InvalidInput:
    return InvalidInput(
        "contact of a mesh that is not convex",
        f"must have at most {MOST_CONTACTS} pairs of features, and {MOST_NUMBERS:.0e} numbers in all",
        figure,
        "Take coarser meshes, or a smooth shape for a rounded body, or a decomposition of the body into convex pieces.",
    )


def _crossings(one: Features, two: Features) -> Iterator[_Edges]:
    surfaces = (
        surface_numbers(one, patches_for_body(one, 0.0)),
        surface_numbers(two, patches_for_body(two, 0.0)),
    )
    rows = [edge_row(two, j) for j in range(len(two.edges))]
    for i in range(len(one.edges)):
        row = edge_row(one, i)
        for j, other in enumerate(rows):
            yield _Edges((row, other), surfaces, (i, j), max(one.size, two.size))
