"""Smooth motion between events: the right-hand side in the present modes."""

from __future__ import annotations

from nonsmooth.engine.bodies.anisotropy import facing_force
from nonsmooth.engine.bodies.bodies import (
    evaluate_bodies,
    evaluate_driven_bodies,
    evaluate_free_bodies,
    evaluate_integrated_bodies,
)
from nonsmooth.engine.bodies.compliance import (
    evaluate_compliant_force,
    refresh_states,
    rub_by_traction,
    write_state_rates,
)
from nonsmooth.engine.bodies.courses import is_on_course
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_geometry, evaluate_rates
from nonsmooth.engine.contact.forces import friction_of_slip
from nonsmooth.engine.contact.held_contacts import hold_contacts, write_rows
from nonsmooth.engine.contact.implicit_slip import hold_at_end
from nonsmooth.engine.contact.lone_slip import hold_lone_slip, lone_slip
from nonsmooth.engine.contact.problem import follow_slip, free_acceleration, friction_coefficient, slip_coefficient
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.flight import accelerate_in_flight
from nonsmooth.engine.memory.layout import DRIVEN, EXCHANGED, FRICTION_LOSS, LOADS
from nonsmooth.engine.memory.modes import OPEN, SLIDE, STICK
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    active_at,
    body_at,
    contact_at,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.linear import product
from nonsmooth.engine.numerics.vectors import length

WRONG_FORCE = -2.0
"""A force below so many times what its contact problem took for zero violates its mode."""


@entry_point("i8(S, F, I, f8, i8, i8, i8)")
def right_hand_side(S: Scalars, w: Floats, k: Integers, t: float, y: int, choosing: int, every: int) -> int:
    """Evaluate bodies, closed contacts, their forces and the accelerations ``du`` at ``t`` and ``y``.

    That is of every body (1), or of those that are integrated.  The closed contacts are grouped into islands.  In free
    flight the driven bodies are left alone.  With ``choosing`` (1) the null-space force of those not unique is chosen
    anew; return 0 if somewhere none keeps every bound, else 1.  Within an implicit step friction opposes the slip that
    the stage ends with.
    """
    keeps = 1
    S.singular = -1
    if every == 0 and S.n_loads + S.n_joints == 0:
        # no call: most right-hand sides are of these
        evaluate_integrated_bodies(S, w, k, t, y)
    else:
        evaluate_free_bodies(S, w, k, t, y, every)
    free_acceleration(S, w, k, every)
    if S.n_grouped == 0:
        return keeps
    evaluate_driven_bodies(S, w, k, t, y)
    refresh_states(S, w, k, y)
    for group in range(S.n_groups):
        c = lone_slip(S, w, k, group)
        if c >= 0 and hold_lone_slip(S, w, k, c) == 1:
            continue
        activate_group(S, w, k, group)
        implicit = S.ahead > 0.0 and _slides(S, w, k) == 1
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            c = active.slot
            if implicit:
                continue
            contact = contact_at(S, w, k, c)
            evaluate_geometry(S, w, k, c)
            evaluate_rates(S, w, k, c)
            if contact.normal_function != 0:
                evaluate_compliant_force(S, w, k, c)
            _set_friction(S, w, k, a, y)
            evaluate_bias(S, w, k, c, 1 + 2 * active.tangent_held)
            write_rows(S, w, k, a)
        if implicit:
            hold_at_end(S, w, k)
        else:
            keeps = min(keeps, hold_contacts(S, w, k, choosing))
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            c = active.slot
            contact = contact_at(S, w, k, c)
            contact.redundant = active.redundant
            contact.holds = active.tangent_held
            if contact.mode == STICK:
                contact.static_margin = _static_margin(S, w, k, a)
            for r in range(3):
                contact.force[r] = active.force[r]
    return keeps


@kernel("i8(S, F, I)")
def _slides(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if one of the active contacts slides, and their forces are none that are averaged."""
    slides = 0
    for a in range(S.n_active):
        contact = contact_at(S, w, k, active_at(S, w, k, a).slot)
        if contact.averaged != OPEN:
            return 0
        if contact.mode == SLIDE:
            slides = 1
    return slides


@kernel("f8(S, F, I, i8)")
def _static_margin(S: Scalars, w: Floats, k: Integers, a: int) -> float:
    """Return how far the friction of an active contact is from its bound [N]; without any, its slip from one [m/s]."""
    active = active_at(S, w, k, a)
    c = active.slot
    contact = contact_at(S, w, k, c)
    if contact.averaged != OPEN:
        return 1.0
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
    elif contact.averaged != OPEN:
        active.normal_held = 0
        active.normal_force = contact.mean_force[0]
    if contact.averaged != OPEN:
        active.friction = contact.mean_force[1], contact.mean_force[2]
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
    """Return what is positive while contact ``c`` stays closed: its normal force, if compliant the way to its reach.

    Forces that are averaged end nothing, nor does what stands for a gap past the end of features, which is an event of
    its own: bodies may still overlap there.
    """
    contact = contact_at(S, w, k, c)
    if contact.averaged != OPEN or (contact.normal_function != 0 and contact.beyond > 0.0):
        return 1.0
    if contact.normal_function != 0:
        return float(contact.reach - contact.gap)
    return float(contact.force[0])


@kernel("i8(S, F, I, i8)")
def is_violated(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return 1 if the force of closed contact ``c`` violates its mode by more than what it takes for zero."""
    contact = contact_at(S, w, k, c)
    least = hold_guard(S, w, k, c)
    if contact.holds == 1:
        least = min(least, contact.static_margin)
    return 1 if least < WRONG_FORCE * contact.small_force_of else 0


@kernel("f8(S, F, I, i8)")
def slip_guard(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return the slip along its direction at the start of the step, or 1 where nothing depends on its sign.

    In an implicit step, which stops and turns slips itself, it is the slip.
    """
    contact = contact_at(S, w, k, c)
    if contact.traction_function != 0 or contact.averaged != OPEN:
        return 1.0
    speed = length(contact.slip)
    if contact.normal_function != 0 and slip_coefficient(S, w, k, c, speed) == 0.0:
        return 1.0
    if S.stage_time > 0.0:
        return speed
    return float(contact.slip[0] * contact.direction[0] + contact.slip[1] * contact.direction[1])


@entry_point("void(S, F, I, f8, i8, i8, i8, i8)")
def slope(S: Scalars, w: Floats, k: Integers, t: float, y: int, out: int, choosing: int, every: int) -> None:
    """Write dy/dt: coordinate rates, accelerations, and four powers.

    These are of the driven bodies, lost to friction, exchanged in all by what is integrated, and of the loads.  For
    ``choosing`` and ``every`` see :func:`right_hand_side`.
    """
    S.evaluations += 1
    right_hand_side(S, w, k, t, y, choosing, every)
    if every == 1:
        for i in range(S.n_flying):
            if body_at(S, w, k, k[S.flying + i]).course == 1:
                accelerate_in_flight(S, w, k, t, k[S.flying + i])
    lost = own = 0.0
    for i in range(S.n_bodies if every == 1 else S.n_integrated):
        body = body_at(S, w, k, i if every == 1 else k[S.integrated + i])
        rates, n_q, n_u = body.tail, body.nq, body.nu
        accelerations, velocities = S.du + body.u, S.n_q + body.u
        for j in range(n_q):
            w[out + body.q + j] = w[rates + j]
        for j in range(n_u):
            w[out + velocities + j] = w[accelerations + j]
        if body.flies == 0:
            own = product(w, own, rates + n_q, y + velocities, n_u)
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        sticks = contact.mode == STICK and contact.averaged == OPEN
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


@kernel("i8(S, F, I, i8)")
def hardest_pressed(S: Scalars, w: Floats, k: Integers, sliding: int) -> int:
    """Return the closed contact of the greatest normal force, or -1; of those only that slide (1), or all (0)."""
    group_closed(S, w, k)
    evaluate_bodies(S, w, k, S.t, S.y)
    right_hand_side(S, w, k, S.t, S.y, 0, 1)
    hardest, most = -1, 0.0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        takes_part = contact.mode == SLIDE if sliding == 1 else contact.mode != OPEN
        takes_part = takes_part and is_on_course(S, w, k, c) == 0
        force = contact.force[0] if sliding == 1 else abs(contact.force[0])
        if takes_part and contact.normal_function == 0 and force > most:
            hardest, most = c, force
    return hardest
