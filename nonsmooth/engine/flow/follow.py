"""Where a run was between the states that it stored: the flow in given modes, and what acts at an instant of it.

Nothing here looks for events: there are none between a stored state and the time asked for.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_driven_bodies
from nonsmooth.engine.bodies.joint_forces import evaluate_joint_forces
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.contact.trial import slope_of_slip
from nonsmooth.engine.delassus.delassus import assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.averaged import end_averaging_span, start_averaging_span
from nonsmooth.engine.flow.flight import choose_integrated, take_off
from nonsmooth.engine.flow.flow import value_of_normal_guard, right_hand_side, value_of_slip_guard, slope
from nonsmooth.engine.flow.guard_numbers import friction_guard
from nonsmooth.engine.flow.point_jump import jump_contact_points
from nonsmooth.engine.flow.projection import normalise_quaternions, project_closed, project_joints
from nonsmooth.engine.flow.step import relaxation_rate, try_length
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.runge_kutta import SAFETY, SHRINK, step_factor
from nonsmooth.engine.numerics.vectors import length

_ROUND_OFF = 1e-8
"""Forces past their bounds by this part of the largest are so by more than round-off."""


@kernel("void(ws, b1)")
def orient_slips(ws: Workspace, at_end: bool) -> None:
    """Take the directions of slips at hand, or of those at the end of the last step (1), for the step that begins."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.mode == Mode.SLIDE:
            slip = contact.slip_at_end if at_end else contact.slip
            speed = length(slip)
            if speed > ws.tolerance.velocity:
                contact.direction = slip[0] / speed, slip[1] / speed


@kernel("b1(ws)")
def _has_reversed_slip(ws: Workspace) -> bool:
    """Orient the slips by the rates at hand; return 1 if one goes against the direction that friction took it to go.

    A slip may turn round without an event, as where a belt pulls on.
    """
    against = False
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        if contact.mode == Mode.SLIDE and value_of_slip_guard(ws, c) < -ws.tolerance.velocity:
            against = True
    orient_slips(ws, at_end=False)
    return against


@kernel("f8(ws)")
def _part_before_reversal(ws: Workspace) -> float:
    """Return the part of the step that was tried up to where a slip turns round, 1 if none does.

    A slip from rest that has gone the other way has had the wrong direction; it is turned, and 0 returned.
    """
    part = 1.0
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        last = value_of_slip_guard(ws, c)
        if contact.mode != Mode.SLIDE or last >= -ws.tolerance.velocity:
            continue
        first = ws.guards[friction_guard(ws, c)].initial
        if first > ws.tolerance.velocity:
            part = min(part, max(SHRINK, first / (first - last)))
            continue
        part = 0.0
        ws.guards[friction_guard(ws, c)].initial = -first
        contact.direction = -contact.direction[0], -contact.direction[1]
    return part


@kernel("f8(ws, f8)")
def _find_step(ws: Workspace, h: float) -> float:
    """Try steps of ``h`` and less until one meets the tolerance and no slip turns within it; return it, or -1."""
    while True:
        error = try_length(ws, h)
        if ws.request.is_interrupted:
            return -1.0
        part = 1.0
        if error <= 1.0:
            part = _part_before_reversal(ws)
            if part == 1.0 or h <= ws.tolerance.time:
                return h
        elif not h > ws.tolerance.time:
            return -1.0
        if part == 0.0:
            slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=True)
            part = 0.5
        elif part == 1.0:
            part = step_factor(error) if error < math.inf else SHRINK
        h *= min(part, SAFETY)


@kernel()
def _evaluate_slip_per_force(ws: Workspace) -> None:
    """Write how fast each closed contact slips under a unit of friction, as an event does."""
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        for a in range(ws.problem.n_active):
            evaluate_contact(ws, ws.actives[a].contact, 1)
        assemble_delassus(ws)
        for a in range(ws.problem.n_active):
            ws.contacts[ws.actives[a].contact].slip_per_force = slope_of_slip(ws, a)


@entry_point("Status(ws, f8)")
def follow(ws: Workspace, t: float) -> Status:
    """Go on to time ``t`` in the present modes, by steps of the run's tolerance; return the status."""
    group_closed(ws)
    choose_integrated(ws)
    _evaluate_slip_per_force(ws)
    wanted = ws.tolerance.largest_step
    if ws.island.averaged_until <= ws.island.time:
        start_averaging_span(ws, follows=False)
    while ws.island.time < t:
        ws.island.stage_time, ws.step.uses_last_slope, ws.step.has_replaced_slope = 0.0, False, False
        slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=True)
        if _has_reversed_slip(ws):
            slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=True)
        take_off(ws)
        for i in range(ws.island.n_grouped):
            c = ws.island.grouped[i]
            ws.guards[friction_guard(ws, c)].initial = value_of_slip_guard(ws, c)
            contact = ws.contacts[c]
            contact.velocity_at_end = contact.velocity
        ws.step.relaxation = relaxation_rate(ws)
        left = t - ws.island.time
        h = _find_step(ws, min(wanted, left, ws.island.averaged_until - ws.island.time))
        if h < 0.0 and not ws.request.is_interrupted and jump_contact_points(ws, ws.tolerance.time):
            h = ws.tolerance.time
        if h < 0.0:
            return Status.NOT_FINITE if ws.request.is_interrupted else Status.STEP_TOO_SMALL
        ws.step.h = h
        ws.island.time = t if h == left else ws.island.time + h
        for i in range(ws.model.n_y):
            ws.island.y[i] = ws.step.y_new[i]
        normalise_quaternions(ws)
        if ws.model.n_joints > 0:
            project_joints(ws)
        if ws.island.averaged_until - ws.island.time <= ws.tolerance.time:
            end_averaging_span(ws)
            start_averaging_span(ws, follows=True)
        else:
            ws.totals.closing_loss += project_closed(ws, at_event=False, averaged=False)
        if ws.run.failure != Status.RUNNING:
            return ws.run.failure
        wanted = min(ws.tolerance.largest_step, 2.0 * h)
    return Status.RUNNING


@kernel("b1(ws)")
def _exceed_bounds(ws: Workspace) -> bool:
    """Return 1 if forces that are not unique pull, or pass the bound of their friction."""
    least = largest = 0.0
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        if contact.has_redundant_force:
            largest = max(largest, abs(contact.force[0]))
            least = min(least, value_of_normal_guard(ws, c))
            if contact.is_held_by_friction:
                least = min(least, contact.static_margin)
    return least < -_ROUND_OFF * largest


@entry_point("void(ws, b1)")
def evaluate_forces(ws: Workspace, may_choose: bool) -> None:
    """Evaluate bodies, closed contacts and joints with their forces at the present state.

    Of forces that are not unique the null-space force is chosen anew if it ``may_choose``, as at an event, or if with
    that at hand a bound is passed.
    """
    group_closed(ws)
    ws.island.stage_time = 0.0
    if may_choose or ws.island.averaged_until <= ws.island.time:
        start_averaging_span(ws, follows=False)
    evaluate_driven_bodies(ws, ws.island.time, ws.island.y.start)
    right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose, of_all_bodies=True)
    has_turned = _has_reversed_slip(ws)
    is_past_bounds = not may_choose and _exceed_bounds(ws)
    if has_turned or is_past_bounds:
        right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose or is_past_bounds, of_all_bodies=True)
    if ws.model.n_joints > 0:
        evaluate_joint_forces(ws)
