"""Balls between planes as statics sees them, by numpy and scipy alone: who touches, and whether forces can balance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

Array = NDArray[np.float64]
_TOUCHES = 1e-8
"""Gaps up to this are none [m]."""
_DIRECTIONS = 96
"""The cone is that of so many directions on the edge of Coulomb's, which lies inside of it."""


@dataclass(frozen=True)
class Touch:
    """One contact: the ball that is pushed along ``normal``, the other one or -1 of a plane, the friction."""

    ball: int
    other: int
    normal: Array
    friction: float


def touches(
    centres: Array, radius: float, planes: Sequence[tuple[Array, Array]], friction: Callable[[int, int], float]
) -> list[Touch]:
    """Return the contacts of balls with planes, each a point and the normal out of it, and with each other."""
    found = []
    for i, centre in enumerate(centres):
        for point, normal in planes:
            if normal @ (centre - point) - radius < _TOUCHES:
                found.append(Touch(i, -1, normal, friction(i, -1)))
        for j in range(i):
            way = centre - centres[j]
            distance = float(np.linalg.norm(way))
            if distance - 2.0 * radius < _TOUCHES:
                found.append(Touch(i, j, way / distance, friction(i, j)))
    return found


def frame(normal: Array) -> Array:
    """Return the normal and two tangents as rows."""
    across = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    across /= np.linalg.norm(across)
    return np.array([normal, across, np.cross(normal, across)])


def wrench(touch: Touch, force: Array, radius: float, n: int) -> Array:
    """Return force and moment on each ball of a force on ``touch.ball``, shape [6 n]."""
    wrenches = np.zeros((n, 6))
    wrenches[touch.ball] = *force, *np.cross(-radius * touch.normal, force)
    if touch.other >= 0:
        wrenches[touch.other] = *-force, *np.cross(radius * touch.normal, -force)
    return wrenches.reshape(-1)


def unbalanced(found: Sequence[Touch], radius: float, masses: Array, gravity: float) -> float:
    """Return the least wrench that forces inside the cones leave of the weights, relative to the largest weight.

    Moments count by the radius.
    """
    n = len(masses)
    columns: list[Any] = []
    for touch in found:
        axes = frame(touch.normal)
        angles = 2.0 * np.pi * np.arange(_DIRECTIONS if touch.friction > 0.0 else 1) / _DIRECTIONS
        for angle in angles:
            force = axes[0] + touch.friction * (np.cos(angle) * axes[1] + np.sin(angle) * axes[2])
            columns.append(wrench(touch, force, radius, n))
    scale = np.tile([1.0, 1.0, 1.0, *[1.0 / radius] * 3], n) / (np.max(masses) * gravity)
    weights = np.zeros((n, 6))
    weights[:, 2] = masses * gravity
    return float(nnls(np.array(columns).T * scale[:, None], weights.reshape(-1) * scale, maxiter=100 * len(columns))[1])
