"""Interface of solids, the points that shapes enclose: for overlaps, distances and meetings of bodies."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Piece:
    """A convex set of points of a body.

    Attributes
    ----------
    support : callable
        Function that returns a point of the piece farthest along a direction of any length [m], both of shape [3].
    place : Vector
        A point of the piece, its middle if it has one [m], shape [3].
    normals : tuple of Vector
        Directions along which the piece is thin, shape [3] each. A search for a separating plane tries them first.
    """

    support: Callable[[Vector], Vector]
    place: Vector
    normals: tuple[Vector, ...] = ()


class SolidRegion(ABC):
    """The points that a shape encloses, in the frame of its body.

    Solids show overlaps that gaps of contacts cannot show, because gaps are those of features that face each other.

    The contract:

    1. The convex pieces (:meth:`pieces`) lie within the solid and cover its boundary. If ``hollow`` is False, they also
       fill its inside; if ``hollow`` is True, they leave out its inside.
    2. The surface from which contacts compute gaps is nowhere farther than ``set_back`` [m] from the boundary.
    """

    @property
    @abstractmethod
    def set_back(self) -> float:
        """Largest distance between the boundary and the surface from which contacts compute gaps [m]."""

    @property
    @abstractmethod
    def hollow(self) -> bool:
        """True if the pieces cover the boundary only, and leave out the inside of the solid."""

    @property
    @abstractmethod
    def bounds(self) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates of the solid [m], shape [3] each."""

    @abstractmethod
    def support(self, direction: Vector) -> Vector:
        """Return a point that lies farthest along a direction of any length [m], both of shape [3]."""

    @abstractmethod
    def pieces(self, low: Vector, high: Vector) -> Sequence[Piece]:
        """Return the pieces that may reach into the box between two corners [m], shape [3] each."""

    @property
    @abstractmethod
    def inner(self) -> Vector:
        """One or more points deep inside the solid [m], shape [n, 3], as far from its boundary as possible.

        If such a point lies in another solid, the two solids overlap.
        """

    @abstractmethod
    def holds(self, point: Vector, margin: float) -> bool:
        """Return True if a point lies in a ``hollow`` solid, more than ``margin`` [m] below its boundary.

        A solid that is not ``hollow`` returns False for every point: its pieces fill it, so each point inside the solid
        is found in a piece.
        """
