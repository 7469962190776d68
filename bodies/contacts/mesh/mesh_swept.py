"""Contacts of a polyhedron, sharp or rounded, or a capsule with a triangle mesh, convex or not."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import Value

from ...shapes.polyhedron import SweptPolytope
from ...shapes.triangle_mesh import TriangleMesh
from ..features.polytope_tables import edge_rows
from ..features.polytope_tables import star_of as star_of_vertex
from ..features.swept_vertex import SweptVertex
from ..surface.surface_edges import bound_of_edges, evaluate_edges
from ..surface.surface_pairs import features_of_core
from ..surface.surface_tables import star_of
from .mesh_mesh import DEPARTURES, MeshEdges, are_many, sharp_contacts
from .mesh_sphere import MeshSphere
from .swept_pairs import SweptPairs


@final
@dataclass(frozen=True)
class MeshSwept(ContactKinematics):
    """Contact of a convex edge of a mesh with a rounded edge of a polyhedron, or with the side of a capsule.

    The two bodies have further contacts: each vertex of the second body, as a sphere, with each patch of the mesh, and
    each corner of the mesh with the nearest face, edge or vertex of the second body.  A sharp polyhedron has the
    contacts of two meshes (:class:`bodies.MeshMesh`).  If there are hundreds of pairs of features, only near pairs get
    contacts (:class:`bodies.contacts.mesh.swept_pairs.SweptPairs`).

    Attributes
    ----------
    edges : MeshEdges
        The two edges and the radius.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (TriangleMesh, SweptPolytope)
    departures: ClassVar[Mapping[str, str]] = DEPARTURES
    edges: MeshEdges

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of pairs of edges, then of the second body's vertices, then of the first's corners."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, SweptPolytope)
        own, core = first.features, second.core
        if second.sweep == 0.0:
            return sharp_contacts(cls, own, features_of_core(core), (first.extent, second.extent))
        size = max(own.size, core.size + 2.0 * second.sweep)
        if are_many(len(own.edges) * len(core.edges) + len(own.corners)):
            return SweptPairs.between(first, second)
        own_star = [(place, star_of_vertex(core, i), f"vertex {i}") for i, place in enumerate(core.vertices)]
        balls = MeshSphere.of_balls(own, own_star, second.sweep, size)
        tips = own.vertices[list(own.corners)].tolist()
        stars = [((x, y, z), tuple(star_of(own, i)), f"corner {i}") for i, (x, y, z) in enumerate(tips)]
        corners = SweptVertex.over(second, stars, 0.0, size, True)
        names = [f"edge {j}" for j in range(len(core.edges))] if core.faces else ["side"]
        crossings = MeshEdges.crossings(own, edge_rows(core), names, second.sweep, size)
        return *(cls(pair) for pair in crossings), *balls, *corners

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
        """Name of the only pair of features."""
        return self.edges.features
