"""Directions of incipient slip made exact: the friction of a contact that starts to slide opposes its acceleration."""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import eliminate_reduced
from nonsmooth.engine.contact.trial import hold_tried
from nonsmooth.engine.contact.unknowns import list_unknown
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.modes import SLIDE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, at, entry_point, kernel, unknown_at
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
def _across(S: Scalars, w: Floats, k: Integers, a: int, i: int) -> float:
    """Write what row ``i`` of contact ``a``, that of its turn, lacks; return how wrong it is, relative."""
    d1, d2 = active_at(S, w, k, a).direction
    a1, a2 = _acceleration(S, w, k, a, 1), _acceleration(S, w, k, a, 2)
    w[S.right + i] = -(a1 * d2 - a2 * d1)
    return float(abs(w[S.right + i]) / max(S.acceleration_scale, abs(a1), abs(a2)))


@kernel("f8(S, F, I, i8)")
def _worst_across(S: Scalars, w: Floats, k: Integers, n: int) -> float:
    """Write the right-hand side of Newton's system; return how wrong the worst direction is.

    The forces of the present directions are exact.
    """
    worst = 0.0
    for i in range(n):
        unknown = unknown_at(S, w, k, i)
        w[S.right + i] = 0.0
        if unknown.turn == 1:
            worst = max(worst, _across(S, w, k, unknown.contact, i))
    return worst


@kernel("void(S, F, I, i8, i8, i8)")
def _write_row(S: Scalars, w: Floats, k: Integers, a: int, i: int, n: int) -> None:
    """Write row ``i`` of Newton's system, one of contact ``a``: of an acceleration, or of that across a slip."""
    active, unknown = active_at(S, w, k, a), unknown_at(S, w, k, i)
    line, turn, r = band_row(S.reduced, i, n, S.half_band), unknown.turn, unknown.direction
    d1, d2 = active.direction
    for block in range(active.first_block, active.end_block):
        other = active_at(S, w, k, k[S.block_column + block])
        out, end = line + other.first_unknown, line + other.end_unknown
        if out == end:
            continue
        g = at(w, S.delassus + DELASSUS * block)
        if turn == 1:
            g0, g1, g2 = d2 * g[3] - d1 * g[6], d2 * g[4] - d1 * g[7], d2 * g[5] - d1 * g[8]
        else:
            g0, g1, g2 = g[3 * r], g[3 * r + 1], g[3 * r + 2]
        e1, e2 = other.direction
        if other.normal_held == 1:
            w[out] = g0 if other.tangent_held == 1 else g0 - other.mu * (e1 * g1 + e2 * g2)
            out += 1
        if other.tangent_held == 1:
            w[out], w[out + 1] = g1, g2
            out += 2
        if out < end:
            w[out] = e2 * g1 - e1 * g2
    if turn == 1:
        _add_turn(S, w, k, a, i, n)


@kernel("void(S, F, I, i8, i8, i8)")
def _add_turn(S: Scalars, w: Floats, k: Integers, a: int, i: int, n: int) -> None:
    """Add what turning the direction of contact ``a`` does to what is across it, by the force that the turn moves.

    Of next to no force it is so much that the row is weighed less, or all others would count as zero beside it.
    """
    active, own = active_at(S, w, k, a), diagonal_block(S, w, k, a)
    force, (d1, d2) = active.mu * active.normal_force, active.direction
    if not abs(force) > 0.0:
        return
    line = band_row(S.reduced, i, n, S.half_band)
    turned = (_acceleration(S, w, k, a, 1) * d1 + _acceleration(S, w, k, a, 2) * d2) / force
    w[line + i] += turned
    mobility = max(own.nn, own.t11, own.t22)
    weight = mobility / (mobility + abs(turned))
    w[S.right + i] *= weight
    for j in range(max(0, i - S.half_band), min(n, i + S.half_band + 1)):
        w[line + j] *= weight


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
    if it arrives, its forces in ``active_forces``, or 2 where there is nothing to turn.  Nothing is asked of signs and
    bounds.
    """
    turns = 0
    for a in range(S.n_active):
        turns += _starts(S, w, k, a)
    if turns == 0:
        return 2
    best = 1e300
    for _step in range(_STEPS):
        hold_tried(S, w, k)
        n = _list_unknowns(S, w, k)
        worst = _worst_across(S, w, k, n)
        if worst <= EXACT or (worst <= _NEAR and worst >= best):
            return 1
        best = min(best, worst)
        if open_band(S, w, k, n, S.reduced) == 0:
            return 0
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            for i in range(active.first_unknown, active.end_unknown):
                _write_row(S, w, k, a, i, n)
        _solve(S, w, n)
        for i in range(n):
            if unknown_at(S, w, k, i).turn == 1:
                _turn(S, w, k, i)
    return 0
