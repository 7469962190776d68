"""The mode automaton, the only place that knows the order: flow, guard, jump, new mode."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import turn_facing
from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.courses import has_own_step
from nonsmooth.engine.bodies.listing import list_contacts, longest_step
from nonsmooth.engine.delassus.islands import group_closed
from nonsmooth.engine.events.averaging import average_island_of, end_averaging, holds_time_up
from nonsmooth.engine.events.causes import cause_at_start, cause_of
from nonsmooth.engine.events.event_update import update_at_event
from nonsmooth.engine.events.record import (
    CODE_HEAD,
    EVENT_HEAD,
    LISTED,
    MOST_EVENTS,
    record_event,
    record_samples,
    remember,
)
from nonsmooth.engine.events.stall import stalls
from nonsmooth.engine.events.step_length import accepted_step, is_held, longest_wanted
from nonsmooth.engine.events.stopping import stopping
from nonsmooth.engine.flow.choices import choices_bend, choose_anew
from nonsmooth.engine.flow.clearance import bound_speeds
from nonsmooth.engine.flow.courses import drifted, end_courses, set_off
from nonsmooth.engine.flow.ending import end_features
from nonsmooth.engine.flow.flight import choose_integrated, take_off
from nonsmooth.engine.flow.flow import hardest_pressed, is_violated, slope
from nonsmooth.engine.flow.follow import orient_slips
from nonsmooth.engine.flow.guard_numbers import (
    contact_of,
    first_end_guard,
    first_own_guard,
    normal_guard,
)
from nonsmooth.engine.flow.guards import (
    arm_guards,
    has_other_features,
    is_of_redundant_force,
    keep_end,
    keep_start,
    watch_features,
    write_guards,
)
from nonsmooth.engine.flow.leap import leap, measure_noise, passed_flat
from nonsmooth.engine.flow.location import first_crossing, locate
from nonsmooth.engine.flow.projection import (
    normalise_quaternions,
    project_closed,
    project_joints,
)
from nonsmooth.engine.flow.self_check import NOUGHT, check_end, check_gaps, close_account
from nonsmooth.engine.flow.step import try_step
from nonsmooth.engine.memory.layout import BOOKED, LAST_STAGE
from nonsmooth.engine.memory.limits import BY_CROWD, BY_END, BY_EVENT, NO_STEP
from nonsmooth.engine.memory.modes import (
    AVERAGING,
    DONE,
    FEATURE_CHANGE,
    FEATURE_END,
    GUARD,
    IMPACT,
    JAM,
    NO_CONTACT_SOLUTION,
    NO_SLOT,
    NOT_FINITE,
    OPEN,
    PAUSED,
    RUNNING,
    SLIP_TO_STICK,
    STALLED,
    START,
    STEP_TOO_SMALL,
    STICK_TO_SLIP,
    STOPPED,
)
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.vectors import length

_SPACINGS = 4.0 * 2.0**-52
"""Times closer than this part of the time are not told apart."""


@kernel("i8(ws, f8)")
def _commit(ws: Workspace, h: float) -> int:
    """Take over the step of ``h`` with its samples; return how many courses end."""
    record_samples(ws, h)
    return _take_over(ws, h)


@kernel("i8(ws, f8)")
def _take_over(ws: Workspace, h: float) -> int:
    """Take over the step of ``h``: state, time, constraints; return how many courses end."""
    for i in range(ws.n_y):
        ws.y[i] = ws.y_new[i]
    ws.t += h
    normalise_quaternions(ws)
    if ws.n_joints > 0:
        project_joints(ws)
    ended = end_courses(ws)
    if ended > 0:
        group_closed(ws)
    if drifted(ws):
        ws.closing_loss += project_closed(ws, 0, 0)
    return ended


@kernel("i8(ws, i8)")
def _up_to_end(ws: Workspace, status: int) -> int:
    """Let a step that failed be tried once more, up to the end of the run: what lies behind need not have a value."""
    if ws.h_valid <= ws.t_end - ws.t:
        return status
    ws.h_valid, ws.fresh = ws.t_end - ws.t, 0
    return RUNNING


@kernel("i8(ws)")
def _arrived(ws: Workspace) -> int:
    """Look at the state at the end time; return the status."""
    ws.t = ws.t_end
    check_end(ws)
    return DONE if ws.failed == RUNNING else int(ws.failed)


@kernel("i8(ws)")
def _end_within(ws: Workspace) -> int:
    """End the run within the step that leads past its end time, before any event of it; return the status.

    The step was taken, and its event looked for, as if the run went on: where it ends then changes nothing of what
    it does before.
    """
    h = ws.t_end - ws.t
    record_samples(ws, h)
    ws.h = h
    if not try_step(ws, h) < 1e300:
        return NOT_FINITE
    _take_over(ws, h)
    return _arrived(ws)


@kernel("i8(ws, i8, i8)")
def _carry_out(ws: Workspace, cause: int, which: int) -> int:
    """Carry out an event of contact ``which``: update modes and velocities at its instant; return the status."""
    ws.fresh = 0
    if stalls(ws, which):
        if not average_island_of(ws, which):
            return STALLED
        ws.contacts[which].burst_events = 0
    return update_at_event(ws, cause, which)


@kernel("i8(ws)")
def _step(ws: Workspace) -> int:
    """Advance by one step or to the next event, whichever is earlier; return the status."""
    if ws.mean_until - ws.t <= ws.time_tolerance:
        ws.fresh = 0
        return update_at_event(ws, AVERAGING, -1)
    _evaluate_start(ws)
    check_gaps(ws)
    if ws.failed != RUNNING:
        return int(ws.failed)
    if ws.mean_until < math.inf and ws.strayed > 1.0:
        end_averaging(ws)
        ws.fresh = 0
        return update_at_event(ws, AVERAGING, ws.stray)
    keep_start(ws)
    which = _due_at_start(ws)
    if which >= 0:
        return _carry_out(ws, cause_at_start(ws, which), which)
    ws.h_listed = longest_step(ws) if ws.n_units > 0 else 1e300
    if ws.h_listed == 0.0:
        return int(list_contacts(ws))
    orient_slips(ws, 1)
    arm_guards(ws)
    which = holds_time_up(ws) if ws.n_grouped > 0 else -1
    if which >= 0 and average_island_of(ws, which):
        ws.fresh = 0
        return update_at_event(ws, AVERAGING, which)
    status = accepted_step(ws)
    if status != RUNNING:
        return _without_step(ws, status)
    ws.steps += 1
    high = first_crossing(ws, ws.h)
    for i in range(first_own_guard(ws), first_end_guard(ws)):
        if not abs(ws.guards[i].end) < 1e300:
            return _up_to_end(ws, NOT_FINITE)
    if high > 0.0:
        return _step_to_event(ws, high)
    return _whole_step(ws)


@kernel()
def _evaluate_start(ws: Workspace) -> None:
    """Write slope and guards where the step begins; behind a step without an event they are at hand."""
    ws.follows = ws.fresh
    ws.replaced = 0
    if ws.fresh == 1:
        ws.power_first = ws.power_end
        watch_features(ws)
        for i in range(ws.n_y):
            ws.slopes[i] = ws.slopes[LAST_STAGE * ws.n_y + i]
        return
    set_off(ws, ws.h_closed, ws.h_valid)
    group_closed(ws)
    choose_integrated(ws)
    slope(ws, ws.t, ws.offsets.y, ws.offsets.slopes, 1, 1)
    take_off(ws)
    close_account(ws)
    watch_features(ws)
    write_guards(ws, ws.t, ws.offsets.y, forces_are_known=True)
    keep_end(ws)
    bound_speeds(ws)


@kernel("i8(ws)")
def _due_at_start(ws: Workspace) -> int:
    """Return a contact of which an event is due before any step, or -1."""
    for c in range(ws.n_contacts):
        contact = ws.contacts[c]
        # a gap that closes exactly where the last step ended is an event of that step
        gap = ws.guards[normal_guard(c)].end
        arrived = gap <= ws.gap_tolerance and contact.gap_rate_at_end < -ws.velocity_tolerance
        if contact.mode == OPEN and arrived:
            return c
        # what put the contacts on their constraints may have put one past its end
        if contact.mode != OPEN and ws.guards[first_end_guard(ws) + c].end < 0.0:
            return c
        if has_own_step(ws, c) == 1:
            continue
        # and may have turned a slip so that its force is another one
        unique = contact.mode != OPEN and not contact.is_compliant and not contact.has_redundant_force
        if ws.fresh == 0 and unique and is_violated(ws, c):
            return c
    return -1


@kernel("i8(ws, i8)")
def _without_step(ws: Workspace, status: int) -> int:
    """Say what follows where no step was accepted, for the reason ``status``; return the status."""
    ws.limit = NO_STEP
    if status == STEP_TOO_SMALL and leap(ws, ws.time_tolerance):
        return _after_leap(ws)
    if status == STEP_TOO_SMALL:
        which = end_features(ws)
        if which >= 0:
            changed = has_other_features(ws, ws.contacts[which])
            _take_over(ws, ws.h)
            return _pass_on(ws, which, changed)
        which = hardest_pressed(ws, 1)
        if which >= 0:
            outcome = _carry_out(ws, JAM, which)
            if outcome != NO_CONTACT_SOLUTION:
                return int(outcome)
        which = hardest_pressed(ws, 0)
        if which >= 0 and average_island_of(ws, which):
            ws.fresh = 0
            return update_at_event(ws, AVERAGING, which)
    return _up_to_end(ws, status)


@kernel("i8(ws)")
def _after_leap(ws: Workspace) -> int:
    """Take over the instant in which contact points ran along bodies, and what it let go; return the status."""
    ws.h, ws.fresh = ws.time_tolerance, 0
    _take_over(ws, ws.h)
    cause, which = 0, -1
    for c in range(ws.n_contacts):
        contact = ws.contacts[c]
        if contact.mode != OPEN and contact.was_released and which < 0:
            cause, which = contact.released, c
        contact.released = 0
    if which >= 0:
        return _carry_out(ws, cause, which)
    measure_noise(ws)
    return RUNNING


@kernel("i8(ws)")
def _whole_step(ws: Workspace) -> int:
    """Take over a step without an event, unless a slip has come to rest in it; return the status."""
    if ws.h > ws.t_end - ws.t:
        ws.limit = BY_END
        return _end_within(ws)
    which = passed_flat(ws)
    if which >= 0 and ws.h > ws.time_tolerance:
        return _in_part(ws)
    ended = _commit(ws, ws.h)
    if ws.blended == 1:
        ws.chosen_t = ws.t
    if which >= 0:
        return _carry_out(ws, IMPACT, which)
    which = stopping(ws)
    if which >= 0:
        return _carry_out(ws, SLIP_TO_STICK, which)
    ws.fresh = 1 if ended == 0 else 0
    if ws.limit == BY_EVENT and ws.fresh == 1 and ws.failed == RUNNING and ws.t_end - ws.t > ws.time_tolerance:
        # it was made to end where a gap is about to close
        which = _due_at_start(ws)
        if which >= 0:
            return _carry_out(ws, cause_at_start(ws, which), which)
    return RUNNING


@kernel("i8(ws, f8)")
def _step_to_event(ws: Workspace, high: float) -> int:
    """Locate the first event before the fraction ``high`` of the step and carry it out; return the status."""
    ws.fresh, ws.limit = 0, BY_EVENT
    if choices_bend(ws, high):
        return _in_part(ws)
    h = locate(ws, ws.h, high)
    if h < 0.0:
        return _in_part(ws)
    if h > ws.t_end - ws.t:
        ws.limit = BY_END
        return _end_within(ws)
    return _event(ws, h, ws.trigger)


@kernel("i8(ws)")
def _in_part(ws: Workspace) -> int:
    """Ask for a quarter of the step, which leads past what it should end at; return the status."""
    ws.fresh, ws.limit = 0, BY_CROWD
    # crowded guards, an error that grows, or a flat place
    if ws.h < NOUGHT * ws.time_tolerance:
        return _without_step(ws, STEP_TOO_SMALL)
    if ws.n_integrated == 0 and ws.course_end < math.inf:
        ws.course_end = ws.t + 0.25 * ws.h
    elif is_held(ws):
        ws.h_closed = 0.25 * ws.h
    else:
        ws.h_free = 0.25 * ws.h
    return RUNNING


@kernel("i8(ws, f8, i8)")
def _event(ws: Workspace, h: float, guard: int) -> int:
    """Take over the step of ``h`` at whose end a guard fires, and carry out its event; return the status."""
    if guard >= first_end_guard(ws):
        which = guard - first_end_guard(ws)
        changed = has_other_features(ws, ws.contacts[which])
        _commit(ws, h)
        return _pass_on(ws, which, changed)
    if guard >= first_own_guard(ws):
        _commit(ws, h)
        return _own_event(ws, guard - first_own_guard(ws))
    cause, which = cause_of(ws, guard), contact_of(ws, guard)
    if cause == STICK_TO_SLIP:
        _break_direction(ws, which)
    _commit(ws, h)
    if is_of_redundant_force(ws, guard) == 1 and choose_anew(ws) == 1:
        return RUNNING
    return _carry_out(ws, cause, which)


@kernel("i8(ws, i8, i8)")
def _pass_on(ws: Workspace, which: int, changed: int) -> int:
    """Carry out that the features of contact ``which`` have ended, or changed (1); return the status."""
    if changed == 1:
        ws.feature_t = ws.t
    return _carry_out(ws, FEATURE_CHANGE if changed == 1 else FEATURE_END, which)


@kernel("i8(ws, i8)")
def _own_event(ws: Workspace, number: int) -> int:
    """Record the event of a guard of the scenario's own; return the status."""
    remember(ws)
    record_event(ws, GUARD, number, 0)
    guard = ws.own_guards[number]
    guard.spent = 1
    return STOPPED if guard.ends == 1 else RUNNING


@kernel("void(ws, i8)")
def _break_direction(ws: Workspace, which: int) -> None:
    """Let a contact that breaks away slip against the friction that held it, that of least norm if it is not unique."""
    contact = ws.contacts[which]
    t1 = contact.force[1] - contact.null_space_force[1] * contact.redundant
    t2 = contact.force[2] - contact.null_space_force[2] * contact.redundant
    norm, speed = length((t1, t2)), length(contact.slip)
    if norm > 0.0:
        turn_facing(ws, which, t1)
        contact.direction = -t1 / norm, -t2 / norm
    elif speed > 0.0:
        # nothing held it: it slips as it does
        contact.direction = contact.slip[0] / speed, contact.slip[1] / speed


@entry_point("i8(ws, i8, i8)")
def advance(ws: Workspace, most_steps: int, wary: int) -> int:
    """Run until the end time, a failure, full buffers or ``most_steps``; return the status.

    A wary run (1) pauses before a step that may lead past the end time.
    """
    if ws.started == 0:
        ws.started = 1
        ws.time_tolerance = max(ws.time_resolution, _SPACINGS * abs(ws.t))
        evaluate_bodies(ws, ws.t, ws.offsets.y)
        status = update_at_event(ws, START, -1)
        if ws.crowded == 1:
            return NO_SLOT
        if status != RUNNING:
            return status
    if ws.resumed == 1:
        # what follows from modes and is long is not kept in a state
        ws.resumed = 0
        group_closed(ws)
        choose_integrated(ws)
    if ws.end_of_valid != ws.t_end:
        # what had no value behind another end time may have one now
        ws.end_of_valid, ws.h_valid = ws.t_end, 1e300
    for _index in range(most_steps):
        # late in a run doubles are farther apart than the tolerance
        ws.time_tolerance = max(ws.time_resolution, _SPACINGS * abs(ws.t))
        if wary == 1 and longest_wanted(ws) > ws.t_end - ws.t:
            return PAUSED
        if ws.t_end - ws.t <= ws.time_tolerance:
            return _arrived(ws)
        row = EVENT_HEAD + ws.n_u + ws.n_y + BOOKED + LISTED * ws.n_contacts
        floats_left, integers_left = ws.event_floats - ws.floats_used, ws.event_integers - ws.integers_used
        if floats_left < MOST_EVENTS * row or integers_left < MOST_EVENTS * (CODE_HEAD + 2 * ws.n_contacts):
            return PAUSED
        if 2 * ws.n_samples > ws.sample_capacity:
            return PAUSED
        ws.limit = NO_STEP
        status = _step(ws)
        ws.limits[ws.limit] += 1
        if status == RUNNING:
            status = int(ws.failed)
        if ws.crowded == 1:
            status = NO_SLOT
        if status != RUNNING:
            return status
    return PAUSED
