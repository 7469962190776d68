"""Interfaces of solids, the points that shapes enclose: for overlaps, distances and meetings of bodies."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces.convex_part import ConvexPart

Vector = NDArray[np.float64]


class Surface(ABC):
    """A closed surface of convex pieces, such as the triangles of a mesh, in the frame of the body.

    The contract:

    1. The pieces cover the boundary of the solid, and leave out its inside.
    2. They are those from which contacts compute gaps.
    """

    @property
    @abstractmethod
    def boxes(self) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates of every piece [m], shape [n, 3] each."""

    @abstractmethod
    def near(self, low: Vector, high: Vector) -> NDArray[np.int64]:
        """Return the numbers of the pieces whose boxes meet the box between two corners [m], shape [3] each."""

    @abstractmethod
    def piece(self, number: int) -> ConvexPart:
        """Return a piece."""

    @property
    @abstractmethod
    def hull(self) -> ConvexPart:
        """Convex hull of the solid."""

    @property
    @abstractmethod
    def inner(self) -> Vector:
        """One or more points deep inside the solid [m], shape [n, 3], as far from its boundary as possible.

        If such a point lies in another solid, the two solids overlap.
        """

    @abstractmethod
    def holds(self, point: Vector, margin: float) -> bool:
        """Return True if a point is inside of the solid, more than ``margin`` [m] below its boundary."""


class SolidRegion(ABC):
    """The points that a shape encloses, in the frame of its body.

    The surface from which contacts compute gaps is nowhere farther than ``set_back`` [m] from the boundary.
    """

    @property
    @abstractmethod
    def set_back(self) -> float:
        """Largest distance between the boundary and the surface from which contacts compute gaps [m]."""

    @property
    @abstractmethod
    def bounds(self) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates of the solid [m], shape [3] each."""

    @abstractmethod
    def support(self, direction: Vector) -> Vector:
        """Return a point that lies farthest along a direction of any length [m], both of shape [3]."""

    @property
    @abstractmethod
    def surface(self) -> Surface | None:
        """Its boundary, if it may be not convex; None for a convex solid."""
