"""Forces of the active contacts in given modes, from one system of linear equations.

The accelerations of the contacts are a = b + G f: b without contact forces, G the Delassus matrix, f the forces. The
unknowns are

* the normal force of each contact with ``is_normal_force_unknown``, so that a_n = 0;
* the friction of each contact that ``sticks``, so that a_t = 0.

All other normal forces are given. Friction that slides is f_t = -mu f_n d, so it follows from the normal force. In an
impact the same equations hold for impulses and velocities.

More contacts than the motion determines, as under a table with four legs, make the system singular: the forces are
redundant. The forces of least norm are then found, together with the projector on the null space, which shows which
forces may change without a change of the motion. Near such a position the pivots of the elimination become small
gradually. So small pivots alone do not decide: the rank is taken from the matrix without sliding friction, which is
positive semidefinite and depends on the geometry alone.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.unknowns import count_as_unique, list_unknowns, set_force
from nonsmooth.engine.delassus.delassus import acceleration, diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import FIRST_ROW, SINGULAR
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, at, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.arrays import clear, copy_numbers, subtract_part
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.least_norm import complete, minimum_norm, rank_of_semidefinite, transpose
from nonsmooth.engine.numerics.linear import band_row, band_width, eliminate, solve_three
from nonsmooth.engine.numerics.null_band import least_norm_in_band
from nonsmooth.engine.numerics.vectors import length

ILL_CONDITIONED = 1e-5
"""Pivot, relative to the largest entry, below which a contact may be redundant, so that the rank is examined."""
_COUPLED = 1e-7
"""Entry of the null-space projector (whose entries are at most 1) above which an unknown is redundant. It is far above
round-off."""


# --- the system of equations ------------------------------------------------------------------------------------------


@entry_point()
def resolve(ws: Workspace) -> None:
    """Find the unknown forces of the active contacts [N]. ``sticks`` and ``is_normal_force_unknown`` give the modes.

    If forces are redundant, those of least norm are found, and the contacts get ``has_redundant_force``. Signs and
    bounds of the forces are not checked.
    """
    # the slip directions are given, so their turns are no unknowns
    n = list_unknowns(ws, with_turns=False)
    for active in ws.actives:
        _set_known_forces(ws, active)
    # an interrupt is counted here and noticed by the callers, because forces are needed in any case
    interrupted(ws, n * ws.problem.n_active)
    # an island of one contact that sticks (three unknowns) needs no matrix
    if ws.problem.n_active == 1 and n == 3 and _solve_lone_sticking(ws):
        return
    # False: the band has too many entries. The unknown forces are left as they are, and the run stops
    if not open_band(ws, n, ws.problem.reduced.start):
        return
    for i in range(n):
        _write_row(ws, i, n)
    # False: the matrix is ill-conditioned, and its rank is found without friction
    if not solve_unknowns(ws, n):
        for i in range(n):
            _write_frictionless_row(ws, i, n)
        solve_ill_conditioned(ws, n)
    for i in range(n):
        set_force(ws, i, ws.problem.x[i])
    for active in ws.actives:
        if active.is_normal_force_unknown and not active.sticks:
            # friction follows from the normal force found
            friction_of_slip(ws, active.index)


@kernel("void(ws, ActiveContact)")
def _set_known_forces(ws: Workspace, active: ActiveContact) -> None:
    """Set the forces of a contact to the known ones [N]: normal force 0 unless given, and friction if it slides.

    So the accelerations under these forces give the right-hand side for the unknowns.
    """
    if active.is_normal_force_unknown:
        active.normal_force = 0.0
    # friction that sticks is unknown
    active.friction = 0.0, 0.0
    if not active.sticks:
        friction_of_slip(ws, active.index)


@kernel("b1(ws)")
def _solve_lone_sticking(ws: Workspace) -> bool:
    """Find the force of an island of one contact that sticks [N]. False, with nothing done, if ill-conditioned."""
    active = ws.actives[0]
    # the block of the Delassus matrix, row by row; the right-hand side is minus the acceleration without the force
    own = diagonal_block(ws, active.index).entries
    rows = (own[0], own[1], own[2]), (own[3], own[4], own[5]), (own[6], own[7], own[8])
    right = -active.free[0], -active.free[1], -active.free[2]
    forces = solve_three(rows[0], rows[1], rows[2], right, ILL_CONDITIONED)
    # not a number: a pivot is small
    if math.isnan(forces[0]):
        return False
    count_as_unique(ws, n=3)
    active.normal_force, active.friction = forces[0], (forces[1], forces[2])
    return True


@kernel("void(ws, i8, i8)")
def _write_row(ws: Workspace, i: int, n: int) -> None:
    """Write row ``i`` of ``n`` to ``reduced``: acceleration in the direction of unknown ``i`` per unit of each unknown.

    The right-hand side is minus the acceleration under the known forces. The unknowns of a contact are its normal
    force, if it has no given one, and its friction, if it sticks.
    """
    active, r = ws.actives[ws.unknowns[i].contact], ws.unknowns[i].direction
    ws.problem.right[i] = -acceleration(ws, active, r)
    line = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        other = ws.actives[ws.island.block_column[block]]
        # row r of the block: its entries for forces of the other contact along n, t1 and t2
        g = at(ws.floats, ws.island.delassus.start + DELASSUS * block + 3 * r)
        out = line + other.first_unknown
        if other.is_normal_force_unknown:
            ws.floats[out] = g[0]
            if not other.sticks:
                # the friction of a sliding contact is proportional to its normal force
                ws.floats[out] -= other.friction_coefficient * (other.direction[0] * g[1] + other.direction[1] * g[2])
            out += 1
        if other.sticks:
            ws.floats[out], ws.floats[out + 1] = g[1], g[2]


@kernel("void(ws, i8, i8)")
def _write_frictionless_row(ws: Workspace, i: int, n: int) -> None:
    """Write row ``i`` of ``n`` to ``matrix``, as if sliding contacts had no friction: this matrix shows the rank."""
    active, r = ws.actives[ws.unknowns[i].contact], ws.unknowns[i].direction
    line = band_row(ws.problem.matrix.start, i, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        other = ws.actives[ws.island.block_column[block]]
        for j in range(other.first_unknown, other.end_unknown):
            # without friction these are entries of the Delassus matrix
            ws.floats[line + j] = ws.island.delassus[DELASSUS * block + 3 * r + ws.unknowns[j].direction]


# --- its solution -----------------------------------------------------------------------------------------------------


@kernel("b1(ws, i8)")
def solve_unknowns(ws: Workspace, n: int) -> bool:
    """Solve ``reduced . x = right`` for ``n`` unknowns. False if the matrix is ill-conditioned.

    All forces count as unique at first. If False, ``x`` is undefined, and ``matrix`` is cleared, so that its rows
    without friction can be written for :func:`solve_ill_conditioned`.
    """
    count_as_unique(ws, n)
    # one equation is never ill-conditioned, and its matrix is one number
    if n == 1 and ws.problem.reduced[0] != 0.0:
        ws.problem.x[0] = ws.problem.right[0] / ws.problem.reduced[0]
        return True
    if eliminate_reduced(ws, n, ILL_CONDITIONED):
        return True
    clear(ws.floats, ws.problem.matrix.start, n * band_width(n, ws.problem.half_band))
    return False


@entry_point("void(ws, i8)")
def solve_ill_conditioned(ws: Workspace, n: int) -> None:
    """Solve ``reduced . x = right`` for ``n`` unknowns, for least norm if the geometry makes contacts redundant.

    ``matrix`` must hold the matrix without sliding friction, and its rank decides. The rank of ``reduced`` would not
    do: near a position in which contacts are redundant, friction alone gives it a small pivot. A matrix that is not
    stored in full is solved within its band. Contacts whose forces are not unique get ``has_redundant_force``.
    """
    is_full = band_width(n, ws.problem.half_band) == n
    # within a band the rank is not known, and elimination decides
    rank = rank_of_semidefinite(ws.floats, ws.problem.matrix.start, n) if is_full else n
    if rank == n and eliminate_reduced(ws, n, SINGULAR):
        return
    ws.problem.is_deficient = True
    if is_full:
        _solve_for_least_norm(ws, n, rank)
    else:
        ws.problem.is_null_space_banded = True
        least_norm_in_band(ws, n)
    for i in range(n):
        # a force that a null-space force changes is not unique
        if null_entry(ws, i, i) > _COUPLED:
            ws.actives[ws.unknowns[i].contact].has_redundant_force = True


@kernel("void(ws, i8, i8)")
def _solve_for_least_norm(ws: Workspace, n: int, max_rank: int) -> None:
    """Solve the singular system of ``n`` unknowns, stored in full, for least norm.

    A basis of the null space (forces that cause no motion) is written to the last rows of ``basis``, the projector on
    it to ``null``. The rank is at most ``max_rank``.
    """
    ws.problem.rank = solve_reduced_for_least_norm(ws, n, max_rank)
    complete(ws.floats, ws.problem.basis.start, n, ws.problem.rank)
    clear(ws.floats, ws.problem.null.start, n * n)
    for i in range(n):
        for k in range(ws.problem.rank, n):
            # the projector is the sum of v v^T over the basis vectors v
            vector = ws.problem.basis.start + k * n
            subtract_part(ws.floats, ws.problem.null.start + i * n, -ws.problem.basis[k * n + i], vector, n)


@kernel("i8(ws, i8, i8)")
def solve_reduced_for_least_norm(ws: Workspace, n: int, max_rank: int) -> int:
    """Solve ``reduced . x = right``, stored in full, for least norm. Returns the rank, at most ``max_rank``.

    The first rows of ``basis`` become a basis of the row space. ``matrix``, ``right`` and ``sigma`` are overwritten.
    """
    matrix, right, x = ws.problem.matrix.start, ws.problem.right.start, ws.problem.x.start
    # the matrix is read by columns
    transpose(ws.floats, ws.problem.reduced.start, n, matrix)
    basis, work = ws.problem.basis.start, ws.problem.sigma.start
    return minimum_norm(ws.floats, matrix, n, right, x, basis, work, max_rank)


@kernel("b1(ws, i8, f8)")
def eliminate_reduced(ws: Workspace, n: int, least: float) -> bool:
    """Solve ``reduced . x = right`` by elimination. False if a pivot is below ``least`` times the largest entry.

    The elimination works on copies in ``matrix`` and ``x``. So ``reduced`` and ``right`` stay, for another attempt
    after False, which leaves ``x`` undefined.
    """
    matrix, x, half = ws.problem.matrix.start, ws.problem.x.start, ws.problem.half_band
    copy_numbers(ws.floats, ws.problem.right.start, n, x)
    copy_numbers(ws.floats, ws.problem.reduced.start, n * band_width(n, half), matrix)
    return eliminate(ws.floats, matrix, n, half, x, least)


@kernel("f8(ws, i8, i8)")
def null_entry(ws: Workspace, i: int, j: int) -> float:
    """Entry (i, j) of the projector on the null space [1]. Entries outside its band count as zero.

    It shows how far unknown forces i and j may change together without a change of the motion.
    """
    if not ws.problem.is_null_space_banded:
        return ws.problem.null[i * ws.problem.n_unknown + j]
    if abs(i - j) > ws.problem.null_half_band:
        return 0.0
    # the banded projector takes the place of the matrix
    return float(ws.floats[band_row(ws.problem.reduced.start, i, ws.problem.n_unknown, ws.problem.null_half_band) + j])


# --- friction ---------------------------------------------------------------------------------------------------------


@kernel("void(ws, i8)")
def friction_of_slip(ws: Workspace, a: int) -> None:
    """Set the friction of sliding active contact ``a`` to -mu f_n d [N]."""
    active = ws.actives[a]
    along = -active.friction_coefficient * active.normal_force
    active.friction = along * active.direction[0], along * active.direction[1]


@kernel("f8(ws, i8)")
def reduced_coefficient(ws: Workspace, a: int) -> float:
    """Gap acceleration of sliding active contact ``a`` per unit of its normal force, friction included [1/kg]."""
    # not positive: more force means more approach (Painleve's paradox)
    active, own = ws.actives[a], diagonal_block(ws, a)
    return float(own.nn - active.friction_coefficient * (active.direction[0] * own.n1 + active.direction[1] * own.n2))


@kernel()
def evaluate_margins(ws: Workspace) -> None:
    """Write ``static_margin`` of the active contacts [N]: at 0, a contact that sticks starts to slide.

    It is the distance of the friction to the static bound if the contact sticks (negative beyond it), and 0 if not.
    """
    for active in ws.actives:
        if not active.sticks:
            active.static_margin = 0.0
        elif active.has_redundant_force:
            active.static_margin = _margin_of_redundant_friction(ws, active)
        else:
            active.static_margin = active.static_coefficient * active.normal_force - length(active.friction)


@kernel("f8(ws, ActiveContact)")
def _margin_of_redundant_friction(ws: Workspace, active: ActiveContact) -> float:
    """Margin [N] by which friction that the accelerations do not determine stays within Coulomb's bounds, Eq. (38).

    Negative if no choice of the undetermined part obeys the bounds. It is the smaller one of two margins.
    """
    # the unknown of its friction along t1 comes after that of its normal force, if there is one (a boolean is 0 or 1)
    first = active.first_unknown + active.is_normal_force_unknown
    # the part of its own friction that all solutions share obeys its own bound
    margin = active.static_coefficient * active.normal_force - _unique_friction(ws, active, first)
    # the friction of all contacts that are redundant together obeys the sum of their bounds
    return float(min(_margin_of_group(ws, active, first), margin))


@kernel("f8(ws, ActiveContact, i8)")
def _margin_of_group(ws: Workspace, active: ActiveContact, first: int) -> float:
    """Sum of the bounds less the sum of the friction of all contacts that are redundant together with a contact [N].

    ``first`` is the unknown of its friction along t1. Components along t1 and t2 are summed as if the tangents of all
    these contacts were parallel.
    """
    # a pair t1, t2 begins before the last unknown
    begin, end = 0, ws.problem.n_unknown - 1
    if ws.problem.is_null_space_banded:
        begin, end = max(0, first - ws.problem.null_half_band), min(end, first + ws.problem.null_half_band)
    # TODO: contacts outside the band, and those coupled by others only, are left out of the sum
    bound = sum_1 = sum_2 = 0.0
    for i in range(begin, end):
        unknown = ws.unknowns[i]
        other = ws.actives[unknown.contact]
        if unknown.direction != FIRST_ROW or not other.has_redundant_force:
            continue
        # contacts are redundant together if their friction changes together in the null space
        coupling = abs(null_entry(ws, first, i)) + abs(null_entry(ws, first, i + 1))
        coupling = coupling + abs(null_entry(ws, first + 1, i)) + abs(null_entry(ws, first + 1, i + 1))
        # the contact itself always counts
        if coupling > _COUPLED or unknown.contact == active.index:
            bound += other.static_coefficient * other.normal_force
            sum_1 += other.friction[0]
            sum_2 += other.friction[1]
    return float(bound - length((sum_1, sum_2)))


@kernel("f8(ws, ActiveContact, i8)")
def _unique_friction(ws: Workspace, active: ActiveContact, first: int) -> float:
    """Part of the friction of a contact that is unique [N]: the part orthogonal to its two rows of the null space.

    It is zero if these rows span the tangent plane. ``first`` is the unknown of its friction along t1.
    """
    # the block of the projector for t1 and t2; it has rank one if the determinant is small
    p11, p12 = null_entry(ws, first, first), null_entry(ws, first, first + 1)
    p22 = null_entry(ws, first + 1, first + 1)
    # rows that vanish count as spanning, too: `_margin_of_group` then has this contact alone. They leave 0 < 0, so the
    # comparison is negated
    if not p11 * p22 - p12 * p12 < _COUPLED * (p11 + p22) * (p11 + p22):
        return 0.0
    t1, t2 = active.friction
    # the rows have rank one here; the longer of them gives the direction that is not unique. Across it, the cross
    # product with the unit vector is the unique part
    e1, e2 = (p11, p12) if p11 >= p22 else (p12, p22)
    return float(abs(e1 * t2 - e2 * t1) / length((e1, e2)))
