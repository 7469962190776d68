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
    Floats,
    Integers,
    Scalars,
    at,
    body_at,
    call_body,
    contact_at,
    kernel,
)
from nonsmooth.engine.numerics.runge_kutta import dense_part, dense_weights


@kernel("void(S, I, i8, i8)")
def _add_span(S: Scalars, k: Integers, first: int, length: int) -> None:
    """Add a part of the state to what is integrated, joined to the one before if it stands next to that."""
    last = S.n_spans - 1
    if last >= 0 and k[S.span_first + last] + k[S.span_length + last] == first:
        k[S.span_length + last] += length
        return
    k[S.span_first + S.n_spans], k[S.span_length + S.n_spans] = first, length
    S.n_spans += 1


@kernel()
def choose_integrated(S: Scalars, w: Floats, k: Integers) -> None:
    """List the bodies that fly in the modes at hand, those that are integrated, and their parts of the state.

    The closed contacts must be grouped.
    """
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        body.flies = 1 if body.flight_function != 0 or body.course == 1 else 0
    for i in range(S.n_grouped):
        contact = contact_at(S, w, k, k[S.grouped + i])
        one, two = body_at(S, w, k, contact.body_a), body_at(S, w, k, contact.body_b)
        one.flies = two.flies = 0
    S.n_flying = S.n_integrated = S.n_spans = 0
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        if body.flies == 1:
            k[S.flying + S.n_flying] = number
            S.n_flying += 1
        elif body.nu > 0:
            integrate(S, w, k, number)
    if S.n_integrated > 0:
        integrate_velocities(S, w, k)


@kernel("void(S, F, I, i8)")
def integrate(S: Scalars, w: Floats, k: Integers, number: int) -> None:
    """Add a body to those that are integrated, and its coordinates to the parts of the state."""
    body = body_at(S, w, k, number)
    k[S.integrated + S.n_integrated] = number
    S.n_integrated += 1
    _add_span(S, k, body.q, body.nq)


@kernel()
def integrate_velocities(S: Scalars, w: Floats, k: Integers) -> None:
    """Add the velocities of all bodies that are integrated to these parts, and what else is."""
    for i in range(S.n_integrated):
        body = body_at(S, w, k, k[S.integrated + i])
        _add_span(S, k, S.n_q + body.u, body.nu)
    _add_span(S, k, S.n_q + S.n_u, S.n_y - S.n_q - S.n_u)


@kernel("f8(S, F, I, i8)")
def _power(S: Scalars, w: Floats, k: Integers, velocities: int) -> float:
    """Return the power of the own forces of all that flies, the bodies being evaluated with these velocities [W]."""
    total = 0.0
    for i in range(S.n_flying):
        body = body_at(S, w, k, k[S.flying + i])
        force = body.tail + body.nq
        for j in range(body.nu):
            total += w[force + j] * w[velocities + body.u + j]
    return abs(total)


@kernel()
def take_off(S: Scalars, w: Floats, k: Integers) -> None:
    """Keep the power of the own forces of all that flies where a step begins, the bodies being evaluated there."""
    S.power_first = _power(S, w, k, S.y + S.n_q)


@kernel("void(S, F, I, f8, i8, i8)")
def _go_on(S: Scalars, w: Floats, k: Integers, t: float, number: int, out: int) -> None:
    """Write the state of a body on its course to the state at ``out``, its quaternion of unit length, as rates ask."""
    body = body_at(S, w, k, number)
    theta = (t - body.course_t) / body.course_h
    early, late = dense_weights(S, w, body.course_h, theta, 0), dense_weights(S, w, body.course_h, theta, 1)
    i, j, turn = body.q, S.n_q + body.u, out + body.q + body.quaternion
    dense_part(w, S.course_start + i, S.course_slopes + i, body.nq, S.n_y, early, late, out + i)
    dense_part(w, S.course_start + j, S.course_slopes + j, body.nu, S.n_y, early, late, out + j)
    if body.quaternion >= 0:
        square = w[turn] * w[turn] + w[turn + 1] * w[turn + 1] + w[turn + 2] * w[turn + 2] + w[turn + 3] * w[turn + 3]
        factor = 1.0 / math.sqrt(square)
        for r in range(4):
            w[turn + r] *= factor


@kernel("void(S, F, I, f8, i8, i8)")
def fly(S: Scalars, w: Floats, k: Integers, elapsed: float, number: int, out: int) -> None:
    """Write the state of one body after a time of its flight from ``y``, or on its course, to the state at ``out``."""
    body = body_at(S, w, k, number)
    if body.course == 1:
        _go_on(S, w, k, S.t + elapsed, number, out)
        return
    found = body.flight_out
    q, u = at(w, S.y + body.q), at(w, S.y + S.n_q + body.u)
    call_body(body.flight_function, elapsed, q, u, at(w, body.flight_parameters), at(w, found))
    for i in range(body.nq):
        w[out + body.q + i] = w[found + i]
    for i in range(body.nu):
        w[out + S.n_q + body.u + i] = w[found + body.nq + i]


@kernel("void(S, F, I, f8, i8)")
def accelerate_in_flight(S: Scalars, w: Floats, k: Integers, t: float, number: int) -> None:
    """Write the acceleration of a body that flies to ``du``; on its course it is linear in time: only bounds ask."""
    body = body_at(S, w, k, number)
    if body.course == 0:
        accelerate_freely(S, w, k, number)
        return
    part = (t - body.course_t) / body.course_h
    first = S.course_slopes + S.n_q + body.u
    last = first + LAST_STAGE * S.n_y
    for j in range(body.nu):
        w[S.du + body.u + j] = w[first + j] + part * (w[last + j] - w[first + j])


@kernel("f8(S, F, I, f8)")
def land(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Write what flies to ``y_new`` and its slope to the last one, and evaluate it there.

    Return 0, or what is not a number if that holds of a velocity.
    """
    error = 0.0
    end = S.slopes + LAST_STAGE * S.n_y
    for i in range(S.n_flying):
        number = k[S.flying + i]
        body = body_at(S, w, k, number)
        fly(S, w, k, h, number, S.y_new)
        evaluate_once(S, w, k, S.t + h, S.y_new, number)
        accelerate_in_flight(S, w, k, S.t + h, number)
        for j in range(body.nq):
            w[end + body.q + j] = w[body.tail + j]
        for j in range(body.nu):
            w[end + S.n_q + body.u + j] = w[S.du + body.u + j]
            error += 0.0 * w[S.y_new + S.n_q + body.u + j]
    if S.n_integrated == 0:
        S.free_t = S.t + h
    S.power_end = _power(S, w, k, S.y_new + S.n_q)
    S.exchanged_in_flight = 0.5 * h * (S.power_first + S.power_end)
    w[S.y_new + S.n_q + S.n_u + EXCHANGED] += S.exchanged_in_flight
    return error


@kernel("void(S, F, I, f8, f8, i8, i8)")
def body_within(S: Scalars, w: Floats, k: Integers, h: float, theta: float, number: int, out: int) -> None:
    """Write the state of one body at a fraction of the step to the state at ``out``."""
    body = body_at(S, w, k, number)
    if body.flies == 1:
        fly(S, w, k, theta * h, number, out)
        return
    q, u = body.q, S.n_q + body.u
    early, late = dense_weights(S, w, h, theta, 0), dense_weights(S, w, h, theta, 1)
    dense_part(w, S.y + q, S.slopes + q, body.nq, S.n_y, early, late, out + q)
    dense_part(w, S.y + u, S.slopes + u, body.nu, S.n_y, early, late, out + u)
    spin_within(S, w, k, number, early, late, out)


@kernel("void(S, F, I, f8, f8, i8)")
def state_within(S: Scalars, w: Floats, k: Integers, h: float, theta: float, out: int) -> None:
    """Write the state at a fraction of the step."""
    early, late = dense_weights(S, w, h, theta, 0), dense_weights(S, w, h, theta, 1)
    for span in range(S.n_spans):
        i, n = k[S.span_first + span], k[S.span_length + span]
        dense_part(w, S.y + i, S.slopes + i, n, S.n_y, early, late, out + i)
    for i in range(S.n_turning):
        spin_within(S, w, k, k[S.turning_body + i], early, late, out)
    if S.n_spans == 0:
        for i in range(S.n_q + S.n_u, S.n_y):
            w[out + i] = w[S.y + i]
    if S.n_flying > 0:
        for i in range(S.n_flying):
            fly(S, w, k, theta * h, k[S.flying + i], out)
        w[out + S.n_q + S.n_u + EXCHANGED] += theta * S.exchanged_in_flight
