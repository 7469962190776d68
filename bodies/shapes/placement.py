"""Where a shape stands in its body: what shapes with an axis or with axes have in common."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.interfaces.body import Vector


def turned(w: float, x: float, y: float, z: float, a: float, b: float, c: float) -> tuple[float, float, float]:
    """Return the vector (a, b, c) turned by the unit quaternion (w, x, y, z)."""
    p, q, r = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p


def with_axes(w: float, x: float, y: float, z: float) -> Vector:
    """Return the matrix of a unit quaternion: the axes that it turns to, as columns, shape [3, 3]."""
    return np.array([turned(w, x, y, z, *axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]).T


def about_axis(axis: tuple[float, float, float], along: float, across: float) -> Vector:
    """Return the tensor with one moment about the unit axis and another about all axes across it, shape [3, 3]."""
    return across * np.eye(3) + (along - across) * np.outer(axis, axis)


def across_axis(direction: Vector, axis: tuple[float, float, float]) -> tuple[float, float, Vector]:
    """Return the part of a direction along a unit axis, the size of that across, and the unit vector there.

    Next to the axis a direction across is round-off: then both are 0.
    """
    along = float(direction @ np.array(axis))
    across = direction - along * np.array(axis)
    size = float(np.linalg.norm(across))
    if size <= 1e-15 * abs(along):
        return along, 0.0, np.zeros(3)
    # of a short one what is left along the axis is round-off, too
    across = across / size
    across = across - across @ np.array(axis) * np.array(axis)
    return along, size, across / np.linalg.norm(across)


def farthest_on_circle(radius: float, center: tuple[float, float, float], axis: tuple[float, float, float]) -> float:
    """Return the distance of the farthest point of a circle from the origin [m]."""
    along = sum(c * a for c, a in zip(center, axis, strict=True))
    across = math.hypot(*[c - along * a for c, a in zip(center, axis, strict=True)])
    return math.hypot(along, across + radius)
