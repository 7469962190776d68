"""The mode automaton, the only place that knows the order: flow, guard, jump, new mode."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import turn_facing
from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_driven_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.bodies.listing import list_contacts, longest_step, overran_list
from nonsmooth.engine.delassus.delassus import assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.events.record import (
    CODE_HEAD,
    EVENT_HEAD,
    LISTED,
    MOST_EVENTS,
    record_event,
    record_samples,
    remember,
)
from nonsmooth.engine.events.settle import settle
from nonsmooth.engine.flow.clearance import bound_speeds, foresee
from nonsmooth.engine.flow.flow import right_hand_side, slope, try_step
from nonsmooth.engine.flow.follow import orient_slips
from nonsmooth.engine.flow.guards import arm_guards, keep_end, watch_features, write_guards
from nonsmooth.engine.flow.location import first_crossing, locate
from nonsmooth.engine.flow.projection import (
    normalise_quaternions,
    project_closed,
    project_joints,
)
from nonsmooth.engine.flow.self_check import check_end, check_gaps, close_account
from nonsmooth.engine.impact.instant import is_jammed
from nonsmooth.engine.memory.layout import BOOKED, FALL, GEOMETRY, PAST_END
from nonsmooth.engine.memory.modes import (
    DONE,
    EVENTS_ENDLESS,
    FEATURE_CHANGE,
    FEATURE_END,
    GUARD,
    IMPACT,
    JAM,
    LIFT_OFF,
    NO_SLOT,
    NOT_FINITE,
    OPEN,
    PAUSED,
    RUNNING,
    SLIDE,
    SLIP_TO_STICK,
    START,
    STEP_TOO_SMALL,
    STICK,
    STICK_TO_SLIP,
    STOPPED,
    TOUCH,
)
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room
from nonsmooth.engine.numerics.runge_kutta import step_factor

_BEGINS = 10.0
"""A compliant contact begins so many gap tolerances from its reach at most."""
_FIRST_WAY = 1e-3
"""Way that surfaces go in the first step of one, in units of the smaller body."""
_EVENTS_AT_ONCE = 100
"""Besides one for every contact."""
_DRIFT = 0.3
_SPACINGS = 4.0 * 2.0**-52
"""Times closer than this part of the time are not told apart."""
_NO_STEP = 1e-3
"""A step below this part of the time tolerance in which guards crowd or the error grows leads nowhere."""


@kernel("f8(S, F, I, i8)")
def _first_of_compliant(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return how long the first step of a closed contact may be: a compliant one that begins has no force as yet.

    Were it over before the second stage of the step, none would meet a force, and the bodies would pass each other.
    """
    if k[S.normal_function + c] == 0 or w[S.guard_end + 2 * c] > _BEGINS * S.gap_tolerance:
        return 1e300
    rate = S.rate_end + 3 * c
    speed = math.sqrt(w[rate] * w[rate] + w[rate + 1] * w[rate + 1] + w[rate + 2] * w[rate + 2])
    return float(_FIRST_WAY * w[S.size + c] / max(speed, S.velocity_tolerance))


@kernel("f8(S, I)")
def _wanted_step(S: Scalars, k: Integers) -> float:
    """Return how long the next step is if nothing cuts it short; it is never longer."""
    for c in range(S.n_contacts):
        if k[S.mode + c] != OPEN:
            return float(min(S.h_closed, S.h_max))
    return float(min(S.h_free, S.h_max))


@kernel("i8(S, F, I)")
def _accepted_step(S: Scalars, w: Floats, k: Integers) -> int:
    """Find a step that meets the tolerance, in ``h``; return the status."""
    closed = 0
    for c in range(S.n_contacts):
        if k[S.mode + c] != OPEN:
            closed = 1
            if S.fresh == 0:
                S.h_first = min(S.h_first, _first_of_compliant(S, w, k, c))
    wanted = _wanted_step(S, k)
    h = min(wanted, S.h_listed, S.h_sampled, S.h_valid)
    if S.fresh == 0:
        h = min(h, S.h_first)
        foresee(S, w, k, h)
    for _attempt in range(200):
        if S.stopped == 1:
            return NOT_FINITE
        error = try_step(S, w, k, h)
        if error <= 1.0 and S.singular >= 0:
            # beyond the Painleve singularity a sliding contact is balanced on an edge: not a step further
            h *= 0.5
            wanted = 0.0
            if h < S.time_tolerance:
                return STEP_TOO_SMALL
            continue
        if error <= 1.0 and S.n_units > 0:
            evaluate_driven_bodies(S, w, k, S.t + h, S.y_new)
            if overran_list(S, w, k, h) == 1:
                h *= 0.5
                if h < S.time_tolerance:
                    return STEP_TOO_SMALL
                continue
        if error <= 1.0:
            S.h = h
            S.step_error = error
            # the touch-down that was due is behind it, or is an event of it
            S.h_first = 1e300
            # what cut a step short says nothing of the next one
            following = h * step_factor(error)
            if h < wanted:
                following = max(following, wanted)
            if closed == 1:
                S.h_closed = following
            else:
                S.h_free = following
            return RUNNING
        S.rejected += 1
        wanted = 0.0
        if not error < 1e300:
            if h < S.time_tolerance:
                return NOT_FINITE
            h *= 0.1
        else:
            h *= step_factor(error)
        if h < S.time_tolerance:
            return STEP_TOO_SMALL
    return STEP_TOO_SMALL


@kernel("i8(S, F, I)")
def _drifted(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if some closed contact has left its constraints by more than a part of the tolerances."""
    for c in range(S.n_contacts):
        if k[S.mode + c] != OPEN:
            rate, gap = abs(w[S.rate_end + 3 * c]), abs(w[S.gap_end + c])
            if k[S.normal_function + c] != 0:
                rate = gap = 0.0
            if k[S.mode + c] == STICK:
                rate += abs(w[S.rate_end + 3 * c + 1]) + abs(w[S.rate_end + 3 * c + 2])
            if rate > _DRIFT * S.velocity_tolerance or gap > _DRIFT * S.gap_tolerance:
                return 1
    return 0


@kernel("void(S, F, I, f8)")
def _commit(S: Scalars, w: Floats, k: Integers, h: float) -> None:
    """Take over the step of ``h`` with its samples."""
    record_samples(S, w, k, h)
    _take_over(S, w, k, h)


@kernel("void(S, F, I, f8)")
def _take_over(S: Scalars, w: Floats, k: Integers, h: float) -> None:
    """Take over the step of ``h``: state, time, constraints."""
    for i in range(S.n_y):
        w[S.y + i] = w[S.y_new + i]
    S.t += h
    normalise_quaternions(S, w, k)
    if S.n_joints > 0:
        project_joints(S, w, k)
    if _drifted(S, w, k) == 1:
        S.closing_loss += project_closed(S, w, k, 0)


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


@kernel("i8(S, I, i8)")
def _closing_cause(S: Scalars, k: Integers, c: int) -> int:
    """Return what it is when contact ``c`` closes."""
    return IMPACT if k[S.normal_function + c] == 0 else TOUCH


@kernel("i8(S, F, I)")
def _cause(S: Scalars, w: Floats, k: Integers) -> int:
    """Return what the guard that fired means."""
    c = S.trigger // 2
    if S.trigger % 2 == 0:
        return _closing_cause(S, k, c) if k[S.mode + c] == OPEN else LIFT_OFF
    if k[S.mode + c] != STICK:
        return SLIP_TO_STICK
    # the static bound vanishes with the normal force
    return LIFT_OFF if w[S.guard + 2 * c] <= 1e-9 * w[S.guard_first + 2 * c] else STICK_TO_SLIP


@kernel("i8(S, F, I, i8, i8)")
def _settle_event(S: Scalars, w: Floats, k: Integers, cause: int, contact: int) -> int:
    """Settle the instant of an event; return the status."""
    if S.t - S.last_event_t > S.time_tolerance:
        S.repeated = 0
    S.repeated += 1
    S.last_event_t = S.t
    if S.repeated > _EVENTS_AT_ONCE + S.n_contacts:
        return EVENTS_ENDLESS
    return settle(S, w, k, cause, contact)


@kernel("i8(S, F, I)")
def _stopping(S: Scalars, w: Floats, k: Integers) -> int:
    """Return a contact whose slip has come next to rest in the step that ended and slows down, or -1.

    So close to rest the direction of the slip is stiff, and what is left of it below the tolerance.
    """
    for c in range(S.n_contacts):
        if k[S.mode + c] == SLIDE and k[S.traction_function + c] == 0:
            v1, v2 = w[S.rate_end + 3 * c + 1], w[S.rate_end + 3 * c + 2]
            speed = math.sqrt(v1 * v1 + v2 * v2)
            if speed <= S.velocity_tolerance and speed < w[S.guard_first + 2 * c + 1]:
                return c
    return -1


@kernel("i8(S, F, I)")
def _singular(S: Scalars, w: Floats, k: Integers) -> int:
    """Return a contact that slides at the Painleve singularity, or -1."""
    evaluate_bodies(S, w, k, S.t, S.y)
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        for a in range(S.n_active):
            evaluate_contact(S, w, k, k[S.active + a], 1)
        assemble_delassus(S, w, k)
        for a in range(S.n_active):
            if is_jammed(S, w, k, a) == 1:
                return k[S.active + a]
    return -1


@kernel("i8(S, F, I)")
def _step(S: Scalars, w: Floats, k: Integers) -> int:
    """Advance by one step or to the next event, whichever is earlier; return the status."""
    if S.fresh == 0:
        group_closed(S, w, k)
        S.choosing = 1
        slope(S, w, k, S.t, S.y, S.slopes)
        S.choosing = 0
        close_account(S, w, k)
        watch_features(S, w, k)
        write_guards(S, w, k, S.t, S.y, 1)
        keep_end(S, w, k)
        bound_speeds(S, w, k)
    else:
        watch_features(S, w, k)
        for i in range(S.n_y):
            w[S.slopes + i] = w[S.slopes + 6 * S.n_y + i]
    S.h_listed = 1e300
    if S.n_units > 0:
        S.h_listed = longest_step(S, w, k)
        if S.h_listed == 0.0:
            return int(list_contacts(S, w, k))
    check_gaps(S, w, k)
    if S.failed != RUNNING:
        return int(S.failed)
    for c in range(S.n_contacts):
        w[S.gap_rate_first + c] = w[S.gap_rate_end + c]
        w[S.past_first + c], w[S.speed_first + c] = w[S.past_end + c], w[S.speed_end + c]
        for r in range(FALL):
            w[S.fall_first + FALL * c + r] = w[S.fall_end + FALL * c + r] if S.fresh == 1 else -1.0
        for r in range(3):
            w[S.arm_first + 3 * c + r] = w[S.arm_end + 3 * c + r]
    # a gap that closes exactly where the last step ended is an event of that step
    for c in range(S.n_contacts):
        arrived = w[S.guard_end + 2 * c] <= S.gap_tolerance and w[S.gap_rate_end + c] < -S.velocity_tolerance
        if k[S.mode + c] == OPEN and arrived:
            S.fresh = 0
            return _settle_event(S, w, k, _closing_cause(S, k, c), c)
        # what put the contacts on their constraints may have put one past its end
        if k[S.mode + c] != OPEN and w[S.guard_end + 2 * S.n_contacts + S.n_own_guards + c] < 0.0:
            S.fresh = 0
            return _settle_event(S, w, k, FEATURE_END, c)
    orient_slips(S, w, k, S.rate_end)
    arm_guards(S, w, k)
    status = _accepted_step(S, w, k)
    if status == STEP_TOO_SMALL:
        contact = _singular(S, w, k)
        if contact >= 0:
            S.fresh = 0
            return _settle_event(S, w, k, JAM, contact)
    if status != RUNNING:
        return _up_to_end(S, status)
    S.steps += 1
    h = S.h
    high = first_crossing(S, w, k, h)
    for i in range(2 * S.n_contacts, 2 * S.n_contacts + S.n_own_guards):
        if not abs(w[S.guard_end + i]) < 1e300:
            return _up_to_end(S, NOT_FINITE)
    if high == 0.0:
        if h > S.t_end - S.t:
            return _end_within(S, w, k)
        _commit(S, w, k, h)
        contact = _stopping(S, w, k)
        if contact < 0:
            S.fresh = 1
            return RUNNING
        S.fresh = 0
        return _settle_event(S, w, k, SLIP_TO_STICK, contact)
    S.fresh = 0
    h = locate(S, w, k, h, high)
    if h < 0.0:
        if S.h < _NO_STEP * S.time_tolerance:
            return STEP_TOO_SMALL
        if S.n_grouped > 0:
            S.h_closed = 0.25 * S.h
        else:
            S.h_free = 0.25 * S.h
        return RUNNING
    if h > S.t_end - S.t:
        return _end_within(S, w, k)
    ends = 2 * S.n_contacts + S.n_own_guards
    if S.trigger >= ends:
        contact = S.trigger - ends
        changed = w[S.geometry + GEOMETRY * contact + PAST_END] <= S.gap_tolerance
        _commit(S, w, k, h)
        if changed:
            S.feature_t = S.t
        return _settle_event(S, w, k, FEATURE_CHANGE if changed else FEATURE_END, contact)
    if S.trigger >= 2 * S.n_contacts:
        _commit(S, w, k, h)
        return _own_event(S, w, k, S.trigger - 2 * S.n_contacts)
    cause = _cause(S, w, k)
    contact = S.trigger // 2
    if cause == STICK_TO_SLIP:
        _break_direction(S, w, k, contact)
    _commit(S, w, k, h)
    if k[S.tied + contact] == 1 and _shares_hold(S, w, k, contact) == 1:
        return RUNNING
    return _settle_event(S, w, k, cause, contact)


@kernel("i8(S, F, I, i8)")
def _shares_hold(S: Scalars, w: Floats, k: Integers, contact: int) -> int:
    """Choose the forces that are not unique anew; return 1 if all closed contacts can keep their bounds.

    The guard that fired must be that of a force.  A second time within the time tolerance there is no choice: then all
    forces vanish.
    """
    if k[S.mode + contact] == OPEN or (S.trigger % 2 == 1 and k[S.holds + contact] == 0):
        return 0
    if S.t - S.chosen_t <= S.time_tolerance:
        return 0
    S.chosen_t = S.t
    group_closed(S, w, k)
    S.shares_hold, S.choosing = 1, 1
    right_hand_side(S, w, k, S.t, S.y)
    S.choosing = 0
    return 1 if S.shares_hold == 1 else 0


@kernel("i8(S, F, I, i8)")
def _own_event(S: Scalars, w: Floats, k: Integers, number: int) -> int:
    """Record the event of a guard of the scenario's own; return the status."""
    remember(S, w, k)
    record_event(S, w, k, GUARD, number, 0)
    k[S.own_guard_spent + number] = 1
    return STOPPED if k[S.own_guard_ends + number] == 1 else RUNNING


@kernel("void(S, F, I, i8)")
def _break_direction(S: Scalars, w: Floats, k: Integers, contact: int) -> None:
    """Let a contact that breaks away slip against the friction that held it, that of least norm if it is not unique."""
    t1 = w[S.force + 3 * contact + 1] - w[S.share + 3 * contact + 1] * k[S.tied + contact]
    t2 = w[S.force + 3 * contact + 2] - w[S.share + 3 * contact + 2] * k[S.tied + contact]
    norm = math.sqrt(t1 * t1 + t2 * t2)
    if norm > 0.0:
        turn_facing(S, w, k, contact, t1)
        w[S.direction + 2 * contact] = -t1 / norm
        w[S.direction + 2 * contact + 1] = -t2 / norm


@room("i8(S, F, I, i8, i8)")
def advance(S: Scalars, w: Floats, k: Integers, most_steps: int, wary: int) -> int:
    """Run until the end time, a failure, full buffers or ``most_steps``; return the status.

    A wary run (1) pauses before a step that may lead past the end time.
    """
    if S.started == 0:
        S.started = 1
        S.time_tolerance = max(S.time_resolution, _SPACINGS * abs(S.t))
        evaluate_bodies(S, w, k, S.t, S.y)
        status = settle(S, w, k, START, -1)
        if S.crowded == 1:
            return NO_SLOT
        if status != RUNNING:
            return status
    if S.resumed == 1:
        # what follows from modes and is long is not kept in a state
        S.resumed = 0
        group_closed(S, w, k)
    S.calls += 1
    for _index in range(most_steps):
        # late in a run doubles are farther apart than the tolerance
        S.time_tolerance = max(S.time_resolution, _SPACINGS * abs(S.t))
        if wary == 1 and _wanted_step(S, k) > S.t_end - S.t:
            return PAUSED
        if S.t_end - S.t <= S.time_tolerance:
            return _arrived(S, w, k)
        row = EVENT_HEAD + S.n_u + S.n_y + BOOKED + LISTED * S.n_contacts
        floats_left, integers_left = S.event_floats - S.floats_used, S.event_integers - S.integers_used
        if floats_left < MOST_EVENTS * row or integers_left < MOST_EVENTS * (CODE_HEAD + 2 * S.n_contacts):
            return PAUSED
        if 2 * S.n_samples > S.sample_capacity:
            return PAUSED
        status = _step(S, w, k)
        if status == RUNNING:
            status = int(S.failed)
        if S.crowded == 1:
            status = NO_SLOT
        if status != RUNNING:
            return status
    return PAUSED
