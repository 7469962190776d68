"""Contacts of a cylinder, cone or disc with a triangle mesh: a rim with a patch, and the list of all contacts.

The mesh need not be convex.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

from nonsmooth.interfaces import ContactKinematics, Shape
from nonsmooth.parameters import SharedNumbers, Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import patches_for_body
from ...meshes.triangles import Triangles
from ...shapes.cylinder import Cylinder
from ...shapes.frustum import SIDE, SWEEP, Frustum, Point
from ...shapes.triangle_mesh import TriangleMesh
from ..frustum.frustum import apex_of, feet_of, set_back
from ..frustum.frustum_swept import FrustumSwept
from ..surface.mesh_point import PointMesh
from ..surface.surface_tables import Numbers, star_of, surface_numbers
from .apex_mesh import ApexMesh
from .flank_mesh import FlankMesh
from .frustum_corner import FrustumCorner
from .frustum_pairs import FrustumPairs
from .mesh_mesh import are_many
from .rim_mesh import RimMesh
from .surface_rim import rim_in_surface, rim_under, write_rim


def _evaluate(
    a: Floats,
    b: Floats,
    out: Floats,
    frustum: Floats,
    radius: float,
    up: float,
    x: float,
    y: float,
    z: float,
    surface: Floats,
    patch: float,
) -> None:
    pose = rim_in_surface(a, b, frustum, x, y, z)
    face, gap, past = rim_under(surface, patch, frustum, radius, up, pose)
    write_rim(a, b, out, frustum, radius, x, y, z, surface, face, gap, past)


@final
@dataclass(frozen=True)
class FrustumMesh(ContactKinematics):
    """The contact of a rim, at its lowest point, with a patch of a mesh.

    A patch is a group of faces of which the body can touch only one at a time (:mod:`bodies.meshes.patches`).  A
    cylinder, cone or disc has flat faces, the caps, with small feet.  :meth:`between` returns this contact for each rim
    and patch, and further contacts of the two bodies:

    - feet, and the apex of a cone, over the patches;
    - corners of the mesh over the caps and the side;
    - convex edges of the mesh across the side and the rims.

    Whether a contact exists depends only on the mesh next to its points, so the mesh need not be convex.  The surface
    of a rounded body is at a constant distance, the radius of rounding, from a smaller core.  Its apex is a sphere,
    and corners of the mesh also touch its rims and its apex.

    If these contacts are too many, :meth:`between` returns :class:`bodies.contacts.mesh.frustum_pairs.FrustumPairs`
    instead: only features that are near each other become contacts.

    Attributes
    ----------
    frustum : tuple of float
        Dimensions of the first body (:func:`bodies.shapes.frustum.frustum_numbers`).
    radius : float
        Radius of the rim [m].
    center : tuple of float
        Centre of the rim in the body frame [m].
    up : float
        1 for the upper rim, else -1.
    surface : SharedNumbers
        Tables of the mesh (:mod:`bodies.contacts.surface.surface_tables`).
    patch : int
        Index of the patch.
    n_faces : int
        Number of the faces of the mesh.
    """

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (Frustum, TriangleMesh)

    frustum: Numbers
    radius: float
    center: Point
    up: float
    surface: SharedNumbers
    patch: int
    n_faces: int

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a cylinder, and a tetrahedron whose faces its rims meet."""
        corners = ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))
        tetrahedron = Triangles(corners, ((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)), "of the example")
        return {"first": Cylinder(0.1, 0.2), "second": TriangleMesh(tetrahedron)}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[ContactKinematics, ...]:
        """Return the contacts of rims, feet and apex over patches, of corners, and of edges with side and rims."""
        assert isinstance(first, Frustum)
        assert isinstance(second, TriangleMesh)
        own, numbers = second.features, set_back(first)
        sweep, size = first.frustum[SWEEP], max(own.size, 2.0 * first.extent)
        if are_many(len(own.edges) * _crossings(numbers) + len(own.corners)):
            return FrustumPairs.between(first, second)
        rims = tuple(itertools.chain(*(cls._of_rim(first, numbers, i, own) for i in range(len(first.standing_rims)))))
        feet = PointMesh.of_vertices(feet_of(first), own, sweep)
        crossings = *FlankMesh.of_edges(numbers, own, size), *RimMesh.of_edges(numbers, own, size)
        vertices = _rounded_vertices if sweep > 0.0 else _sharp_vertices
        return *rims, *feet, *vertices(first, numbers, own, size), *crossings

    @classmethod
    def _of_rim(cls, first: Frustum, numbers: Numbers, number: int, second: Features) -> Iterator[FrustumMesh]:
        radius, center = first.standing_rims[number]
        if radius > 0.0:
            patches = patches_for_body(second, 2.0 * (radius + numbers[SWEEP]))
            surface = surface_numbers(second, patches)
            # a rim touches faces here; edges and corners have contacts of their own, so skip patches without faces
            for patch in sorted(set(patches.of_faces)):
                yield cls(numbers, radius, center, 2.0 * number - 1.0, surface, patch, len(second.planes))

    def parameters(self) -> dict[str, Value]:
        """Return the dimensions of the frustum and its rim, and the tables of the mesh."""
        x, y, z = self.center
        return {
            "frustum": self.frustum,
            "radius": self.radius,
            "up": self.up,
            "x": x,
            "y": y,
            "z": z,
            "surface": self.surface,
            "patch": float(self.patch),
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The closed form."""
        return _evaluate

    @property
    def features(self) -> tuple[str, ...]:
        """Names of the pairs of features: the rim with each face."""
        rim = "rim" if self.up < 0.0 else "upper rim"
        return tuple(f"{rim} and face {i}" for i in range(self.n_faces))


def _sharp_vertices(
    first: Frustum, numbers: Numbers, second: Features, size: float
) -> tuple[PointMesh | FrustumCorner, ...]:
    """Return the contacts of a sharp apex and of the corners of the mesh."""
    return *PointMesh.of_vertices(apex_of(first), second, 0.0), *FrustumCorner.of_corners(numbers, second, size)


def _rounded_vertices(
    _: Frustum, numbers: Numbers, second: Features, size: float
) -> tuple[ApexMesh | FrustumSwept, ...]:
    """Return the contacts of a rounded apex, a sphere, and of the corners of the mesh."""
    places = second.vertices[list(second.corners)].tolist()
    corners = (
        FrustumSwept(numbers, 0.0, (x, y, z), tuple(star_of(second, i)), size, f"corner {i}")
        for i, (x, y, z) in enumerate(places)
    )
    return *ApexMesh.of_patches(numbers, second, size), *corners


def _crossings(numbers: Numbers) -> int:
    """Return the number of contacts of one edge of a mesh with the side and the half rims of a frustum.

    ``numbers`` are those of the frustum (:func:`bodies.shapes.frustum.frustum_numbers`).
    """
    if numbers[SIDE] == 0.0:
        return 2
    return 5 if numbers[1] > 0.0 else 3
