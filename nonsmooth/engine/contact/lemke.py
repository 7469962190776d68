"""Lemke's method on the faceted problem, the facets then laid along the friction that it finds.

With the disc of Coulomb replaced by a polygon whose corners are the unit vectors d_j, the laws are a linear
complementarity problem (Stewart and Trinkle 1996; Anitescu and Potra 1997) in the forces f_N and beta,
f_T = sum of d_j beta_j, and one slip acceleration lambda per contact at rest:

    a_N                          >= 0   complementary to   f_N
    d_j . a_T + lambda           >= 0   complementary to   beta_j
    mu f_N - (sum of beta_j)     >= 0   complementary to   lambda

A corner that points along the exact friction makes the exact solution one of the faceted problem: solved again
with the corners so laid, the facets leave no trace.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import friction_of_slip
from nonsmooth.engine.delassus.delassus import write_dense
from nonsmooth.engine.native.kernel import Workspace, at, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted

STAGES = 12
"""In each of which corners are turned to where the last one found the friction; a few do where that settles at all."""
CORNERS = 4
"""Of the polygon in place of Coulomb's disc, one of them along the friction: the others only bound what turns away."""
_ZERO = 1e-11
"""Entries of the scaled tableau, and differences of ratios in it, below this are round-off."""


@kernel("f8(ws, i8, i8, i8)")
def _corner(ws: Workspace, a: int, j: int, r: int) -> float:
    """Return component ``r`` of corner ``j``; corner 0 points along the friction."""
    d1, d2 = ws.actives[a].direction
    turn = 2.0 * math.pi * j / CORNERS
    if r == 1:
        return float(-d1 * math.cos(turn) + d2 * math.sin(turn))
    return float(-d2 * math.cos(turn) - d1 * math.sin(turn))


@kernel("f8(ws, i8, i8)")
def _push(ws: Workspace, line: int, column: int) -> float:
    """Return what the unknown of a column does to row ``line`` of G f, G standing in full in ``matrix``."""
    a, j = ws.problem.lemke_contact[column], ws.problem.lemke_corner[column]
    active, g = ws.actives[a], at(ws.floats, ws.problem.matrix.start + line * 3 * ws.problem.n_active + 3 * a)
    if j >= 0:
        return g[1] * _corner(ws, a, j, 1) + g[2] * _corner(ws, a, j, 2)
    if j == -2:
        return 0.0
    if active.is_at_rest:
        return g[0]
    return float(g[0] - active.friction_coefficient * (active.direction[0] * g[1] + active.direction[1] * g[2]))


@kernel("i8(ws)")
def _list_unknowns(ws: Workspace) -> int:
    """List contact and corner of every unknown: -1 is a normal force, -2 a slip acceleration; return their number."""
    n = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        for j in range(-2 if active.is_at_rest else -1, CORNERS if active.is_at_rest else 0):
            ws.problem.lemke_contact[n], ws.problem.lemke_corner[n] = a, j
            n += 1
    return n


@kernel("i8(ws, i8, i8)")
def _row(ws: Workspace, n: int, i: int) -> int:
    """Return where row ``i`` of the tableau begins: factors of ``n`` unknowns, of the covering variable, constant."""
    return int(ws.problem.tableau.start + i * (n + 2))


@kernel("void(ws, i8, f8, f8)")
def _lay(ws: Workspace, n: int, g: float, size: float) -> None:
    """Write the tableau: complementary quantities by unknowns, covering column, constant; ``g``, ``size``: scales."""
    for i in range(n):
        a, corner = ws.problem.lemke_contact[i], ws.problem.lemke_corner[i]
        active = ws.actives[a]
        row = _row(ws, n, i)
        # a cover that differs from row to row keeps pivots from being equal
        ws.floats[row + n] = 1.0 + 0.3 * ((0.6180339887498949 * (i + 1)) % 1.0)
        ws.floats[row + n + 1] = 0.0
        ws.problem.lemke_row[i], ws.problem.lemke_column[i] = i, n + i
        for j in range(n):
            other, its = ws.problem.lemke_contact[j], ws.problem.lemke_corner[j]
            entry = 0.0
            if corner == -1:
                entry = _push(ws, 3 * a, j) / g
            elif corner == -2:
                if other == a and its >= 0:
                    entry = -1.0
                elif other == a and its == -1:
                    entry = active.friction_coefficient
            else:
                for r in range(1, 3):
                    entry += _corner(ws, a, corner, r) * _push(ws, 3 * a + r, j) / g
                if other == a and its == -2:
                    entry = 1.0
            ws.floats[row + j] = entry
        if corner == -1:
            ws.floats[row + n + 1] = active.free[0] / size
        elif corner >= 0:
            for r in range(1, 3):
                ws.floats[row + n + 1] += _corner(ws, a, corner, r) * active.free[r] / size
    ws.problem.lemke_column[n] = 2 * n


@kernel("void(ws, i8, i8, i8)")
def _pivot(ws: Workspace, n: int, r: int, s: int) -> None:
    """Exchange the quantity of row ``r`` for that of column ``s``."""
    row = _row(ws, n, r)
    pivot = ws.floats[row + s]
    for j in range(n + 2):
        ws.floats[row + j] = -ws.floats[row + j] / pivot
    ws.floats[row + s] = 1.0 / pivot
    for i in range(n):
        if i == r:
            continue
        other = _row(ws, n, i)
        t = ws.floats[other + s]
        if t != 0.0:
            for j in range(n + 2):
                ws.floats[other + j] += t * ws.floats[row + j]
            ws.floats[other + s] = t / pivot
    ws.problem.lemke_row[r], ws.problem.lemke_column[s] = ws.problem.lemke_column[s], ws.problem.lemke_row[r]


@kernel("i8(ws, i8)")
def _first_row(ws: Workspace, n: int) -> int:
    """Return the row that the covering variable enters at, or -1 if none is needed."""
    first, worst = -1, 0.0
    for i in range(n):
        row = _row(ws, n, i)
        ratio = ws.floats[row + n + 1] / ws.floats[row + n]
        if ratio < worst:
            first, worst = i, ratio
    return first


@kernel("i8(ws, i8, i8)")
def _leaving(ws: Workspace, n: int, s: int) -> int:
    """Return the row that reaches zero first when column ``s`` grows, or -1; among equals the covering variable."""
    best, chosen = 1e300, -1
    for i in range(n):
        row = _row(ws, n, i)
        entry = ws.floats[row + s]
        if entry < -_ZERO:
            ratio = max(0.0, ws.floats[row + n + 1]) / -entry
            if ratio < best:
                best = ratio
    pivot = 0.0
    for i in range(n):
        row = _row(ws, n, i)
        entry = ws.floats[row + s]
        if entry < -_ZERO and max(0.0, ws.floats[row + n + 1]) / -entry <= best + _ZERO:
            if ws.problem.lemke_row[i] == 2 * n:
                return i
            if -entry > pivot:
                pivot, chosen = -entry, i
    return chosen


@entry_point("b1(ws, i8)")
def search_by_pivots(ws: Workspace, stage: int) -> bool:
    """Write ``active_forces`` of the faceted problem; return 1 if there are none, its path ending in a ray."""
    m = ws.problem.n_active
    if m > ws.model.n_pivoted:
        return True
    write_dense(ws)
    g = size = 0.0
    for i in range(3 * m):
        g = max(g, ws.problem.matrix[i * 3 * m + i])
        size = max(size, abs(ws.problem.free_accelerations[i]))
        ws.problem.forces[i] = 0.0
    if size == 0.0:
        return False
    n = _list_unknowns(ws)
    _lay(ws, n, g, size)
    row, column = _first_row(ws, n), n
    for _pivots in range(50 * n):
        if row < 0 or interrupted(ws, m):
            break
        left = ws.problem.lemke_row[row]
        _pivot(ws, n, row, column)
        if left == 2 * n:
            break
        # what enters next is the partner of what has left
        partner = left - n if left >= n else left + n
        for j in range(n + 1):
            if ws.problem.lemke_column[j] == partner:
                column = j
        row = _leaving(ws, n, column)
        if row < 0:
            return True
    for i in range(n):
        unknown = ws.problem.lemke_row[i] - n
        if unknown < 0 or unknown >= n:
            continue
        value = ws.floats[_row(ws, n, i) + n + 1] * size / g
        a, j = ws.problem.lemke_contact[unknown], ws.problem.lemke_corner[unknown]
        active = ws.actives[a]
        if j == -1:
            active.normal_force = value
        elif j >= 0:
            for r in range(1, 3):
                active.force[r] += value * _corner(ws, a, j, r)
    for a in range(m):
        if not ws.actives[a].is_at_rest:
            friction_of_slip(ws, a)
    return False
