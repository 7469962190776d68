"""ConvexShape: a shape that is a convex solid."""

from __future__ import annotations

import functools
from abc import abstractmethod
from typing import final

import numpy as np

from nonsmooth.interfaces.body import Vector
from nonsmooth.interfaces.convex_part import ConvexPart
from nonsmooth.interfaces.convex_solid import ConvexSolid
from nonsmooth.interfaces.look import Look
from nonsmooth.interfaces.shape import Shape


class ConvexShape(Shape):
    """A shape that encloses a convex solid; all in the frame of its body, the shape's own place and turn included.

    What a contact pair needs at every step are compiled functions of numbers; these properties are for what happens
    once: checks, mass properties, boxes for the search for pairs, pictures.

    The contract:

    1. ``support`` returns a point of the solid that lies farthest along a direction, whatever the direction's length.
    2. ``volume``, ``centroid`` and ``inertia`` are those of the solid with density 1; a shape without thickness has
       volume and inertia 0.
    3. ``drawing`` returns a closed mesh of triangles that are counter-clockwise seen from outside, with vertices on the
       surface; it tends to the surface as ``fineness`` grows, and is exact at any for a polyhedron.
    4. ``parts`` are convex parts within the surface that contacts see. Distances and overlaps are those of the parts.
    """

    @abstractmethod
    def support(self, direction: Vector) -> Vector:
        """Return a farthest point along ``direction`` (shape [3], not zero) [m], shape [3]."""

    def farthest(self, direction: Vector) -> Vector:
        """Return what ``support`` returns; a shape whose ``support`` may be wrong looks at it first."""
        return self.support(direction)

    @property
    @abstractmethod
    def parts(self) -> tuple[ConvexPart, ...]:
        """Convex parts within the surface that contacts see, whose distance is that of the shape."""

    @property
    @abstractmethod
    def volume(self) -> float:
        """Volume [m^3]."""

    @property
    @abstractmethod
    def centroid(self) -> Vector:
        """Centre of the volume in the body frame [m], shape [3]."""

    @property
    @abstractmethod
    def inertia(self) -> Vector:
        """Inertia tensor at density 1 about the centroid in the axes of the body frame [m^5], shape [3, 3].

        The element J_xy is -integral of x y dV.
        """

    @abstractmethod
    def drawing(self, fineness: int = 24) -> tuple[Vector, Vector]:
        """Return vertices [m], shape [n, 3], and triangles as integer indices of them, shape [m, 3].

        Parameters
        ----------
        fineness : int
            Number of edges round a full circle, at least 3.
        """

    @property
    @final
    def look(self) -> Look:
        """The drawing."""
        return Look.solid(*self.drawing())

    @property
    def set_back(self) -> float:
        """How far the surface that contacts see may lie off that of the solid [m]; none by default."""
        return 0.0

    @functools.cached_property
    @final
    def solid(self) -> ConvexSolid:
        """What it encloses."""
        return ConvexSolid(self.farthest, self.set_back)

    @property
    @final
    def bounds(self) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates in the body frame [m], shape [3] each."""
        axes = np.eye(3)
        return (
            np.array([self.farthest(-axis)[i] for i, axis in enumerate(axes)]),
            np.array([self.farthest(axis)[i] for i, axis in enumerate(axes)]),
        )
