"""Solid: a shape as an object of a library."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, TypeAlias

from bodies.distances.pose import Pose
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector

Frame: TypeAlias = tuple[Vector, Vector]
"""Place [m] and axes as columns of a geometry."""


class Solid(ABC):
    """A shape of a body as an object of a library, which it keeps alive; pickled and copied by the shape.

    Subclasses are final, one for each library, and made of a shape.

    Parameters
    ----------
    shape : Shape
        A bounded solid of a kind that the library has.
    made : tuple
        The library's geometry, its place [m] and its axes in the body.
    """

    def __init__(self, shape: Shape, made: tuple[Any, Vector, Vector]) -> None:
        self.shape = shape
        self.geometry, self._place, self._axes = made

    def __reduce__(self) -> tuple[Any, tuple[Shape]]:
        return type(self), (self.shape,)

    def frame(self, pose: Pose, origin: Vector) -> Frame:
        """Return place [m] from ``origin`` and axes of the geometry for a pose of the body."""
        return pose.position - origin + pose.rotation @ self._place, pose.rotation @ self._axes

    @abstractmethod
    def distance(self, own: Frame, other: Solid, its: Frame) -> tuple[float, Vector, Vector]:
        """Return distance [m] to a solid of the same library, and nearest points in the axes of the frames.

        A distance that is not positive stands for an overlap.  A mesh is asked for its distance to another shape, not
        the other way round.
        """
