"""Directions of incipient slip made exact: the friction of a contact that starts to slide opposes its acceleration."""

from __future__ import annotations

import math

from nonsmooth.engine.contact_trial import hold_tried
from nonsmooth.engine.kernel import Floats, Integers, Scalars, kernel, room
from nonsmooth.engine.linear import eliminate, minimum_norm
from nonsmooth.engine.modes import SLIDE

_STEPS = 25
_TURN = 0.7
"""Largest turn of a direction in one step [rad]."""
_EXACT = 1e-14
_NEAR = 1e-8


@kernel("f8(S, F, i8)")
def _acceleration(S: Scalars, w: Floats, line: int) -> float:
    width = 3 * S.n_active
    total = w[S.b + line]
    for j in range(width):
        total += w[S.delassus + line * width + j] * w[S.f + j]
    return total


@kernel("f8(S, F, I, i8, i8, i8)")
def _effect(S: Scalars, w: Floats, k: Integers, line: int, j: int, p: int) -> float:
    """Return the effect on row ``line`` of unknown ``j``: a force, or from ``p`` on the turn of a direction."""
    column = k[S.column + j]
    a = column // 3
    g = S.delassus + line * 3 * S.n_active + 3 * a
    d1, d2 = w[S.d + 2 * a], w[S.d + 2 * a + 1]
    if j >= p:
        return d2 * w[g + 1] - d1 * w[g + 2]
    if column != 3 * a or k[S.tangent_held + a] == 1:
        return w[g + column - 3 * a]
    return w[g] - w[S.mu + a] * (d1 * w[g + 1] + d2 * w[g + 2])


@kernel("f8(S, F, I, i8, i8)")
def _lay_system(S: Scalars, w: Floats, k: Integers, n: int, size: int) -> float:
    """Write Newton's system for forces and turns; return the worst acceleration across the slip, relative."""
    worst = 0.0
    for i in range(size):
        line = k[S.column + i]
        if i < n:
            w[S.x + i] = 0.0  # the forces of these directions are exact
            for j in range(size):
                w[S.matrix + i * size + j] = _effect(S, w, k, line, j, n)
            continue
        a = line // 3
        d1, d2 = w[S.d + 2 * a], w[S.d + 2 * a + 1]
        a1, a2 = _acceleration(S, w, 3 * a + 1), _acceleration(S, w, 3 * a + 2)
        w[S.x + i] = -(a1 * d2 - a2 * d1)
        for j in range(size):
            w[S.matrix + i * size + j] = d2 * _effect(S, w, k, 3 * a + 1, j, n) - d1 * _effect(S, w, k, 3 * a + 2, j, n)
        # a turn counts by the force that it moves
        force = w[S.mu + a] * w[S.f + 3 * a]
        if abs(force) > 0.0:
            w[S.matrix + i * size + i] += (a1 * d1 + a2 * d2) / force
        worst = max(worst, abs(w[S.x + i]) / max(S.acceleration_scale, abs(a1), abs(a2)))
    return worst


@kernel("i8(S, F, I, i8)")
def _list_turns(S: Scalars, w: Floats, k: Integers, n: int) -> int:
    """Append the contacts that start to slide to the unknowns; return how many unknowns there are then."""
    size = n
    for a in range(S.n_active):
        if k[S.at_rest + a] == 1 and k[S.mode_tried + a] == SLIDE:
            k[S.column + size] = 3 * a
            size += 1
    return size


@kernel("void(S, F, I, i8)")
def _turn(S: Scalars, w: Floats, k: Integers, i: int) -> None:
    """Turn the direction of unknown ``i`` by its step; one without friction follows its acceleration."""
    a = k[S.column + i] // 3
    d1, d2 = w[S.d + 2 * a], w[S.d + 2 * a + 1]
    force = w[S.mu + a] * w[S.f + 3 * a]
    if abs(force) > 0.0:
        angle = max(-_TURN, min(_TURN, w[S.x + i] / force))
        w[S.d + 2 * a], w[S.d + 2 * a + 1] = (
            d1 * math.cos(angle) - d2 * math.sin(angle),
            d2 * math.cos(angle) + d1 * math.sin(angle),
        )
        return
    a1, a2 = _acceleration(S, w, 3 * a + 1), _acceleration(S, w, 3 * a + 2)
    norm = math.sqrt(a1 * a1 + a2 * a2)
    if norm > 0.0:
        w[S.d + 2 * a], w[S.d + 2 * a + 1] = a1 / norm, a2 / norm


@room("i8(S, F, I)")
def polish(S: Scalars, w: Floats, k: Integers) -> int:
    """Turn the directions ``d`` of incipient slip until no acceleration is left across them, the modes being given.

    Newton's method on the turns, the forces of every direction being exact; quadratic, from a good guess.  Return 1
    if it arrives.  Nothing is asked of signs and bounds.
    """
    if _list_turns(S, w, k, 0) == 0:
        return 1
    best = 1e300
    for _step in range(_STEPS):
        hold_tried(S, w, k)
        n = S.n_unknown
        size = _list_turns(S, w, k, n)
        worst = _lay_system(S, w, k, n, size)
        if worst <= _EXACT or (worst <= _NEAR and worst >= best):
            return 1
        best = min(best, worst)
        if eliminate(w, S.matrix, size, S.x) == 0:
            _lay_system(S, w, k, n, size)
            for i in range(size):
                w[S.right + i] = w[S.x + i]
            minimum_norm(w, S.matrix, size, S.right, S.x, S.basis, S.sigma)
        for i in range(n, size):
            _turn(S, w, k, i)
    return 0
