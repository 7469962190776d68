"""The woodpecker by Moreau's time-stepping: an implicit scheme without events, written apart from the engine."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from scenarios.woodpecker import Woodpecker

GRAVITY = 9.81


def _dot_of(a: Any, b: Any) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


_dot: Any = numba.njit(_dot_of)


def _march_of(
    step: float,
    n: int,
    q: Any,
    u: Any,
    inverse: Any,
    constant: Any,
    stiffness: Any,
    rows: Any,
    offset: Any,
    restitution: Any,
    mu: float,
) -> Any:
    """Return times and heights of the beak's hits: midpoint positions, impulses by projection contact by contact.

    Of the rows 0 to 2 are normals, 3 to 5 tangents.
    """
    hits, response = np.zeros((1000, 2)), rows @ inverse
    n_hits = last = 0
    impulse, middle, force = np.zeros(6), np.zeros(3), np.zeros(3)
    before = np.zeros(3)
    for i in range(n):
        for j in range(3):
            middle[j] = q[j] + 0.5 * step * u[j]
        for c in range(3):
            before[c] = _dot(rows[c], u)
            force[c] = constant[c] - _dot(stiffness[c], middle)
        for j in range(3):
            u[j] += step * _dot(inverse[j], force)
        impulse[:] = 0.0
        change = 1.0
        while change > 1e-15:
            change = 0.0
            for c in range(3):
                if offset[c] + _dot(rows[c], middle) > 0.0:
                    continue
                for r in (c, c + 3):
                    rate = _dot(rows[r], u) + (restitution[c] * before[c] if r == c else 0.0)
                    new = impulse[r] - rate / _dot(rows[r], response[r])
                    new = max(0.0, new) if r == c else min(max(new, -mu * impulse[c]), mu * impulse[c])
                    for j in range(3):
                        u[j] += response[r, j] * (new - impulse[r])
                    change = max(change, abs(new - impulse[r]))
                    impulse[r] = new
        for j in range(3):
            q[j] = middle[j] + 0.5 * step * u[j]
        # one peck per hundred steps at most; the beak never rests
        if impulse[0] > 1e-5 and i - last > 100:
            hits[n_hits, 0], hits[n_hits, 1] = i * step, q[0]
            n_hits, last = n_hits + 1, i
    return hits[:n_hits]


_march: Any = numba.njit(_march_of)


def cycle(toy: Woodpecker, step: float, t_end: float) -> tuple[float, float]:
    """Return duration [s] and descent [m] of the last cycle, the mean of two."""
    m, s = toy.sleeve_mass, toy.bird_mass
    arm, bird = toy.sleeve_arm, toy.bird_arm
    levers = np.array([1.0, arm, bird])
    mass = s * np.outer(levers, levers) + np.diag([m, toy.sleeve_inertia, toy.bird_inertia])
    weight = -GRAVITY * (s * levers + np.array([m, 0.0, 0.0]))
    stiffness = toy.spring * np.array([[0.0, 0.0, 0.0], [0.0, 1.0, -1.0], [0.0, -1.0, 1.0]])
    edge = [1.0, toy.sleeve_radius, 0.0]
    rows = np.array(
        [
            [0.0, 0.0, -toy.beak_height],
            [0.0, toy.sleeve_height, 0.0],
            [0.0, -toy.sleeve_height, 0.0],
            [1.0, arm, bird - toy.beak_arm],
            edge,
            edge,
        ]
    )
    room = toy.sleeve_radius - toy.pole_radius
    offset = np.array([arm + bird - toy.beak_arm - toy.pole_radius, room, room])
    restitution = np.array([toy.beak_restitution, toy.sleeve_restitution, toy.sleeve_restitution])
    q, u = np.array([0.0, -room / toy.sleeve_height, -0.2788]), np.array([-0.3411, 0.0, -7.4583])
    n, inverse = int(t_end / step), np.linalg.inv(mass)
    hits = _march(step, n, q, u, inverse, weight, stiffness, rows, offset, restitution, toy.friction)
    return float(hits[-1, 0] - hits[-3, 0]) / 2.0, float(hits[-3, 1] - hits[-1, 1]) / 2.0
