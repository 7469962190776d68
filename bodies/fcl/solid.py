"""Solid: a shape as an object of FCL."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from bodies.fcl.geometry import SCALE, geometry_of
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector

_ORTHONORMAL = 1e-9


@final
@dataclass(frozen=True)
class Pose:
    """Where a body is, checked.

    Attributes
    ----------
    position : Vector
        Origin of its frame [m], shape [3].
    rotation : Vector
        Its axes as columns, shape [3, 3].

    Raises
    ------
    InvalidInput
        If a number is not finite, or the matrix is no rotation to 1e-9: FCL ends the process or computes with it.
    """

    position: Vector = field(default_factory=lambda: np.zeros(3))
    rotation: Vector = field(default_factory=lambda: np.eye(3))

    def __post_init__(self) -> None:
        position, rotation = np.array(self.position, dtype=float), np.array(self.rotation, dtype=float)
        if position.shape != (3,) or not np.all(np.isfinite(position)):
            raise InvalidInput("Pose.position", "must be three finite numbers", self.position, "Give it in [m].")
        if rotation.shape != (3, 3) or not np.all(np.isfinite(rotation)):
            raise InvalidInput("Pose.rotation", "must be a 3 x 3 matrix of finite numbers", self.rotation, "See above.")
        off = float(np.max(np.abs(rotation @ rotation.T - np.eye(3))))
        if off > _ORTHONORMAL or np.linalg.det(rotation) < 0.0:
            raise InvalidInput(
                "Pose.rotation",
                "must be a rotation to 1e-9",
                rotation.tolist(),
                f"R R^T differs from 1 by {off:.2g}, and det R is {np.linalg.det(rotation):.3g}.",
            )
        object.__setattr__(self, "position", position)
        object.__setattr__(self, "rotation", rotation)


@final
class Solid:
    """A shape of a body as an object of FCL, which it keeps alive; pickled and copied by the shape.

    Parameters
    ----------
    shape : Shape
        A bounded solid of a kind that FCL has.

    Raises
    ------
    InvalidInput
        If FCL has no such kind, or a triangle of it is degenerate.
    """

    def __init__(self, shape: Shape) -> None:
        import fcl

        self.shape = shape
        self._geometry, self._place, self._axes = geometry_of(shape)
        self._object = fcl.CollisionObject(self._geometry, fcl.Transform())

    def __reduce__(self) -> tuple[type[Solid], tuple[Shape]]:
        return Solid, (self.shape,)

    def own_frame(self, pose: Pose, origin: Vector) -> tuple[Vector, Vector]:
        """Return place [m] from ``origin`` and axes of the geometry for a pose of the body."""
        return pose.position - origin + pose.rotation @ self._place, pose.rotation @ self._axes

    def at(self, place: Vector, axes: Vector) -> Any:
        """Return the object of FCL, put there and enlarged."""
        import fcl

        self._object.setTransform(fcl.Transform(np.ascontiguousarray(axes), np.ascontiguousarray(SCALE * place)))
        return self._object
