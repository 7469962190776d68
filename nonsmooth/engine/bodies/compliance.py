"""Compliant contacts: their normal force is a function of gap and gap rate, so it is known before the contact problem.

A compliant contact is open or closed as any other. Closed, it does not keep its gap: it applies a force. Its friction
obeys Coulomb's law with the bound that the known normal force sets, or a traction law. A traction law gives friction
force and moment from the slip, and may have inner states. A contact with such a law never sticks.

Laws may have inner states, which are integrated with the motion behind the energy accounts.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import evaluate_row_response, push_response, wrench_row
from nonsmooth.engine.memory.blocks import DELASSUS, FORCE_AND_MOMENT, TRACTION, TRACTION_MOMENT
from nonsmooth.engine.memory.layout import FIRST_ROW, N_ACCOUNTS, NORMAL_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    ContactRecord,
    Floats,
    Workspace,
    at,
    call_compliance,
    call_rates,
    call_traction,
    frame_at,
    kernel,
)
from nonsmooth.engine.numerics.vectors import Vector, dot, length, minus


@kernel("void(ws, i8)")
def evaluate_compliant_force(ws: Workspace, c: int) -> None:
    """Write the normal force of the compliant contact ``c`` [N], by its law. Geometry and rates must be evaluated."""
    contact = ws.contacts[c]
    # laws take indentation and its rate, gap and gap rate with the opposite sign, and the rate at which it closed
    depth, rate, parameters = -contact.gap, -contact.rate[0], at(ws.floats, contact.normal_parameters)
    contact.compliant_force = call_compliance(contact.normal_function, depth, rate, contact.closing_rate, parameters)


@kernel("void(ws, ContactRecord)")
def _evaluate_motion(ws: Workspace, contact: ContactRecord) -> None:
    """Write the slip velocity [m/s] and the relative angular velocity [1/s] along t1, t2 and n for a traction law.

    They are those of the second body less the first, and go to ``problem.motion`` in the order of the law's argument:
    slip along t1 and t2, then spin along t1, t2 and n.
    """
    motion = at(ws.floats, ws.problem.motion.start)
    turning = minus(frame_at(ws.floats, contact.frame_b).spin, frame_at(ws.floats, contact.frame_a).spin)
    motion[0], motion[1] = contact.slip
    motion[2] = dot(contact.axis_1, turning)
    motion[3] = dot(contact.axis_2, turning)
    motion[4] = dot(contact.axis_n, turning)


@kernel("void(ws, i8, i8)")
def evaluate_traction(ws: Workspace, c: int, y: int) -> None:
    """Evaluate the traction law of contact ``c`` at the state ``y``, and write the power of its moment [W].

    The law gives friction force [N], moment [N m] and rates of its inner states from the slip, and writes them to
    ``traction_out``. The power is negative if the moment dissipates energy.
    """
    contact = ws.contacts[c]
    _evaluate_motion(ws, contact)
    motion, states = at(ws.floats, ws.problem.motion.start), at(ws.floats, inner_states_at(ws, c, y))
    parameters, out = at(ws.floats, contact.traction_parameters), at(ws.floats, contact.traction_out)
    call_traction(contact.traction_function, contact.compliant_force, motion, states, parameters, out)
    contact.dissipated_by_spin = 0.0
    for i in range(3):
        # the angular velocities follow the two slip velocities
        contact.dissipated_by_spin += out[TRACTION_MOMENT + i] * motion[2 + i]


@kernel("i8(ws, i8, i8)")
def inner_states_at(ws: Workspace, c: int, y: int) -> int:
    """Offset of the inner states of the laws of contact ``c`` in the state at ``y``, after the energy accounts."""
    return int(y + ws.model.n_q + ws.model.n_u + N_ACCOUNTS + ws.contacts[c].inner_states)


@kernel("void(ws, i8)")
def copy_inner_states(ws: Workspace, y: int) -> None:
    """Copy the inner states of friction laws from the state at ``y`` to their parameters, where the laws read them.

    To be called before the laws are evaluated at another state.
    """
    if ws.model.n_states == 0:
        return
    for contact in ws.contacts:
        # 0: no inner states, or a traction law, which reads them in the state itself
        if contact.inner_states_copy > 0:
            for i in range(contact.n_inner_states):
                ws.floats[contact.inner_states_copy + i] = ws.floats[inner_states_at(ws, contact.index, y) + i]


@kernel("void(ws, i8)")
def start_inner_states(ws: Workspace, c: int) -> None:
    """Set the inner states of contact ``c``, which closes, to their initial values, and store its closing rate [m/s].

    Damping laws divide by the closing rate. A rate within the velocity tolerance is zero: a contact that is closed from
    the start has no closing rate.
    """
    contact = ws.contacts[c]
    contact.closing_rate = -contact.rate[0] if contact.rate[0] < -ws.tolerance.velocity else 0.0
    for i in range(contact.n_inner_states):
        ws.floats[inner_states_at(ws, c, ws.island.y.start) + i] = ws.floats[contact.inner_states_at_start + i]


@kernel("void(ws, i8, i8)")
def write_inner_rates(ws: Workspace, y: int, out: int) -> None:
    """Write the rates of the inner states of all friction laws, at the state ``y``, to the slope at ``out``.

    The inner states of open contacts do not change: they start anew when the contact closes. The forces of the contacts
    must be evaluated, because traction laws write the rates with them.
    """
    if ws.model.n_states == 0:
        return
    for i in range(ws.model.n_states):
        ws.floats[out + ws.model.n_q + ws.model.n_u + N_ACCOUNTS + i] = 0.0
    for contact in ws.contacts:
        if contact.n_inner_states == 0 or contact.mode == Mode.OPEN:
            continue
        # a traction law has written the rates; a friction law evaluates them here
        source = contact.traction_out + FORCE_AND_MOMENT
        if contact.inner_states_copy > 0:
            source = contact.rates_out
            # the slip of a contact that sticks is round-off
            speed = 0.0 if contact.mode == Mode.STICK else length(contact.slip)
            states = at(ws.floats, inner_states_at(ws, contact.index, y))
            parameters = at(ws.floats, contact.rates_parameters)
            call_rates(contact.rates_function, speed, states, parameters, at(ws.floats, source))
        for i in range(contact.n_inner_states):
            ws.floats[inner_states_at(ws, contact.index, out) + i] = ws.floats[source + i]


@kernel("v3(ContactRecord, f8, f8, f8)")
def _in_world(contact: ContactRecord, along_n: float, along_1: float, along_2: float) -> Vector:
    """World components of a vector, from its components along the axes n, t1 and t2 of a contact."""
    n, t1, t2 = contact.axis_n, contact.axis_1, contact.axis_2
    return (
        along_n * n[0] + along_1 * t1[0] + along_2 * t2[0],
        along_n * n[1] + along_1 * t1[1] + along_2 * t2[1],
        along_n * n[2] + along_1 * t1[2] + along_2 * t2[2],
    )


@kernel("void(ws, i8, F)")
def write_wrench(ws: Workspace, c: int, f: Floats) -> None:
    """Write the generalised forces of contact ``c`` by its known force ``f`` along n, t1, t2 [N], and their response.

    A traction law adds its moment. The forces overwrite ``FIRST_ROW`` of the Jacobians. The response, the acceleration
    that they give, overwrites response ``NORMAL_ROW``: there solvers read that to the force of a contact which does not
    stick, whatever its direction.
    """
    contact = ws.contacts[c]
    force, moment = _in_world(contact, f[0], f[1], f[2]), (0.0, 0.0, 0.0)
    if contact.has_traction_law:
        # the law writes its moment along t1, t2, n
        m = at(ws.floats, contact.traction_out + TRACTION_MOMENT)
        moment = _in_world(contact, m[2], m[0], m[1])
    wrench_row(ws, c, FIRST_ROW, force, moment)
    evaluate_row_response(ws, c, FIRST_ROW, NORMAL_ROW)


@kernel("void(ws, i8, F, i8)")
def apply_traction_law(ws: Workspace, c: int, f: Floats, y: int) -> None:
    """Write the force of contact ``c``, which has a traction law, at the state ``y`` to ``f``: along n, t1, t2 [N].

    Its normal part is the compliant force, which must be evaluated. The moment, inner rates and power of the law are
    written, too, to fields of the contact.
    """
    evaluate_traction(ws, c, y)
    contact = ws.contacts[c]
    traction = at(ws.floats, contact.traction_out + TRACTION)
    f[0], f[1], f[2] = contact.compliant_force, traction[0], traction[1]


@kernel()
def accelerate_by_compliance(ws: Workspace) -> None:
    """Add the accelerations by the known forces of touching compliant contacts to ``du``, before friction is found.

    Known are all forces of contacts with a traction law, which are written to ``force``, and else the normal forces:
    Coulomb friction is part of the contact problem. The responses of the contacts must be evaluated.
    """
    for contact in ws.contacts:
        if not contact.is_compliant or not contact.is_touching:
            continue
        if contact.has_traction_law:
            apply_traction_law(ws, contact.index, contact.force, ws.island.y.start)
            write_wrench(ws, contact.index, contact.force)
            # the response of the wrench is that to the whole force
            push_response(ws, contact.index, NORMAL_ROW, 1.0, ws.island.du.start)
        else:
            push_response(ws, contact.index, NORMAL_ROW, contact.compliant_force, ws.island.du.start)


@kernel("b1(ws, i8)")
def has_known_friction(ws: Workspace, c: int) -> bool:
    """True if the friction of the compliant contact ``c`` is known, so that the contact problem has no part of it.

    A traction law gives it. Without a normal force that pushes it is zero.
    """
    contact = ws.contacts[c]
    return contact.has_traction_law or contact.compliant_force <= 0.0


@kernel()
def decouple_normals(ws: Workspace) -> None:
    """Make the normal forces of the active compliant contacts known numbers in the contact problem.

    Their accelerations are in the free accelerations already. So their normal rows and columns of G are replaced by
    uncoupled ones, g_nn x = g_nn f, whose solution is the known force f. The solvers then need no special case.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        for block in range(active.first_block, active.end_block):
            g, d = at(ws.floats, ws.island.delassus.start + DELASSUS * block), ws.island.block_column[block]
            # the block of the contact with itself
            if d == active.index and contact.is_compliant:
                # a contact of driven bodies has g_nn = 0, and any positive number gives the known force
                g_nn = g[0] if g[0] > 0.0 else 1.0
                # the problem sets g_nn x + free to zero
                active.free[0] = -g_nn * contact.compliant_force
                for i in range(1, 3):
                    g[i] = g[3 * i] = 0.0
                g[0] = g_nn
                continue
            # zero the normal row of this contact, and the normal column of the contact that the block couples with
            is_column_known = ws.contacts[ws.actives[d].contact].is_compliant
            for i in range(3):
                if contact.is_compliant:
                    g[i] = 0.0
                if is_column_known:
                    g[3 * i] = 0.0
