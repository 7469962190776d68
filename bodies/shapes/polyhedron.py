"""Polyhedron: what all shapes with flat faces have in common."""

from __future__ import annotations

from abc import abstractmethod

from bodies.shapes.polytope import Polytope
from nonsmooth.interfaces import ConvexShape


class Polyhedron(ConvexShape):
    """A convex shape with flat faces."""

    @property
    @abstractmethod
    def polytope(self) -> Polytope:
        """Vertices, faces and edges in the body frame."""
