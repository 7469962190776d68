"""Two surfaces that need not be convex: edges across edges, vertices over faces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value

from ...meshes.features import Features
from ...meshes.patches import patches_for_ball
from ...shapes.triangle_mesh import TriangleMesh
from ..surface.mesh_point import MeshPoint, PointMesh
from ..surface.surface_edges import bound_of_edges, evaluate_edges
from ..surface.surface_pairs import SurfacePairs
from ..surface.surface_tables import Numbers, edge_row

MOST_EACH = 500
"""Largest number of pairs of features for which each pair is a contact; for more, only near pairs are contacts."""
DEPARTURES = MappingProxyType(
    dict.fromkeys(
        ("gap rate", "second-order terms"),
        "two given edges face each other in hardly any random pose; the tests make poses from edges that cross",
    )
)


@dataclass(frozen=True)
class MeshEdges:
    """A convex edge of each body, and the radius of the second edge.

    Attributes
    ----------
    edges : tuple
        The edges (:func:`bodies.contacts.surface.surface_tables.edge_row`).
    radius : float
        Radius of the cylinder about the second edge [m]; 0 if the second body is not rounded.
    size : float
        Size of the larger body [m].
    names : tuple of str
        Names of the edges.
    """

    edges: tuple[Numbers, Numbers]
    radius: float
    size: float
    names: tuple[str, str]

    @classmethod
    def crossings(
        cls, first: Features, rows: Sequence[Numbers], names: Sequence[str], radius: float, size: float
    ) -> Iterator[MeshEdges]:
        """Return all pairs of a convex edge of a mesh and an edge of another body."""
        for i in range(len(first.edges)):
            row = edge_row(first, i)
            for other, name in zip(rows, names, strict=True):
                yield cls((row, other), radius, size, (f"edge {i}", name))

    def values(self) -> dict[str, Value]:
        """Return edges, radius and size, by the names of the evaluator's arguments."""
        return {
            "edge_a": self.edges[0],
            "edge_b": self.edges[1],
            "radius": self.radius,
            "size": self.size,
        }

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features, an edge of each body."""
        return (f"{self.names[0]} and {self.names[1]}",)


@final
@dataclass(frozen=True)
class MeshMesh(ContactKinematics):
    """Contact of a convex edge of a mesh that crosses a convex edge of another mesh.

    Two meshes have a contact for every pair of convex edges, and one for every corner over every patch of the other
    mesh.  Which contacts can close depends only on the surfaces next to the contact points, so that the bodies need not
    be convex.  If there are hundreds of pairs, near pairs only are contacts
    (:class:`bodies.contacts.surface.surface_pairs.SurfacePairs`).

    Attributes
    ----------
    edges : MeshEdges
        The edges.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, TriangleMesh)
    departures: ClassVar[Mapping[str, str]] = DEPARTURES
    edges: MeshEdges

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of pairs of edges, then of the second body's corners, then of the first's corners."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, TriangleMesh)
        return sharp_contacts(cls, first.features, second.features, (first.extent, second.extent))

    def parameters(self) -> dict[str, Value]:
        """Return edges, radius and size."""
        return self.edges.values()

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return evaluate_edges

    @property
    def bound(self) -> Callable[..., None]:
        """Distance of the edges, and of their normals."""
        return bound_of_edges

    @property
    def features(self) -> tuple[str, ...]:
        """Name of the only pair of features, an edge of each body."""
        return self.edges.features


def sharp_contacts(
    kind: Callable[[MeshEdges], ContactKinematics], one: Features, two: Features, extents: tuple[float, float]
) -> tuple[ContactKinematics, ...]:
    """Return the contacts of two surfaces: pairs of edges, then the second's corners, then the first's corners.

    If there are more than :data:`MOST_EACH` pairs, return contacts that a search assigns to near pairs of features.

    Parameters
    ----------
    kind : callable
        Function that makes a contact from two edges, such as a class of contacts.
    one, two : Features
        The surfaces.
    extents : tuple of float
        Radii about the frames of the bodies [m].
    """
    crossings = len(one.edges) * len(two.edges)
    patches = (patches_for_ball(features, 0.0).count for features in (two, one))
    corners = sum(len(own.corners) * count for own, count in zip((one, two), patches, strict=True))
    if are_many(crossings + corners):
        return SurfacePairs.of_surfaces(one, two, extents)
    rows = [edge_row(two, j) for j in range(len(two.edges))]
    names = [f"edge {j}" for j in range(len(two.edges))]
    edges = MeshEdges.crossings(one, rows, names, 0.0, max(one.size, two.size))
    return *map(kind, edges), *MeshPoint.of_corners(one, two), *PointMesh.of_corners(one, two)


def are_many(contacts: int) -> bool:
    """Return whether there are too many pairs of features for a contact each, so that near pairs are searched for."""
    return contacts > MOST_EACH
