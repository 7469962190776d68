"""Painleve's paradox of the arm: friction decides the sign of the normal acceleration of its sliding tip."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from .arm import mass, tip_jacobian


def second_angle(theta_1: float, height_ratio: float) -> float:
    """Return theta_2 > 0 [rad] of the arm with its tip on the belt, cos theta_1 + cos theta_2 = H / l."""
    return math.acos(height_ratio - math.cos(theta_1))


def mobility(theta_1: float, height_ratio: float, link_mass: float, link_length: float) -> NDArray[np.float64]:
    """Return the Delassus matrix of the tip on the belt [1/kg], rows normal and tangent, shape [2, 2]."""
    q = np.array([theta_1, second_angle(theta_1, height_ratio)])
    matrix, jacobian = np.zeros(4), np.zeros(6)
    mass(q, matrix, link_mass, link_length)
    tip_jacobian(q, jacobian, link_length)
    rows = jacobian.reshape(3, 2)[[2, 0]]
    return np.asarray(rows @ np.linalg.solve(matrix.reshape(2, 2), rows.T))


def reduced_coefficient(
    theta_1: float, friction: float, height_ratio: float, link_mass: float, link_length: float
) -> float:
    """Return A = G_nn - mu G_nt [1/kg], the normal acceleration of the tip per normal force while it slides along x.

    If A is negative, a normal force pulls the tip into the belt: no force fulfils the laws of contact.
    """
    g = mobility(theta_1, height_ratio, link_mass, link_length)
    return float(g[0, 0] - friction * g[0, 1])


def critical_friction(theta_1: float, height_ratio: float, link_mass: float, link_length: float) -> float:
    """Return the friction coefficient above which Painleve's paradox occurs in a posture, or infinity.

    At this coefficient A of :func:`reduced_coefficient` vanishes; above it A is negative.
    """
    g = mobility(theta_1, height_ratio, link_mass, link_length)
    return float(g[0, 0] / g[0, 1]) if g[0, 1] > 0.0 else math.inf


def least_critical_friction(height_ratio: float, link_mass: float, link_length: float) -> tuple[float, float]:
    """Return the least critical friction over all postures on the belt, and its theta_1 [rad]."""
    low, high = math.acos(min(1.0, height_ratio)), math.acos(max(-1.0, height_ratio - 1.0))
    grid = np.linspace(low, high, 202)[1:-1]
    sizes = (height_ratio, link_mass, link_length)
    best = int(np.argmin([critical_friction(x, *sizes) for x in grid]))
    bounds = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, len(grid) - 1)])
    found = minimize_scalar(critical_friction, bounds=bounds, args=sizes, options={"xatol": 1e-10})
    return float(found.fun), float(found.x)


def impulse(
    theta_1: float,
    friction: float,
    restitution: float,
    slip: float,
    height_ratio: float,
    link_mass: float,
    link_length: float,
) -> float:
    """Return the normal impulse of the impact without collision that stops a slip [N s], if friction then holds it.

    The slip ends at P_1 with the tip pressed; it sticks to the end of compression, and e^2 of the work comes back.
    """
    g = mobility(theta_1, height_ratio, link_mass, link_length)
    reduced = reduced_coefficient(theta_1, friction, height_ratio, link_mass, link_length)
    first = slip / float(friction * g[1, 1] - g[0, 1])
    pressed = reduced * first
    held = float(g[0, 0] - g[0, 1] ** 2 / g[1, 1])
    stored = -0.5 * reduced * first**2 + pressed**2 / (2.0 * held)
    return first + (math.sqrt(2.0 * held * restitution**2 * stored) - pressed) / held
