"""Ballistic motion: bodies without contact, joint and load follow a closed form, if their class has one.

Such a body (:attr:`nonsmooth.interfaces.Body.flight`) is not integrated.  Its state within a step follows from the
closed form, for any length of the step.  Bodies with an own step (multirate, :mod:`nonsmooth.engine.flow.own_steps`)
are treated in the same way; their closed form is the interpolant of that step.  All other bodies are integrated, and so
is a ballistic body as soon as one of its contacts closes.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_body, evaluate_driven_bodies, evaluate_if_changed
from nonsmooth.engine.contact.problem import accelerate_freely
from nonsmooth.engine.flow.spins import normalise, write_spin_within
from nonsmooth.engine.memory.layout import EXCHANGED, LAST_STAGE
from nonsmooth.engine.native.kernel import Workspace, at, call_body, kernel
from nonsmooth.engine.numerics.linear import product
from nonsmooth.engine.numerics.runge_kutta import dense_part, dense_weights
from nonsmooth.engine.numerics.vectors import Vector


@kernel("void(ws, i8, i8)")
def _add_span(ws: Workspace, first: int, length: int) -> None:
    """Add entries of the state to the spans that are integrated; adjacent entries extend the last span."""
    last = ws.island.n_spans - 1
    if last >= 0 and ws.island.span_first[last] + ws.island.span_length[last] == first:
        ws.island.span_length[last] += length
        return
    ws.island.span_first[ws.island.n_spans], ws.island.span_length[ws.island.n_spans] = first, length
    ws.island.n_spans += 1


@kernel()
def choose_integrated(ws: Workspace) -> None:
    """List the ballistic and the integrated bodies in the current modes, and the spans of the state to integrate.

    The closed contacts must be grouped.
    """
    for body in ws.bodies:
        body.is_ballistic = body.ballistic_function != 0 or body.has_own_step
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        ws.bodies[contact.body_a].is_ballistic = ws.bodies[contact.body_b].is_ballistic = False
    ws.island.n_ballistic = ws.island.n_integrated = ws.island.n_spans = 0
    for body in ws.bodies:
        if body.is_ballistic:
            ws.island.ballistic[ws.island.n_ballistic] = body.index
            ws.island.n_ballistic += 1
        elif body.n_u > 0:
            integrate(ws, body.index)
    if ws.island.n_integrated > 0:
        integrate_velocities(ws)


@kernel("void(ws, i8)")
def integrate(ws: Workspace, number: int) -> None:
    """Integrate body ``number`` numerically from now on: add its coordinates to the integrated ranges of the state."""
    body = ws.bodies[number]
    ws.island.integrated[ws.island.n_integrated] = number
    ws.island.n_integrated += 1
    _add_span(ws, body.q, body.n_q)


@kernel()
def integrate_velocities(ws: Workspace) -> None:
    """Add to the integrated ranges of the state: velocities of integrated bodies, energy accounts, and inner states."""
    for i in range(ws.island.n_integrated):
        body = ws.bodies[ws.island.integrated[i]]
        _add_span(ws, ws.model.n_q + body.u, body.n_u)
    _add_span(ws, ws.model.n_q + ws.model.n_u, ws.model.n_y - ws.model.n_q - ws.model.n_u)


@kernel("f8(ws, i8)")
def _power(ws: Workspace, velocities: int) -> float:
    """Absolute value of the power of the forces on all ballistic bodies, without contact forces [W].

    The forces are those of the last evaluation of the bodies. ``velocities`` is the offset in ``ws.floats`` of the
    velocities of all bodies at that evaluation.
    """
    total = 0.0
    for i in range(ws.island.n_ballistic):
        body = ws.bodies[ws.island.ballistic[i]]
        total = product(ws.floats, total, body.tail + body.n_q, velocities + body.u, body.n_u)
    return abs(total)


@kernel()
def take_off(ws: Workspace) -> None:
    """Store the power of the forces on ballistic bodies at the start of a step [W].

    The bodies must be evaluated at the start of the step.
    """
    ws.step.power_at_start = _power(ws, ws.island.y.start + ws.model.n_q)


@kernel("void(ws, i8, i8, i8, i8, v3, v3, i8)")
def _write_dense(ws: Workspace, start: int, slopes: int, i: int, n: int, early: Vector, late: Vector, out: int) -> None:
    """Write ``n`` entries, from entry ``i`` on, of an interpolated state to the state at ``out``.

    ``start`` and ``slopes`` are the offsets of the state and of the slopes at the start of the step.

    ``early`` and ``late`` are the weights of the interpolant (:func:`dense_weights`).
    """
    dense_part(ws.floats, start + i, slopes + i, n, ws.model.n_y, early, late, out + i)


@kernel("void(ws, f8, i8, i8)")
def _go_on(ws: Workspace, t: float, number: int, out: int) -> None:
    """Interpolate a body with an own step (multirate) at time ``t`` [s], and write it to the state at offset ``out``.

    The quaternion is normalised, because the rates of gaps and slips are computed for unit quaternions.
    """
    body = ws.bodies[number]
    h, theta = body.own_step, (t - body.own_step_time) / body.own_step
    early, late = dense_weights(ws, h, theta, is_late=False), dense_weights(ws, h, theta, is_late=True)
    start, slopes = ws.island.own_start.start, ws.island.own_slopes.start
    _write_dense(ws, start, slopes, body.q, body.n_q, early, late, out)
    _write_dense(ws, start, slopes, ws.model.n_q + body.u, body.n_u, early, late, out)
    if body.quaternion >= 0:
        normalise(ws.floats, out + body.q + body.quaternion)


@kernel("void(ws, f8, i8, i8)")
def fly(ws: Workspace, elapsed: float, number: int, out: int) -> None:
    """Write the state of a ballistic body, ``elapsed`` [s] after the start of the step, to the state at ``out``."""
    body = ws.bodies[number]
    if body.has_own_step:
        _go_on(ws, ws.island.time + elapsed, number, out)
        return
    found = body.ballistic_out
    q, u = at(ws.floats, ws.island.y.start + body.q), at(ws.floats, ws.island.y.start + ws.model.n_q + body.u)
    call_body(body.ballistic_function, elapsed, q, u, at(ws.floats, body.ballistic_parameters), at(ws.floats, found))
    for i in range(body.n_q):
        ws.floats[out + body.q + i] = ws.floats[found + i]
    for i in range(body.n_u):
        ws.floats[out + ws.model.n_q + body.u + i] = ws.floats[found + body.n_q + i]


@kernel("void(ws, f8, i8)")
def accelerate_in_flight(ws: Workspace, t: float, number: int) -> None:
    """Write the acceleration of a ballistic body at time ``t`` [s] to ``du``.

    If the body has an own step (multirate), its acceleration is interpolated linearly. This is accurate enough for
    bounds of gaps, its only use.
    """
    body = ws.bodies[number]
    if not body.has_own_step:
        accelerate_freely(ws, number)
        return
    part = (t - body.own_step_time) / body.own_step
    first = ws.island.own_slopes.start + ws.model.n_q + body.u
    last = first + LAST_STAGE * ws.model.n_y
    for j in range(body.n_u):
        ws.island.du[body.u + j] = ws.floats[first + j] + part * (ws.floats[last + j] - ws.floats[first + j])


@kernel("f8(ws, f8)")
def land(ws: Workspace, h: float) -> float:
    """Write the states of ballistic bodies at the end of a step of ``h`` [s] to ``y_new``, and evaluate them there.

    Their derivatives are written to the slope of the last stage. The result is an error: 0, or not a number if a
    velocity is not finite.
    """
    error = 0.0
    end = ws.island.slopes.start + LAST_STAGE * ws.model.n_y
    for i in range(ws.island.n_ballistic):
        number = ws.island.ballistic[i]
        body = ws.bodies[number]
        fly(ws, h, number, ws.step.y_new.start)
        evaluate_if_changed(ws, ws.island.time + h, ws.step.y_new.start, number)
        accelerate_in_flight(ws, ws.island.time + h, number)
        for j in range(body.n_q):
            ws.floats[end + body.q + j] = ws.floats[body.tail + j]
        for j in range(body.n_u):
            ws.floats[end + ws.model.n_q + body.u + j] = ws.island.du[body.u + j]
            error += 0.0 * ws.step.y_new[ws.model.n_q + body.u + j]
    if ws.island.n_integrated == 0:
        ws.island.free_time = ws.island.time + h
    ws.island.power_at_end = _power(ws, ws.step.y_new.start + ws.model.n_q)
    ws.step.ballistic_exchange = 0.5 * h * (ws.step.power_at_start + ws.island.power_at_end)
    ws.step.y_new[ws.model.n_q + ws.model.n_u + EXCHANGED] += ws.step.ballistic_exchange
    return error


@kernel("void(ws, f8, f8, i8, i8)")
def body_within(ws: Workspace, h: float, theta: float, number: int, out: int) -> None:
    """Write the state of one body at the fraction ``theta`` of the step of ``h`` [s] to the state at ``out``."""
    body = ws.bodies[number]
    if body.is_ballistic:
        fly(ws, theta * h, number, out)
        return
    early, late = dense_weights(ws, h, theta, is_late=False), dense_weights(ws, h, theta, is_late=True)
    y, slopes = ws.island.y.start, ws.island.slopes.start
    _write_dense(ws, y, slopes, body.q, body.n_q, early, late, out)
    _write_dense(ws, y, slopes, ws.model.n_q + body.u, body.n_u, early, late, out)
    write_spin_within(ws, number, early, late, out)


@kernel("void(ws, f8, f8, i8)")
def evaluate_within(ws: Workspace, h: float, theta: float, number: int) -> None:
    """Evaluate body ``number`` at the fraction ``theta`` of the step of ``h`` [s].

    Within the step the state is that of the interpolant, at its ends ``y`` and ``y_new``. ``y_stage`` is overwritten.
    """
    # a driven body depends on time only
    if ws.bodies[number].n_u == 0:
        evaluate_driven_bodies(ws, ws.island.time + theta * h, ws.island.y.start)
        return
    state = ws.island.y.start if theta == 0.0 else ws.step.y_new.start
    if 0.0 < theta < 1.0:
        state = ws.step.y_stage.start
        body_within(ws, h, theta, number, state)
    evaluate_body(ws, ws.island.time + theta * h, state, number)


@kernel("void(ws, f8, f8, i8)")
def state_within(ws: Workspace, h: float, theta: float, out: int) -> None:
    """Write the state of all bodies at the fraction ``theta`` of the step of ``h`` [s] to ``out``."""
    early, late = dense_weights(ws, h, theta, is_late=False), dense_weights(ws, h, theta, is_late=True)
    y, slopes = ws.island.y.start, ws.island.slopes.start
    for span in range(ws.island.n_spans):
        _write_dense(ws, y, slopes, ws.island.span_first[span], ws.island.span_length[span], early, late, out)
    for i in range(ws.island.n_spinning):
        write_spin_within(ws, ws.island.spinning[i], early, late, out)
    if ws.island.n_spans == 0:
        for i in range(ws.model.n_q + ws.model.n_u, ws.model.n_y):
            ws.floats[out + i] = ws.island.y[i]
    for i in range(ws.island.n_ballistic):
        fly(ws, theta * h, ws.island.ballistic[i], out)
    if ws.island.n_ballistic > 0:
        ws.floats[out + ws.model.n_q + ws.model.n_u + EXCHANGED] += theta * ws.step.ballistic_exchange
