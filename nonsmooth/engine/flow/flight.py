"""Bodies in flight: where nothing touches a body and neither joint nor load holds it, it may know where it flies.

Such a body (:attr:`nonsmooth.interfaces.Body.flight`) is not integrated: its state within a step is that of its closed
form, whatever the length of the step, and of its forces nothing is asked before the end.  So it is with bodies on their
courses (:mod:`nonsmooth.engine.flow.courses`), whose closed form is the interpolant of a step of their own.  All others
are integrated, those that fly among them as soon as one of their contacts closes.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_once
from nonsmooth.engine.contact.problem import accelerate_freely
from nonsmooth.engine.flow.spins import spin_within
from nonsmooth.engine.memory.layout import EXCHANGED, LAST_STAGE
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    call_body,
    kernel,
)
from nonsmooth.engine.numerics.runge_kutta import dense_part, dense_weights


@kernel("void(ws, i8, i8)")
def _add_span(ws: Workspace, first: int, length: int) -> None:
    """Add a part of the state to what is integrated, joined to the one before if it stands next to that."""
    last = ws.n_spans - 1
    if last >= 0 and ws.span_first[last] + ws.span_length[last] == first:
        ws.span_length[last] += length
        return
    ws.span_first[ws.n_spans], ws.span_length[ws.n_spans] = first, length
    ws.n_spans += 1


@kernel()
def choose_integrated(ws: Workspace) -> None:
    """List the bodies that fly in the modes at hand, those that are integrated, and their parts of the state.

    The closed contacts must be grouped.
    """
    for number in range(ws.n_bodies):
        body = ws.bodies[number]
        body.flies = 1 if body.flight_function != 0 or body.course == 1 else 0
    for i in range(ws.n_grouped):
        contact = ws.contacts[ws.grouped[i]]
        one, two = ws.bodies[contact.body_a], ws.bodies[contact.body_b]
        one.flies = two.flies = 0
    ws.n_flying = ws.n_integrated = ws.n_spans = 0
    for number in range(ws.n_bodies):
        body = ws.bodies[number]
        if body.flies == 1:
            ws.flying[ws.n_flying] = number
            ws.n_flying += 1
        elif body.nu > 0:
            integrate(ws, number)
    if ws.n_integrated > 0:
        integrate_velocities(ws)


@kernel("void(ws, i8)")
def integrate(ws: Workspace, number: int) -> None:
    """Add a body to those that are integrated, and its coordinates to the parts of the state."""
    body = ws.bodies[number]
    ws.integrated[ws.n_integrated] = number
    ws.n_integrated += 1
    _add_span(ws, body.q, body.nq)


@kernel()
def integrate_velocities(ws: Workspace) -> None:
    """Add the velocities of all bodies that are integrated to these parts, and what else is."""
    for i in range(ws.n_integrated):
        body = ws.bodies[ws.integrated[i]]
        _add_span(ws, ws.n_q + body.u, body.nu)
    _add_span(ws, ws.n_q + ws.n_u, ws.n_y - ws.n_q - ws.n_u)


@kernel("f8(ws, i8)")
def _power(ws: Workspace, velocities: int) -> float:
    """Return the power of the own forces of all that flies, the bodies being evaluated with these velocities [W]."""
    total = 0.0
    for i in range(ws.n_flying):
        body = ws.bodies[ws.flying[i]]
        force = body.tail + body.nq
        for j in range(body.nu):
            total += ws.floats[force + j] * ws.floats[velocities + body.u + j]
    return abs(total)


@kernel()
def take_off(ws: Workspace) -> None:
    """Keep the power of the own forces of all that flies where a step begins, the bodies being evaluated there."""
    ws.power_first = _power(ws, ws.offsets.y + ws.n_q)


@kernel("void(ws, f8, i8, i8)")
def _go_on(ws: Workspace, t: float, number: int, out: int) -> None:
    """Write the state of a body on its course to the state at ``out``, its quaternion of unit length, as rates ask."""
    body = ws.bodies[number]
    theta = (t - body.course_t) / body.course_h
    early, late = dense_weights(ws, body.course_h, theta, 0), dense_weights(ws, body.course_h, theta, 1)
    i, j, turn = body.q, ws.n_q + body.u, out + body.q + body.quaternion
    dense_part(
        ws.floats, ws.offsets.course_start + i, ws.offsets.course_slopes + i, body.nq, ws.n_y, early, late, out + i
    )
    dense_part(
        ws.floats, ws.offsets.course_start + j, ws.offsets.course_slopes + j, body.nu, ws.n_y, early, late, out + j
    )
    if body.quaternion >= 0:
        square = (
            ws.floats[turn] * ws.floats[turn]
            + ws.floats[turn + 1] * ws.floats[turn + 1]
            + ws.floats[turn + 2] * ws.floats[turn + 2]
            + ws.floats[turn + 3] * ws.floats[turn + 3]
        )
        factor = 1.0 / math.sqrt(square)
        for r in range(4):
            ws.floats[turn + r] *= factor


@kernel("void(ws, f8, i8, i8)")
def fly(ws: Workspace, elapsed: float, number: int, out: int) -> None:
    """Write the state of one body after a time of its flight from ``y``, or on its course, to the state at ``out``."""
    body = ws.bodies[number]
    if body.course == 1:
        _go_on(ws, ws.t + elapsed, number, out)
        return
    found = body.flight_out
    q, u = at(ws.floats, ws.offsets.y + body.q), at(ws.floats, ws.offsets.y + ws.n_q + body.u)
    call_body(body.flight_function, elapsed, q, u, at(ws.floats, body.flight_parameters), at(ws.floats, found))
    for i in range(body.nq):
        ws.floats[out + body.q + i] = ws.floats[found + i]
    for i in range(body.nu):
        ws.floats[out + ws.n_q + body.u + i] = ws.floats[found + body.nq + i]


@kernel("void(ws, f8, i8)")
def accelerate_in_flight(ws: Workspace, t: float, number: int) -> None:
    """Write the acceleration of a body that flies to ``du``; on its course it is linear in time: only bounds ask."""
    body = ws.bodies[number]
    if body.course == 0:
        accelerate_freely(ws, number)
        return
    part = (t - body.course_t) / body.course_h
    first = ws.offsets.course_slopes + ws.n_q + body.u
    last = first + LAST_STAGE * ws.n_y
    for j in range(body.nu):
        ws.du[body.u + j] = ws.floats[first + j] + part * (ws.floats[last + j] - ws.floats[first + j])


@kernel("f8(ws, f8)")
def land(ws: Workspace, h: float) -> float:
    """Write what flies to ``y_new`` and its slope to the last one, and evaluate it there.

    Return 0, or what is not a number if that holds of a velocity.
    """
    error = 0.0
    end = ws.offsets.slopes + LAST_STAGE * ws.n_y
    for i in range(ws.n_flying):
        number = ws.flying[i]
        body = ws.bodies[number]
        fly(ws, h, number, ws.offsets.y_new)
        evaluate_once(ws, ws.t + h, ws.offsets.y_new, number)
        accelerate_in_flight(ws, ws.t + h, number)
        for j in range(body.nq):
            ws.floats[end + body.q + j] = ws.floats[body.tail + j]
        for j in range(body.nu):
            ws.floats[end + ws.n_q + body.u + j] = ws.du[body.u + j]
            error += 0.0 * ws.y_new[ws.n_q + body.u + j]
    if ws.n_integrated == 0:
        ws.free_t = ws.t + h
    ws.power_end = _power(ws, ws.offsets.y_new + ws.n_q)
    ws.exchanged_in_flight = 0.5 * h * (ws.power_first + ws.power_end)
    ws.y_new[ws.n_q + ws.n_u + EXCHANGED] += ws.exchanged_in_flight
    return error


@kernel("void(ws, f8, f8, i8, i8)")
def body_within(ws: Workspace, h: float, theta: float, number: int, out: int) -> None:
    """Write the state of one body at a fraction of the step to the state at ``out``."""
    body = ws.bodies[number]
    if body.flies == 1:
        fly(ws, theta * h, number, out)
        return
    q, u = body.q, ws.n_q + body.u
    early, late = dense_weights(ws, h, theta, 0), dense_weights(ws, h, theta, 1)
    dense_part(ws.floats, ws.offsets.y + q, ws.offsets.slopes + q, body.nq, ws.n_y, early, late, out + q)
    dense_part(ws.floats, ws.offsets.y + u, ws.offsets.slopes + u, body.nu, ws.n_y, early, late, out + u)
    spin_within(ws, number, early, late, out)


@kernel("void(ws, f8, f8, i8)")
def state_within(ws: Workspace, h: float, theta: float, out: int) -> None:
    """Write the state at a fraction of the step."""
    early, late = dense_weights(ws, h, theta, 0), dense_weights(ws, h, theta, 1)
    for span in range(ws.n_spans):
        i, n = ws.span_first[span], ws.span_length[span]
        dense_part(ws.floats, ws.offsets.y + i, ws.offsets.slopes + i, n, ws.n_y, early, late, out + i)
    for i in range(ws.n_turning):
        spin_within(ws, ws.turning_body[i], early, late, out)
    if ws.n_spans == 0:
        for i in range(ws.n_q + ws.n_u, ws.n_y):
            ws.floats[out + i] = ws.y[i]
    if ws.n_flying > 0:
        for i in range(ws.n_flying):
            fly(ws, theta * h, ws.flying[i], out)
        ws.floats[out + ws.n_q + ws.n_u + EXCHANGED] += theta * ws.exchanged_in_flight
