"""SolidRegion: what a shape encloses, for what is asked once: whether bodies overlap, and where one meets another."""

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
        Returns a point of it that lies farthest along a direction of any length [m], both of shape [3].
    place : Vector
        One of its points, in the middle where it has one [m], shape [3].
    normals : tuple of Vector
        Directions along which it is thin, to be tried first, shape [3] each.
    """

    support: Callable[[Vector], Vector]
    place: Vector
    normals: tuple[Vector, ...] = ()


class SolidRegion(ABC):
    """The points that a shape encloses, in the frame of its body; gaps of contacts tell only of features that face.

    The contract:

    1. The pieces lie within the solid and cover its boundary; they fill it unless it is ``hollow``.
    2. The surface that contacts see is nowhere farther than ``set_back`` from the boundary.
    """

    @property
    @abstractmethod
    def set_back(self) -> float:
        """How far what contacts see may lie off the boundary [m]."""

    @property
    @abstractmethod
    def hollow(self) -> bool:
        """Whether the pieces leave out what is inside."""

    @property
    @abstractmethod
    def bounds(self) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates [m], shape [3] each."""

    @abstractmethod
    def support(self, direction: Vector) -> Vector:
        """Return a point that lies farthest along a direction of any length [m], both of shape [3]."""

    @abstractmethod
    def pieces(self, low: Vector, high: Vector) -> Sequence[Piece]:
        """Return the pieces that may reach into the box between two corners [m], shape [3] each."""

    @property
    @abstractmethod
    def inner(self) -> Vector:
        """Points inside, off the boundary as far as that can be [m], shape [n, 3]; at least one."""

    @abstractmethod
    def holds(self, point: Vector, margin: float) -> bool:
        """Tell whether a hollow one goes round a point that lies deeper than a margin under its boundary [m]."""
