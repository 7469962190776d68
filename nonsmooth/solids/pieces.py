"""Convex pieces of a shape, prepared for measurements: its convex parts, or the pieces of its surface."""

from __future__ import annotations

import functools
import math
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces.convex_part import ConvexPart
from nonsmooth.interfaces.shape import Shape
from nonsmooth.interfaces.solid import Surface, Vector
from nonsmooth.solids.measure import PartNumbers

_AXES = np.vstack([-np.eye(3), np.eye(3)])
"""Both directions of the coordinate axes, the negative ones first."""


@final
class Pieces:
    """Convex pieces of a shape, in the frame of its body.

    Attributes
    ----------
    surface : Surface or None
        Its surface, if the pieces are those of a surface; None if they are convex parts, which fill the shape.
    hull : tuple of PartNumbers
        Convex parts that hold the shape: its parts, or the convex hull of its surface.
    """

    def __init__(self, parts: tuple[ConvexPart, ...], surface: Surface | None) -> None:
        """Prepare the pieces of a surface, or convex parts if ``surface`` is None."""
        self.surface = surface
        self.hull = tuple(map(PartNumbers.of, parts if surface is None else (surface.hull,)))
        self._parts = {} if surface is not None else dict(enumerate(self.hull))
        if surface is not None:
            self._low, self._high = surface.boxes
        else:
            self._low, self._high = (np.array(corners) for corners in zip(*map(_box, parts), strict=True))

    @classmethod
    def of(cls, shape: Shape) -> Pieces | None:
        """Pieces of a shape; None if it has neither convex parts nor a surface.

        They are kept for the next call, if the shape is hashable.
        """
        try:
            hash(shape)
        except TypeError:
            return _made(shape)
        return _kept(shape)

    @property
    def is_bounded(self) -> bool:
        """False for a half-space."""
        return all(math.isfinite(part.radius) for part in self.hull)

    @property
    def inner(self) -> Vector:
        """Points deep inside of the shape [m], shape [n, 3]."""
        return np.array([part.middle for part in self.hull]) if self.surface is None else self.surface.inner

    @property
    def bounds(self) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates of all pieces [m], shape [3] each."""
        return np.min(self._low, axis=0), np.max(self._high, axis=0)

    def near(self, low: Vector, high: Vector) -> NDArray[np.int64]:
        """Numbers of the pieces that may reach into the box between two corners [m], shape [3] each."""
        return np.arange(len(self._low)) if self.surface is None else self.surface.near(low, high)

    def boxes(self, numbers: NDArray[np.int64]) -> tuple[Vector, Vector]:
        """Lowest and highest coordinates of some pieces [m], shape [n, 3] each."""
        return self._low[numbers], self._high[numbers]

    def piece(self, number: int) -> PartNumbers:
        """A piece. It is prepared at its first use."""
        if number not in self._parts:
            assert self.surface is not None
            self._parts[number] = PartNumbers.of(self.surface.piece(number))
        return self._parts[number]


def _box(part: ConvexPart) -> tuple[Vector, Vector]:
    """Lower and upper corner of a box that holds a part [m], shape [3] each."""
    if part.is_half_space or part.function:
        # of a function only a radius is known
        return part.place - part.radius, part.place + part.radius
    heights = part.heights(_AXES)
    return -heights[:3], heights[3:]


def _made(shape: Shape) -> Pieces | None:
    # the hull of a convex mesh takes less time than its triangles
    if parts := shape.parts:
        return Pieces(parts, None)
    solid = shape.solid
    surface = None if solid is None else solid.surface
    return None if surface is None else Pieces((), surface)


@functools.lru_cache(maxsize=256)
def _kept(shape: Shape) -> Pieces | None:
    return _made(shape)
