"""Forces that hold the closed contacts in their modes during smooth motion.

Every closed contact contributes rows, what it holds, and columns, along what it pushes: a sticking one holds and
pushes along n, t1, t2; a sliding one holds n and pushes along n - mu d, friction included.  Rows times K
times columns is the reduced matrix whose unknowns are the forces; no more of G than that is needed.  A compliant
contact pushes along n as its law says, holds t1, t2 where it sticks, and nothing where it rubs.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.compliance import write_wrench
from nonsmooth.engine.bodies.kinematics import evaluate_row, evaluate_row_response, push_response, row
from nonsmooth.engine.contact.forces import ILL_CONDITIONED, friction_of_slip, solve_ill_conditioned, solve_unknowns
from nonsmooth.engine.contact.null_space_forces import add_null_space_force, choose_null_space_force
from nonsmooth.engine.contact.unknowns import set_unknown
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    Workspace,
    kernel,
)
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.linear import band_row, product, solve_three


@kernel("void(ws, i8)")
def write_rows(ws: Workspace, a: int) -> None:
    """Write rows and columns of the active contact ``a``: Jacobian rows 0 to 2, or 0 and that of the column, 1."""
    active = ws.actives[a]
    c = active.contact
    contact = ws.contacts[c]
    n, t1, t2 = contact.axis_n, contact.axis_1, contact.axis_2
    if active.sticks:
        evaluate_row(ws, c, NORMAL_ROW, n)
        evaluate_row(ws, c, FIRST_ROW, t1)
        evaluate_row(ws, c, SECOND_ROW, t2)
        for r in range(3):
            evaluate_row_response(ws, c, r, r)
        return
    if not active.is_normal_force_unknown:
        write_wrench(ws, c, active.force)
        return
    m1, m2 = active.friction_coefficient * active.direction[0], active.friction_coefficient * active.direction[1]
    push = (
        n[0] - m1 * t1[0] - m2 * t2[0],
        n[1] - m1 * t1[1] - m2 * t2[1],
        n[2] - m1 * t1[2] - m2 * t2[2],
    )
    evaluate_row(ws, c, NORMAL_ROW, n)
    evaluate_row(ws, c, FIRST_ROW, push)
    evaluate_row_response(ws, c, FIRST_ROW, NORMAL_ROW)


@kernel("f8(ws, i8, i8, i8, i8)")
def coupling(ws: Workspace, c: int, r: int, d: int, s: int) -> float:
    """Return what a unit force in column ``s`` of contact ``d`` does to row ``r`` of contact ``c``."""
    contact, pushing = ws.contacts[c], ws.contacts[d]
    total = 0.0
    for side in range(2):
        articulation = contact.articulation_a if side == 0 else contact.articulation_b
        n_u = ws.articulations[articulation].n_u
        jacobian = (contact.jacobian_a if side == 0 else contact.jacobian_b) + r * n_u
        if n_u > 0 and pushing.articulation_a == articulation:
            total = product(ws.floats, total, jacobian, pushing.response_a + s * n_u, n_u)
        if n_u > 0 and pushing.articulation_b == articulation:
            total = product(ws.floats, total, jacobian, pushing.response_b + s * n_u, n_u)
    return total


@kernel("i8(ws)")
def _list_rows(ws: Workspace) -> int:
    """List the rows of the active contacts; return how many there are."""
    n = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.has_redundant_force = False
        active.first_unknown = n
        for r in range(1 - active.is_normal_force_unknown, 1 + 2 * active.sticks):
            set_unknown(ws, n, active, r, is_turn=False)
            n += 1
    ws.problem.first_unknown[ws.problem.n_active] = n
    return n


@kernel("void(ws, i8, i8, i8)")
def _reduce(ws: Workspace, a: int, i: int, n: int) -> None:
    """Write row ``i`` of the reduced matrix, one of contact ``a``, and what it lacks to vanish without forces."""
    active = ws.actives[a]
    c, r = active.contact, ws.unknowns[i].direction
    contact = ws.contacts[c]
    ws.problem.right[i] = -contact.bias[r] - row(ws, c, r, ws.island.du.start)
    line = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        pushing = ws.actives[ws.island.block_column[block]]
        for j in range(pushing.first_unknown, pushing.end_unknown):
            ws.floats[line + j] = coupling(ws, c, r, pushing.contact, ws.unknowns[j].direction)
    # a sliding contact on which more force gives more approach
    if r == 0 and contact.mode == Mode.SLIDE and ws.floats[line + i] <= 0.0:
        ws.island.singular_contact = c


@kernel("void(ws, i8, i8, i8)")
def _write_held_row(ws: Workspace, a: int, i: int, n: int) -> None:
    """Write row ``i`` of what the unknowns would do without friction to ``matrix``, response 1 of slips being that."""
    active = ws.actives[a]
    c, r = active.contact, ws.unknowns[i].direction
    line = band_row(ws.problem.matrix.start, i, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        pushing = ws.actives[ws.island.block_column[block]]
        for j in range(pushing.first_unknown, pushing.end_unknown):
            column = ws.unknowns[j].direction + 1 - pushing.sticks
            ws.floats[line + j] = coupling(ws, c, r, pushing.contact, column)


@kernel()
def _push_compliant(ws: Workspace) -> None:
    """Add to ``du`` what the active compliant contacts are known to do, and note the powers."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.is_normal_force_unknown:
            continue
        c, sticks = active.contact, active.sticks
        contact = ws.contacts[c]
        force = active.normal_force if sticks == 1 else 1.0
        push_response(ws, c, NORMAL_ROW, force, ws.island.du.start)
        ws.step.driven_power += force * row(ws, c, 1 - sticks, ws.island.velocities) - contact.dissipated_by_spin
        if contact.is_compliant:
            ws.step.load_power += active.normal_force * contact.rate[0]


@kernel("b1(ws)")
def _solve_held(ws: Workspace) -> bool:
    """Write the unknown forces to ``x``; return 0 if there is no room for that."""
    n = _list_rows(ws)
    if not open_band(ws, n, ws.problem.reduced.start):
        return False
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        for i in range(active.first_unknown, active.end_unknown):
            _reduce(ws, a, i, n)
    if not solve_unknowns(ws, n):
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            if not active.sticks and active.is_normal_force_unknown:
                evaluate_row_response(ws, active.contact, NORMAL_ROW, FIRST_ROW)
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            for i in range(active.first_unknown, active.end_unknown):
                _write_held_row(ws, a, i, n)
        solve_ill_conditioned(ws, n)
    return True


@kernel("b1(ws)")
def _stick_alone(ws: Workspace) -> bool:
    """Hold an island of one rigid contact that sticks; false, nothing done, where it is doubtful what holds it."""
    active = ws.actives[0]
    c = active.contact
    contact = ws.contacts[c]
    row_0 = coupling(ws, c, NORMAL_ROW, c, NORMAL_ROW), 0.0, 0.0
    row_1 = coupling(ws, c, FIRST_ROW, c, NORMAL_ROW), coupling(ws, c, FIRST_ROW, c, FIRST_ROW), 0.0
    row_2 = (
        coupling(ws, c, SECOND_ROW, c, NORMAL_ROW),
        coupling(ws, c, SECOND_ROW, c, FIRST_ROW),
        coupling(ws, c, SECOND_ROW, c, SECOND_ROW),
    )
    bias, du = contact.bias, ws.island.du.start
    right = (
        -bias[0] - row(ws, c, NORMAL_ROW, du),
        -bias[1] - row(ws, c, FIRST_ROW, du),
        -bias[2] - row(ws, c, SECOND_ROW, du),
    )
    forces = solve_three(row_0, row_1, row_2, right, ILL_CONDITIONED)
    if forces[0] != forces[0]:
        return False
    ws.problem.n_unknown, ws.problem.is_deficient, ws.problem.is_null_space_banded, active.has_redundant_force = (
        3,
        False,
        False,
        False,
    )
    active.normal_force, active.friction = forces[0], (forces[1], forces[2])
    for r in range(3):
        push_response(ws, c, r, active.force[r], du)
        ws.step.driven_power += active.force[r] * (row(ws, c, r, ws.island.velocities) - contact.rate[r])
    return True


@kernel("b1(ws)")
def _hold_alone(ws: Workspace) -> bool:
    """Do the same for an island of one rigid contact.

    If it does not stick its only row is a division; false, nothing done, if its force moves nothing.
    """
    active = ws.actives[0]
    if active.sticks:
        return _stick_alone(ws)
    c = active.contact
    contact = ws.contacts[c]
    own = coupling(ws, c, NORMAL_ROW, c, NORMAL_ROW)
    if own == 0.0:
        return False
    if contact.mode == Mode.SLIDE and own < 0.0:
        ws.island.singular_contact = c
    ws.problem.n_unknown, ws.problem.is_deficient, ws.problem.is_null_space_banded, active.has_redundant_force = (
        1,
        False,
        False,
        False,
    )
    force = (-contact.bias[0] - row(ws, c, NORMAL_ROW, ws.island.du.start)) / own
    active.normal_force = force
    push_response(ws, c, NORMAL_ROW, force, ws.island.du.start)
    friction_of_slip(ws, 0)
    (t1, t2), (v1, v2) = active.friction, contact.slip
    on_coordinates = force * row(ws, c, FIRST_ROW, ws.island.velocities)
    ws.step.driven_power += on_coordinates - force * contact.rate[0] - t1 * v1 - t2 * v2
    return True


@kernel("b1(ws, b1)")
def hold_contacts(ws: Workspace, may_choose: bool) -> bool:
    """Write the ``active_forces`` of the active contacts, add what they do to ``du``, note the driven bodies' power.

    Rows and columns must be laid, and the given forces; the free accelerations stand in ``du``.  If it
    ``may_choose``, the null-space force of those not unique is chosen anew: false if there is none that keeps every bound.
    """
    if ws.problem.n_active == 1 and ws.actives[0].is_normal_force_unknown and _hold_alone(ws):
        return True
    _push_compliant(ws)
    if not _solve_held(ws):
        return True
    keeps = True
    if ws.problem.is_deficient:
        if may_choose:
            keeps = choose_null_space_force(ws)
        add_null_space_force(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        first_row = 0 if active.sticks else 1
        for i in range(active.first_unknown, active.end_unknown):
            r, force = ws.unknowns[i].direction, ws.problem.x[i]
            active.force[r] = force
            push_response(ws, c, r, force, ws.island.du.start)
            # the power of what the coordinates do not move: that of the force less that on them
            ws.step.driven_power += force * row(ws, c, r + first_row, ws.island.velocities)
        if not active.sticks and active.is_normal_force_unknown:
            friction_of_slip(ws, a)
        for r in range(3):
            ws.step.driven_power -= active.force[r] * contact.rate[r]
    return keeps
