"""The mode automaton, the only place that knows the order: flow, guard, jump, new mode."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import turn_facing
from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.bodies.touching import find_touching
from nonsmooth.engine.delassus.islands import group_closed
from nonsmooth.engine.events.averaging import (
    average_island_of,
    contact_of_burst,
    count_event,
    end_averaging,
    is_stalled,
)
from nonsmooth.engine.events.causes import cause_at_start, cause_of, cause_of_closing
from nonsmooth.engine.events.event_update import update_at_event
from nonsmooth.engine.events.record import NO_PHASES, begin_event, record_event, record_samples
from nonsmooth.engine.events.step_length import accepted_step, is_held, longest_wanted
from nonsmooth.engine.events.stopping import stopped_contact
from nonsmooth.engine.flow.arming import arm_guards, store_end, store_start
from nonsmooth.engine.flow.clearance import bound_speeds
from nonsmooth.engine.flow.crossing import first_crossing
from nonsmooth.engine.flow.feature_end import find_feature_end
from nonsmooth.engine.flow.flight import choose_integrated, take_off
from nonsmooth.engine.flow.flow import is_violated, most_loaded_contact, slope
from nonsmooth.engine.flow.follow import orient_slips
from nonsmooth.engine.flow.guard_numbers import (
    contact_of,
    end_of,
    first_end_guard,
    first_user_guard,
    normal_of,
)
from nonsmooth.engine.flow.guard_values import has_other_features, store_features, write_guards
from nonsmooth.engine.flow.guards import has_finite_user_guards, is_of_redundant_force
from nonsmooth.engine.flow.initial_depth import end_depths
from nonsmooth.engine.flow.location import locate
from nonsmooth.engine.flow.own_steps import begin_own_steps, end_own_steps, has_drifted
from nonsmooth.engine.flow.point_jump import contact_past_flat_place, evaluate_force_round_off, jump_contact_points
from nonsmooth.engine.flow.projection import normalise_quaternions, project_closed, project_joints
from nonsmooth.engine.flow.redundant_forces import can_choose_within, choose_forces_again
from nonsmooth.engine.flow.self_check import check_end, check_gaps, close_energy_account
from nonsmooth.engine.flow.step import try_step
from nonsmooth.engine.memory.event_rows import CODE_HEAD, EVENT_HEAD, LISTED, MOST_EVENTS
from nonsmooth.engine.memory.layout import BOOKED, LAST_STAGE, NO_PAIR
from nonsmooth.engine.memory.modes import NO_CONTACT, NO_RELEASE, Cause, Limit, Mode, Status
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.tolerances import ALLOWED, NEGLIGIBLE, SPACING
from nonsmooth.engine.numerics.vectors import length
from nonsmooth.engine.pairs.apart import find_apart
from nonsmooth.engine.pairs.listing import list_touching, list_with, longest_step
from nonsmooth.engine.pairs.motion import bound_carriers


@kernel("i8(ws, f8)")
def _commit(ws: Workspace, h: float) -> int:
    """Accept the step of ``h`` [s] and record its samples.

    Returns the number of bodies whose own step (multirate) ends with it.
    """
    record_samples(ws, h)
    return _take_over(ws, h)


@kernel("i8(ws, f8)")
def _take_over(ws: Workspace, h: float) -> int:
    """Accept the step of ``h`` [s]: set state and time to those at its end, and project on the constraints.

    Returns the number of bodies whose own step (multirate) ends with it.
    """
    for i in range(ws.model.n_y):
        ws.island.y[i] = ws.step.y_new[i]
    ws.island.time += h
    normalise_quaternions(ws)
    if ws.model.n_joints > 0:
        project_joints(ws)
    ended = end_own_steps(ws)
    if ended > 0:
        group_closed(ws)
    if has_drifted(ws):
        ws.totals.closing_loss += project_closed(ws, at_event=False, averaged=False)
    return ended


@kernel("Status(ws, Status)")
def _up_to_end(ws: Workspace, status: Status) -> Status:
    """Limit the next step to the end time, to repeat a failed step once.

    The failed step may have evaluated a law after the end time, and a law need not be defined there. Returns
    ``RUNNING`` if the step is to be repeated. If steps were limited to the end time already, returns the ``status`` of
    the failure.
    """
    if ws.island.resumed_step <= ws.request.t_end - ws.island.time:
        return status
    ws.island.resumed_step, ws.island.follows_a_step = ws.request.t_end - ws.island.time, False
    return Status.RUNNING


@kernel("Status(ws)")
def _arrived(ws: Workspace) -> Status:
    """Check the state at the end time. ``DONE``, or the failure that was found."""
    ws.island.time = ws.request.t_end
    check_end(ws)
    return Status.DONE if ws.run.failure == Status.RUNNING else ws.run.failure


@kernel("Status(ws)")
def _end_within(ws: Workspace) -> Status:
    """Advance to the end time, which lies within the current step and before its first event; return the status.

    The current step was chosen, and its event located, as if the run continued. So the end time has no effect on the
    results before it.
    """
    h = ws.request.t_end - ws.island.time
    record_samples(ws, h)
    ws.step.h = h
    if not try_step(ws, h) < math.inf:
        return Status.NOT_FINITE
    _take_over(ws, h)
    return _arrived(ws)


@kernel("Status(ws, Cause, i8)")
def _carry_out(ws: Workspace, cause: Cause, which: int) -> Status:
    """Carry out an event of contact ``which``: update modes and velocities at its instant; return the status."""
    ws.island.follows_a_step = False
    if ws.model.n_pairs > 0:
        which = _listed_anew(ws, which)
        if which == NO_CONTACT:
            return Status.LIST_FULL
    count_event(ws, which)
    if is_stalled(ws, which):
        if not average_island_of(ws, which):
            return Status.STALLED
        ws.contacts[which].burst_events = 0
    return update_at_event(ws, cause, which)


@kernel("i8(ws, i8)")
def _listed_anew(ws: Workspace, which: int) -> int:
    """List the contacts of pairs that touch at the instant, too. Returns where contact ``which`` is in the new list.

    ``NO_CONTACT`` if the list has not enough places.
    """
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    declared, pair = ws.contacts[which].declared, ws.contacts[which].pair
    if not find_apart(ws, pair):
        return which
    if list_with(ws, pair) != Status.RUNNING:
        return NO_CONTACT
    for contact in ws.contacts:
        if contact.declared == declared:
            return contact.index
    return NO_CONTACT


@kernel("Status(ws, f8)")
def _meet(ws: Workspace, h: float) -> Status:
    """Accept the step of ``h`` [s], at whose end two parts meet, and carry out the event; return the status."""
    group = ws.pairs[ws.step.meeting].group
    _commit(ws, h)
    ws.island.follows_a_step = False
    status = list_with(ws, group)
    if status != Status.RUNNING:
        return status
    find_touching(ws)
    which, least = NO_CONTACT, math.inf
    for contact in ws.contacts:
        if contact.pair == group and contact.is_touching and contact.gap < least:
            which, least = contact.index, contact.gap
    # no feature touches: the features of the parts are evaluated from now on, as they are next to each other
    if which == NO_CONTACT:
        return Status.RUNNING
    return _carry_out(ws, cause_of_closing(ws.contacts[which]), which)


@kernel("Status(ws)")
def _step(ws: Workspace) -> Status:
    """Advance by one step or to the next event, whichever is earlier; return the status."""
    if ws.island.averaged_until - ws.island.time <= ws.tolerance.time:
        ws.island.follows_a_step = False
        return update_at_event(ws, Cause.AVERAGING, -1)
    if ws.model.n_pairs > 0 and find_apart(ws, NO_PAIR):
        return list_touching(ws)
    _evaluate_start(ws)
    check_gaps(ws)
    if ws.run.failure != Status.RUNNING:
        return ws.run.failure
    if ws.island.averaged_until < math.inf and ws.island.strayed > 1.0:
        end_averaging(ws)
        ws.island.follows_a_step = False
        return update_at_event(ws, Cause.AVERAGING, ws.island.stray_contact)
    if ws.model.n_pairs > 0:
        end_depths(ws)
    store_start(ws)
    which = _due_at_start(ws)
    if which >= 0:
        return _carry_out(ws, cause_at_start(ws, which), which)
    ws.step.listed_step = longest_step(ws)
    if ws.step.listed_step == 0.0:
        return list_touching(ws)
    orient_slips(ws, at_end=True)
    arm_guards(ws)
    which = contact_of_burst(ws) if ws.island.n_grouped > 0 else -1
    if which >= 0 and average_island_of(ws, which):
        ws.island.follows_a_step = False
        return update_at_event(ws, Cause.AVERAGING, which)
    status = accepted_step(ws)
    if status != Status.RUNNING:
        return _without_step(ws, status)
    ws.totals.n_steps += 1
    high = first_crossing(ws, ws.step.h)
    if ws.step.is_undecided:
        return _in_part(ws)
    if not has_finite_user_guards(ws):
        return _up_to_end(ws, Status.NOT_FINITE)
    if high > 0.0:
        return _step_to_event(ws, high)
    return _whole_step(ws)


@kernel()
def _evaluate_start(ws: Workspace) -> None:
    """Write slope and guards at the start of the step.

    After a step without an event, they are copied from the end of that step.
    """
    ws.step.uses_last_slope = ws.island.follows_a_step
    ws.step.has_replaced_slope = False
    if ws.island.follows_a_step:
        ws.step.power_at_start = ws.island.power_at_end
        store_features(ws)
        for i in range(ws.model.n_y):
            ws.island.slopes[i] = ws.island.slopes[LAST_STAGE * ws.model.n_y + i]
        return
    begin_own_steps(ws, ws.island.closed_step, ws.island.resumed_step)
    group_closed(ws)
    choose_integrated(ws)
    slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=True, of_all_bodies=True)
    take_off(ws)
    close_energy_account(ws)
    store_features(ws)
    write_guards(ws, ws.island.time, ws.island.y.start, forces_are_known=True)
    store_end(ws)
    bound_speeds(ws)
    bound_carriers(ws)


@kernel("i8(ws)")
def _due_at_start(ws: Workspace) -> int:
    """Return the number of a contact that has an event at the start of the step, or -1."""
    for contact in ws.contacts:
        c = contact.index
        if contact.mode == Mode.OPEN:
            # a gap that closes exactly where the last step ended is an event of that step
            gap = normal_of(ws, contact).at_end
            arrived = gap <= ws.tolerance.gap and contact.gap_rate_at_end < -ws.tolerance.velocity
            # features of bodies on springs may begin to face each other at depth
            begins_deep = contact.is_compliant and gap < -ALLOWED * ws.tolerance.gap
            if arrived or begins_deep:
                return c
            continue
        # the projection on the constraints may have moved a contact point past the end of its feature
        if end_of(ws, contact).at_end < 0.0:
            return c
        # the projection may have turned a slip direction, so that the contact force violates a bound
        is_unique = not (contact.is_compliant or contact.has_redundant_force or has_own_step(ws, c))
        if not ws.island.follows_a_step and is_unique and is_violated(ws, c):
            return c
    return -1


@kernel("Status(ws, Status)")
def _without_step(ws: Workspace, status: Status) -> Status:
    """Handle a step that was not accepted, for the reason ``status``; return the new status.

    A step that is too small may end at a jump of a contact point, at the end of a feature, in a jam of a sliding
    contact, or in averaged forces (time-stepping fallback). These are tried in this order. Otherwise the step is
    repeated once up to the end time.
    """
    ws.step.limit = Limit.NO_STEP
    if status == Status.STEP_TOO_SMALL and jump_contact_points(ws, ws.tolerance.time):
        return _after_leap(ws)
    if status == Status.STEP_TOO_SMALL:
        which = find_feature_end(ws)
        if which >= 0:
            changed = has_other_features(ws, ws.contacts[which])
            _take_over(ws, ws.step.h)
            return _pass_on(ws, which, changed)
        which = most_loaded_contact(ws, sliding=True)
        if which >= 0:
            outcome = _carry_out(ws, Cause.JAM, which)
            if outcome != Status.NO_CONTACT_SOLUTION:
                return outcome
        which = most_loaded_contact(ws, sliding=False)
        if which >= 0 and average_island_of(ws, which):
            ws.island.follows_a_step = False
            return update_at_event(ws, Cause.AVERAGING, which)
    return _up_to_end(ws, status)


@kernel("Status(ws)")
def _after_leap(ws: Workspace) -> Status:
    """Accept the short step in which contact points jumped; return the status.

    If the jump released a contact, its event is carried out.
    """
    ws.step.h, ws.island.follows_a_step = ws.tolerance.time, False
    _take_over(ws, ws.step.h)
    cause, which = NO_RELEASE, -1
    for contact in ws.contacts:
        if contact.mode != Mode.OPEN and contact.release != NO_RELEASE and which < 0:
            cause, which = contact.release, contact.index
        contact.release = NO_RELEASE
    if which >= 0:
        return _carry_out(ws, cause, which)
    evaluate_force_round_off(ws)
    return Status.RUNNING


@kernel("Status(ws)")
def _whole_step(ws: Workspace) -> Status:
    """Accept a step in which no guard fired; return the status.

    A slip that has come to rest in the step, or a contact point that has jumped, is then an event at its end.
    """
    if ws.step.h > ws.request.t_end - ws.island.time:
        ws.step.limit = Limit.END
        return _end_within(ws)
    which = contact_past_flat_place(ws)
    if which >= 0 and ws.step.h > ws.tolerance.time:
        return _in_part(ws)
    ended = _commit(ws, ws.step.h)
    if ws.step.is_blended:
        ws.island.last_choice = ws.island.time
    if which >= 0:
        return _carry_out(ws, Cause.IMPACT, which)
    which = stopped_contact(ws)
    if which >= 0:
        return _carry_out(ws, Cause.SLIP_TO_STICK, which)
    ws.island.follows_a_step = ended == 0
    continues = ws.run.failure == Status.RUNNING and ws.request.t_end - ws.island.time > ws.tolerance.time
    if ws.step.limit == Limit.EVENT and ws.island.follows_a_step and continues:
        # the step was chosen to end at the expected closing of a gap
        which = _due_at_start(ws)
        if which >= 0:
            return _carry_out(ws, cause_at_start(ws, which), which)
    return Status.RUNNING


@kernel("Status(ws, f8)")
def _step_to_event(ws: Workspace, high: float) -> Status:
    """Locate the first event before the fraction ``high`` of the step and carry it out; return the status."""
    ws.island.follows_a_step, ws.step.limit = False, Limit.EVENT
    if can_choose_within(ws, high):
        return _in_part(ws)
    h = locate(ws, ws.step.h, high)
    if h < 0.0 or ws.step.is_undecided:
        return _in_part(ws)
    if h > ws.request.t_end - ws.island.time:
        ws.step.limit = Limit.END
        return _end_within(ws)
    return _meet(ws, h) if ws.step.meeting != NO_PAIR else _event(ws, h, ws.step.guard)


@kernel("Status(ws)")
def _in_part(ws: Workspace) -> Status:
    """Reject the step, and propose a quarter of its length for the next attempt; return the status."""
    ws.island.follows_a_step, ws.step.limit = False, Limit.CROWDED_EVENTS
    # causes: many guards fire in the step, its error grows, a contact point has jumped, or a gap is not decided
    if ws.step.h < NEGLIGIBLE * ws.tolerance.time:
        return _without_step(ws, Status.STEP_TOO_SMALL)
    if ws.island.n_integrated == 0 and ws.island.own_steps_end < math.inf:
        ws.island.own_steps_end = ws.island.time + 0.25 * ws.step.h
    elif is_held(ws):
        ws.island.closed_step = 0.25 * ws.step.h
    else:
        ws.island.free_step = 0.25 * ws.step.h
    return Status.RUNNING


@kernel("Status(ws, f8, i8)")
def _event(ws: Workspace, h: float, guard: int) -> Status:
    """Accept the step of ``h`` [s], at whose end a guard fires, and carry out its event; return the status."""
    if guard >= first_end_guard(ws):
        which = guard - first_end_guard(ws)
        changed = has_other_features(ws, ws.contacts[which])
        _commit(ws, h)
        return _pass_on(ws, which, changed)
    if guard >= first_user_guard(ws):
        _commit(ws, h)
        return _own_event(ws, guard - first_user_guard(ws))
    cause, which = cause_of(ws, guard), contact_of(ws, guard)
    if cause == Cause.STICK_TO_SLIP:
        _break_direction(ws, which)
    _commit(ws, h)
    if is_of_redundant_force(ws, guard) and choose_forces_again(ws):
        return Status.RUNNING
    return _carry_out(ws, cause, which)


@kernel("Status(ws, i8, b1)")
def _pass_on(ws: Workspace, which: int, has_changed: bool) -> Status:
    """Carry out the event in which the features of contact ``which`` have ended or changed; return the status."""
    if has_changed:
        ws.island.last_feature_change = ws.island.time
    return _carry_out(ws, Cause.FEATURE_CHANGE if has_changed else Cause.FEATURE_END, which)


@kernel("Status(ws, i8)")
def _own_event(ws: Workspace, number: int) -> Status:
    """Record the event of a guard that the user declared; return the status."""
    begin_event(ws)
    record_event(ws, Cause.GUARD, number, NO_PHASES)
    guard = ws.own_guards[number]
    guard.has_just_fired = True
    return Status.STOPPED if guard.ends_the_run else Status.RUNNING


@kernel("void(ws, i8)")
def _break_direction(ws: Workspace, which: int) -> None:
    """Set the slip direction of a contact that breaks away: against the friction that acted while it stuck.

    If this friction is not unique, the friction of least norm is used.
    """
    contact = ws.contacts[which]
    t1 = contact.force[1] - contact.null_space_force[1] * contact.has_redundant_force
    t2 = contact.force[2] - contact.null_space_force[2] * contact.has_redundant_force
    norm, speed = length((t1, t2)), length(contact.slip)
    if norm > 0.0:
        turn_facing(ws, which, t1)
        contact.direction = -t1 / norm, -t2 / norm
    elif speed > 0.0:
        # no friction acted: keep the direction of the present slip
        contact.direction = contact.slip[0] / speed, contact.slip[1] / speed


@kernel()
def _derive(ws: Workspace) -> None:
    """Evaluate the numbers that a checkpoint omits, because they follow from the state (:attr:`Life.DERIVED`)."""
    ws.island.velocities = ws.island.y.start + ws.model.n_q
    group_closed(ws)
    choose_integrated(ws)


@entry_point("Status(ws, i8, b1)")
def advance(ws: Workspace, most_steps: int, pauses_before_end: bool) -> Status:
    """Run until the end time, a failure, full buffers or ``most_steps``; return the status.

    With ``pauses_before_end`` it pauses before a step that may lead past the end time.
    """
    if not ws.run.has_started:
        ws.run.has_started = True
        ws.tolerance.time = max(ws.tolerance.resolution, SPACING * abs(ws.island.time))
        evaluate_bodies(ws, ws.island.time, ws.island.y.start)
        status = update_at_event(ws, Cause.START, -1)
        if ws.run.has_too_many_blocks:
            return Status.NO_SLOT
        if status != Status.RUNNING:
            return status
    if ws.request.is_resumed:
        ws.request.is_resumed = False
        _derive(ws)
    if ws.island.resumed_end != ws.request.t_end:
        # steps may have been limited to the previous end time, because a law was not defined after it; see _up_to_end.
        # With another end time this limit of the step is removed
        ws.island.resumed_end, ws.island.resumed_step = ws.request.t_end, math.inf
    for _index in range(most_steps):
        # late in a run doubles are farther apart than the tolerance
        ws.tolerance.time = max(ws.tolerance.resolution, SPACING * abs(ws.island.time))
        if pauses_before_end and longest_wanted(ws) > ws.request.t_end - ws.island.time:
            return Status.PAUSED
        if ws.request.t_end - ws.island.time <= ws.tolerance.time:
            return _arrived(ws)
        row = EVENT_HEAD + ws.model.n_u + ws.model.n_y + BOOKED + LISTED * ws.island.n_contacts
        floats_left = ws.model.event_floats - ws.output.floats_used
        integers_left = ws.model.event_integers - ws.output.integers_used
        if floats_left < MOST_EVENTS * row or integers_left < MOST_EVENTS * (CODE_HEAD + 2 * ws.island.n_contacts):
            return Status.PAUSED
        if 2 * ws.output.n_samples > ws.model.sample_capacity:
            return Status.PAUSED
        ws.step.limit = Limit.NO_STEP
        status = _step(ws)
        ws.totals.n_steps_limited[ws.step.limit.value] += 1
        if status == Status.RUNNING:
            status = ws.run.failure
        if ws.run.has_too_many_blocks:
            status = Status.NO_SLOT
        if status != Status.RUNNING:
            return status
    return Status.PAUSED
