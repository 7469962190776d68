"""Smooth motion between events: the right-hand side dy/dt in the present modes.

At a time and a state, bodies and closed contacts are evaluated, then the contact forces are found island by island, and
from them the accelerations. Three kinds of islands are solved differently: a single contact that slides, in closed
form; an island within an implicit step, with friction against the slip at the end of the stage; and all others, by the
equations of their sticking and sliding contacts. No inequality is solved here: the guards find the time at which a mode
ends.

The state ends with five energy accounts, whose rates are powers: of driven bodies, of friction, of all that is
exchanged, of loads, and of normal forces of the time-stepping fallback.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.anisotropy import force_in_facing, stretch_along
from nonsmooth.engine.bodies.bodies import (
    evaluate_bodies,
    evaluate_driven_bodies,
    evaluate_free_bodies,
    evaluate_integrated_bodies,
)
from nonsmooth.engine.bodies.compliance import (
    apply_traction_law,
    copy_inner_states,
    evaluate_compliant_force,
    write_inner_rates,
)
from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.bodies.equations import coordinate_rates
from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_geometry, evaluate_rates
from nonsmooth.engine.contact.closed_contacts import add_contact_forces, write_rows
from nonsmooth.engine.contact.forces import friction_of_slip
from nonsmooth.engine.contact.implicit_slip import add_forces_at_stage_end
from nonsmooth.engine.contact.lone_slip import add_lone_slip_force, lone_sliding_contact
from nonsmooth.engine.contact.problem import follow_slip, free_acceleration, friction_coefficient, slip_coefficient
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.flight import accelerate_in_flight
from nonsmooth.engine.memory.layout import CLOSING_LOSS, DRIVEN, EXCHANGED, FRICTION_LOSS, LOADS
from nonsmooth.engine.memory.modes import NO_CONTACT, Mode
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.linear import product
from nonsmooth.engine.numerics.vectors import Pair, length

WRONG_FORCE = -2.0
"""Force that violates its mode, relative to the force that its contact problem counts as zero."""


@entry_point("b1(ws, f8, i8, b1, b1)")
def right_hand_side(ws: Workspace, t: float, y: int, may_choose: bool, of_all_bodies: bool) -> bool:
    """Evaluate bodies, closed contacts, their forces and the accelerations ``du``, at time ``t`` [s] and state ``y``.

    The bodies are all, or only those that the integrator steps. The closed contacts must be grouped into islands. If it
    ``may_choose``, redundant forces, which are not unique, are chosen anew. False if no choice keeps all bounds of some
    island; else True, also if forces were not chosen.
    """
    keeps_bounds = True
    # -1 for none; the search for forces writes a contact near the Painleve singularity
    ws.island.singular_contact = -1
    if not of_all_bodies and ws.model.n_loads + ws.model.n_joints == 0:
        # this call is inlined, and most right-hand sides are of this kind
        evaluate_integrated_bodies(ws, t, y)
    else:
        evaluate_free_bodies(ws, t, y, of_all_bodies)
    free_acceleration(ws, of_all_bodies)
    # without closed contacts nothing depends on driven bodies
    if ws.island.n_grouped == 0:
        return keeps_bounds
    evaluate_driven_bodies(ws, t, y)
    # friction laws read their inner states from a copy
    copy_inner_states(ws, y)
    for group in range(ws.island.n_groups):
        c = lone_sliding_contact(ws, group)
        # a single contact that slides has its force in closed form
        if c >= 0 and add_lone_slip_force(ws, c):
            continue
        activate_group(ws, group)
        # the stage time is positive in the stages of implicit steps only
        if ws.problem.stage_time > 0.0 and _is_implicit_slip(ws):
            add_forces_at_stage_end(ws)
        else:
            _evaluate_active(ws, y)
            keeps_bounds = add_contact_forces(ws, may_choose) and keeps_bounds
        _store_forces(ws)
    return keeps_bounds


@kernel("void(ws, i8)")
def _evaluate_active(ws: Workspace, y: int) -> None:
    """Evaluate the active contacts (those of the island) at the state ``y``, and write their unknowns and equations.

    The bias is the acceleration of a contact at constant velocities. A contact that sticks needs it in all three rows,
    a sliding one in its normal row only.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        evaluate_geometry(ws, active.contact)
        evaluate_rates(ws, active.contact)
        if contact.is_compliant:
            evaluate_compliant_force(ws, active.contact)
        _set_unknowns(ws, active, y)
        evaluate_bias(ws, active.contact, rows=3 if active.sticks else 1)
        write_rows(ws, active.index)


@kernel()
def _store_forces(ws: Workspace) -> None:
    """Copy what was solved for the active contacts to their contacts: force [N], whether redundant, and static margin.

    The entries of active contacts are overwritten by the next island.
    """
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        contact.has_redundant_force = active.has_redundant_force
        contact.is_held_by_friction = active.sticks
        if contact.mode == Mode.STICK:
            contact.static_margin = _static_margin(ws, active)
        for r in range(3):
            contact.force[r] = active.force[r]


@kernel("b1(ws)")
def _is_implicit_slip(ws: Workspace) -> bool:
    """True if one of the active contacts slides, and none has forces that are averaged over time.

    In an implicit stage the friction of such an island is found together with its slip.
    """
    has_slip = False
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        if contact.is_averaged:
            return False
        has_slip = has_slip or contact.mode == Mode.SLIDE
    return has_slip


@kernel("f8(ws, ActiveContact)")
def _static_margin(ws: Workspace, active: ActiveContact) -> float:
    """Distance of the friction of an active contact in mode stick to its static bound [N].

    Without a coefficient of friction it is the distance of the slip to the velocity tolerance [m/s]. Averaged forces
    have no bound within their span. Their margin is 1, which is positive, so that its guard never fires.
    """
    contact = ws.contacts[active.contact]
    if contact.is_averaged:
        return 1.0
    if not active.sticks:
        return float(ws.tolerance.velocity - length(contact.slip))
    # anisotropic friction along t1 is scaled to the bound of the slip that it opposes, forward or backward
    friction = force_in_facing(ws, active.contact, active.force[1]), active.force[2]
    # a choice of redundant forces may exceed its bound by the slack
    slack = contact.slack * active.has_redundant_force
    return float(active.static_coefficient * active.normal_force - length(friction) + slack)


@kernel("void(ws, ActiveContact, i8)")
def _set_unknowns(ws: Workspace, active: ActiveContact, y: int) -> None:
    """Write which forces of an active contact are unknown, the values of the known ones, and its slip direction.

    Known are a compliant normal force, friction and moment of a traction law, and averaged forces. A contact that
    ``sticks`` has unknown friction, which holds it. A contact in mode stick without a coefficient of friction is
    treated as one that slides. ``y`` is the state, with the inner states of traction laws.
    """
    c = active.contact
    contact = ws.contacts[c]
    active.is_normal_force_unknown = True
    active.sticks = False
    # only a traction law has a friction moment
    contact.dissipated_by_spin = 0.0
    if contact.is_compliant:
        active.is_normal_force_unknown = False
        active.normal_force = contact.compliant_force
        if contact.has_traction_law:
            # writes friction and moment
            apply_traction_law(ws, c, active.force, y)
            return
    elif contact.is_averaged:
        active.is_normal_force_unknown = False
        active.normal_force = contact.mean_force[0]
    if contact.is_averaged:
        # the force is constant over the span, also where the slip turns back and changes the facing
        active.friction = contact.mean_force[1] / stretch_along(ws, contact), contact.mean_force[2]
        return
    if contact.mode == Mode.STICK:
        active.static_coefficient = friction_coefficient(ws, c, speed=0.0)
        if active.static_coefficient > 0.0:
            active.sticks = True
            return
    follow_slip(ws, active.index, contact.slip, ws.tolerance.velocity, may_reverse=False)
    if not active.is_normal_force_unknown:
        # an adhesive force causes no friction
        active.friction_coefficient *= 1.0 if contact.compliant_force > 0.0 else 0.0
        friction_of_slip(ws, active.index)


@kernel("f8(ws, i8)")
def value_of_normal_guard(ws: Workspace, c: int) -> float:
    """Normal guard of the closed contact ``c``: normal force [N], or distance of a compliant one to its reach [m].

    A compliant contact acts up to the gap ``reach``. Averaged forces end no mode, so their guard is 1, which is
    positive. So is that of a compliant contact past the end of its features: its gap is a substitute there, and bodies
    may still overlap. The end of features is an event of its own.
    """
    contact = ws.contacts[c]
    if contact.is_averaged or (contact.is_compliant and contact.past_feature > 0.0):
        return 1.0
    if contact.is_compliant:
        return float(contact.reach - contact.gap)
    return float(contact.force[0])


@kernel("b1(ws, i8)")
def is_violated(ws: Workspace, c: int) -> bool:
    """True if the force of the rigid closed contact ``c`` violates its mode by more than round-off of its problem.

    A normal force violates it if it pulls, friction that holds the contact if it exceeds its static bound. For a
    compliant contact this is no test, because its normal guard is a length.
    """
    contact = ws.contacts[c]
    least = value_of_normal_guard(ws, c)
    if contact.is_held_by_friction:
        least = min(least, contact.static_margin)
    return least < WRONG_FORCE * contact.force_round_off


@kernel("f8(ws, i8)")
def value_of_slip_guard(ws: Workspace, c: int) -> float:
    """Slip of contact ``c`` along the slip direction at the start of the step [m/s].

    If no force depends on its sign, it is 1, and its guard never fires: with a traction law, averaged forces, or a
    compliant contact without friction. In an implicit step, which stops and reverses slips itself, it is the slip
    speed.
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
    """Write dy/dt at time ``t`` [s] and state ``y`` to ``out``: coordinate rates, accelerations, powers, inner rates.

    The powers are the rates of the energy accounts [W]. ``may_choose`` lets redundant forces be chosen anew. Of the
    bodies it is all, or only those that the integrator steps. Forces, least guards and ``du`` are left in the
    workspace.
    """
    ws.totals.n_evaluations += 1
    right_hand_side(ws, t, y, may_choose, of_all_bodies)
    if of_all_bodies:
        # the contact of a body with an own step is in no island, so its acceleration is that of its interpolant
        for i in range(ws.island.n_ballistic):
            if ws.bodies[ws.island.ballistic[i]].has_own_step:
                accelerate_in_flight(ws, t, ws.island.ballistic[i])
    of_bodies = _write_slope_of_bodies(ws, y, out, of_all_bodies)
    lost, closing = _powers_lost(ws)
    _update_least_guards(ws)
    # the rates of the energy accounts follow those of coordinates and velocities
    powers = out + ws.model.n_q + ws.model.n_u
    ws.floats[powers + DRIVEN], ws.floats[powers + LOADS] = ws.step.driven_power, ws.step.load_power
    ws.floats[powers + FRICTION_LOSS], ws.floats[powers + CLOSING_LOSS] = lost, closing
    # round-off of the energy is relative to all that was exchanged; the forces of bodies include the loads
    ws.floats[powers + EXCHANGED] = abs(of_bodies) + abs(ws.step.driven_power) + abs(lost) + abs(closing)
    write_inner_rates(ws, y, out)


@kernel("f8(ws, i8, i8, b1)")
def _write_slope_of_bodies(ws: Workspace, y: int, out: int, of_all_bodies: bool) -> float:
    """Write coordinate rates and accelerations of the bodies to the slope at ``out``. Power of their own forces [W].

    ``y`` is the state, and ``du`` holds the accelerations. The forces are those without contacts. Bodies in ballistic
    motion have no part in the power: their energy is accounted for in closed form.
    """
    power = 0.0
    for i in range(ws.model.n_bodies if of_all_bodies else ws.island.n_integrated):
        body = ws.bodies[i if of_all_bodies else ws.island.integrated[i]]
        # the forces follow the coordinate rates in the output block of a body
        rates, forces, velocities = coordinate_rates(ws, body), body.tail + body.n_q, ws.model.n_q + body.u
        for j in range(body.n_q):
            ws.floats[out + body.q + j] = rates[j]
        for j in range(body.n_u):
            ws.floats[out + velocities + j] = ws.island.du[body.u + j]
        if not body.is_ballistic:
            power = product(ws.floats, power, forces, y + velocities, body.n_u)
    return power


@kernel("v2(ws)")
def _powers_lost(ws: Workspace) -> Pair:
    """Powers lost in the closed contacts: by friction, and by normal forces of the time-stepping fallback [W].

    A contact that sticks dissipates nothing, unless its averaged forces act while it slips within their span. Averaged
    normal forces take force times gap rate, not force times change of the gap: the gap jumps where features change.
    Their power lost is negative if a force pushes while its gap opens. The work of compliant contacts is no loss.
    """
    friction, closing = 0.0, 0.0
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        if contact.mode != Mode.STICK or contact.is_averaged:
            # the two tangential rows
            for r in range(1, 3):
                friction -= contact.force[r] * contact.rate[r]
        # power of the friction moment on the relative spin, negative if it dissipates
        friction -= contact.dissipated_by_spin
        if contact.is_averaged and not contact.is_compliant:
            closing -= contact.normal_force * contact.normal_rate
    return friction, closing


@kernel()
def _update_least_guards(ws: Workspace) -> None:
    """Update ``least_force``, the least normal guard of each closed contact in the stages of the step [N or m].

    The search for events evaluates forces within the step if it is true. So does ``has_doubtful_force``: it
    becomes true if a normal guard or a slip guard is negative at this stage, or if a contact sticks, as the distance to
    its static bound is not evaluated here.
    """
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        normal = value_of_normal_guard(ws, contact.index)
        contact.least_force = min(contact.least_force, normal)
        sticks = contact.mode == Mode.STICK and not contact.is_averaged
        if sticks or normal < 0.0 or value_of_slip_guard(ws, contact.index) < 0.0:
            ws.step.has_doubtful_force = True


@kernel("i8(ws, b1)")
def most_loaded_contact(ws: Workspace, sliding: bool) -> int:
    """Closed rigid contact with the normal force of largest absolute value, or ``NO_CONTACT`` if there is none.

    It is taken as the cause if no step is found. If ``sliding``, only contacts that slide and whose force pushes count.
    Contacts of bodies with an own step (multirate) never do. Evaluates all forces at the present state.
    """
    group_closed(ws)
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose=False, of_all_bodies=True)
    which, largest = NO_CONTACT, 0.0
    for contact in ws.contacts:
        takes_part = contact.mode == Mode.SLIDE if sliding else contact.mode != Mode.OPEN
        takes_part = takes_part and not has_own_step(ws, contact.index)
        force = contact.normal_force if sliding else abs(contact.normal_force)
        if takes_part and not contact.is_compliant and force > largest:
            which, largest = contact.index, force
    return which
