"""Directions of incipient slip made exact: the friction of a contact that starts to slide opposes its acceleration."""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import eliminate_reduced
from nonsmooth.engine.contact.trial import hold_tried
from nonsmooth.engine.contact.unknowns import set_unknown
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    entry_point,
    kernel,
)
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


@kernel("f8(ws, i8, i8)")
def _acceleration(ws: Workspace, a: int, r: int) -> float:
    return add_product(ws, ws.actives[a].free[r], a, r, ws.problem.forces.start)


@kernel("f8(ws, i8, i8)")
def _across(ws: Workspace, a: int, i: int) -> float:
    """Write what row ``i`` of contact ``a``, that of its turn, lacks; return how wrong it is, relative."""
    d1, d2 = ws.actives[a].direction
    a1, a2 = _acceleration(ws, a, FIRST_ROW), _acceleration(ws, a, SECOND_ROW)
    ws.problem.right[i] = -(a1 * d2 - a2 * d1)
    return float(abs(ws.problem.right[i]) / max(ws.problem.acceleration_scale, abs(a1), abs(a2)))


@kernel("f8(ws, i8)")
def _worst_across(ws: Workspace, n: int) -> float:
    """Write the right-hand side of Newton's system; return how wrong the worst direction is.

    The forces of the present directions are exact.
    """
    worst = 0.0
    for i in range(n):
        unknown = ws.unknowns[i]
        ws.problem.right[i] = 0.0
        if unknown.is_turn:
            worst = max(worst, _across(ws, unknown.contact, i))
    return worst


@kernel("void(ws, i8, i8, i8)")
def _write_row(ws: Workspace, a: int, i: int, n: int) -> None:
    """Write row ``i`` of Newton's system, one of contact ``a``: of an acceleration, or of that across a slip."""
    active, unknown = ws.actives[a], ws.unknowns[i]
    line, turn, r = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band), unknown.is_turn, unknown.direction
    d1, d2 = active.direction
    for block in range(active.first_block, active.end_block):
        other = ws.actives[ws.island.block_column[block]]
        out, end = line + other.first_unknown, line + other.end_unknown
        if out == end:
            continue
        g = at(ws.floats, ws.island.delassus.start + DELASSUS * block)
        if turn:
            g0, g1, g2 = d2 * g[3] - d1 * g[6], d2 * g[4] - d1 * g[7], d2 * g[5] - d1 * g[8]
        else:
            g0, g1, g2 = g[3 * r], g[3 * r + 1], g[3 * r + 2]
        e1, e2 = other.direction
        if other.is_normal_force_unknown:
            ws.floats[out] = g0 if other.sticks else g0 - other.friction_coefficient * (e1 * g1 + e2 * g2)
            out += 1
        if other.sticks:
            ws.floats[out], ws.floats[out + 1] = g1, g2
            out += 2
        if out < end:
            ws.floats[out] = e2 * g1 - e1 * g2
    if turn:
        _add_turn(ws, a, i, n)


@kernel("void(ws, i8, i8, i8)")
def _add_turn(ws: Workspace, a: int, i: int, n: int) -> None:
    """Add what turning the direction of contact ``a`` does to what is across it, by the force that the turn moves.

    Of next to no force it is so much that the row is weighed less, or all others would count as zero beside it.
    """
    active, own = ws.actives[a], diagonal_block(ws, a)
    force, (d1, d2) = active.friction_coefficient * active.normal_force, active.direction
    if not abs(force) > 0.0:
        return
    line = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band)
    turned = (_acceleration(ws, a, FIRST_ROW) * d1 + _acceleration(ws, a, SECOND_ROW) * d2) / force
    ws.floats[line + i] += turned
    mobility = max(own.nn, own.t11, own.t22)
    weight = mobility / (mobility + abs(turned))
    ws.problem.right[i] *= weight
    for j in range(max(0, i - ws.problem.half_band), min(n, i + ws.problem.half_band + 1)):
        ws.floats[line + j] *= weight


@kernel("i8(ws)")
def _list_unknowns(ws: Workspace) -> int:
    """List the forces that are held and the turns of the contacts that start to slide; return how many there are."""
    n = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.first_unknown = n
        for r in range(3):
            if active.is_normal_force_unknown if r == 0 else active.sticks:
                set_unknown(ws, n, active, r, is_turn=False)
                n += 1
        if _starts(ws, a):
            set_unknown(ws, n, active, NORMAL_ROW, is_turn=True)
            n += 1
    ws.problem.first_unknown[ws.problem.n_active] = n
    return n


@kernel("b1(ws, i8)")
def _starts(ws: Workspace, a: int) -> bool:
    active = ws.actives[a]
    return active.is_at_rest and active.mode_tried == Mode.SLIDE


@kernel("void(ws, i8)")
def _turn(ws: Workspace, i: int) -> None:
    """Turn the direction of unknown ``i`` by its step; one without friction follows its acceleration."""
    a = ws.unknowns[i].contact
    active = ws.actives[a]
    d1, d2 = active.direction
    force = active.friction_coefficient * active.normal_force
    if abs(force) > 0.0:
        angle = max(-_TURN, min(_TURN, ws.problem.x[i] / force))
        active.direction = (
            d1 * math.cos(angle) - d2 * math.sin(angle),
            d2 * math.cos(angle) + d1 * math.sin(angle),
        )
        return
    a1, a2 = _acceleration(ws, a, FIRST_ROW), _acceleration(ws, a, SECOND_ROW)
    norm = length((a1, a2))
    if norm > 0.0:
        active.direction = a1 / norm, a2 / norm


@kernel("void(ws, i8)")
def _solve(ws: Workspace, n: int) -> None:
    """Solve Newton's system; where it is singular, for least norm, or a little off where its band is narrow."""
    if eliminate_reduced(ws, n, SINGULAR):
        return
    if band_width(n, ws.problem.half_band) < n:
        for i in range(n):
            ws.problem.x[i] = ws.problem.right[i]
        solve_shifted(ws, n)
        return
    transpose(ws.floats, ws.problem.reduced.start, n, ws.problem.matrix.start)
    minimum_norm(
        ws.floats,
        ws.problem.matrix.start,
        n,
        ws.problem.right.start,
        ws.problem.x.start,
        ws.problem.basis.start,
        ws.problem.sigma.start,
        n,
    )


@entry_point("i8(ws)")
def polish(ws: Workspace) -> int:
    """Turn the directions of incipient slip until no acceleration is left across them, the modes being given.

    Newton's method on the turns, the forces of every direction being exact; quadratic, from a good guess.  Return 1
    if it arrives, its forces in ``active_forces``, or 2 where there is nothing to turn.  Nothing is asked of signs and
    bounds.
    """
    turns = 0
    for a in range(ws.problem.n_active):
        turns += _starts(ws, a)
    if turns == 0:
        return 2
    best = math.inf
    for _step in range(_STEPS):
        hold_tried(ws)
        n = _list_unknowns(ws)
        worst = _worst_across(ws, n)
        if worst <= EXACT or (worst <= _NEAR and worst >= best):
            return 1
        best = min(best, worst)
        if not open_band(ws, n, ws.problem.reduced.start):
            return 0
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            for i in range(active.first_unknown, active.end_unknown):
                _write_row(ws, a, i, n)
        _solve(ws, n)
        for i in range(n):
            if ws.unknowns[i].is_turn:
                _turn(ws, i)
    return 0
