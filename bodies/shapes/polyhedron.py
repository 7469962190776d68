"""Base classes of shapes with flat faces, sharp or rounded, and of segments with a radius."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import ConvexPart, ConvexShape
from nonsmooth.interfaces.body import Vector

from .polytope import Polytope


class SweptPolytope(ConvexShape):
    """All points within a radius of a polyhedron or a segment, the core; with radius 0 the core itself."""

    @property
    @abstractmethod
    def core(self) -> Polytope:
        """Vertices, faces and edges of the polyhedron or segment that is swept, in the body frame."""

    @property
    @abstractmethod
    def sweep(self) -> float:
        """Radius of the sphere that sweeps the core [m]."""

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """The hull of the vertices, swept by the sphere."""
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
        """Vertices, faces and edges of a sharp one in the body frame.

        Raises
        ------
        InvalidInput
            If it is rounded: who asks for its sharp edges would not see where they are.
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
        """Distance of the farthest point [m]."""
        return max(math.hypot(*vertex) for vertex in self.core.vertices) + self.rounding

    def support(self, direction: Vector) -> Vector:
        """Return the farthest vertex of the core, of several the first, and the rounding along the direction [m]."""
        vertices = np.array(self.core.vertices)
        return np.asarray(vertices[np.argmax(vertices @ direction)] + self._rounded(direction))

    @final
    def _rounded(self, direction: Vector) -> Vector:
        if self.rounding == 0.0:
            return np.zeros(3)
        return np.asarray(self.rounding * direction / np.linalg.norm(direction))
