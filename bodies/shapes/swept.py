"""SweptPolytope: what all shapes made of points within a radius of a core with flat faces have in common."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from bodies.shapes.polytope import Polytope
from nonsmooth.interfaces import ConvexPart, ConvexShape


class SweptPolytope(ConvexShape):
    """All points within a radius of a polyhedron or a segment, the core; with radius 0 the core itself."""

    @property
    @abstractmethod
    def core(self) -> Polytope:
        """Vertices, faces and edges of what is swept, in the body frame; a segment has no faces."""

    @property
    @abstractmethod
    def sweep(self) -> float:
        """Radius of the sphere that sweeps the core [m]."""

    @property
    def parts(self) -> tuple[ConvexPart, ...]:
        """The hull of the vertices, swept."""
        return (ConvexPart.of_points(np.array(self.core.vertices), self.sweep),)
