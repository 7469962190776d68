"""Pose: where a body is, checked."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

_ORTHONORMAL = 1e-9


@final
@dataclass(frozen=True)
class Pose:
    """Where a body is.

    Attributes
    ----------
    position : Vector
        Origin of its frame [m], shape [3].
    rotation : Vector
        Its axes as columns, shape [3, 3].

    Raises
    ------
    InvalidInput
        If a number is not finite, or the matrix is no rotation to 1e-9: libraries end the process or compute with it.
    """

    position: Vector = field(default_factory=lambda: np.zeros(3))
    rotation: Vector = field(default_factory=lambda: np.eye(3))

    def __post_init__(self) -> None:
        position, rotation = np.array(self.position, dtype=float), np.array(self.rotation, dtype=float)
        if position.shape != (3,) or not np.all(np.isfinite(position)):
            raise InvalidInput("Pose.position", "must be three finite numbers", self.position, "Give it in [m].")
        if rotation.shape != (3, 3) or not np.all(np.isfinite(rotation)):
            raise InvalidInput(
                "Pose.rotation", "must be a 3 x 3 matrix of finite numbers", self.rotation, "Axes are its columns."
            )
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
