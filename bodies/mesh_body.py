"""MeshBody: a solid body with the surface of a mesh."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector

from .free import TensorBody
from .inertia import density_field, mass_field, mass_of, tensor_in
from .meshes.decomposition import Decomposition
from .meshes.mesh import Mesh, Surface, check_surface_of
from .shapes.hull import ConvexHull
from .shapes.polytope import MOST_VERTICES
from .shapes.triangle_mesh import TriangleMesh


@final
@dataclass(frozen=True)
class MeshBody(TensorBody):
    """A free solid with the surface of a mesh.

    Its frame has the axes of the mesh and its origin at the mass centre; :attr:`centre` is the mass centre in the
    mesh's coordinates. Mass properties are those of the mesh, also if convex pieces take its place in contacts.

    Attributes
    ----------
    surface : Surface
        A :class:`bodies.MeshFile` or :class:`bodies.Triangles`.
    decomposition : Decomposition, optional
        Method that cuts a surface that is not convex into convex pieces.  By default the surface itself is in contact.

    Raises
    ------
    InvalidInput
        The user gave both mass and density, or a decomposition for a convex surface.
    """

    surface: Surface
    density: float | None = density_field()
    mass: float | None = mass_field()
    decomposition: Decomposition | None = None

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a tetrahedron."""
        return TriangleMesh.example()

    def _check(self) -> None:
        check_surface_of("MeshBody", self.surface)
        if self.decomposition is not None and self.mesh.is_convex:
            raise InvalidInput(
                "MeshBody.decomposition",
                "must be left out for a convex mesh, which is one piece",
                f"{self.mesh.name}, {self.mesh.volume_ratio:.6f} of its hull's volume",
                "Leave it out.",
            )

    @property
    def mesh(self) -> Mesh:
        """The checked mesh."""
        return self.surface.mesh

    @property
    def centre(self) -> Vector:
        """The mass centre in the coordinates of the mesh [m], shape [3]."""
        return self.mesh.centroid

    @property
    def total_mass(self) -> float:
        """Mass as given, or density times volume [kg]."""
        return mass_of(self, self.mass, self.density, self.mesh.volume)

    @property
    def _tensor(self) -> Vector:
        return tensor_in(self.mesh, self.total_mass)

    @functools.cached_property
    def shapes(self) -> tuple[Shape, ...]:
        """The pieces of a decomposed mesh, the convex hull of a convex one, else the mesh itself.

        A convex mesh with more corners than a hull may have is not replaced by its hull.
        """
        mesh = self.mesh
        if self.decomposition is not None:
            pieces = self.decomposition.of(mesh)
        elif mesh.is_convex and len(mesh.hull.corners) <= MOST_VERTICES:
            pieces = (mesh.hull.corners,)
        else:
            x, y, z = (-self.centre).tolist()
            return (TriangleMesh(self.surface, x, y, z),)
        return tuple(ConvexHull(tuple(map(tuple, (piece - self.centre).tolist()))) for piece in pieces)
