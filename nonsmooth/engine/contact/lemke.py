"""The solver "lemke" of the contact problem: Lemke's method, with polygons in place of Coulomb's discs.

With a polygon whose corners are the unit vectors d_j, the laws are a linear complementarity problem (Stewart and
Trinkle, Int. J. Numer. Methods Eng. 39 (1996) 2673-2691; Anitescu and Potra, Nonlinear Dyn. 14 (1997) 231-247). The
unknowns are normal forces f_n, forces beta_j >= 0 along the corners, with f_t = sum of beta_j d_j, and one slip
acceleration lambda >= 0 of each contact at rest:

    a_n                          >= 0   complementary to   f_n
    d_j . a_t + lambda           >= 0   complementary to   beta_j
    mu f_n - (sum of beta_j)     >= 0   complementary to   lambda

If a corner points along the exact friction, the exact solution solves the problem with the polygon, too. So the problem
is solved again in stages, each with one corner along the friction found last. A polygon of four corners is then enough.

Lemke's method follows a path of pivots. It ends in a solution or in a ray, where it fails. It does not depend on a
start, so it finds solutions that the iterative solvers miss. Its tableau is a full matrix, so it is for few contacts.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import friction_of_slip
from nonsmooth.engine.delassus.delassus import write_dense
from nonsmooth.engine.memory.layout import FIRST_ROW, SECOND_ROW
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, at, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.arrays import clear, largest_size
from nonsmooth.engine.numerics.vectors import Pair

STAGES = 12
"""Number of stages. A few turn the corners along the friction, if this converges at all."""
CORNERS = 4
"""Number of corners of the polygon. The workspace holds six unknowns per contact: these, f_n and lambda."""
_PIVOTS = 50
"""Maximum number of pivots per unknown. It ends a cycle, which round-off may cause."""
_ZERO = 1e-11
"""Entry of the scaled tableau, or difference of ratios in it, that counts as zero: round-off of the pivots."""
_COVER_SPREAD = 0.3
"""Difference between the largest and the smallest factor of the covering variable. Equal ones would lead to ties."""
_GOLDEN_RATIO = 0.6180339887498949
"""Its multiples modulo 1 are spread evenly, so that no two factors of the covering variable are equal."""
_NORMAL_FORCE = -1
"""Number in place of a corner: the unknown is f_n."""
_SLIP_ACCELERATION = -2
"""Number in place of a corner: the unknown is lambda."""
_NO_ROW = -1
"""Number in place of a row of the tableau where there is none."""


@entry_point("b1(ws, i8)")
def search_by_pivots(ws: Workspace, stage: int) -> bool:
    """Find the forces of the problem with polygons in place of Coulomb's discs [N], by Lemke's method.

    True if a further stage is useless: the path ends in a ray, and the forces are zero, or the tableau has no place for
    so many contacts, and the forces are as before. All stages are equal. Between them, the search turns ``direction``,
    and with it the corners. So ``stage`` is not used.
    """
    n_active = ws.problem.n_active
    if n_active > ws.model.n_pivoted:
        return True
    write_dense(ws)
    clear(ws.floats, ws.problem.forces.start, 3 * n_active)
    # scales of the tableau: largest free acceleration, and largest diagonal entry of the Delassus matrix
    size, inverse_mass = largest_size(ws.floats, ws.problem.free_accelerations.start, 3 * n_active), 0.0
    for i in range(3 * n_active):
        inverse_mass = max(inverse_mass, ws.problem.matrix[i * 3 * n_active + i])
    # without accelerations no forces are needed: they stay zero
    if size == 0.0:
        return False
    n = _list_unknowns(ws)
    _write_tableau(ws, n, inverse_mass, size)
    if _follow_path(ws, n):
        return True
    _read_forces(ws, n, inverse_mass, size)
    for active in ws.actives:
        if not active.is_at_rest:
            # its friction follows from its normal force, the only unknown
            friction_of_slip(ws, active.index)
    return False


# --- the tableau ------------------------------------------------------------------------------------------------------


@kernel("i8(ws)")
def _list_unknowns(ws: Workspace) -> int:
    """List contact and corner of each unknown. Returns the number of unknowns.

    A contact at rest has lambda (its slip acceleration), f_n and forces along its corners, one that slides f_n only.
    """
    n = 0
    for active in ws.actives:
        # numbers below 0 take the place of corners: -2 is lambda, -1 is f_n
        first = _SLIP_ACCELERATION if active.is_at_rest else _NORMAL_FORCE
        for corner in range(first, CORNERS if active.is_at_rest else 0):
            ws.problem.lemke_contact[n], ws.problem.lemke_corner[n] = active.index, corner
            n += 1
    return n


@kernel("v2(ActiveContact, i8)")
def _corner(active: ActiveContact, number: int) -> Pair:
    """Unit vector along t1, t2 of corner ``number`` of the polygon of a contact, which replaces Coulomb's disc."""
    # corner 0 is opposite to the slip direction, as friction is
    d1, d2 = active.direction
    angle = 2.0 * math.pi * number / CORNERS
    return -d1 * math.cos(angle) + d2 * math.sin(angle), -d2 * math.cos(angle) - d1 * math.sin(angle)


@kernel("f8(ws, i8, i8)")
def _acceleration_per_unknown(ws: Workspace, line: int, column: int) -> float:
    """Acceleration along row ``line`` of the Delassus matrix G per unit of the unknown of a ``column`` [1/kg].

    The unknown is a force along a corner or the normal, or lambda, a slip acceleration that causes none.
    """
    a, corner = ws.problem.lemke_contact[column], ws.problem.lemke_corner[column]
    active, g = ws.actives[a], at(ws.floats, ws.problem.matrix.start + line * 3 * ws.problem.n_active + 3 * a)
    if corner >= 0:
        c1, c2 = _corner(active, corner)
        return g[1] * c1 + g[2] * c2
    if corner == _SLIP_ACCELERATION:
        return 0.0
    if active.is_at_rest:
        return g[0]
    # the friction of a contact that slides follows from its normal force
    return float(g[0] - active.friction_coefficient * (active.direction[0] * g[1] + active.direction[1] * g[2]))


@kernel("i8(ws, i8, i8)")
def _row(ws: Workspace, n: int, i: int) -> int:
    """Offset of row ``i`` of the tableau of Lemke's method with ``n`` unknowns."""
    # a row holds the factors of n unknowns, the factor of the covering variable, and the constant
    return int(ws.problem.tableau.start + i * (n + 2))


@kernel("void(ws, i8, f8, f8)")
def _write_tableau(ws: Workspace, n: int, inverse_mass: float, size: float) -> None:
    """Write the tableau of ``n`` rows. It is scaled by an ``inverse_mass`` [1/kg] and the ``size`` of b [m/s^2].

    Row i is a quantity that must not be negative, as a function of the unknowns: a_n, d_j . a_t + lambda, or the
    friction bound. Variables 0 to n - 1 are these quantities, n to 2 n - 1 the unknowns, and 2 n is the covering
    variable, which is added to each row to make it positive at first.
    """
    for i in range(n):
        corner = ws.problem.lemke_corner[i]
        active = ws.actives[ws.problem.lemke_contact[i]]
        row = _row(ws, n, i)
        # factors of the covering variable that all differ, because equal ones would lead to ties
        ws.floats[row + n] = 1.0 + _COVER_SPREAD * ((_GOLDEN_RATIO * (i + 1)) % 1.0)
        # the constant: an acceleration without contact forces; a friction bound has none
        ws.floats[row + n + 1] = 0.0
        # at first all unknowns are zero, and the quantities are the variables of the rows
        ws.problem.lemke_row[i], ws.problem.lemke_column[i] = i, n + i
        for j in range(n):
            ws.floats[row + j] = _tableau_entry(ws, i, j, inverse_mass)
        if corner == _NORMAL_FORCE:
            ws.floats[row + n + 1] = active.free[0] / size
        elif corner >= 0:
            # b along the corner
            c1, c2 = _corner(active, corner)
            ws.floats[row + n + 1] += c1 * active.free[1] / size
            ws.floats[row + n + 1] += c2 * active.free[2] / size
    ws.problem.lemke_column[n] = 2 * n


@kernel("f8(ws, i8, i8, f8)")
def _tableau_entry(ws: Workspace, i: int, j: int, inverse_mass: float) -> float:
    """Factor of unknown ``j`` in row ``i`` of the tableau, where G is divided by ``inverse_mass`` [1/kg].

    The row is that of a_n, of d_j . a_t + lambda, or of the friction bound mu f_n - sum of beta_j, by the unknown
    complementary to it: f_n, beta_j (the force along corner j) or lambda.
    """
    a, corner = ws.problem.lemke_contact[i], ws.problem.lemke_corner[i]
    active, is_own = ws.actives[a], ws.problem.lemke_contact[j] == a
    other_corner = ws.problem.lemke_corner[j]
    if corner == _NORMAL_FORCE:
        return _acceleration_per_unknown(ws, 3 * a, j) / inverse_mass
    if corner == _SLIP_ACCELERATION:
        # the friction bound of the contact: each beta_j counts -1, f_n counts mu, other contacts nothing
        if is_own and other_corner >= 0:
            return -1.0
        return float(active.friction_coefficient if is_own and other_corner == _NORMAL_FORCE else 0.0)
    # lambda enters the rows of its own contact's corners with factor 1
    if is_own and other_corner == _SLIP_ACCELERATION:
        return 1.0
    c1, c2 = _corner(active, corner)
    entry = 0.0
    entry += c1 * _acceleration_per_unknown(ws, 3 * a + 1, j) / inverse_mass
    entry += c2 * _acceleration_per_unknown(ws, 3 * a + 2, j) / inverse_mass
    return entry


# --- the path of pivots -----------------------------------------------------------------------------------------------


@kernel("b1(ws, i8)")
def _follow_path(ws: Workspace, n: int) -> bool:
    """Follow the path of pivots from no forces to a solution. True if it ends in a ray, so that no solution is found.

    The covering variable enters first. After each pivot, the complement of the variable that has left enters. The path
    ends in a solution if the covering variable leaves. False, too, if the path is cut short by an interrupt or by the
    limit of pivots: the search verifies all forces.
    """
    row, column = _first_row(ws, n), n
    # round-off may cause a cycle, which ends here
    for _ in range(_PIVOTS * n):
        # no row: the tableau is solved already; the search notices an interrupt itself
        if row == _NO_ROW or interrupted(ws, ws.problem.n_active):
            return False
        leaving = ws.problem.lemke_row[row]
        _pivot(ws, n, row, column)
        if leaving == 2 * n:
            return False
        # variables i and n + i: one of them is zero in the solution
        complement = leaving - n if leaving >= n else leaving + n
        for j in range(n + 1):
            if ws.problem.lemke_column[j] == complement:
                column = j
        row = _leaving_row(ws, n, column)
        if row == _NO_ROW:
            # no variable reaches zero: a ray
            return True
    return False


@kernel("i8(ws, i8)")
def _first_row(ws: Workspace, n: int) -> int:
    """Row whose variable leaves when the covering variable enters, or -1 if the tableau is solved already.

    It is the row that needs the covering variable most: all constants are then not negative.
    """
    first, worst = _NO_ROW, 0.0
    for i in range(n):
        row = _row(ws, n, i)
        # constant over factor of the covering variable: minus the value of this variable that makes the row zero
        ratio = ws.floats[row + n + 1] / ws.floats[row + n]
        if ratio < worst:
            first, worst = i, ratio
    return first


@kernel("i8(ws, i8, i8)")
def _leaving_row(ws: Workspace, n: int, s: int) -> int:
    """Row whose variable reaches zero first while the variable of column ``s`` grows, or -1 if none does.

    Of equal rows, that of the covering variable is taken, or else the one with the largest pivot.
    """
    least, chosen = math.inf, _NO_ROW
    for i in range(n):
        row = _row(ws, n, i)
        entry = ws.floats[row + s]
        if entry < -_ZERO:
            # a constant below zero is round-off
            least = min(least, max(0.0, ws.floats[row + n + 1]) / -entry)
    pivot = 0.0
    for i in range(n):
        row = _row(ws, n, i)
        entry = ws.floats[row + s]
        if entry < -_ZERO and max(0.0, ws.floats[row + n + 1]) / -entry <= least + _ZERO:
            # its leaving ends the path in a solution
            if ws.problem.lemke_row[i] == 2 * n:
                return i
            if -entry > pivot:
                pivot, chosen = -entry, i
    return chosen


@kernel("void(ws, i8, i8, i8)")
def _pivot(ws: Workspace, n: int, r: int, s: int) -> None:
    """Exchange the variable of row ``r`` for that of column ``s``.

    The row is solved for the variable that enters, and substituted in all other rows.
    """
    row = _row(ws, n, r)
    pivot = ws.floats[row + s]
    # row r: its variable = pivot times the variable of column s + the rest
    for j in range(n + 2):
        ws.floats[row + j] = -ws.floats[row + j] / pivot
    # this column now belongs to the variable that has left
    ws.floats[row + s] = 1.0 / pivot
    for i in range(n):
        other = _row(ws, n, i)
        t = ws.floats[other + s]
        if i != r and t != 0.0:
            # entry s of row r is the factor of the variable that has left, which column s holds now
            for j in range(n + 2):
                ws.floats[other + j] += t * ws.floats[row + j]
            ws.floats[other + s] = t / pivot
    ws.problem.lemke_row[r], ws.problem.lemke_column[s] = ws.problem.lemke_column[s], ws.problem.lemke_row[r]


@kernel("void(ws, i8, f8, f8)")
def _read_forces(ws: Workspace, n: int, inverse_mass: float, size: float) -> None:
    """Write the forces of the solved tableau [N], which are zero before. :func:`_write_tableau` defines the scales.

    Friction of contacts that slide is not written: it follows from their normal force.
    """
    for i in range(n):
        unknown = ws.problem.lemke_row[i] - n
        # only variables n to 2 n - 1 are unknowns
        if not 0 <= unknown < n:
            continue
        # the value of a variable in a row is its constant; all others are zero
        value = ws.floats[_row(ws, n, i) + n + 1] * size / inverse_mass
        active, corner = ws.actives[ws.problem.lemke_contact[unknown]], ws.problem.lemke_corner[unknown]
        if corner == _NORMAL_FORCE:
            active.normal_force = value
        elif corner >= 0:
            c1, c2 = _corner(active, corner)
            # the friction is the sum of the forces along the corners
            active.force[FIRST_ROW] += value * c1
            active.force[SECOND_ROW] += value * c2
