"""Contacts of a sphere and a triangle mesh, in closed form; if the mesh has many patches, only with near patches."""

from __future__ import annotations

from typing import final

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.patches import patches_for_ball
from ...shapes.sphere import Sphere
from ...shapes.triangle_mesh import TriangleMesh
from ...vectors import vector_at
from ..features.writing import write_apart
from ..surface.patch_near import patch_contacts
from ..surface.surface_ball import write_ball


def evaluate_sphere_over_surface(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface: Floats, radius: float, place: Floats, size: float
) -> None:
    """Write the geometry block of a sphere, with its centre at ``place`` [m] in its body, and a patch of the mesh.

    ``candidate`` holds a kind (0: no candidate), the number of the patch, an unused number, and the distance up to
    which it is valid [m].
    """
    if candidate[0] == 0.0:
        write_apart(a, out, size)
    else:
        reach = radius + candidate[3]
        write_ball(a, b, out, surface, candidate[1], radius, vector_at(place, 0), 0.0, surface, size, reach)


@final
class MeshSphere(ContactKinematics):
    """The contact of a sphere with the nearest face, convex edge or corner of each patch of a mesh.

    The surface is divided into patches, so that a sphere of this size touches one feature of a patch at a time
    (:mod:`bodies.meshes.patches`).  A convex mesh is one patch; a mesh with inner corners has two or more.  If there
    are many patches, a search assigns near patches to the contacts.
    """

    pair = TriangleMesh, Sphere

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return as many contacts as there are patches."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, Sphere)
        own, radius, place = first.features, second.radius, (second.x, second.y, second.z)
        patches, values = patches_for_ball(own, radius), dict[str, Value](radius=radius, place=place)
        return patch_contacts(evaluate_sphere_over_surface, own, patches, (*place, radius), values, "sphere")
