"""Directions of incipient slip made exact: the friction of a contact that starts to slide opposes its acceleration."""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import eliminate_reduced
from nonsmooth.engine.contact.trial import hold_tried
from nonsmooth.engine.contact.unknowns import list_unknown
from nonsmooth.engine.delassus.delassus import add_product
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.modes import SLIDE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, entry_point, kernel, unknown_at
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.linear import SINGULAR, band_row, band_width, minimum_norm, transpose
from nonsmooth.engine.numerics.null_band import solve_shifted
from nonsmooth.engine.numerics.vectors import length

_STEPS = 25
"""Newton steps of the directions: from a guess far off some go to within a turn, and then they are quadratic."""
_TURN = 0.7
"""Largest turn of a direction in one step [rad]."""
EXACT = 1e-14
"""Acceleration across its slip, relative to the largest, that is round-off."""
_NEAR = 1e-8
"""The same where Newton's steps gain no more: next to redundant contacts round-off is larger."""


@kernel("f8(S, F, I, i8, i8)")
def _acceleration(S: Scalars, w: Floats, k: Integers, a: int, r: int) -> float:
    return add_product(S, w, k, active_at(S, w, k, a).free[r], a, r, S.active_forces)


@kernel("f8(S, F, I, i8, i8)")
def _effect(S: Scalars, w: Floats, k: Integers, g: int, j: int) -> float:
    """Return the effect of unknown ``j``, a force or the turn of a direction, on the row of a block at ``g``."""
    unknown = unknown_at(S, w, k, j)
    active = active_at(S, w, k, unknown.contact)
    d1, d2 = active.direction
    if unknown.turn == 1:
        return float(d2 * w[g + 1] - d1 * w[g + 2])
    if unknown.direction != 0 or active.tangent_held == 1:
        return w[g + unknown.direction]
    return float(w[g] - active.mu * (d1 * w[g + 1] + d2 * w[g + 2]))


@kernel("f8(S, F, I, i8, i8, i8)")
def _write_row(S: Scalars, w: Floats, k: Integers, a: int, i: int, n: int) -> float:
    """Write row ``i`` of Newton's system, one of contact ``a``; return how wrong it is, relative."""
    active, unknown = active_at(S, w, k, a), unknown_at(S, w, k, i)
    line = band_row(S.reduced, i, n, S.half_band)
    d1, d2 = active.direction
    for block in range(active.first_block, active.end_block):
        other = active_at(S, w, k, k[S.block_column + block])
        g = S.delassus + DELASSUS * block
        for j in range(other.first_unknown, other.end_unknown):
            if unknown.turn == 0:
                w[line + j] = _effect(S, w, k, g + 3 * unknown.direction, j)
            else:
                w[line + j] = d2 * _effect(S, w, k, g + 3, j) - d1 * _effect(S, w, k, g + 6, j)
    w[S.right + i] = 0.0
    if unknown.turn == 0:
        return 0.0  # the forces of these directions are exact
    a1, a2 = _acceleration(S, w, k, a, 1), _acceleration(S, w, k, a, 2)
    w[S.right + i] = -(a1 * d2 - a2 * d1)
    # a turn counts by the force that it moves
    force = active.mu * active.normal_force
    if abs(force) > 0.0:
        w[line + i] += (a1 * d1 + a2 * d2) / force
    return float(abs(w[S.right + i]) / max(S.acceleration_scale, abs(a1), abs(a2)))


@kernel("i8(S, F, I)")
def _list_unknowns(S: Scalars, w: Floats, k: Integers) -> int:
    """List the forces that are held and the turns of the contacts that start to slide; return how many there are."""
    n = 0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        active.first_unknown = n
        for r in range(3):
            if (active.normal_held if r == 0 else active.tangent_held) == 1:
                list_unknown(S, w, k, n, a, r, 0)
                n += 1
        if _starts(S, w, k, a) == 1:
            list_unknown(S, w, k, n, a, 0, 1)
            n += 1
    k[S.first_unknown + S.n_active] = n
    return n


@kernel("i8(S, F, I, i8)")
def _starts(S: Scalars, w: Floats, k: Integers, a: int) -> int:
    active = active_at(S, w, k, a)
    return 1 if active.at_rest == 1 and active.mode_tried == SLIDE else 0


@kernel("void(S, F, I, i8)")
def _turn(S: Scalars, w: Floats, k: Integers, i: int) -> None:
    """Turn the direction of unknown ``i`` by its step; one without friction follows its acceleration."""
    a = unknown_at(S, w, k, i).contact
    active = active_at(S, w, k, a)
    d1, d2 = active.direction
    force = active.mu * active.normal_force
    if abs(force) > 0.0:
        angle = max(-_TURN, min(_TURN, w[S.x + i] / force))
        active.direction = (
            d1 * math.cos(angle) - d2 * math.sin(angle),
            d2 * math.cos(angle) + d1 * math.sin(angle),
        )
        return
    a1, a2 = _acceleration(S, w, k, a, 1), _acceleration(S, w, k, a, 2)
    norm = length((a1, a2))
    if norm > 0.0:
        active.direction = a1 / norm, a2 / norm


@kernel("void(S, F, i8)")
def _solve(S: Scalars, w: Floats, n: int) -> None:
    """Solve Newton's system; where it is singular, for least norm, or a little off where its band is narrow."""
    if eliminate_reduced(S, w, n, SINGULAR) == 1:
        return
    if band_width(n, S.half_band) < n:
        for i in range(n):
            w[S.x + i] = w[S.right + i]
        solve_shifted(S, w, n)
        return
    transpose(w, S.reduced, n, S.matrix)
    minimum_norm(w, S.matrix, n, S.right, S.x, S.basis, S.sigma, n)


@entry_point("i8(S, F, I)")
def polish(S: Scalars, w: Floats, k: Integers) -> int:
    """Turn the directions of incipient slip until no acceleration is left across them, the modes being given.

    Newton's method on the turns, the forces of every direction being exact; quadratic, from a good guess.  Return 1
    if it arrives.  Nothing is asked of signs and bounds.
    """
    turns = 0
    for a in range(S.n_active):
        turns += _starts(S, w, k, a)
    if turns == 0:
        return 1
    best = 1e300
    for _step in range(_STEPS):
        hold_tried(S, w, k)
        n = _list_unknowns(S, w, k)
        if open_band(S, w, k, n, S.reduced) == 0:
            return 0
        worst = 0.0
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            for i in range(active.first_unknown, active.end_unknown):
                worst = max(worst, _write_row(S, w, k, a, i, n))
        if worst <= EXACT or (worst <= _NEAR and worst >= best):
            return 1
        best = min(best, worst)
        _solve(S, w, n)
        for i in range(n):
            if unknown_at(S, w, k, i).turn == 1:
                _turn(S, w, k, i)
    return 0
