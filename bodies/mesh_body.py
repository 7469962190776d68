"""MeshBody: a solid body with the surface of a mesh."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from bodies.free import FreeBody
from bodies.inertia import check_mass, mass_of
from bodies.meshes.decomposition import Decomposition
from bodies.meshes.mesh import Mesh
from bodies.meshes.surface import Surface
from bodies.shapes.hull import ConvexHull
from bodies.shapes.polytope import MOST_VERTICES
from bodies.shapes.triangle_mesh import TriangleMesh
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter


@final
@dataclass(frozen=True)
class MeshBody(FreeBody):
    """A free solid body of even density with the surface of a mesh.

    Its frame has the axes of the mesh and its origin at the mass centre, which :attr:`centre` tells in the mesh's
    coordinates.  Mass properties are those of the polyhedron, whatever the shapes.

    Attributes
    ----------
    surface : Surface
        A :class:`bodies.MeshFile` or :class:`bodies.Triangles`.
    density : float, optional
        Density [kg/m^3]; steel, 7800, where no mass is given.
    mass : float, optional
        Mass [kg], instead of the density.
    decomposition : Decomposition, optional
        How to cut a surface that is not convex into convex pieces.  Without one it touches as it is.

    Raises
    ------
    InvalidInput
        If both mass and density are given, or a convex surface is to be cut.
    """

    surface: Surface
    density: float | None = parameter(
        None, doc="density; 7800 without a mass", unit="kg/m^3", above=0.0, usual=(10.0, 3e4)
    )
    mass: float | None = parameter(None, doc="mass, instead of the density", unit="kg", above=0.0)
    decomposition: Decomposition | None = None

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a tetrahedron."""
        return TriangleMesh.example()

    def _check(self) -> None:
        if not isinstance(self.surface, Surface):
            raise InvalidInput(
                "MeshBody.surface",
                "must be a surface",
                type(self.surface).__name__,
                'For example MeshFile("part.stl", unit="mm").',
            )
        check_mass("MeshBody", self.mass, self.density)
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
        """As given, or density times volume [kg]."""
        return mass_of(self.mass, self.density, self.mesh.volume)

    @property
    def _tensor(self) -> Vector:
        tensor = self.total_mass / self.mesh.volume * self.mesh.inertia
        # what is left of products that cancel is round-off; without it principal axes stay principal
        return np.where(np.abs(tensor) > 1e-14 * np.max(tensor), tensor, 0.0)

    @property
    def inertia(self) -> tuple[float, float, float]:
        """Of the polyhedron about the axes of the frame [kg m^2]."""
        x, y, z = np.diag(self._tensor).tolist()
        return x, y, z

    @property
    def products(self) -> tuple[float, float, float]:
        """The elements J_yz, J_xz, J_xy [kg m^2]."""
        tensor = self._tensor.tolist()
        return tensor[1][2], tensor[0][2], tensor[0][1]

    @functools.cached_property
    def _shapes(self) -> tuple[Shape, ...]:
        x, y, z = (-self.centre).tolist()
        mesh = self.mesh
        if self.decomposition is not None:
            pieces = self.decomposition.of(mesh)
        elif mesh.is_convex and len(mesh.hull.corners) <= MOST_VERTICES:
            pieces = (mesh.hull.corners,)
        else:
            return (TriangleMesh(self.surface, x, y, z),)
        return tuple(ConvexHull(tuple(map(tuple, (piece - self.centre).tolist()))) for piece in pieces)

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The convex hull of a convex mesh, the pieces of one that is cut, else the mesh itself.

        A convex mesh with more corners than a hull may have stays a mesh.
        """
        return self._shapes
