"""Smooth motion between events: the right-hand side in the present modes."""

from __future__ import annotations

from nonsmooth.engine.bodies.anisotropy import force_in_facing
from nonsmooth.engine.bodies.bodies import (
    evaluate_bodies,
    evaluate_driven_bodies,
    evaluate_free_bodies,
    evaluate_integrated_bodies,
)
from nonsmooth.engine.bodies.compliance import (
    evaluate_compliant_force,
    copy_inner_states,
    apply_traction_law,
    write_inner_rates,
)
from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_geometry, evaluate_rates
from nonsmooth.engine.contact.forces import friction_of_slip
from nonsmooth.engine.contact.held_contacts import hold_contacts, write_rows
from nonsmooth.engine.contact.implicit_slip import hold_at_end
from nonsmooth.engine.contact.lone_slip import hold_lone_slip, lone_slip
from nonsmooth.engine.contact.problem import follow_slip, free_acceleration, friction_coefficient, slip_coefficient
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.flight import accelerate_in_flight
from nonsmooth.engine.memory.layout import DRIVEN, EXCHANGED, FRICTION_LOSS, LOADS
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.linear import product
from nonsmooth.engine.numerics.vectors import length

WRONG_FORCE = -2.0
"""A force below so many times what its contact problem took for zero violates its mode."""


@entry_point("b1(ws, f8, i8, b1, b1)")
def right_hand_side(ws: Workspace, t: float, y: int, may_choose: bool, of_all_bodies: bool) -> bool:
    """Evaluate bodies, closed contacts, their forces and the accelerations ``du`` at ``t`` and ``y``.

    That is of all bodies, or of those that are integrated. The closed contacts are grouped into islands. In free flight
    the driven bodies are left alone. If it ``may_choose``, the null-space force of contact forces that are not unique
    is chosen anew: false if somewhere none keeps every bound. Within an implicit step friction opposes the slip that
    the stage ends with.
    """
    keeps = True
    ws.island.singular_contact = -1
    if not of_all_bodies and ws.model.n_loads + ws.model.n_joints == 0:
        # no call: most right-hand sides are of these
        evaluate_integrated_bodies(ws, t, y)
    else:
        evaluate_free_bodies(ws, t, y, of_all_bodies)
    free_acceleration(ws, of_all_bodies)
    if ws.island.n_grouped == 0:
        return keeps
    evaluate_driven_bodies(ws, t, y)
    copy_inner_states(ws, y)
    for group in range(ws.island.n_groups):
        c = lone_slip(ws, group)
        if c >= 0 and hold_lone_slip(ws, c):
            continue
        activate_group(ws, group)
        implicit = ws.problem.stage_time > 0.0 and _is_implicit_slip(ws)
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            c = active.contact
            if implicit:
                continue
            contact = ws.contacts[c]
            evaluate_geometry(ws, c)
            evaluate_rates(ws, c)
            if contact.is_compliant:
                evaluate_compliant_force(ws, c)
            _set_unknowns(ws, a, y)
            evaluate_bias(ws, c, 1 + 2 * active.sticks)
            write_rows(ws, a)
        if implicit:
            hold_at_end(ws)
        else:
            keeps = hold_contacts(ws, may_choose) and keeps
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            c = active.contact
            contact = ws.contacts[c]
            contact.has_redundant_force = active.has_redundant_force
            contact.is_held_by_friction = active.sticks
            if contact.mode == Mode.STICK:
                contact.static_margin = _static_margin(ws, a)
            for r in range(3):
                contact.force[r] = active.force[r]
    return keeps


@kernel("b1(ws)")
def _is_implicit_slip(ws: Workspace) -> bool:
    """Return 1 if one of the active contacts slides, and their forces are none that are averaged."""
    slides = False
    for a in range(ws.problem.n_active):
        contact = ws.contacts[ws.actives[a].contact]
        if contact.is_averaged:
            return False
        if contact.mode == Mode.SLIDE:
            slides = True
    return slides


@kernel("f8(ws, i8)")
def _static_margin(ws: Workspace, a: int) -> float:
    """Return how far the friction of an active contact is from its bound [N]; without any, its slip from one [m/s]."""
    active = ws.actives[a]
    c = active.contact
    contact = ws.contacts[c]
    if contact.is_averaged:
        return 1.0
    if not active.sticks:
        return float(ws.tolerance.velocity - length(contact.slip))
    friction = force_in_facing(ws, c, active.force[1]), active.force[2]
    slack = contact.slack * active.has_redundant_force
    return float(active.static_coefficient * active.normal_force - length(friction) + slack)


@kernel("void(ws, i8, i8)")
def _set_unknowns(ws: Workspace, a: int, y: int) -> None:
    """Set what the active contact ``a`` holds, and its slip direction and friction where it slides."""
    active = ws.actives[a]
    c = active.contact
    contact = ws.contacts[c]
    active.is_normal_force_unknown = True
    active.sticks = False
    contact.dissipated_by_spin = 0.0
    if contact.is_compliant:
        active.is_normal_force_unknown = False
        active.normal_force = contact.compliant_force
        if contact.has_traction_law:
            apply_traction_law(ws, c, active.force, y)
            return
    elif contact.is_averaged:
        active.is_normal_force_unknown = False
        active.normal_force = contact.mean_force[0]
    if contact.is_averaged:
        active.friction = contact.mean_force[1], contact.mean_force[2]
        return
    if contact.mode == Mode.STICK:
        active.static_coefficient = friction_coefficient(ws, c, 0.0)
        if active.static_coefficient > 0.0:
            active.sticks = True
            return
    follow_slip(ws, a, contact.slip, ws.tolerance.velocity)
    if not active.is_normal_force_unknown:
        # what pulls does not rub
        active.friction_coefficient *= 1.0 if contact.compliant_force > 0.0 else 0.0
        friction_of_slip(ws, a)


@kernel("f8(ws, i8)")
def value_of_normal_guard(ws: Workspace, c: int) -> float:
    """Return what is positive while contact ``c`` stays closed: its normal force, if compliant the way to its reach.

    Forces that are averaged end nothing, nor does what stands for a gap past the end of features, which is an event of
    its own: bodies may still overlap there.
    """
    contact = ws.contacts[c]
    if contact.is_averaged or (contact.is_compliant and contact.past_feature > 0.0):
        return 1.0
    if contact.is_compliant:
        return float(contact.reach - contact.gap)
    return float(contact.force[0])


@kernel("b1(ws, i8)")
def is_violated(ws: Workspace, c: int) -> bool:
    """Return 1 if the force of closed contact ``c`` violates its mode by more than what it takes for zero."""
    contact = ws.contacts[c]
    least = value_of_normal_guard(ws, c)
    if contact.is_held_by_friction:
        least = min(least, contact.static_margin)
    return least < WRONG_FORCE * contact.force_round_off


@kernel("f8(ws, i8)")
def value_of_slip_guard(ws: Workspace, c: int) -> float:
    """Return the slip along its direction at the start of the step, or 1 where nothing depends on its sign.

    In an implicit step, which stops and turns slips itself, it is the slip.
    """
    contact = ws.contacts[c]
    if contact.has_traction_law or contact.is_averaged:
        return 1.0
    speed = length(contact.slip)
    if contact.is_compliant and slip_coefficient(ws, c, speed) == 0.0:
        return 1.0
    if ws.island.stage_time > 0.0:
        return speed
    return float(contact.slip[0] * contact.direction[0] + contact.slip[1] * contact.direction[1])


@entry_point("void(ws, f8, i8, i8, b1, b1)")
def slope(ws: Workspace, t: float, y: int, out: int, may_choose: bool, of_all_bodies: bool) -> None:
    """Write dy/dt: coordinate rates, accelerations, and four powers.

    These are of the driven bodies, lost to friction, exchanged in all by what is integrated, and of the loads.  For
    ``may_choose`` and ``of_all_bodies`` see :func:`right_hand_side`.
    """
    ws.totals.n_evaluations += 1
    right_hand_side(ws, t, y, may_choose, of_all_bodies)
    if of_all_bodies:
        for i in range(ws.island.n_ballistic):
            if ws.bodies[ws.island.ballistic[i]].has_own_step:
                accelerate_in_flight(ws, t, ws.island.ballistic[i])
    lost = own = 0.0
    for i in range(ws.model.n_bodies if of_all_bodies else ws.island.n_integrated):
        body = ws.bodies[i if of_all_bodies else ws.island.integrated[i]]
        rates, n_q, n_u = body.tail, body.n_q, body.n_u
        accelerations, velocities = ws.island.du.start + body.u, ws.model.n_q + body.u
        for j in range(n_q):
            ws.floats[out + body.q + j] = ws.floats[rates + j]
        for j in range(n_u):
            ws.floats[out + velocities + j] = ws.floats[accelerations + j]
        if not body.is_ballistic:
            own = product(ws.floats, own, rates + n_q, y + velocities, n_u)
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        sticks = contact.mode == Mode.STICK and not contact.is_averaged
        if not sticks:
            for r in range(1, 3):
                lost -= contact.force[r] * contact.rate[r]
        lost -= contact.dissipated_by_spin
        hold = value_of_normal_guard(ws, c)
        contact.least_force = min(contact.least_force, hold)
        if sticks or hold < 0.0 or value_of_slip_guard(ws, c) < 0.0:
            ws.step.has_doubtful_force = True
    powers = out + ws.model.n_q + ws.model.n_u
    ws.floats[powers + DRIVEN], ws.floats[powers + FRICTION_LOSS], ws.floats[powers + LOADS] = (
        ws.step.driven_power,
        lost,
        ws.step.load_power,
    )
    ws.floats[powers + EXCHANGED] = abs(own) + abs(ws.step.driven_power) + abs(lost)
    write_inner_rates(ws, y, out)


@kernel("i8(ws, b1)")
def most_loaded_contact(ws: Workspace, sliding: bool) -> int:
    """Return the closed contact of the greatest normal force, or -1; of those only that slide (1), or all (0)."""
    group_closed(ws)
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose=False, of_all_bodies=True)
    hardest, most = -1, 0.0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        takes_part = contact.mode == Mode.SLIDE if sliding else contact.mode != Mode.OPEN
        takes_part = takes_part and not has_own_step(ws, c)
        force = contact.force[0] if sliding else abs(contact.force[0])
        if takes_part and not contact.is_compliant and force > most:
            hardest, most = c, force
    return hardest
