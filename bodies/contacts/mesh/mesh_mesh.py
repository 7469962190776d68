"""Two surfaces that need not be convex: edges across edges, vertices over faces."""

from __future__ import annotations

from typing import final

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape

from ...meshes.features import Features
from ...shapes.triangle_mesh import TriangleMesh
from ..surface.surface_pairs import contacts_each, contacts_near, count_pairs

MOST_EACH = 500
"""Largest number of pairs of features for which each pair is a contact; for more, only near pairs are contacts."""


@final
class MeshMesh(ContactKinematics):
    """Contacts of two meshes: pairs of convex edges that cross, and corners over patches of the other mesh.

    Which contacts can close depends only on the surfaces next to the contact points, so that the bodies need not be
    convex.  If there are hundreds of pairs, only near pairs are contacts.
    """

    pair = TriangleMesh, TriangleMesh

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of pairs of edges, then of the second body's corners, then of the first's corners."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, TriangleMesh)
        return sharp_contacts(first.features, second.features, (first.extent, second.extent))


def sharp_contacts(first: Features, second: Features, extents: tuple[float, float]) -> tuple[FeaturePair, ...]:
    """Return a contact for each pair of features of two surfaces, or for near pairs if there are too many.

    ``extents`` are the radii of balls about the frames of the bodies, which contain them [m].
    """
    if are_many(count_pairs(first, second)):
        return contacts_near(first, second, extents)
    return tuple(contacts_each(first, second))


def are_many(contacts: int) -> bool:
    """Return whether there are too many pairs of features for a contact each; a search then finds near pairs."""
    return contacts > MOST_EACH
