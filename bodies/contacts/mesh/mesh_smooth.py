"""A smooth body against a triangle mesh, convex or not; of many patches, only near ones are contacts."""

from __future__ import annotations

from typing import final

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.types import Floats

from ...meshes.patches import patches_for_body
from ...shapes.smooth import SmoothShape, extent
from ...shapes.triangle_mesh import TriangleMesh
from ..features.writing import write_apart
from ..surface.patch_near import patch_contacts
from ..surface.surface_smooth import write_surface_smooth

POINT = 0.0, 0.0, 0.0, 2.0, 2.0, 0.0
"""A point as a core: three semi-axes 0, both powers 2, radius 0 (:func:`bodies.shapes.smooth.core_numbers`)."""


def evaluate_smooth_over_surface(
    a: Floats, b: Floats, out: Floats, candidate: Floats, surface: Floats, second: Floats, point: Floats, size: float
) -> None:
    """Write the geometry block of a smooth body ``second`` and a patch of the mesh, the present candidate.

    ``candidate`` holds a kind (0: no candidate), the number of the patch, an unused number, and the distance up to
    which it is valid [m].  ``point`` is :data:`POINT`.
    """
    if candidate[0] == 0.0:
        write_apart(a, out, size)
    else:
        write_surface_smooth(a, b, out, surface, candidate[1], second, point, candidate[3])


@final
class MeshSmooth(ContactKinematics):
    """The contact of a smooth body with the nearest face, convex edge or corner of each patch of a mesh.

    The patches are made for a body of this size.  If there are many, a search assigns near patches to the contacts.
    """

    pair = TriangleMesh, SmoothShape

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return as many contacts as there are patches."""
        assert isinstance(first, TriangleMesh)
        assert isinstance(second, SmoothShape)
        own, core = first.features, second.core
        ball = core[6], core[7], core[8], extent(core)
        patches, values = patches_for_body(own, 2.0 * ball[3]), {"second": core, "point": POINT}
        return patch_contacts(evaluate_smooth_over_surface, own, patches, ball, values, "smooth")
