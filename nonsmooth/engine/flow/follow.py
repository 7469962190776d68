"""Replay of the motion between two stored states, and forces at an instant, in given modes.

A run stores states at events only. A sample in between is found by integrating the motion from the last stored state in
the modes that were recorded with it. No event is searched for: there is none before the next stored state. So the steps
need not be those of the run.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.articulations import solve_factorised
from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_driven_bodies
from nonsmooth.engine.bodies.compliance import write_wrench
from nonsmooth.engine.bodies.equations import force_without_contacts
from nonsmooth.engine.bodies.kinematics import evaluate_contact
from nonsmooth.engine.contact.trial import tangential_inverse_mass
from nonsmooth.engine.delassus.delassus import assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.averaged import end_averaging_span, start_averaging_span
from nonsmooth.engine.flow.flight import choose_integrated, take_off
from nonsmooth.engine.flow.flow import right_hand_side, slope, value_of_normal_guard, value_of_slip_guard
from nonsmooth.engine.flow.guard_numbers import friction_of
from nonsmooth.engine.flow.point_jump import jump_contact_points
from nonsmooth.engine.flow.projection import normalise_quaternions, project_closed, project_joints
from nonsmooth.engine.flow.step import relaxation_rate, try_length
from nonsmooth.engine.memory.layout import FIRST_ROW
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import Articulation, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.linear import product
from nonsmooth.engine.numerics.runge_kutta import SAFETY, SHRINK, step_factor
from nonsmooth.engine.numerics.vectors import length


@kernel("void(ws, i8)")
def _add_contact_forces(ws: Workspace, forces: int) -> None:
    """Add the forces of the closed contacts to the generalised forces of all bodies at offset ``forces``.

    ``FIRST_ROW`` of the Jacobians of the contacts and ``NORMAL_ROW`` of their responses are overwritten.
    """
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        write_wrench(ws, c, contact.force)
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            # write_wrench has written the generalised forces to this row
            row = (contact.jacobian_a if side == 0 else contact.jacobian_b) + FIRST_ROW * articulation.n_u
            for j in range(articulation.n_u):
                ws.floats[forces + articulation.u + j] += ws.floats[row + j]


@kernel("void(ws, Articulation, i8)")
def _solve_rows(ws: Workspace, articulation: Articulation, forces: int) -> None:
    """Write the multipliers mu of the joint rows of an articulation [N or N m], from the generalised forces F.

    mu = -(A M^-1 A^T)^-1 (A M^-1 F + b), with the Jacobian A and the biases b of the rows. F of all bodies is at offset
    ``forces``.  An articulation is a set of bodies that joints connect.  The factor of A M^-1 A^T, and the response A
    M^-1, must be evaluated.
    """
    n, m = articulation.n_u, articulation.n_rows
    # store the right-hand side of each row; solve_factorised overwrites it with the multiplier
    for line in range(m):
        row, bias = articulation.response + line * n, ws.floats[articulation.bias + line]
        ws.floats[articulation.forces + line] = -product(ws.floats, bias, row, forces + articulation.u, n)
    solve_factorised(ws.floats, articulation.factor, m, articulation.forces, stride=1)


@kernel()
def evaluate_joint_forces(ws: Workspace) -> None:
    """Write the force of every row of the joints [N or N m], for the output. The contact forces must be evaluated.

    A row that others imply gets no force. ``FIRST_ROW`` of the Jacobians of the contacts and ``NORMAL_ROW`` of their
    responses are overwritten.
    """
    # no step is in progress, so its work array y_stage can hold the generalised forces of all bodies
    forces = ws.step.y_stage.start
    for body in ws.bodies:
        without_contacts = force_without_contacts(ws, body)
        for i in range(body.n_u):
            ws.floats[forces + body.u + i] = without_contacts[i]
    _add_contact_forces(ws, forces)
    for articulation in ws.articulations:
        if articulation.n_rows > 0:
            _solve_rows(ws, articulation, forces)


_ROUND_OFF = 1e-8
"""Excess of a force over its bound that is round-off, relative to the largest force."""
_NO_STEP = -1.0
"""Length in place of a step if none was found."""


@kernel("void(ws, b1)")
def orient_slips(ws: Workspace, at_end: bool) -> None:
    """Set the slip directions of a step to those of the present slips, or, ``at_end``, of those at the last step's end.

    A slip within the velocity tolerance keeps its direction, because its own is round-off.
    """
    for contact in ws.contacts:
        if contact.mode == Mode.SLIDE:
            slip = contact.slip_at_end if at_end else contact.slip
            speed = length(slip)
            if speed > ws.tolerance.velocity:
                contact.direction = slip[0] / speed, slip[1] / speed


@kernel("b1(ws)")
def _reorient_slips(ws: Workspace) -> bool:
    """Set the slip directions by the present slips. True if one was opposite: the forces must be evaluated again.

    A slip may reverse without an event, for example if a belt accelerates past the body.
    """
    was_opposite = False
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        if contact.mode == Mode.SLIDE and value_of_slip_guard(ws, contact.index) < -ws.tolerance.velocity:
            was_opposite = True
    orient_slips(ws, at_end=False)
    return was_opposite


@kernel("f8(ws)")
def _part_before_reversal(ws: Workspace) -> float:
    """Part of the tried step after which a slip reverses, by linear interpolation. It is 1 if none reverses.

    The part is at least ``SHRINK``, the largest reduction of a step. A slip that started from rest and ends against its
    direction had the wrong direction from the start. Its direction is reversed here, and the part is 0: the step must
    be tried again from a new slope.
    """
    part = 1.0
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        last = value_of_slip_guard(ws, contact.index)
        if contact.mode != Mode.SLIDE or last >= -ws.tolerance.velocity:
            continue
        # _start_step has stored the slip at the start in the guard
        first = friction_of(ws, contact).initial
        if first > ws.tolerance.velocity:
            part = min(part, max(SHRINK, first / (first - last)))
            continue
        part = 0.0
        friction_of(ws, contact).initial = -first
        contact.direction = -contact.direction[0], -contact.direction[1]
    return part


@kernel("f8(ws, f8)")
def _find_step(ws: Workspace, h: float) -> float:
    """Try steps of ``h`` [s] and less until one meets the tolerance and reverses no slip. Its length [s].

    ``_NO_STEP`` if it would be below the time tolerance, or the run is interrupted. A step of the time tolerance may
    reverse slips. Slip directions that were wrong from the start are reversed, and the slope at the start with them.
    """
    while True:
        error = try_length(ws, h)
        if ws.request.is_interrupted:
            return _NO_STEP
        part = 1.0
        if error <= 1.0:
            part = _part_before_reversal(ws)
            if part == 1.0 or h <= ws.tolerance.time:
                return h
        # a length that is not a number ends the search, too
        elif not h > ws.tolerance.time:
            return _NO_STEP
        if part == 0.0:
            # a slip direction was reversed: the new slope is tried over half of the step
            slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=True)
            part = 0.5
        elif part == 1.0:
            # the error was too large
            part = step_factor(error) if error < math.inf else SHRINK
        # the step becomes shorter in any case
        h *= min(part, SAFETY)


@kernel()
def _evaluate_slip_per_force(ws: Workspace) -> None:
    """Write the slip acceleration per unit of friction of each closed contact [1/kg], for the relaxation rate of slips.

    In a run, events write it, which a replay does not repeat.
    """
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        for active in ws.actives:
            evaluate_contact(ws, active.contact, rows=1)
        assemble_delassus(ws)
        for active in ws.actives:
            ws.contacts[active.contact].slip_per_force = tangential_inverse_mass(ws, active)


@entry_point("Status(ws, f8)")
def follow(ws: Workspace, t: float) -> Status:
    """Integrate the motion up to time ``t`` [s] in the present modes. ``RUNNING``, or why it has not reached ``t``.

    If no step is found, contact points may jump, which takes one time tolerance. Each step may be twice as long as the
    one before. Averaged forces that have ended, or were never found, are found first.
    """
    group_closed(ws)
    choose_integrated(ws)
    _evaluate_slip_per_force(ws)
    wanted = ws.tolerance.largest_step
    if ws.island.averaged_until <= ws.island.time:
        start_averaging_span(ws, follows=False)
    while ws.island.time < t:
        _start_step(ws)
        left = t - ws.island.time
        # a step must not pass the end of an averaging span
        h = _find_step(ws, min(wanted, left, ws.island.averaged_until - ws.island.time))
        if h < 0.0 and not ws.request.is_interrupted and jump_contact_points(ws, ws.tolerance.time):
            h = ws.tolerance.time
        if h < 0.0:
            # TODO: an interrupt needs a status of its own: this one says that a law gave a number that is not finite.
            return Status.NOT_FINITE if ws.request.is_interrupted else Status.STEP_TOO_SMALL
        ws.step.h = h
        # the last step ends at t without round-off
        ws.island.time = t if h == left else ws.island.time + h
        _end_step(ws)
        if ws.run.failure != Status.RUNNING:
            return ws.run.failure
        wanted = min(ws.tolerance.largest_step, 2.0 * h)
    return Status.RUNNING


@kernel()
def _start_step(ws: Workspace) -> None:
    """Evaluate the slope at the start of a step, the slips there and the relaxation rate of their directions.

    The rate decides between explicit and implicit steps. The step begins as explicit, from a slope of its own. Slips
    are copied to ``velocity_at_end``, from which the relaxation rate is found.
    """
    ws.island.stage_time, ws.step.uses_last_slope, ws.step.has_replaced_slope = 0.0, False, False
    slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=True)
    if _reorient_slips(ws):
        slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=True)
    # the power on ballistic bodies, which follow a closed form, at the start of the step
    take_off(ws)
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        friction_of(ws, contact).initial = value_of_slip_guard(ws, contact.index)
        contact.velocity_at_end = contact.velocity
    ws.step.relaxation = relaxation_rate(ws)


@kernel()
def _end_step(ws: Workspace) -> None:
    """Make ``y_new`` the present state and put it on the constraints. Begin the next averaging span if one ends."""
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


@kernel("b1(ws)")
def _exceed_bounds(ws: Workspace) -> bool:
    """True if a force that is not unique pulls, or exceeds its static bound, by more than round-off.

    Round-off is relative to the largest of these normal forces. They must then be chosen anew.
    """
    least = largest = 0.0
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        if contact.has_redundant_force:
            largest = max(largest, abs(contact.force[0]))
            least = min(least, value_of_normal_guard(ws, contact.index))
            if contact.is_held_by_friction:
                least = min(least, contact.static_margin)
    return least < -_ROUND_OFF * largest


@entry_point("void(ws, b1)")
def evaluate_forces(ws: Workspace, may_choose: bool) -> None:
    """Evaluate bodies, closed contacts and joints with their forces at the present state.

    Redundant forces are chosen anew if it ``may_choose``, as at an event, or if the present choice exceeds a bound.
    Slip directions are set by the present slips. If one was opposite, the forces are evaluated a second time.
    """
    group_closed(ws)
    # the forces are those of an instant, not of a stage of an implicit step
    ws.island.stage_time = 0.0
    # averaged forces belong to a span, which begins here
    if may_choose or ws.island.averaged_until <= ws.island.time:
        start_averaging_span(ws, follows=False)
    evaluate_driven_bodies(ws, ws.island.time, ws.island.y.start)
    right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose, of_all_bodies=True)
    # forces against wrong slip directions are wrong, and a new choice may keep bounds that the present one exceeds
    have_turned = _reorient_slips(ws)
    is_past_bounds = not may_choose and _exceed_bounds(ws)
    if have_turned or is_past_bounds:
        right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose or is_past_bounds, of_all_bodies=True)
    if ws.model.n_joints > 0:
        evaluate_joint_forces(ws)
