"""Where a run was between the states that it stored: the flow in given modes, and what acts at an instant of it.

Nothing here looks for events: there are none between a stored state and the time asked for.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_driven_bodies
from nonsmooth.engine.bodies.joint_forces import evaluate_joint_forces
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.contact.trial import slope_of_slip
from nonsmooth.engine.delassus.delassus import assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.averaged import reach_end, renew_mean_forces
from nonsmooth.engine.flow.flight import choose_integrated, take_off
from nonsmooth.engine.flow.flow import hold_guard, right_hand_side, slip_guard, slope
from nonsmooth.engine.flow.guard_numbers import friction_guard
from nonsmooth.engine.flow.leap import leap
from nonsmooth.engine.flow.projection import normalise_quaternions, project_closed, project_joints
from nonsmooth.engine.flow.step import relaxation, try_length
from nonsmooth.engine.memory.modes import NOT_FINITE, RUNNING, SLIDE, STEP_TOO_SMALL
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
from nonsmooth.engine.numerics.runge_kutta import SAFETY, SHRINK, step_factor
from nonsmooth.engine.numerics.vectors import length

_EXCESS = 1e-8
"""Forces past their bounds by this part of the largest are so by more than round-off."""


@kernel("void(S, F, I, i8)")
def orient_slips(S: Scalars, w: Floats, k: Integers, at_end: int) -> None:
    """Take the directions of slips at hand, or of those at the end of the last step (1), for the step that begins."""
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode == SLIDE:
            slip = contact.slip_end if at_end == 1 else contact.slip
            speed = length(slip)
            if speed > S.velocity_tolerance:
                contact.direction = slip[0] / speed, slip[1] / speed


@kernel("i8(S, F, I)")
def _turned_round(S: Scalars, w: Floats, k: Integers) -> int:
    """Orient the slips by the rates at hand; return 1 if one goes against the direction that friction took it to go.

    A slip may turn round without an event, as where a belt pulls on.
    """
    against = 0
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        if contact.mode == SLIDE and slip_guard(S, w, k, c) < -S.velocity_tolerance:
            against = 1
    orient_slips(S, w, k, 0)
    return against


@kernel("f8(S, F, I)")
def _up_to_turn(S: Scalars, w: Floats, k: Integers) -> float:
    """Return the part of the step that was tried up to where a slip turns round, 1 if none does.

    A slip from rest that has gone the other way has had the wrong direction; it is turned, and 0 returned.
    """
    part = 1.0
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        last = slip_guard(S, w, k, c)
        if contact.mode != SLIDE or last >= -S.velocity_tolerance:
            continue
        first = guard_at(S, w, k, friction_guard(S, c)).first
        if first > S.velocity_tolerance:
            part = min(part, max(SHRINK, first / (first - last)))
            continue
        part = 0.0
        guard_at(S, w, k, friction_guard(S, c)).first = -first
        contact.direction = -contact.direction[0], -contact.direction[1]
    return part


@kernel("f8(S, F, I, f8)")
def _found_step(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Try steps of ``h`` and less until one meets the tolerance and no slip turns within it; return it, or -1."""
    while True:
        error = try_length(S, w, k, h)
        if S.stopped == 1:
            return -1.0
        part = 1.0
        if error <= 1.0:
            part = _up_to_turn(S, w, k)
            if part == 1.0 or h <= S.time_tolerance:
                return h
        elif not h > S.time_tolerance:
            return -1.0
        if part == 0.0:
            slope(S, w, k, S.t, S.y, S.slopes, 0, 1)
            part = 0.5
        elif part == 1.0:
            part = step_factor(error) if error < 1e300 else SHRINK
        h *= min(part, SAFETY)


@kernel("void(S, F, I)")
def _measure_mobilities(S: Scalars, w: Floats, k: Integers) -> None:
    """Write how fast each closed contact slips under a unit of friction, as an event does."""
    evaluate_bodies(S, w, k, S.t, S.y)
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        for a in range(S.n_active):
            evaluate_contact(S, w, k, active_at(S, w, k, a).slot, 1)
        assemble_delassus(S, w, k)
        for a in range(S.n_active):
            contact_at(S, w, k, active_at(S, w, k, a).slot).mobility = slope_of_slip(S, w, k, a)


@entry_point("i8(S, F, I, f8)")
def follow(S: Scalars, w: Floats, k: Integers, t: float) -> int:
    """Go on to time ``t`` in the present modes, by steps of the run's tolerance; return the status."""
    group_closed(S, w, k)
    choose_integrated(S, w, k)
    _measure_mobilities(S, w, k)
    wanted = S.h_max
    if S.mean_until <= S.t:
        renew_mean_forces(S, w, k, 0)
    while S.t < t:
        S.stage_time, S.follows, S.replaced = 0.0, 0, 0
        slope(S, w, k, S.t, S.y, S.slopes, 0, 1)
        if _turned_round(S, w, k) == 1:
            slope(S, w, k, S.t, S.y, S.slopes, 0, 1)
        take_off(S, w, k)
        for i in range(S.n_grouped):
            c = k[S.grouped + i]
            guard_at(S, w, k, friction_guard(S, c)).first = slip_guard(S, w, k, c)
            contact = contact_at(S, w, k, c)
            contact.rate_end = contact.velocity
        S.relaxation = relaxation(S, w, k)
        left = t - S.t
        h = _found_step(S, w, k, min(wanted, left, S.mean_until - S.t))
        if h < 0.0 and S.stopped == 0 and leap(S, w, k, S.time_tolerance) == 1:
            h = S.time_tolerance
        if h < 0.0:
            return NOT_FINITE if S.stopped == 1 else STEP_TOO_SMALL
        S.h = h
        S.t = t if h == left else S.t + h
        for i in range(S.n_y):
            w[S.y + i] = w[S.y_new + i]
        normalise_quaternions(S, w, k)
        if S.n_joints > 0:
            project_joints(S, w, k)
        if S.mean_until - S.t <= S.time_tolerance:
            reach_end(S, w, k)
            renew_mean_forces(S, w, k, 1)
        else:
            S.closing_loss += project_closed(S, w, k, 0, 0)
        if S.failed != RUNNING:
            return int(S.failed)
        wanted = min(S.h_max, 2.0 * h)
    return RUNNING


@kernel("i8(S, F, I)")
def _past_bounds(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if forces that are not unique pull, or pass the bound of their friction."""
    least = largest = 0.0
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        if contact.redundant == 1:
            largest = max(largest, abs(contact.force[0]))
            least = min(least, hold_guard(S, w, k, c))
            if contact.holds == 1:
                least = min(least, contact.static_margin)
    return 1 if least < -_EXCESS * largest else 0


@entry_point("void(S, F, I, i8)")
def evaluate_forces(S: Scalars, w: Floats, k: Integers, choosing: int) -> None:
    """Evaluate bodies, closed contacts and joints with their forces at the present state.

    Of forces that are not unique the null-space force is chosen anew with ``choosing`` (1), as at an event, or if
    with that at hand a bound is passed.
    """
    group_closed(S, w, k)
    S.stage_time = 0.0
    if choosing == 1 or S.mean_until <= S.t:
        renew_mean_forces(S, w, k, 0)
    evaluate_driven_bodies(S, w, k, S.t, S.y)
    right_hand_side(S, w, k, S.t, S.y, choosing, 1)
    turned = _turned_round(S, w, k)
    anew = max(choosing, _past_bounds(S, w, k))
    if turned + anew > choosing:
        right_hand_side(S, w, k, S.t, S.y, anew, 1)
    if S.n_joints > 0:
        evaluate_joint_forces(S, w, k)
