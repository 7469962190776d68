"""Forces of the active contacts when it is known what each of them does.

One linear problem serves sustained contact and impact.  For every active contact the normal force is
either unknown (``normal_held``: its normal row of G f + b must vanish) or given in ``active_forces``; the
tangential force is either unknown (``tangent_held``: sticking) or follows the slip, -mu f_N d.
"""

from __future__ import annotations

from nonsmooth.engine.contact.unknowns import list_unknown, set_force
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    entry_point,
    kernel,
)
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.linear import (
    SINGULAR,
    band_row,
    band_width,
    complete,
    eliminate,
    minimum_norm,
    rank_of_semidefinite,
    solve_three,
    subtract_part,
    transpose,
)
from nonsmooth.engine.numerics.null_band import least_norm_in_band
from nonsmooth.engine.numerics.vectors import length

DOUBTFUL = 1e-5
"""A pivot below this part of the largest entry may be that of contacts of which one is redundant."""
_COUPLED = 1e-7
"""Null-space entries above this tie a contact to the group whose forces are not unique."""


@entry_point()
def resolve(ws: Workspace) -> None:
    """Complete ``active_forces``; where the forces are not unique, take those of least norm and mark the contacts."""
    n = _collect(ws)
    interrupted(ws, n * ws.problem.n_active)
    if ws.problem.n_active == 1 and n == 3 and _stick_alone(ws):
        return
    if not open_band(ws, n, ws.problem.reduced.start):
        return
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        for i in range(active.first_unknown, active.end_unknown):
            _write_row(ws, a, i, n)
    if not solve_unknowns(ws, n):
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            for i in range(active.first_unknown, active.end_unknown):
                _write_frictionless_row(ws, a, i, n)
        solve_doubtful(ws, n)
    for i in range(n):
        set_force(ws, i, ws.problem.x[i])
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.is_normal_force_unknown and not active.sticks:
            friction_of_slip(ws, a)


@kernel("b1(ws)")
def _stick_alone(ws: Workspace) -> bool:
    """Complete the forces of an island of one contact that sticks; return 0, nothing done, where that is doubtful."""
    active, own = ws.actives[0], diagonal_block(ws, 0).entries
    rows = (own[0], own[1], own[2]), (own[3], own[4], own[5]), (own[6], own[7], own[8])
    right = -active.free[0], -active.free[1], -active.free[2]
    forces = solve_three(rows[0], rows[1], rows[2], right, DOUBTFUL)
    if forces[0] != forces[0]:
        return False
    ws.problem.n_unknown, ws.problem.is_deficient, ws.problem.is_null_space_banded = 3, False, False
    active.normal_force, active.friction = forces[0], (forces[1], forces[2])
    return True


@kernel("void(ws, i8, i8, i8)")
def _write_row(ws: Workspace, a: int, i: int, n: int) -> None:
    """Write the row of unknown ``i``, one of contact ``a``: what the unknowns and the given forces do to it."""
    active = ws.actives[a]
    r = ws.unknowns[i].direction
    ws.problem.right[i] = -add_product(ws, active.free[r], a, r, ws.problem.forces.start)
    line = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        pushing = ws.actives[ws.island.block_column[block]]
        g = at(ws.floats, ws.island.delassus.start + DELASSUS * block + 3 * r)
        out = line + pushing.first_unknown
        if pushing.is_normal_force_unknown:
            ws.floats[out] = g[0]
            if not pushing.sticks:
                # the friction of a sliding contact moves with its normal force
                ws.floats[out] -= pushing.friction_coefficient * (
                    pushing.direction[0] * g[1] + pushing.direction[1] * g[2]
                )
            out += 1
        if pushing.sticks:
            ws.floats[out], ws.floats[out + 1] = g[1], g[2]


@kernel("void(ws, i8, i8, i8)")
def _write_frictionless_row(ws: Workspace, a: int, i: int, n: int) -> None:
    """Write row ``i`` of what the unknowns would do without the friction of sliding contacts to ``matrix``."""
    active = ws.actives[a]
    r = ws.unknowns[i].direction
    line = band_row(ws.problem.matrix.start, i, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        pushing = ws.actives[ws.island.block_column[block]]
        for j in range(pushing.first_unknown, pushing.end_unknown):
            ws.floats[line + j] = ws.island.delassus[DELASSUS * block + 3 * r + ws.unknowns[j].direction]


@kernel("b1(ws, i8)")
def solve_unknowns(ws: Workspace, n: int) -> bool:
    """Solve ``reduced . x = right`` of the unknowns in ``column``; return 0 if the matrix is doubtfully regular.

    Then zeros are written over the band of ``matrix``, for :func:`solve_doubtful`.
    """
    ws.problem.n_unknown = n
    ws.problem.is_deficient = ws.problem.is_null_space_banded = False
    if n == 1 and ws.problem.reduced[0] != 0.0:
        ws.problem.x[0] = ws.problem.right[0] / ws.problem.reduced[0]
        return True
    if eliminate_reduced(ws, n, DOUBTFUL):
        return True
    for i in range(n * band_width(n, ws.problem.half_band)):
        ws.problem.matrix[i] = 0.0
    return False


@entry_point("void(ws, i8)")
def solve_doubtful(ws: Workspace, n: int) -> None:
    """Solve ``reduced . x = right`` for least norm if singular.

    In ``matrix`` stands what the unknowns would do if nothing slid with friction.  Its rank is that of the contacts'
    geometry, and not to be judged by the reduced matrix: next to a position in which contacts become redundant
    friction gives that a small pivot of its own.  Least norm stays in the band, or is treated in full where the band
    fills it.
    """
    full = band_width(n, ws.problem.half_band) == n
    rank = rank_of_semidefinite(ws.floats, ws.problem.matrix.start, n) if full else n
    if rank == n and eliminate_reduced(ws, n, SINGULAR):
        return
    ws.problem.is_deficient = True
    if not full:
        ws.problem.is_null_space_banded = True
        least_norm_in_band(ws, n)
    else:
        _least_norm(ws, n, rank)
    for i in range(n):
        if null_entry(ws, i, i) > _COUPLED:
            ws.actives[ws.unknowns[i].contact].has_redundant_force = True


@kernel("void(ws, i8, i8)")
def _least_norm(ws: Workspace, n: int, most: int) -> None:
    """Solve the singular system, stored in full, for least norm.

    A basis of its null space is kept in the last rows of ``basis``, and the projector on it in ``null``.
    """
    transpose(ws.floats, ws.problem.reduced.start, n, ws.problem.matrix.start)
    ws.problem.rank = minimum_norm(
        ws.floats,
        ws.problem.matrix.start,
        n,
        ws.problem.right.start,
        ws.problem.x.start,
        ws.problem.basis.start,
        ws.problem.sigma.start,
        most,
    )
    complete(ws.floats, ws.problem.basis.start, n, ws.problem.rank)
    for i in range(n):
        for j in range(n):
            ws.problem.null[i * n + j] = 0.0
        for c in range(ws.problem.rank, n):
            subtract_part(
                ws.floats,
                ws.problem.null.start + i * n,
                -ws.problem.basis[c * n + i],
                ws.problem.basis.start + c * n,
                n,
            )


@kernel("b1(ws, i8, f8)")
def eliminate_reduced(ws: Workspace, n: int, least: float) -> bool:
    """Solve ``reduced . x = right`` by elimination; return 0 if singular."""
    for i in range(n):
        ws.problem.x[i] = ws.problem.right[i]
    for i in range(n * band_width(n, ws.problem.half_band)):
        ws.problem.matrix[i] = ws.problem.reduced[i]
    return eliminate(ws.floats, ws.problem.matrix.start, n, ws.problem.half_band, ws.problem.x.start, least)


@kernel("f8(ws, i8, i8)")
def null_entry(ws: Workspace, i: int, j: int) -> float:
    """Return an entry of the projector on the null space; those outside of a band count as zero."""
    if not ws.problem.is_null_space_banded:
        return ws.problem.null[i * ws.problem.n_unknown + j]
    if abs(i - j) > ws.problem.null_half_band:
        return 0.0
    return ws.floats[band_row(ws.problem.reduced.start, i, ws.problem.n_unknown, ws.problem.null_half_band) + j]


@kernel("i8(ws)")
def _collect(ws: Workspace) -> int:
    """List the unknown components and write the given ones; return how many are unknown."""
    n = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.has_redundant_force = False
        active.first_unknown = n
        if active.is_normal_force_unknown:
            list_unknown(ws, n, a, 0, turn=False)
            n += 1
            active.normal_force = 0.0
        active.friction = 0.0, 0.0
        if active.sticks:
            list_unknown(ws, n, a, 1, turn=False)
            list_unknown(ws, n + 1, a, 2, turn=False)
            n += 2
        else:
            friction_of_slip(ws, a)
    ws.problem.first_unknown[ws.problem.n_active] = n
    return n


@kernel("void(ws, i8)")
def friction_of_slip(ws: Workspace, a: int) -> None:
    """Write the friction of the sliding active contact ``a``, -mu f_N d."""
    active = ws.actives[a]
    pull = -active.friction_coefficient * active.normal_force
    active.friction = pull * active.direction[0], pull * active.direction[1]


@kernel("f8(ws, i8)")
def reduced_coefficient(ws: Workspace, a: int) -> float:
    """Return the gap acceleration per normal force of the sliding active contact ``a``, its friction included."""
    active, own = ws.actives[a], diagonal_block(ws, a)
    return float(own.nn - active.friction_coefficient * (active.direction[0] * own.n1 + active.direction[1] * own.n2))


@kernel()
def evaluate_margins(ws: Workspace) -> None:
    """Write, for every sticking active contact, how far its friction is from the static bound [N].

    A contact whose tangential force is not unique obeys two bounds: the sum rule of its group, Eq. (38),
    and the plain bound for the part of its force that is unique.
    """
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if not active.sticks:
            active.static_margin = 0.0
            continue
        if active.has_redundant_force:
            _group_margin(ws, a)
        else:
            active.static_margin = active.static_coefficient * active.normal_force - length(active.friction)


@kernel("void(ws, i8)")
def _group_margin(ws: Workspace, a: int) -> None:
    active = ws.actives[a]
    own = active.first_unknown + active.is_normal_force_unknown
    first, end = 0, ws.problem.n_unknown - 1
    if ws.problem.is_null_space_banded:
        first, end = max(0, own - ws.problem.null_half_band), min(end, own + ws.problem.null_half_band)
    bound = sum1 = sum2 = 0.0
    for i in range(first, end):
        unknown = ws.unknowns[i]
        sharing = ws.actives[unknown.contact]
        if unknown.direction != 1 or not sharing.has_redundant_force:
            continue
        coupling = (
            abs(null_entry(ws, own, i))
            + abs(null_entry(ws, own, i + 1))
            + abs(null_entry(ws, own + 1, i))
            + abs(null_entry(ws, own + 1, i + 1))
        )
        if coupling > _COUPLED or unknown.contact == a:
            bound += sharing.static_coefficient * sharing.normal_force
            sum1 += sharing.friction[0]
            sum2 += sharing.friction[1]
    group = bound - length((sum1, sum2))
    # the part of the force orthogonal to this contact's share of the null space
    p11, p12 = null_entry(ws, own, own), null_entry(ws, own, own + 1)
    p22 = null_entry(ws, own + 1, own + 1)
    t1, t2 = active.friction
    unique = 0.0
    if p11 * p22 - p12 * p12 < _COUPLED * (p11 + p22) * (p11 + p22):
        if p11 >= p22:
            e1, e2 = p11, p12
        else:
            e1, e2 = p12, p22
        unique = abs(e1 * t2 - e2 * t1) / length((e1, e2))
    active.static_margin = min(group, active.static_coefficient * active.normal_force - unique)
