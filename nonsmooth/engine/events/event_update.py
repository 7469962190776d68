"""What happens at an instant: impacts until nothing approaches, then closings, then the new modes."""

from __future__ import annotations

from nonsmooth.engine.bodies.anisotropy import along_tangents, face_slips, turn_facing
from nonsmooth.engine.bodies.compliance import (
    begin_contact,
    push_compliant,
    rubs_unasked,
)
from nonsmooth.engine.bodies.courses import is_on_course
from nonsmooth.engine.bodies.touching import slip_speed, touch
from nonsmooth.engine.contact.forces import reduced_coefficient
from nonsmooth.engine.contact.problem import accelerate, accelerate_touching, set_up, solve_contact
from nonsmooth.engine.contact.trial import slope_of_slip, small_force
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_members, group_touching
from nonsmooth.engine.events.accumulation import (
    average_slow,
    close_contacts,
    hand_over,
    provisional_mode,
    slow_speed,
    stop_creeping,
    stop_slow,
)
from nonsmooth.engine.events.averaging import average, average_active, keeps_averaging
from nonsmooth.engine.events.record import (
    DRIVEN_WORK,
    FRICTION_LOSS,
    MOST_EVENTS,
    RESTITUTION_LOSS,
    amend_last,
    code,
    impact_code,
    record_event,
    remember,
)
from nonsmooth.engine.events.simultaneous import join_near
from nonsmooth.engine.events.twins import has_replaced
from nonsmooth.engine.flow.averaged import reach_end
from nonsmooth.engine.flow.guard_numbers import normal_guard
from nonsmooth.engine.flow.mean_work import book_mean_forces
from nonsmooth.engine.flow.projection import project_closed
from nonsmooth.engine.flow.self_check import open_account
from nonsmooth.engine.impact.instant import jam_slips, map_impact
from nonsmooth.engine.impact.problem import ENDLESS, INVALID, energetic_impact
from nonsmooth.engine.impact.window import LARGE, windowed_impact
from nonsmooth.engine.memory.modes import (
    AVERAGING,
    COMPLIANT,
    FEATURE_CHANGE,
    IMPACT,
    IMPACT_ENDLESS,
    JAM,
    LIFT_OFF,
    NO_CONTACT_SOLUTION,
    NOT_FINITE,
    OPEN,
    PAINLEVE,
    PARADOX_REFUSED,
    REFUSE,
    RUNNING,
    SLIDE,
    START,
    STICK,
    STICK_TO_SLIP,
    UPDATE_ENDLESS,
)
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    active_at,
    contact_at,
    entry_point,
    guard_at,
    kernel,
)
from nonsmooth.engine.native.watch import interrupted

_ATTEMPTS = MOST_EVENTS - 4
"""To settle an instant: each may record an event, and a few come before and after."""
_NEXT_TO_NOTHING = 1e-3
"""An approach below this part of the fastest approach or slip before an impact counts as none where that has no end."""
_PAINLEVE_ATTEMPTS = 5
"""Impacts without collision at one instant; after one there are forces, unless it leads to another jam."""
_PROJECTIONS = 2
"""So often an instant is settled anew after a projection that may have turned a slip."""
_SLOW = 100.0
"""A slip of up to so many velocity tolerances may be turned."""
_FACINGS = 20
"""So often in one instant friction may be found to oppose the other way: contacts that turn each other need not end."""


@kernel("i8(S, F, I)")
def _fastest_approach(S: Scalars, w: Floats, k: Integers) -> int:
    """Return the touching contact that approaches most."""
    which, worst = -1, 1e300
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.touching == 1 and contact.normal_function == 0 and contact.rate[0] < worst:
            which, worst = c, contact.rate[0]
    return which


@kernel("i8(S, F, I)")
def _approaches(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if a touching contact approaches, after an impact."""
    which = _fastest_approach(S, w, k)
    return 1 if which >= 0 and contact_at(S, w, k, which).rate[0] < -S.velocity_tolerance else 0


@kernel("i8(S, F, I, i8, i8)")
def _takes_part(S: Scalars, w: Floats, k: Integers, cause: int, which: int) -> int:
    """Return 1 if the active contacts collide: one of them approaches, or it is the one that jams or has no force."""
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        c = active.slot
        contact = contact_at(S, w, k, c)
        if c == which or (cause == IMPACT and contact.rate[0] < -S.velocity_tolerance):
            return 1
    return 0


@entry_point("i8(S, F, I, i8, i8, f8)")
def collide(S: Scalars, w: Floats, k: Integers, cause: int, which: int, seed: float) -> int:
    """Run the impact law on the touching contacts, island by island, book and record it; return the status.

    An impact without collision needs a speed for its ``seed`` [m/s].
    """
    remember(S, w, k)
    accelerate_touching(S, w, k)
    push_compliant(S, w, k)
    group_touching(S, w, k)
    phases = truncated = 0
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        if _takes_part(S, w, k, cause, which) == 0:
            continue
        status = _collide_island(S, w, k, cause, seed)
        if status != RUNNING:
            # what the islands before have done is in no account yet
            for i in range(S.n_u):
                w[S.y + S.n_q + i] = w[S.u_before + i]
            return status
        phases += S.phases
        truncated = max(truncated, S.truncated)
    S.impacts += 1
    S.phases, S.truncated = phases, truncated
    S.driven_work += w[S.event_head + DRIVEN_WORK]
    S.restitution_loss += w[S.event_head + RESTITUTION_LOSS]
    S.friction_loss += w[S.event_head + FRICTION_LOSS]
    # until the instant is settled: apart is open, the rest goes by its slip
    face_slips(S, w, k)
    touch(S, w, k)
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.code_during != contact.code_before or contact.mode != OPEN:
            provisional_mode(S, w, k, c)
        contact.released = 0
    record_event(S, w, k, cause, which, S.phases)
    return RUNNING


@kernel("i8(S, F, I)")
def _is_over(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if next to nothing approaches behind the impact of the active contacts, which has been cut short.

    Contacts that slip may feed each other's bounces for as long as they do, however small these are.
    """
    before = behind = 0.0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        before = max(before, abs(active.rate_before[0]), abs(active.rate_before[1]), abs(active.rate_before[2]))
        behind = max(behind, -active.gap_rate)
    return 1 if behind <= _NEXT_TO_NOTHING * before else 0


@kernel("i8(S, F, I, i8, f8)")
def _collide_island(S: Scalars, w: Floats, k: Integers, cause: int, seed: float) -> int:
    """Run the impact law on the active contacts and give the bodies its impulses; return the status."""
    m = S.n_active
    large = m > LARGE and S.impact_map == 0 and cause == IMPACT
    if not large:
        assemble_delassus(S, w, k)
    for a in range(m):
        active = active_at(S, w, k, a)
        c = active.slot
        contact = contact_at(S, w, k, c)
        contact.code_during = impact_code(S, w, k, c)
        active.lossless = 1 if cause == PAINLEVE and S.policy == COMPLIANT else 0
        # what counts as no approach must not begin a compression of its own
        active.rate_before[0] = contact.rate[0] if abs(contact.rate[0]) > S.velocity_tolerance else 0.0
        for r in range(1, 3):
            active.rate_before[r] = contact.rate[r]
    S.phases, S.truncated = 1, 0
    S.slow_speed = slow_speed(S, w, k)
    if cause == JAM:
        if jam_slips(S, w, k) == 0:
            return NO_CONTACT_SOLUTION
    elif S.impact_map != 0:
        map_impact(S, w, k)
    else:
        outcome = windowed_impact(S, w, k) if large else energetic_impact(S, w, k, seed)
        if outcome == INVALID:
            return NOT_FINITE
        if outcome == ENDLESS and (large or S.stopped == 1 or _is_over(S, w, k) == 0):
            return IMPACT_ENDLESS
    for i in range(3 * m):
        if not abs(w[S.impulse + i]) < 1e300:
            return NOT_FINITE
    add_response(S, w, k, S.impulse, S.y + S.n_q)
    for a in range(m):
        active = active_at(S, w, k, a)
        c = active.slot
        contact = contact_at(S, w, k, c)
        w[S.event_head + RESTITUTION_LOSS] += active.stored - active.returned
        w[S.event_head + FRICTION_LOSS] += active.rubbed
        for r in range(3):
            impulse = active.impulse[r]
            contact.event_impulse[r] = impulse
            w[S.event_head + DRIVEN_WORK] -= impulse * contact.prescribed_rate[r]
        if contact.oriented == 1:
            contact.event_friction = along_tangents(S, w, k, c, contact.event_friction)
    return RUNNING


@kernel("i8(S, F, I, i8)")
def _force_gone(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return 1 if the normal force of a closed contact has gone together with that which fired."""
    contact = contact_at(S, w, k, c)
    largest = 0.0
    for other in range(S.n_contacts):
        pushing = contact_at(S, w, k, other)
        if pushing.mode != OPEN and pushing.normal_function == 0 and is_on_course(S, w, k, other) == 0:
            largest = max(largest, guard_at(S, w, k, normal_guard(other)).first)
    rigid = contact.normal_function == 0
    return 1 if rigid and contact.mode != OPEN and guard_at(S, w, k, normal_guard(c)).value <= 1e-9 * largest else 0


@kernel("i8(S, F, I, i8, i8)")
def _share_a_bound(S: Scalars, w: Floats, k: Integers, c: int, which: int) -> int:
    """Return 1 if the forces of two contacts are not unique, so that they share one bound."""
    return 1 if contact_at(S, w, k, c).redundant + contact_at(S, w, k, which).redundant == 2 else 0


@kernel("void(S, F, I, i8, i8)")
def _expect(S: Scalars, w: Floats, k: Integers, cause: int, which: int) -> None:
    """Group the contacts at rest in the normal direction and guess their modes: the past ones, and the event's."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.member = 0
        contact.mode_agreed = contact.mode if is_on_course(S, w, k, c) == 1 else OPEN
        if contact.normal_function != 0:
            _expect_compliant(S, w, k, c, which, cause)
        elif contact.touching == 1 and (contact.rate[0] <= S.velocity_tolerance or contact.averaged != OPEN):
            contact.member = 1
            # a slip about to start from rest is found anew, not remembered
            mode = SLIDE if slip_speed(S, w, k, c) > S.velocity_tolerance else STICK
            # one that touches without having closed parts again
            if contact.mode == OPEN and (c != which or cause == JAM) and cause != START:
                mode = OPEN
            if cause == LIFT_OFF and (c == which or _force_gone(S, w, k, c) == 1):
                mode = OPEN
            # a group whose forces are not unique has one bound and breaks away together
            if cause == STICK_TO_SLIP and (c == which or _share_a_bound(S, w, k, c, which) == 1):
                mode = SLIDE
            contact.mode_agreed = mode
    group_members(S, w, k)


@kernel("void(S, F, I, i8, i8, i8)")
def _expect_compliant(S: Scalars, w: Floats, k: Integers, c: int, which: int, cause: int) -> None:
    """Guess the mode of a compliant contact, which is its mode where its friction is no question."""
    contact = contact_at(S, w, k, c)
    if cause == LIFT_OFF and c == which:
        contact.touching = 0
    if contact.touching == 0:
        return
    speed = slip_speed(S, w, k, c)
    slides = speed > S.velocity_tolerance or contact.traction_function != 0
    breaks = cause == STICK_TO_SLIP and (c == which or _share_a_bound(S, w, k, c, which) == 1)
    contact.mode_agreed = SLIDE if slides or breaks else STICK
    contact.member = 1 - rubs_unasked(S, w, k, c)
    contact.direction_agreed = contact.direction
    if speed > S.velocity_tolerance:
        contact.direction_agreed = contact.slip[0] / speed, contact.slip[1] / speed


@kernel("i8(S, F, I, i8)")
def _solve_islands(S: Scalars, w: Floats, k: Integers, ends: int) -> int:
    """Find modes and forces of the grouped contacts; return 1, or 0 with an island active that has no solution.

    Return 2 where all is to be done again, some friction having another bound than it seemed.
    """
    accelerate_touching(S, w, k)
    push_compliant(S, w, k)
    S.mean_until = 1e300
    turned = 0
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        if keeps_averaging(S, w, k, ends) == 1:
            average(S, w, k, ends)
            accelerate(S, w, k)
            continue
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            contact = contact_at(S, w, k, active.slot)
            if contact.averaged != OPEN:
                contact.mean_asked = S.t
            contact.averaged, active.mode_tried = OPEN, contact.mode_agreed
        set_up(S, w, k)
        if solve_contact(S, w, k) == 0:
            return 0
        accelerate(S, w, k)
        for a in range(S.n_active):
            active = active_at(S, w, k, a)
            c = active.slot
            contact = contact_at(S, w, k, c)
            contact.small_force_of = small_force(S, w, k, a)
            contact.mobility = slope_of_slip(S, w, k, a)
            contact.mode_agreed = active.mode_tried
            contact.direction_agreed = active.direction
            if active.at_rest == 1 and active.mode_tried != OPEN:
                turned += turn_facing(S, w, k, c, active.force[1])
    # friction that turned out to oppose the other way has another bound
    return 2 if turned > 0 else 1


@kernel("i8(S, F, I, i8)")
def _jam(S: Scalars, w: Floats, k: Integers, which: int) -> int:
    """Run the impact of a jam on the island of contact ``which``; return the status."""
    return PARADOX_REFUSED if S.policy == REFUSE else int(collide(S, w, k, JAM, which, 0.0))


@kernel("i8(S, F, I)")
def _impact_without_collision(S: Scalars, w: Floats, k: Integers) -> int:
    """Run the impact from rest on the contacts whose reduced normal coefficient has the wrong sign."""
    for c in range(S.n_contacts):
        contact_at(S, w, k, c).impacting = 0
    which, seed = -1, 0.0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        if active.at_rest == 0 and reduced_coefficient(S, w, k, a) <= 0.0:
            which = active.slot
            contact_at(S, w, k, which).impacting = 1
            seed = max(seed, slip_speed(S, w, k, which))
    if which < 0:
        return NO_CONTACT_SOLUTION
    if S.policy == REFUSE:
        return PARADOX_REFUSED
    return int(collide(S, w, k, PAINLEVE, which, seed))


@kernel("i8(S, F, I)")
def _creeps(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if one of several closed contacts slips so slowly that projecting the others may turn its slip."""
    closed = creeping = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode != OPEN and contact.normal_function == 0:
            closed += 1
            # how averaged forces go on is known, whichever way it slips
            instant = contact.averaged == OPEN
            if instant and S.velocity_tolerance < slip_speed(S, w, k, c) <= _SLOW * S.velocity_tolerance:
                creeping += 1
    return 1 if closed > 1 and creeping > 0 else 0


@entry_point("i8(S, F, I, i8, i8)")
def update_at_event(S: Scalars, w: Floats, k: Integers, cause: int, which: int) -> int:
    """Carry the system through an instant that contact ``which`` makes one by ``cause``; return the status."""
    S.recorded = S.truncated = 0
    resting = projected = stopped = 0
    fastest = -1
    ends = 1 if cause == AVERAGING and which < 0 else 0
    if S.mean_until < 1e300:
        touch(S, w, k)
        book_mean_forces(S, w, k)
    if ends == 1:
        reach_end(S, w, k)
    approaching = touch(S, w, k)
    open_account(S, w, k)
    if cause == JAM:
        status = _jam(S, w, k, which)
        if status != RUNNING:
            return status
        approaching = _approaches(S, w, k)
    for _attempt in range(_ATTEMPTS):
        if interrupted(S, S.n_contacts) == 1:
            return UPDATE_ENDLESS
        if approaching == 1 and hand_over(S, w, k) == 1:
            approaching = touch(S, w, k)
            continue
        if approaching == 1:
            fastest = _fastest_approach(S, w, k)
            join_near(S, w, k, -contact_at(S, w, k, fastest).rate[0])
        if approaching == 1 and stopped == 0 and stop_slow(S, w, k) > 0:
            stopped, approaching = 1, touch(S, w, k)
            continue
        if approaching == 1 and stopped == 1:
            approaching = average_slow(S, w, k)
        if approaching == 1:
            status = collide(S, w, k, IMPACT, fastest, 0.0)
            if status != RUNNING:
                return status
            approaching, stopped = _approaches(S, w, k), 0
            continue
        if S.recorded == 0 and projected == 0:
            remember(S, w, k)
        _expect(S, w, k, cause, which)
        solved = _solve_islands(S, w, k, ends)
        if solved == 2 and _attempt < _FACINGS:
            approaching = touch(S, w, k)
            continue
        if S.stopped == 1:
            return UPDATE_ENDLESS
        if solved == 0:
            for a in range(S.n_active):
                active = active_at(S, w, k, a)
                if not (active.mu >= 0.0 and active.mu_static >= 0.0):
                    return NOT_FINITE
            resting += 1
            status = NO_CONTACT_SOLUTION
            if resting <= _PAINLEVE_ATTEMPTS:
                status = _impact_without_collision(S, w, k)
            if status == NO_CONTACT_SOLUTION and average_active(S, w, k) == 1:
                # those that are averaged already begin anew with it
                ends = 0
                approaching = touch(S, w, k)
                continue
            if status != RUNNING:
                return status
            approaching = _approaches(S, w, k)
            continue
        _adopt(S, w, k)
        if close_contacts(S, w, k) == 0:
            if _creeps(S, w, k) == 0 or projected == _PROJECTIONS:
                _finish(S, w, k, cause, which, ends)
                return RUNNING
            # what brings others to rest may turn so slow a slip, and modes follow from its direction
            projected += 1
            S.closing_loss += project_closed(S, w, k, 1, 0)
        else:
            # those whose averaging has begun with it go on with it
            ends = 0
        approaching = touch(S, w, k)
    return UPDATE_ENDLESS


@kernel("void(S, F, I)")
def _adopt(S: Scalars, w: Floats, k: Integers) -> None:
    """Take over the modes and slip directions that the contact problem found."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode == OPEN and contact.mode_agreed != OPEN:
            begin_contact(S, w, k, c)
        contact.mode = contact.mode_agreed
        if contact.mode == OPEN:
            contact.averaged = OPEN
        if contact.mode == SLIDE:
            contact.direction = contact.direction_agreed


@kernel("void(S, F, I, i8, i8, i8)")
def _finish(S: Scalars, w: Floats, k: Integers, cause: int, which: int, ends: int) -> None:
    """Put the closed contacts exactly on their constraints and write the event."""
    S.closing_loss += project_closed(S, w, k, 1, 0) + stop_creeping(S, w, k)
    if S.recorded > 0:
        amend_last(S, w, k)
        return
    if cause == IMPACT and has_replaced(S, w, k, which) == 1:
        cause = FEATURE_CHANGE
    changed = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        begun_or_ended = (contact.averaged != OPEN) != (contact.averaged_before != OPEN)
        if code(S, w, k, c) != contact.code_before or begun_or_ended:
            changed = 1
    if changed == 1 or cause == START or cause == FEATURE_CHANGE or (cause == AVERAGING and ends == 0):
        record_event(S, w, k, cause, which, 0)
