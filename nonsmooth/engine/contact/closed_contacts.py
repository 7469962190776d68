"""Forces of closed contacts during smooth motion, in their modes.

Each contact has rows, along which its acceleration must vanish, and columns, along which an unknown force acts:

=======================  ==================  ==============================
contact                  rows                columns
=======================  ==================  ==============================
sticks                   n, t1, t2           n, t1, t2
slides                   n                   n - mu d, friction included
compliant and sticks     t1, t2              t1, t2
compliant and slides     none                none: its force is given
=======================  ==================  ==============================

With the rows W^T, the columns V and the inverse mass matrix K, the forces f follow from

    (W^T K V) f = -(W^T a + bias),

where a are the accelerations without contact forces. This is the matrix of :mod:`nonsmooth.engine.contact.forces`, but
only the entries that are needed are computed. The three rows of each contact of the Delassus matrix would take up to
nine times as many products.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.compliance import write_wrench
from nonsmooth.engine.bodies.kinematics import evaluate_row, evaluate_row_response, push_response, row
from nonsmooth.engine.contact.forces import ILL_CONDITIONED, friction_of_slip, solve_ill_conditioned, solve_unknowns
from nonsmooth.engine.contact.null_space_forces import add_null_space_force, choose_null_space_force
from nonsmooth.engine.contact.unknowns import count_as_unique, list_unknowns
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, kernel
from nonsmooth.engine.numerics.band import open_band
from nonsmooth.engine.numerics.linear import band_row, product, solve_three


@kernel("b1(ws, b1)")
def add_contact_forces(ws: Workspace, may_choose: bool) -> bool:
    """Find the forces of the active contacts [N], and add their responses to ``du`` and their powers.

    The powers are added to those of driven bodies and loads. Before: rows, columns and given forces are written, and
    ``du`` holds the accelerations without contact forces. If ``may_choose``, the null-space force of redundant
    contacts, which moves no body, is chosen anew; else the one chosen before is added. False if it is chosen anew, and
    no choice keeps all forces within their bounds; else True.
    """
    # an island of one contact needs no matrix, unless its problem is ill-conditioned
    if ws.problem.n_active == 1 and ws.actives[0].is_normal_force_unknown and _add_lone_force(ws):
        return True
    _add_given_forces(ws)
    if not _solve_forces(ws):
        # the matrix has too many entries: the run stops, whatever the result
        return True
    keeps_bounds = True
    if ws.problem.is_deficient:
        if may_choose:
            keeps_bounds = choose_null_space_force(ws)
        add_null_space_force(ws)
    for active in ws.actives:
        _add_unknown_forces(ws, active)
    return keeps_bounds


# --- rows and columns -------------------------------------------------------------------------------------------------


@kernel("void(ws, i8)")
def write_rows(ws: Workspace, a: int) -> None:
    """Write the rows of active contact ``a`` (directions of its accelerations), and the responses to its forces.

    If the contact sticks, these are Jacobian rows n, t1, t2 and their responses. If it slides, row 0 is n, row 1 is
    n - mu d, and response 0 that of row 1. If its whole force is given, as of a compliant contact that slides, row 1 is
    the wrench of this force.
    """
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
        # row 1, and its response in place of response 0
        write_wrench(ws, c, active.force)
        return
    # direction of the whole force, per unit of normal force
    m1, m2 = active.friction_coefficient * active.direction[0], active.friction_coefficient * active.direction[1]
    force_direction = (n[0] - m1 * t1[0] - m2 * t2[0], n[1] - m1 * t1[1] - m2 * t2[1], n[2] - m1 * t1[2] - m2 * t2[2])
    evaluate_row(ws, c, NORMAL_ROW, n)
    evaluate_row(ws, c, FIRST_ROW, force_direction)
    # the one unknown, the normal force, acts along row 1 with its friction
    evaluate_row_response(ws, c, FIRST_ROW, NORMAL_ROW)


@kernel("f8(ws, i8, i8, i8, i8)")
def coupling(ws: Workspace, c: int, r: int, d: int, s: int) -> float:
    """Acceleration along row ``r`` of contact ``c`` per unit force in column ``s`` of contact ``d`` [1/kg].

    A column is the direction of an unknown force, to which the bodies' response is stored. The result is 0 if the
    contacts share no movable articulation (a body, or several that joints connect).
    """
    contact, other = ws.contacts[c], ws.contacts[d]
    total = 0.0
    for side in range(2):
        articulation = contact.articulation_a if side == 0 else contact.articulation_b
        n_u = ws.articulations[articulation].n_u
        jacobian = (contact.jacobian_a if side == 0 else contact.jacobian_b) + r * n_u
        # a force acts through each movable articulation that both contacts share
        if n_u > 0 and other.articulation_a == articulation:
            total = product(ws.floats, total, jacobian, other.response_a + s * n_u, n_u)
        if n_u > 0 and other.articulation_b == articulation:
            total = product(ws.floats, total, jacobian, other.response_b + s * n_u, n_u)
    return total


# --- any number of contacts -------------------------------------------------------------------------------------------


@kernel()
def _add_given_forces(ws: Workspace) -> None:
    """Add the responses to given forces to ``du``, and their powers: power of driven bodies, and power of loads.

    Given are the normal forces of compliant contacts, and the forces of the time-stepping fallback. A contact with a
    given normal force that slides has given friction, too; if it sticks, its friction is an unknown.
    """
    for active in ws.actives:
        if active.is_normal_force_unknown:
            continue
        contact = ws.contacts[active.contact]
        # sticks: row 0 and response 0 are those of a unit normal force. Slides: row 1 is the whole force in newtons,
        # and response 0 is that to it (see `write_rows`), so the factor is 1
        factor, jacobian_row = (active.normal_force, NORMAL_ROW) if active.sticks else (1.0, FIRST_ROW)
        push_response(ws, active.contact, NORMAL_ROW, factor, ws.island.du.start)
        power = factor * row(ws, active.contact, jacobian_row, ws.island.velocities)
        # power of driven bodies: power on all coordinates, less that on the relative motion. Of the latter, the part of
        # the friction moment is subtracted here, that of the force in `_add_unknown_forces`
        ws.step.driven_power += power - contact.dissipated_by_spin
        # the work of a compliant normal force counts as that of a load
        if contact.is_compliant:
            ws.step.load_power += active.normal_force * contact.rate[0]


@kernel("b1(ws)")
def _solve_forces(ws: Workspace) -> bool:
    """Write the unknown forces to ``x`` [N]. False if the matrix has too many entries: the run then stops."""
    # the slips have their directions already, so their turns are no unknowns
    n = list_unknowns(ws, with_turns=False)
    if not open_band(ws, n, ws.problem.reduced.start):
        return False
    for i in range(n):
        _write_row(ws, i, n)
    # False: the matrix is ill-conditioned, and its rank is found without friction
    if not solve_unknowns(ws, n):
        for active in ws.actives:
            if not active.sticks and active.is_normal_force_unknown:
                # the matrix without friction needs the response to row 0, the normal; response 1 is not in use
                evaluate_row_response(ws, active.contact, NORMAL_ROW, FIRST_ROW)
        for i in range(n):
            _write_frictionless_row(ws, i, n)
        solve_ill_conditioned(ws, n)
    return True


@kernel("void(ws, i8, i8)")
def _write_row(ws: Workspace, i: int, n: int) -> None:
    """Write row ``i`` of ``n`` of the matrix W^T K V to ``reduced`` [1/kg], and its right-hand side [m/s^2].

    V are the directions of the unknown forces, and W^T is the row of a Jacobian. A contact that slides with a diagonal
    entry that is not positive is marked as singular: the control of the step then halves the step.
    """
    active, r = ws.actives[ws.unknowns[i].contact], ws.unknowns[i].direction
    c, contact = active.contact, ws.contacts[active.contact]
    ws.problem.right[i] = -contact.bias[r] - row(ws, c, r, ws.island.du.start)
    line = band_row(ws.problem.reduced.start, i, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        other = ws.actives[ws.island.block_column[block]]
        for j in range(other.first_unknown, other.end_unknown):
            ws.floats[line + j] = coupling(ws, c, r, other.contact, ws.unknowns[j].direction)
    # more force means more approach (Painleve's paradox)
    if r == NORMAL_ROW and contact.mode == Mode.SLIDE and ws.floats[line + i] <= 0.0:
        ws.island.singular_contact = c


@kernel("void(ws, i8, i8)")
def _write_frictionless_row(ws: Workspace, i: int, n: int) -> None:
    """Write row ``i`` of ``n`` to ``matrix``, as if sliding contacts had no friction: this matrix shows the rank.

    A sliding contact has one unknown, its normal force. The response to it alone must be in ``FIRST_ROW``, because the
    response in ``NORMAL_ROW`` contains friction.
    """
    active, r = ws.actives[ws.unknowns[i].contact], ws.unknowns[i].direction
    line = band_row(ws.problem.matrix.start, i, n, ws.problem.half_band)
    for block in range(active.first_block, active.end_block):
        other = ws.actives[ws.island.block_column[block]]
        for j in range(other.first_unknown, other.end_unknown):
            column = ws.unknowns[j].direction if other.sticks else FIRST_ROW
            ws.floats[line + j] = coupling(ws, active.contact, r, other.contact, column)


@kernel("void(ws, ActiveContact)")
def _add_unknown_forces(ws: Workspace, active: ActiveContact) -> None:
    """Write the forces of a contact that were unknown, in ``x`` [N], and add their responses and powers.

    The power of given forces on the relative motion is subtracted here, too, see :func:`_add_given_forces`.
    """
    c = active.contact
    contact = ws.contacts[c]
    # of a contact that slides, with the one unknown r = 0, row 1 is the direction of the whole force
    row_offset = NORMAL_ROW if active.sticks else FIRST_ROW
    for i in range(active.first_unknown, active.end_unknown):
        r, force = ws.unknowns[i].direction, ws.problem.x[i]
        active.force[r] = force
        push_response(ws, c, r, force, ws.island.du.start)
        # power of driven bodies: power of the force on all coordinates, less its power on the relative motion
        ws.step.driven_power += force * row(ws, c, r + row_offset, ws.island.velocities)
    # the response included this friction already
    if not active.sticks and active.is_normal_force_unknown:
        friction_of_slip(ws, active.index)
    for r in range(3):
        ws.step.driven_power -= active.force[r] * contact.rate[r]


# --- a single rigid contact -------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def _add_lone_force(ws: Workspace) -> bool:
    """Find the force of an island of one rigid contact, and add its response and power, without a matrix.

    False, with nothing done, if the problem is ill-conditioned or the force cannot accelerate the contact: the way with
    a matrix follows. A contact that slides and approaches faster with more force (Painleve's paradox) is marked as
    singular: the control of the step then halves the step.
    """
    active = ws.actives[0]
    if active.sticks:
        return _add_lone_sticking_force(ws)
    c = active.contact
    contact = ws.contacts[c]
    # row 0 is n, and response 0 that of the whole force, friction included
    inverse_mass = coupling(ws, c, NORMAL_ROW, c, NORMAL_ROW)
    if inverse_mass == 0.0:
        return False
    if contact.mode == Mode.SLIDE and inverse_mass < 0.0:
        ws.island.singular_contact = c
    count_as_unique(ws, n=1)
    force = (-contact.bias[0] - row(ws, c, NORMAL_ROW, ws.island.du.start)) / inverse_mass
    active.normal_force = force
    push_response(ws, c, NORMAL_ROW, force, ws.island.du.start)
    friction_of_slip(ws, active.index)
    # power of driven bodies: power of the force on all coordinates, less its power on the relative motion
    (t1, t2), (v1, v2) = active.friction, contact.slip
    # row 1 is the direction of the whole force, per unit of normal force
    on_coordinates = force * row(ws, c, FIRST_ROW, ws.island.velocities)
    ws.step.driven_power += on_coordinates - force * contact.rate[0] - t1 * v1 - t2 * v2
    return True


@kernel("b1(ws)")
def _add_lone_sticking_force(ws: Workspace) -> bool:
    """Find the force of an island of one rigid contact that sticks, by three equations. Adds its response and power.

    False, with nothing done, if the problem is ill-conditioned: the way with a matrix follows.
    """
    active, c = ws.actives[0], ws.actives[0].contact
    contact = ws.contacts[c]
    # the matrix is symmetric, so only its lower triangle is written
    row_0 = coupling(ws, c, NORMAL_ROW, c, NORMAL_ROW), 0.0, 0.0
    row_1 = coupling(ws, c, FIRST_ROW, c, NORMAL_ROW), coupling(ws, c, FIRST_ROW, c, FIRST_ROW), 0.0
    row_2 = (
        coupling(ws, c, SECOND_ROW, c, NORMAL_ROW),
        coupling(ws, c, SECOND_ROW, c, FIRST_ROW),
        coupling(ws, c, SECOND_ROW, c, SECOND_ROW),
    )
    bias, du = contact.bias, ws.island.du.start
    # right-hand side: minus the acceleration without the force
    y0, y1 = -bias[0] - row(ws, c, NORMAL_ROW, du), -bias[1] - row(ws, c, FIRST_ROW, du)
    y2 = -bias[2] - row(ws, c, SECOND_ROW, du)
    forces = solve_three(row_0, row_1, row_2, (y0, y1, y2), ILL_CONDITIONED)
    # not a number: a pivot is small
    if math.isnan(forces[0]):
        return False
    count_as_unique(ws, n=3)
    active.normal_force, active.friction = forces[0], (forces[1], forces[2])
    for r in range(3):
        push_response(ws, c, r, active.force[r], du)
        # of driven bodies: power on all coordinates, less power on the relative motion
        ws.step.driven_power += active.force[r] * (row(ws, c, r, ws.island.velocities) - contact.rate[r])
    return True
