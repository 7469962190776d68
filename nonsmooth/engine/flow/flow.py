"""Smooth motion between events: the right-hand side in the present modes, and one step of it."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import facing_force
from nonsmooth.engine.bodies.bodies import evaluate_driven_bodies, evaluate_free_bodies
from nonsmooth.engine.bodies.compliance import (
    evaluate_compliant_force,
    refresh_states,
    rub_by_traction,
    write_state_rates,
)
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_geometry, evaluate_rates
from nonsmooth.engine.contact.forces import friction_of_slip
from nonsmooth.engine.contact.held_contacts import hold_contacts, lay_rows
from nonsmooth.engine.contact.problem import follow_slip, free_acceleration, friction_coefficient
from nonsmooth.engine.delassus.islands import activate_group
from nonsmooth.engine.memory import tableau
from nonsmooth.engine.memory.layout import DRIVEN, EXCHANGED, FRICTION_LOSS, LAST_STAGE, LOADS, N_ACCOUNTS, N_STAGES
from nonsmooth.engine.memory.modes import STICK
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, body_at, contact_at, kernel, room
from nonsmooth.engine.numerics.runge_kutta import stage_state, step_errors
from nonsmooth.engine.numerics.vectors import length

_SHARE = tableau.NODES[1] / tableau.NODES[2]
"""Where the second stage lies between the first and the third."""


@room("i8(S, F, I, f8, i8, i8)")
def right_hand_side(S: Scalars, w: Floats, k: Integers, t: float, y: int, choosing: int) -> int:
    """Evaluate bodies, closed contacts, their forces and the accelerations ``du`` at ``t`` and ``y``.

    The closed contacts are grouped into islands.  In free flight the driven bodies are left alone.  With ``choosing``
    (1) the null-space force of those not unique is chosen anew; return 0 if somewhere none keeps every bound, else 1.
    """
    keeps = 1
    S.singular = -1
    evaluate_free_bodies(S, w, k, t, y)
    free_acceleration(S, w, k)
    if S.n_grouped == 0:
        return keeps
    evaluate_driven_bodies(S, w, k, t, y)
    refresh_states(S, w, k, y)
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            c = active.slot
            contact = contact_at(S, w, k, c)
            evaluate_geometry(S, w, k, c)
            evaluate_rates(S, w, k, c)
            if contact.normal_function != 0:
                evaluate_compliant_force(S, w, k, c)
            _set_friction(S, w, k, a, y)
            evaluate_bias(S, w, k, c, 1 + 2 * active.tangent_held)
            lay_rows(S, w, k, a)
        keeps = min(keeps, hold_contacts(S, w, k, choosing))
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            c = active.slot
            contact = contact_at(S, w, k, c)
            contact.tied = active.redundant
            contact.holds = active.tangent_held
            contact.static_margin = _static_margin(S, w, k, a)
            for r in range(3):
                contact.force[r] = active.force[r]
    return keeps


@kernel("f8(S, F, I, i8)")
def _static_margin(S: Scalars, w: Floats, k: Integers, a: int) -> float:
    """Return how far the friction of an active contact is from its bound [N]; without any, its slip from one [m/s]."""
    active = active_at(S, w, k, a)
    c = active.slot
    contact = contact_at(S, w, k, c)
    if active.tangent_held == 0:
        return float(S.velocity_tolerance - length(contact.slip))
    friction = facing_force(S, w, k, c, active.force[1]), active.force[2]
    slack = contact.slack * active.redundant
    return float(active.mu_static * active.normal_force - length(friction) + slack)


@kernel("void(S, F, I, i8, i8)")
def _set_friction(S: Scalars, w: Floats, k: Integers, a: int, y: int) -> None:
    """Set what the active contact ``a`` holds, and its slip direction and friction where it slides."""
    active = active_at(S, w, k, a)
    c = active.slot
    contact = contact_at(S, w, k, c)
    active.normal_held = 1
    active.tangent_held = 0
    contact.turned = 0.0
    if contact.normal_function != 0:
        active.normal_held = 0
        active.normal_force = contact.compliant_force
        if contact.traction_function != 0:
            rub_by_traction(S, w, k, c, active.force, y)
            return
    if contact.mode == STICK:
        active.mu_static = friction_coefficient(S, w, k, c, 0.0)
        if active.mu_static > 0.0:
            active.tangent_held = 1
            return
    follow_slip(S, w, k, a, contact.slip, S.velocity_tolerance)
    if active.normal_held == 0:
        # what pulls does not rub
        active.mu *= 1.0 if contact.compliant_force > 0.0 else 0.0
        friction_of_slip(S, w, k, a)


@kernel("f8(S, F, I, i8)")
def hold_guard(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return what is positive while contact ``c`` stays closed: its normal force, if compliant the way to its reach."""
    contact = contact_at(S, w, k, c)
    if contact.normal_function != 0:
        return float(contact.reach - contact.gap)
    return float(contact.force[0])


@kernel("f8(S, F, I, i8)")
def slip_guard(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return the slip along its direction at the start of the step, or 1 where nothing depends on its sign."""
    contact = contact_at(S, w, k, c)
    if contact.traction_function != 0:
        return 1.0
    return float(contact.slip[0] * contact.direction[0] + contact.slip[1] * contact.direction[1])


@room("void(S, F, I, f8, i8, i8, i8)")
def slope(S: Scalars, w: Floats, k: Integers, t: float, y: int, out: int, choosing: int) -> None:
    """Write dy/dt: coordinate rates, accelerations, and four powers.

    These are of the driven bodies, lost to friction, exchanged in all, and of the loads.  For ``choosing`` see
    :func:`right_hand_side`.
    """
    right_hand_side(S, w, k, t, y, choosing)
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        rates = body.tail
        for i in range(body.nq):
            w[out + body.q + i] = w[rates + i]
    for i in range(S.n_u):
        w[out + S.n_q + i] = w[S.du + i]
    lost = own = 0.0
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        h = body.tail + body.nq
        for i in range(body.nu):
            own += w[h + i] * w[y + S.n_q + body.u + i]
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        sticks = contact.mode == STICK
        if not sticks:
            for r in range(1, 3):
                lost -= contact.force[r] * contact.rate[r]
        lost -= contact.turned
        hold = hold_guard(S, w, k, c)
        contact.least_force = min(contact.least_force, hold)
        if sticks or hold < 0.0 or slip_guard(S, w, k, c) < 0.0:
            S.suspect = 1
    powers = out + S.n_q + S.n_u
    w[powers + DRIVEN], w[powers + FRICTION_LOSS], w[powers + LOADS] = S.driven_power, lost, S.load_power
    w[powers + EXCHANGED] = abs(own) + abs(S.driven_power) + abs(lost)
    write_state_rates(S, w, k, y, out)


@kernel("f8(S, F, i8, i8, f8)")
def _worst_error(S: Scalars, w: Floats, first: int, end: int, worst: float) -> float:
    """Return the largest error of some components relative to the tolerance, or ``worst`` if that is larger."""
    for i in range(first, end):
        scale = w[S.y_scale + i] + max(abs(w[S.y + i]), abs(w[S.y_new + i]))
        error = abs(w[S.y_stage + i]) / (S.rtol * scale)
        if error > worst or error != error:
            worst = error
    return worst


@room("f8(S, F, I, f8)")
def try_step(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Take one step of ``h`` from ``y`` to ``y_new``; return its error relative to the tolerance.

    ``slopes`` must hold the slope at ``y`` first; its last entry becomes the slope at ``y_new``.  A force or slip
    that violates its mode at some stage raises ``suspect``.
    """
    n = S.n_y
    S.suspect = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.least_force = 1e300
    for stage in range(1, N_STAGES):
        out = S.y_new if stage == LAST_STAGE else S.y_stage
        stage_state(S, w, S.y, S.slopes, n, stage, h, out)
        slope(S, w, k, S.t + tableau.NODES[stage] * h, out, S.slopes + stage * n, 0)
    step_errors(S, w, S.slopes, n, h, S.y_stage)
    worst = 0.0
    worst = _worst_error(S, w, 0, S.n_q + S.n_u, worst)
    if S.n_states > 0:
        worst = _worst_error(S, w, S.n_q + S.n_u + N_ACCOUNTS, n, worst)
    return max(worst, _unseen(S, w, h))


@kernel("f8(S, F, f8)")
def _unseen(S: Scalars, w: Floats, h: float) -> float:
    """Return how far the second stage is from the first and third, relative to what a step of the tolerance explains.

    It has no weight in the result, nor in the error: a force that only it meets, as where it throws the later stages
    out of a contact, would count for nothing.  Its own error is of the order (L h)^3 where that of the step is of the
    order (L h)^5.
    """
    first = S.slopes + S.n_q
    second, third = first + S.n_y, first + 2 * S.n_y
    y_scale, y, y_new = S.y_scale + S.n_q, S.y + S.n_q, S.y_new + S.n_q
    worst, rtol = 0.0, math.sqrt(S.rtol)
    for i in range(S.n_u):
        change = h * abs(w[second + i] - (1.0 - _SHARE) * w[first + i] - _SHARE * w[third + i])
        explained = rtol * (w[y_scale + i] + max(abs(w[y + i]), abs(w[y_new + i])))
        worst = max(worst, change / explained)
    return worst if worst > 1.0 else 0.0
