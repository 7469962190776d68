"""DistanceBackend: a library that tells how far solids are apart."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, TypeAlias, final

from nonsmooth.interfaces.shape import Shape
from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Component

Place: TypeAlias = tuple[Vector, Vector]
"""Where a frame is: its origin [m], shape [3], and its axes as columns, shape [3, 3]."""


@final
@dataclass(frozen=True, eq=False)
class Separation:
    """How far two solids are from each other, as a library tells.

    Attributes
    ----------
    overlap : bool
        Whether they overlap or nearly touch; how deep is not told then, and nothing else here is a number.
    distance : float
        The distance [m], negative where only what rounds them overlaps.
    error : float
        By how much it may be off [m].
    first, second : Vector
        A nearest point of either, in the world [m], shape [3].
    normal : Vector
        Unit vector from the first to the second, shape [3].
    """

    overlap: bool
    distance: float
    error: float
    first: Vector
    second: Vector
    normal: Vector


class DistanceBackend(Component, ABC):
    """A library that tells distances of solids: a seed, a look from outside, and the way where nothing else is known.

    The contract:

    1. Nothing unchecked reaches the library: whatever it is given, the process survives.
    2. ``solid`` makes what the library keeps of a shape, once, and None of a kind that it does not have.
    3. ``separation`` is right to the error that it states, in either order of the solids, or raises DoubtfulDistance.
    """

    @property
    @abstractmethod
    def rank(self) -> int:
        """Of several that know two shapes that of the lowest rank is asked."""

    @property
    @abstractmethod
    def installed(self) -> bool:
        """Whether its packages are there."""

    @abstractmethod
    def solid(self, shape: Shape) -> Any | None:
        """Return a shape as an object of the library; None if it has no such kind.

        Raises
        ------
        InvalidInput
            If the shape is one that the library cannot be given, as a mesh with triangles of zero area.
        """

    @abstractmethod
    def separation(self, first: Any, one: Place, second: Any, two: Place) -> Separation:
        """Return how far two of its solids are from each other, their bodies at two places, which are finite.

        Raises
        ------
        DoubtfulDistance
            If the answer of the library contradicts what is known.
        """
