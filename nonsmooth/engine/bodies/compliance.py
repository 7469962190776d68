"""Compliant contacts: their normal force is given by gap and gap rate, and the rest of it by laws of traction.

A compliant contact is open or closed as any other, but closed it holds no gap: it pushes.  Its friction may hold it
(STICK), against the bound that the given normal force sets, or rub; a law of traction rubs always.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import evaluate_row_response, push_response, wrench_row
from nonsmooth.engine.memory.blocks import DELASSUS, FORCE_AND_MOMENT, TRACTION, TRACTION_MOMENT
from nonsmooth.engine.memory.layout import FIRST_ROW, N_ACCOUNTS, NORMAL_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
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
    """Write the normal force of the compliant contact ``c``, its geometry and rates being known."""
    contact = ws.contacts[c]
    contact.compliant_force = call_compliance(
        contact.normal_function,
        -contact.gap,
        -contact.rate[0],
        contact.closing_rate,
        at(ws.floats, contact.normal_parameters),
    )


@kernel("void(ws, i8)")
def _evaluate_motion(ws: Workspace, c: int) -> None:
    """Write slip velocity and relative angular velocity of contact ``c`` along its unit tangents and normal."""
    contact, motion = ws.contacts[c], at(ws.floats, ws.problem.motion.start)
    turning = minus(frame_at(ws.floats, contact.frame_b).spin, frame_at(ws.floats, contact.frame_a).spin)
    motion[0], motion[1] = contact.slip
    motion[2] = dot(contact.axis_1, turning)
    motion[3] = dot(contact.axis_2, turning)
    motion[4] = dot(contact.axis_n, turning)


@kernel("void(ws, i8, i8)")
def evaluate_traction(ws: Workspace, c: int, y: int) -> None:
    """Let the law of traction of contact ``c`` write force, moment and rates of its states."""
    contact = ws.contacts[c]
    _evaluate_motion(ws, c)
    out = contact.traction_out
    call_traction(
        contact.traction_function,
        contact.compliant_force,
        at(ws.floats, ws.problem.motion.start),
        at(ws.floats, state_at(ws, c, y)),
        at(ws.floats, contact.traction_parameters),
        at(ws.floats, out),
    )
    contact.dissipated_by_spin = 0.0
    for i in range(3):
        contact.dissipated_by_spin += ws.floats[out + TRACTION_MOMENT + i] * ws.problem.motion[2 + i]


@kernel("i8(ws, i8, i8)")
def state_at(ws: Workspace, c: int, y: int) -> int:
    """Return where the inner states of the laws of contact ``c`` stand."""
    return int(y + ws.model.n_q + ws.model.n_u + N_ACCOUNTS + ws.contacts[c].inner_states)


@kernel("void(ws, i8)")
def refresh_states(ws: Workspace, y: int) -> None:
    """Let the friction coefficients see the inner states as they are at ``y``."""
    if ws.model.n_states == 0:
        return
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.inner_states_copy > 0:
            for i in range(contact.n_inner_states):
                ws.floats[contact.inner_states_copy + i] = ws.floats[state_at(ws, c, y) + i]


@kernel("void(ws, i8)")
def begin_contact(ws: Workspace, c: int) -> None:
    """Let the inner states of contact ``c``, which closes, start anew, and keep the rate at which it does.

    Of one that is closed from the start that rate is none: by what round-off leaves of it no damping is scaled.
    """
    contact = ws.contacts[c]
    contact.closing_rate = -contact.rate[0] if contact.rate[0] < -ws.tolerance.velocity else 0.0
    for i in range(contact.n_inner_states):
        ws.floats[state_at(ws, c, ws.island.y.start) + i] = ws.floats[contact.inner_states_at_start + i]


@kernel("void(ws, i8, i8)")
def write_state_rates(ws: Workspace, y: int, out: int) -> None:
    """Write the rates of the inner states of all contacts to the slope ``out``; those of open contacts are zero."""
    if ws.model.n_states == 0:
        return
    for i in range(ws.model.n_states):
        ws.floats[out + ws.model.n_q + ws.model.n_u + N_ACCOUNTS + i] = 0.0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        n = contact.n_inner_states
        if n == 0 or contact.mode == Mode.OPEN:
            continue
        source = contact.traction_out + FORCE_AND_MOMENT
        if contact.inner_states_copy > 0:
            source = contact.rates_out
            speed = 0.0 if contact.mode == Mode.STICK else length(contact.slip)
            states, parameters = at(ws.floats, state_at(ws, c, y)), at(ws.floats, contact.rates_parameters)
            call_rates(contact.rates_function, speed, states, parameters, at(ws.floats, source))
        for i in range(n):
            ws.floats[state_at(ws, c, out) + i] = ws.floats[source + i]


@kernel("v3(ws, i8, f8, f8, f8)")
def _in_world(ws: Workspace, c: int, x: float, y: float, z: float) -> Vector:
    """Return the world components of a vector given along the axes n, t1, t2 of contact ``c``."""
    contact = ws.contacts[c]
    n, t1, t2 = contact.axis_n, contact.axis_1, contact.axis_2
    return (
        x * n[0] + y * t1[0] + z * t2[0],
        x * n[1] + y * t1[1] + z * t2[1],
        x * n[2] + y * t1[2] + z * t2[2],
    )


@kernel("void(ws, i8, F)")
def write_wrench(ws: Workspace, c: int, f: Floats) -> None:
    """Write row 1 and response 0 of all that the compliant contact ``c`` does, its forces being ``active_forces``."""
    contact = ws.contacts[c]
    force, moment = _in_world(ws, c, f[0], f[1], f[2]), (0.0, 0.0, 0.0)
    if contact.has_traction_law:
        m = at(ws.floats, contact.traction_out + TRACTION_MOMENT)
        moment = _in_world(ws, c, m[2], m[0], m[1])
    wrench_row(ws, c, FIRST_ROW, force, moment)
    evaluate_row_response(ws, c, FIRST_ROW, NORMAL_ROW)


@kernel("void(ws, i8, F, i8)")
def rub_by_traction(ws: Workspace, c: int, f: Floats, y: int) -> None:
    """Write the forces of a contact with a law of traction to ``active_forces``."""
    evaluate_traction(ws, c, y)
    contact = ws.contacts[c]
    traction = at(ws.floats, contact.traction_out + TRACTION)
    f[0], f[1], f[2] = contact.compliant_force, traction[0], traction[1]


@kernel()
def push_compliant(ws: Workspace) -> None:
    """Add to ``du`` what the touching compliant contacts are known to do, all of it or the normal force alone."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if not contact.is_compliant or not contact.is_touching:
            continue
        if contact.has_traction_law:
            rub_by_traction(ws, c, contact.force, ws.island.y.start)
            write_wrench(ws, c, contact.force)
            push_response(ws, c, NORMAL_ROW, 1.0, ws.island.du.start)
        else:
            push_response(ws, c, NORMAL_ROW, contact.compliant_force, ws.island.du.start)


@kernel("b1(ws, i8)")
def rubs_unasked(ws: Workspace, c: int) -> bool:
    """Return 1 if the friction of the compliant contact ``c`` is no question: by a law of traction, or without load."""
    contact = ws.contacts[c]
    return contact.has_traction_law or contact.compliant_force <= 0.0


@kernel()
def decouple_normals(ws: Workspace) -> None:
    """Leave of the normal forces of the active compliant contacts what the friction sees: a given load.

    What they do is in the free accelerations already.  Their rows and columns of G become those of contacts that
    nothing couples, whose forces come out as given.
    """
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        rigid = not contact.is_compliant
        for block in range(active.first_block, active.end_block):
            g, d = at(ws.floats, ws.island.delassus.start + DELASSUS * block), ws.island.block_column[block]
            if d == a and not rigid:
                own = g[0] if g[0] > 0.0 else 1.0
                active.free[0] = -own * contact.compliant_force
                for i in range(1, 3):
                    g[i] = g[3 * i] = 0.0
                g[0] = own
                continue
            pushes = ws.contacts[ws.actives[d].contact].is_compliant
            for i in range(3):
                if not rigid:
                    g[i] = 0.0
                if pushes:
                    g[3 * i] = 0.0
