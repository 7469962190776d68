"""Base classes of shapes with flat faces, sharp or rounded, and of capsules."""

from __future__ import annotations

import functools
import math
from abc import abstractmethod
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ConvexPart, ConvexShape
from nonsmooth.interfaces.body import Vector

from ..meshes.features import Features
from .polytope import Polytope
from .surface_shape import SurfaceShape


class SweptPolytope(ConvexShape, SurfaceShape):
    """All points within the radius ``sweep`` of a polyhedron or a segment, the core; with radius 0 the core itself."""

    @property
    @abstractmethod
    def core(self) -> Polytope:
        """Vertices, faces and edges of the polyhedron or segment inside of the shape, in the body frame."""

    @functools.cached_property
    def features(self) -> Features:
        """Faces, edges and corners of the core, with the numbers that they have there."""
        return self.core.features

    @property
    def corners(self) -> Vector:
        """Vertices of the core in the body frame [m], shape [n, 3]."""
        return np.array(self.core.vertices)

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """One convex part: the hull of the vertices, with all points within the radius ``sweep``."""
        return (ConvexPart.of_points(np.array(self.core.vertices), self.sweep),)


class Polyhedron(SweptPolytope):
    """A convex shape with flat faces, whose edges and vertices are sharp, or rounded by the radius ``rounding``."""

    rounding: float

    @property
    @final
    def sweep(self) -> float:
        """The rounding [m]."""
        return self.rounding

    @property
    @final
    def polytope(self) -> Polytope:
        """Vertices, faces and edges of a sharp shape in the body frame.

        Raises
        ------
        InvalidInput
            The shape is rounded, and has no sharp edges.
        """
        if self.rounding > 0.0:
            raise InvalidInput(
                f"{type(self).__name__}.rounding",
                "must be 0 here, where only sharp edges are known",
                self.rounding,
                "Leave the rounding out, or let it touch anything but cylinders, cones and discs.",
            )
        return self.core

    @property
    def length(self) -> float:
        """Distance of the farthest point from the origin of the body frame [m]."""
        return max(math.hypot(*vertex) for vertex in self.core.vertices) + self.rounding

    def support(self, direction: Vector) -> Vector:
        """Return the farthest point along a direction [m]: a vertex of the core, shifted by the rounding."""
        vertices = np.array(self.core.vertices)
        return np.asarray(vertices[np.argmax(vertices @ direction)] + self._rounded(direction))

    @final
    def _rounded(self, direction: Vector) -> Vector:
        if self.rounding == 0.0:
            return np.zeros(3)
        return np.asarray(self.rounding * direction / np.linalg.norm(direction))
