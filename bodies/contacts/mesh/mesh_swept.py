"""Contacts of a polyhedron, sharp or rounded, or a capsule with a triangle mesh, convex or not."""

from __future__ import annotations

from typing import final

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape

from ...shapes.polyhedron import SweptPolytope
from ...shapes.triangle_mesh import TriangleMesh
from ..surface.surface_pairs import features_of_core
from .mesh_mesh import are_many, sharp_contacts
from .swept_pairs import contacts_each, contacts_near


@final
class MeshSwept(ContactKinematics):
    """Contacts of a mesh with a rounded polyhedron or a capsule.

    They are: convex edges of the mesh across rounded edges, or across the side of a capsule; each vertex of the second
    body, as a sphere, with each patch of the mesh; each corner of the mesh with the nearest face, edge or vertex of the
    second body.  A sharp polyhedron has the contacts of two meshes (:class:`bodies.MeshMesh`).  If there are hundreds
    of pairs of features, only near pairs are contacts.
    """

    pair = TriangleMesh, SweptPolytope

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of pairs of edges, then of the second body's vertices, then of the first's corners."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, SweptPolytope)
        own, core = first.features, second.core
        if second.sweep == 0.0:
            return sharp_contacts(own, features_of_core(core), (first.extent, second.extent))
        if are_many(len(own.edges) * len(core.edges) + len(own.corners)):
            return contacts_near(first, second)
        return tuple(contacts_each(first, second))
