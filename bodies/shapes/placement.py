"""Where a shape stands in its body: what shapes with an axis or with axes have in common."""

from __future__ import annotations

import math


def turned(w: float, x: float, y: float, z: float, a: float, b: float, c: float) -> tuple[float, float, float]:
    """Return the vector (a, b, c) turned by the unit quaternion (w, x, y, z)."""
    p, q, r = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p


def farthest_on_circle(radius: float, center: tuple[float, float, float], axis: tuple[float, float, float]) -> float:
    """Return the distance of the farthest point of a circle from the origin [m]."""
    along = sum(c * a for c, a in zip(center, axis, strict=True))
    across = math.hypot(*[c - along * a for c, a in zip(center, axis, strict=True)])
    return math.hypot(along, across + radius)
