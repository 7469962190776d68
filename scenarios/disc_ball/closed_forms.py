"""Two closed forms of the strike: the symmetric one, and collisions of two bodies one after the other."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_COLLISIONS = 1000
"""Largest number of collisions; elastic equal bodies need only a few."""


def half_angle(radius_ratio: float) -> float:
    """Return the angle alpha [rad] between the line of centres, disc to ball, and the axis of symmetry."""
    return math.asin(1.0 / (1.0 + radius_ratio))


def symmetric(mass_ratio: float, radius_ratio: float, restitution: float) -> tuple[float, float]:
    """Return the velocity of the disc along the axis of symmetry, and the speed of each ball, after a symmetric strike.

    Both are divided by v, the speed of the disc before the strike.  The disc hits both balls at once.  By symmetry the
    impulse P is the same at both contacts: P (1/m + 2 cos^2 alpha / M) = (1 + e) v cos alpha.  Here m is the mass of a
    ball, M the mass of the disc, and alpha the angle of :func:`half_angle`.
    """
    c = math.cos(half_angle(radius_ratio))
    ball = (1.0 + restitution) * c / (1.0 + 2.0 * c * c / mass_ratio)
    return 1.0 - 2.0 * c * ball / mass_ratio, ball


def one_after_the_other(
    mass_ratio: float, radius_ratio: float, restitution: float, direction: Floats, first: int
) -> Floats:
    """Return the velocities of disc, left and right ball after collisions in pairs, shape [3, 2].

    Bodies do not move between the collisions.  Velocities are relative to the disc's speed before the first collision.

    Parameters
    ----------
    mass_ratio, radius_ratio, restitution : float
        Mass and radius of the disc, relative to those of a ball, and coefficient of restitution e.
    direction : array
        Unit vector of the disc's velocity before, shape [2]; y is the axis of symmetry.
    first : int
        Ball that is hit first: 0 left, 1 right.
    """
    alpha = half_angle(radius_ratio)
    normals = np.array([[-math.sin(alpha), math.cos(alpha)], [math.sin(alpha), math.cos(alpha)]])
    u = np.zeros((3, 2))
    u[0] = direction
    ball = first
    for _ in range(_COLLISIONS):
        rates = np.array([normals[i] @ (u[1 + i] - u[0]) for i in range(2)])
        if rates[ball] >= 0.0:
            ball = 1 - ball
            if rates[ball] >= 0.0:
                break
        impulse = -(1.0 + restitution) * rates[ball] / (1.0 + 1.0 / mass_ratio)
        u[1 + ball] += impulse * normals[ball]
        u[0] -= impulse / mass_ratio * normals[ball]
        ball = 1 - ball
    return u
