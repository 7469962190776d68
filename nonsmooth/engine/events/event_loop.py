"""The mode automaton, the only place that knows the order: flow, guard, jump, new mode."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import turn_facing
from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.courses import is_on_course
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
    has_changed,
    is_of_choice,
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
    Floats,
    Integers,
    Scalars,
    contact_at,
    entry_point,
    guard_at,
    kernel,
    own_guard_at,
)
from nonsmooth.engine.numerics.vectors import length

_SPACINGS = 4.0 * 2.0**-52
"""Times closer than this part of the time are not told apart."""


@kernel("i8(S, F, I, f8)")
def _commit(S: Scalars, w: Floats, k: Integers, h: float) -> int:
    """Take over the step of ``h`` with its samples; return how many courses end."""
    record_samples(S, w, k, h)
    return _take_over(S, w, k, h)


@kernel("i8(S, F, I, f8)")
def _take_over(S: Scalars, w: Floats, k: Integers, h: float) -> int:
    """Take over the step of ``h``: state, time, constraints; return how many courses end."""
    for i in range(S.n_y):
        w[S.y + i] = w[S.y_new + i]
    S.t += h
    normalise_quaternions(S, w, k)
    if S.n_joints > 0:
        project_joints(S, w, k)
    ended = end_courses(S, w, k)
    if ended > 0:
        group_closed(S, w, k)
    if drifted(S, w, k) == 1:
        S.closing_loss += project_closed(S, w, k, 0, 0)
    return ended


@kernel("i8(S, i8)")
def _up_to_end(S: Scalars, status: int) -> int:
    """Let a step that failed be tried once more, up to the end of the run: what lies behind need not have a value."""
    if S.h_valid <= S.t_end - S.t:
        return status
    S.h_valid, S.fresh = S.t_end - S.t, 0
    return RUNNING


@kernel("i8(S, F, I)")
def _arrived(S: Scalars, w: Floats, k: Integers) -> int:
    """Look at the state at the end time; return the status."""
    S.t = S.t_end
    check_end(S, w, k)
    return DONE if S.failed == RUNNING else int(S.failed)


@kernel("i8(S, F, I)")
def _end_within(S: Scalars, w: Floats, k: Integers) -> int:
    """End the run within the step that leads past its end time, before any event of it; return the status.

    The step was taken, and its event looked for, as if the run went on: where it ends then changes nothing of what
    it does before.
    """
    h = S.t_end - S.t
    record_samples(S, w, k, h)
    S.h = h
    if not try_step(S, w, k, h) < 1e300:
        return NOT_FINITE
    _take_over(S, w, k, h)
    return _arrived(S, w, k)


@kernel("i8(S, F, I, i8, i8)")
def _carry_out(S: Scalars, w: Floats, k: Integers, cause: int, which: int) -> int:
    """Carry out an event of contact ``which``: update modes and velocities at its instant; return the status."""
    S.fresh = 0
    if stalls(S, w, k, which) == 1:
        if average_island_of(S, w, k, which) == 0:
            return STALLED
        contact_at(S, w, k, which).crowd_events = 0
    return update_at_event(S, w, k, cause, which)


@kernel("i8(S, F, I)")
def _step(S: Scalars, w: Floats, k: Integers) -> int:
    """Advance by one step or to the next event, whichever is earlier; return the status."""
    if S.mean_until - S.t <= S.time_tolerance:
        S.fresh = 0
        return update_at_event(S, w, k, AVERAGING, -1)
    _evaluate_start(S, w, k)
    check_gaps(S, w, k)
    if S.failed != RUNNING:
        return int(S.failed)
    if S.mean_until < 1e300 and S.strayed > 1.0:
        end_averaging(S, w, k)
        S.fresh = 0
        return update_at_event(S, w, k, AVERAGING, S.stray)
    keep_start(S, w, k)
    which = _due_at_start(S, w, k)
    if which >= 0:
        return _carry_out(S, w, k, cause_at_start(S, w, k, which), which)
    S.h_listed = longest_step(S, w, k) if S.n_units > 0 else 1e300
    if S.h_listed == 0.0:
        return int(list_contacts(S, w, k))
    orient_slips(S, w, k, 1)
    arm_guards(S, w, k)
    which = holds_time_up(S, w, k) if S.n_grouped > 0 else -1
    if which >= 0 and average_island_of(S, w, k, which) == 1:
        S.fresh = 0
        return update_at_event(S, w, k, AVERAGING, which)
    status = accepted_step(S, w, k)
    if status != RUNNING:
        return _without_step(S, w, k, status)
    S.steps += 1
    high = first_crossing(S, w, k, S.h)
    for i in range(first_own_guard(S), first_end_guard(S)):
        if not abs(guard_at(S, w, k, i).end) < 1e300:
            return _up_to_end(S, NOT_FINITE)
    if high > 0.0:
        return _step_to_event(S, w, k, high)
    return _whole_step(S, w, k)


@kernel("void(S, F, I)")
def _evaluate_start(S: Scalars, w: Floats, k: Integers) -> None:
    """Write slope and guards where the step begins; behind a step without an event they are at hand."""
    S.follows = S.fresh
    S.replaced = 0
    if S.fresh == 1:
        S.power_first = S.power_end
        watch_features(S, w, k)
        for i in range(S.n_y):
            w[S.slopes + i] = w[S.slopes + LAST_STAGE * S.n_y + i]
        return
    set_off(S, w, k, S.h_closed, S.h_valid)
    group_closed(S, w, k)
    choose_integrated(S, w, k)
    slope(S, w, k, S.t, S.y, S.slopes, 1, 1)
    take_off(S, w, k)
    close_account(S, w, k)
    watch_features(S, w, k)
    write_guards(S, w, k, S.t, S.y, 1)
    keep_end(S, w, k)
    bound_speeds(S, w, k)


@kernel("i8(S, F, I)")
def _due_at_start(S: Scalars, w: Floats, k: Integers) -> int:
    """Return a contact of which an event is due before any step, or -1."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        # a gap that closes exactly where the last step ended is an event of that step
        gap = guard_at(S, w, k, normal_guard(c)).end
        arrived = gap <= S.gap_tolerance and contact.gap_rate_end < -S.velocity_tolerance
        if contact.mode == OPEN and arrived:
            return c
        # what put the contacts on their constraints may have put one past its end
        if contact.mode != OPEN and guard_at(S, w, k, first_end_guard(S) + c).end < 0.0:
            return c
        if is_on_course(S, w, k, c) == 1:
            continue
        # and may have turned a slip so that its force is another one
        unique = contact.mode != OPEN and contact.normal_function == 0 and contact.redundant == 0
        if S.fresh == 0 and unique and is_violated(S, w, k, c) == 1:
            return c
    return -1


@kernel("i8(S, F, I, i8)")
def _without_step(S: Scalars, w: Floats, k: Integers, status: int) -> int:
    """Say what follows where no step was accepted, for the reason ``status``; return the status."""
    S.limit = NO_STEP
    if status == STEP_TOO_SMALL and leap(S, w, k, S.time_tolerance) == 1:
        return _after_leap(S, w, k)
    if status == STEP_TOO_SMALL:
        which = end_features(S, w, k)
        if which >= 0:
            changed = has_changed(S, w, k, which)
            _take_over(S, w, k, S.h)
            return _pass_on(S, w, k, which, changed)
        which = hardest_pressed(S, w, k, 1)
        if which >= 0:
            outcome = _carry_out(S, w, k, JAM, which)
            if outcome != NO_CONTACT_SOLUTION:
                return int(outcome)
        which = hardest_pressed(S, w, k, 0)
        if which >= 0 and average_island_of(S, w, k, which) == 1:
            S.fresh = 0
            return update_at_event(S, w, k, AVERAGING, which)
    return _up_to_end(S, status)


@kernel("i8(S, F, I)")
def _after_leap(S: Scalars, w: Floats, k: Integers) -> int:
    """Take over the instant in which contact points ran along bodies, and what it let go; return the status."""
    S.h, S.fresh = S.time_tolerance, 0
    _take_over(S, w, k, S.h)
    cause, which = 0, -1
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode != OPEN and contact.released != 0 and which < 0:
            cause, which = contact.released, c
        contact.released = 0
    if which >= 0:
        return _carry_out(S, w, k, cause, which)
    measure_noise(S, w, k)
    return RUNNING


@kernel("i8(S, F, I)")
def _whole_step(S: Scalars, w: Floats, k: Integers) -> int:
    """Take over a step without an event, unless a slip has come to rest in it; return the status."""
    if S.h > S.t_end - S.t:
        S.limit = BY_END
        return _end_within(S, w, k)
    which = passed_flat(S, w, k)
    if which >= 0 and S.h > S.time_tolerance:
        return _in_part(S, w, k)
    ended = _commit(S, w, k, S.h)
    if S.blended == 1:
        S.chosen_t = S.t
    if which >= 0:
        return _carry_out(S, w, k, IMPACT, which)
    which = stopping(S, w, k)
    if which >= 0:
        return _carry_out(S, w, k, SLIP_TO_STICK, which)
    S.fresh = 1 if ended == 0 else 0
    if S.limit == BY_EVENT and S.fresh == 1 and S.failed == RUNNING and S.t_end - S.t > S.time_tolerance:
        # it was made to end where a gap is about to close
        which = _due_at_start(S, w, k)
        if which >= 0:
            return _carry_out(S, w, k, cause_at_start(S, w, k, which), which)
    return RUNNING


@kernel("i8(S, F, I, f8)")
def _step_to_event(S: Scalars, w: Floats, k: Integers, high: float) -> int:
    """Locate the first event before the fraction ``high`` of the step and carry it out; return the status."""
    S.fresh, S.limit = 0, BY_EVENT
    if choices_bend(S, w, k, high) == 1:
        return _in_part(S, w, k)
    h = locate(S, w, k, S.h, high)
    if h < 0.0:
        return _in_part(S, w, k)
    if h > S.t_end - S.t:
        S.limit = BY_END
        return _end_within(S, w, k)
    return _event(S, w, k, h, S.trigger)


@kernel("i8(S, F, I)")
def _in_part(S: Scalars, w: Floats, k: Integers) -> int:
    """Ask for a quarter of the step, which leads past what it should end at; return the status."""
    S.fresh, S.limit = 0, BY_CROWD
    # crowded guards, an error that grows, or a flat place
    if S.h < NOUGHT * S.time_tolerance:
        return _without_step(S, w, k, STEP_TOO_SMALL)
    if S.n_integrated == 0 and S.course_end < math.inf:
        S.course_end = S.t + 0.25 * S.h
    elif is_held(S, w, k) == 1:
        S.h_closed = 0.25 * S.h
    else:
        S.h_free = 0.25 * S.h
    return RUNNING


@kernel("i8(S, F, I, f8, i8)")
def _event(S: Scalars, w: Floats, k: Integers, h: float, guard: int) -> int:
    """Take over the step of ``h`` at whose end a guard fires, and carry out its event; return the status."""
    if guard >= first_end_guard(S):
        which = guard - first_end_guard(S)
        changed = has_changed(S, w, k, which)
        _commit(S, w, k, h)
        return _pass_on(S, w, k, which, changed)
    if guard >= first_own_guard(S):
        _commit(S, w, k, h)
        return _own_event(S, w, k, guard - first_own_guard(S))
    cause, which = cause_of(S, w, k, guard), contact_of(S, guard)
    if cause == STICK_TO_SLIP:
        _break_direction(S, w, k, which)
    _commit(S, w, k, h)
    if is_of_choice(S, w, k, guard) == 1 and choose_anew(S, w, k) == 1:
        return RUNNING
    return _carry_out(S, w, k, cause, which)


@kernel("i8(S, F, I, i8, i8)")
def _pass_on(S: Scalars, w: Floats, k: Integers, which: int, changed: int) -> int:
    """Carry out that the features of contact ``which`` have ended, or changed (1); return the status."""
    if changed == 1:
        S.feature_t = S.t
    return _carry_out(S, w, k, FEATURE_CHANGE if changed == 1 else FEATURE_END, which)


@kernel("i8(S, F, I, i8)")
def _own_event(S: Scalars, w: Floats, k: Integers, number: int) -> int:
    """Record the event of a guard of the scenario's own; return the status."""
    remember(S, w, k)
    record_event(S, w, k, GUARD, number, 0)
    guard = own_guard_at(S, w, k, number)
    guard.spent = 1
    return STOPPED if guard.ends == 1 else RUNNING


@kernel("void(S, F, I, i8)")
def _break_direction(S: Scalars, w: Floats, k: Integers, which: int) -> None:
    """Let a contact that breaks away slip against the friction that held it, that of least norm if it is not unique."""
    contact = contact_at(S, w, k, which)
    t1 = contact.force[1] - contact.null_space_force[1] * contact.redundant
    t2 = contact.force[2] - contact.null_space_force[2] * contact.redundant
    norm, speed = length((t1, t2)), length(contact.slip)
    if norm > 0.0:
        turn_facing(S, w, k, which, t1)
        contact.direction = -t1 / norm, -t2 / norm
    elif speed > 0.0:
        # nothing held it: it slips as it does
        contact.direction = contact.slip[0] / speed, contact.slip[1] / speed


@entry_point("i8(S, F, I, i8, i8)")
def advance(S: Scalars, w: Floats, k: Integers, most_steps: int, wary: int) -> int:
    """Run until the end time, a failure, full buffers or ``most_steps``; return the status.

    A wary run (1) pauses before a step that may lead past the end time.
    """
    if S.started == 0:
        S.started = 1
        S.time_tolerance = max(S.time_resolution, _SPACINGS * abs(S.t))
        evaluate_bodies(S, w, k, S.t, S.y)
        status = update_at_event(S, w, k, START, -1)
        if S.crowded == 1:
            return NO_SLOT
        if status != RUNNING:
            return status
    if S.resumed == 1:
        # what follows from modes and is long is not kept in a state
        S.resumed = 0
        group_closed(S, w, k)
        choose_integrated(S, w, k)
    if S.end_of_valid != S.t_end:
        # what had no value behind another end time may have one now
        S.end_of_valid, S.h_valid = S.t_end, 1e300
    for _index in range(most_steps):
        # late in a run doubles are farther apart than the tolerance
        S.time_tolerance = max(S.time_resolution, _SPACINGS * abs(S.t))
        if wary == 1 and longest_wanted(S, w, k) > S.t_end - S.t:
            return PAUSED
        if S.t_end - S.t <= S.time_tolerance:
            return _arrived(S, w, k)
        row = EVENT_HEAD + S.n_u + S.n_y + BOOKED + LISTED * S.n_contacts
        floats_left, integers_left = S.event_floats - S.floats_used, S.event_integers - S.integers_used
        if floats_left < MOST_EVENTS * row or integers_left < MOST_EVENTS * (CODE_HEAD + 2 * S.n_contacts):
            return PAUSED
        if 2 * S.n_samples > S.sample_capacity:
            return PAUSED
        S.limit = NO_STEP
        status = _step(S, w, k)
        k[S.limits + S.limit] += 1
        if status == RUNNING:
            status = int(S.failed)
        if S.crowded == 1:
            status = NO_SLOT
        if status != RUNNING:
            return status
    return PAUSED
