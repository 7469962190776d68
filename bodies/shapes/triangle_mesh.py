"""TriangleMesh: any closed surface of triangles."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.interfaces import ConvexPart
from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.look import Look
from nonsmooth.parameters import parameter
from nonsmooth.vectors import UNIT_PART, unit_vector

from ..meshes.features import Features, features_of
from ..meshes.mesh import Surface, check_surface_of
from ..meshes.solid import MeshSolid
from ..meshes.topology import Integers
from ..meshes.triangles import Triangles
from .placement import with_axes
from .polytope import MOST_VERTICES
from .surface_shape import SurfaceShape


@final
@dataclass(frozen=True)
class TriangleMesh(SurfaceShape):
    """The solid inside a closed surface, convex or not, which stands at (x, y, z) turned by a unit quaternion.

    Attributes
    ----------
    surface : Surface
        The triangles: a :class:`bodies.MeshFile` or :class:`bodies.Triangles`.
    """

    surface: Surface
    x: float = parameter(0.0, doc="origin of the surface's axes in the body, first coordinate", unit="m")
    y: float = parameter(0.0, doc="origin, second coordinate", unit="m")
    z: float = parameter(0.0, doc="origin, third coordinate", unit="m")
    orientation_w: float = parameter(1.0, doc="quaternion from its axes to the body's, scalar part", **UNIT_PART)
    orientation_x: float = parameter(0.0, doc="quaternion, first component", **UNIT_PART)
    orientation_y: float = parameter(0.0, doc="quaternion, second component", **UNIT_PART)
    orientation_z: float = parameter(0.0, doc="quaternion, third component", **UNIT_PART)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a tetrahedron."""
        corners = ((0.0, 0.0, 0.0), (0.02, 0.0, 0.0), (0.0, 0.02, 0.0), (0.0, 0.0, 0.02))
        return {"surface": Triangles(corners, ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)), "of the example")}

    def _check(self) -> None:
        check_surface_of("TriangleMesh", self.surface)
        orientation = self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z
        unit_vector("TriangleMesh orientation", orientation, 4)

    @property
    def _axes(self) -> Vector:
        return with_axes(self.orientation_w, self.orientation_x, self.orientation_y, self.orientation_z)

    def _placed(self, points: Vector) -> Vector:
        return np.asarray(points @ self._axes.T + np.array([self.x, self.y, self.z]))

    @property
    def corners(self) -> Vector:
        """Corners of its convex hull in the body frame [m], shape [n, 3]."""
        return self._placed(self.surface.mesh.hull.corners)

    @functools.cached_property
    def features(self) -> Features:
        """Flat faces, convex edges and corners in the body frame."""
        mesh = self.surface.mesh
        return features_of(self._placed(mesh.vertices), mesh.faces)

    @property
    def sweep(self) -> float:
        """0: the surface is sharp [m]."""
        return 0.0

    def _touched(self) -> Vector:
        """Return the corners of the surface that contacts see [m], shape [n, 3]."""
        return self.features.vertices

    @functools.cached_property
    def solid(self) -> MeshSolid:
        """What its surface encloses, in the body frame."""
        mesh = self.surface.mesh
        return MeshSolid(self._placed(mesh.vertices), mesh.faces, self._touched)

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """The hull of its corners if it is convex."""
        return (ConvexPart.of_points(self.corners),) if self.surface.mesh.is_convex else ()

    @property
    def length(self) -> float:
        """Distance of the farthest corner [m]."""
        return float(np.max(np.linalg.norm(self.corners, axis=1)))

    @property
    def advice(self) -> str:
        """How far from convex it is, and that a decomposition helps; or that it has too many corners."""
        mesh = self.surface.mesh
        if mesh.is_convex:
            return (
                f"The mesh {mesh.name} is convex but has {len(mesh.hull.corners)} corners; only up to {MOST_VERTICES} "
                "make a convex hull, which touches more shapes than a mesh does. Take a coarser mesh, or a shape in "
                "closed form if it stands for a rounded body."
            )
        return (
            f"The mesh {mesh.name} has {mesh.volume_ratio:.1%} of the volume of its convex hull, and surfaces that are "
            "not convex do not touch this shape: give its body a decomposition into convex pieces, "
            "MeshBody(..., decomposition=Decomposition())."
        )

    def support(self, direction: Vector) -> Vector:
        """Return the farthest corner along a direction (shape [3]) [m], shape [3]."""
        corners = self.corners
        return np.asarray(corners[int(np.argmax(corners @ direction))])

    @property
    def bounds(self) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates in the body frame [m], shape [3] each."""
        corners = self.corners
        return np.min(corners, axis=0), np.max(corners, axis=0)

    @property
    def volume(self) -> float:
        """Volume [m^3]."""
        return self.surface.mesh.volume

    @property
    def centroid(self) -> Vector:
        """Centre of the volume in the body frame [m], shape [3]."""
        return self._placed(self.surface.mesh.centroid)

    @property
    def inertia(self) -> Vector:
        """Inertia at density 1 about the centroid in the axes of the body frame [m^5], shape [3, 3]."""
        return np.asarray(self._axes @ self.surface.mesh.inertia @ self._axes.T)

    def drawing(self, fineness: int = 24) -> tuple[Vector, Integers]:
        """Return its vertices in the body frame [m], shape [n, 3], and its triangles, shape [m, 3]."""
        mesh = self.surface.mesh
        return self._placed(mesh.vertices), mesh.faces

    @property
    def look(self) -> Look:
        """The drawing."""
        return Look.solid(*self.drawing())
