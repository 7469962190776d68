"""Own steps of bodies (multirate): a body that rolls or lies on one contact with a body at rest needs no common step.

Every event ends the step of all bodies that are integrated together. A body that sticks to a body at rest by a single
contact acts on nothing else. So it takes an own step. Until that step ends, the body moves along its interpolant
(:func:`fly <nonsmooth.engine.flow.flight.fly>`), whatever happens elsewhere, unless something else touches it
(:mod:`nonsmooth.engine.bodies.courses`).

A body may do so if over the step its normal force and its margin to the friction bound keep half of their largest
value. So it can neither lift off nor slip. All own steps end at one instant, because each end is an end of the common
step. Driven bodies and friction must exchange no power with such a body, because the energy accounts are integrated
with the common step only.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.courses import end_own_steps_of, has_own_step
from nonsmooth.engine.delassus.islands import group_members
from nonsmooth.engine.flow.flight import integrate, integrate_velocities
from nonsmooth.engine.flow.flow import right_hand_side, slope, value_of_normal_guard
from nonsmooth.engine.flow.guard_numbers import friction_of, normal_of
from nonsmooth.engine.flow.step import explicit_step
from nonsmooth.engine.memory.layout import N_STAGES
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import BodyRecord, ContactRecord, GuardRecord, Workspace, frame_at, kernel
from nonsmooth.engine.numerics.runge_kutta import SHRINK, dense_state, step_factor
from nonsmooth.engine.numerics.vectors import dot

_DRIFT = 0.3
"""Gap or rate, in tolerances, at which a closed contact must be projected: well within one tolerance."""
_LARGEST_DROP = 0.5
"""Smallest value of a guard in the samples of a step, relative to the largest one, at which it cannot fire between."""
_ATTEMPTS = 3
"""Most lengths of an own step that are tried at one event. The next event starts with the last length."""
_NO_BODY = -1
"""Number in place of a body if there is none."""


@kernel("b1(ws, i8, i8)")
def _is_at_rest(ws: Workspace, number: int, frame: int) -> bool:
    """True if body ``number`` is driven and the ``frame`` on it, given by its offset, does not move at all."""
    motion = frame_at(ws.floats, frame)
    # zero only if each component is
    squares = dot(motion.velocity, motion.velocity) + dot(motion.spin, motion.spin)
    return ws.bodies[number].n_u == 0 and squares == 0.0


@kernel("b1(ws, ContactRecord)")
def _has_body_at_rest(ws: Workspace, contact: ContactRecord) -> bool:
    """True if one of the two bodies of a contact is driven and does not move."""
    return _is_at_rest(ws, contact.body_a, contact.frame_a) or _is_at_rest(ws, contact.body_b, contact.frame_b)


@kernel("i8(ws, ContactRecord)")
def _independent_body(ws: Workspace, contact: ContactRecord) -> int:
    """Body that sticks by this contact alone to a body at rest and has no own step yet, or ``_NO_BODY``.

    Such a body acts on nothing else, so it may take a step of its own. It must not be the only body with velocities:
    then an own step would save nothing, as there are no events of others. A body that declares a spin (not negative)
    may be integrated with another interpolant, so it takes no own step. Nor does one on a compliant, averaged or
    anisotropic contact. ``n_closed`` must be the number of closed contacts of each body.
    """
    is_plain = not contact.is_compliant and not contact.is_averaged and not contact.is_anisotropic
    # past_feature is positive past the end of the features in contact, where the contact opens
    if contact.mode != Mode.STICK or not is_plain or contact.past_feature > 0.0:
        return _NO_BODY
    if not _has_body_at_rest(ws, contact):
        return _NO_BODY
    number = contact.body_b if _is_at_rest(ws, contact.body_a, contact.frame_a) else contact.body_a
    body = ws.bodies[number]
    is_alone = body.n_closed == 1 and not body.has_own_step
    return int(number) if is_alone and 0 < body.n_u < ws.model.n_u and body.spin < 0 else _NO_BODY


@kernel("i8(ws)")
def _group_independent_bodies(ws: Workspace) -> int:
    """Let the integrator step the independent bodies only, and group their contacts into islands. Number of bodies.

    Independent is a body that sticks by a single contact to a body at rest. If there is none, the islands are left as
    they were. In any case the bodies and islands of a common step must be chosen anew.
    """
    for body in ws.bodies:
        body.n_closed = 0
    for contact in ws.contacts:
        if contact.mode != Mode.OPEN:
            ws.bodies[contact.body_a].n_closed += 1
            ws.bodies[contact.body_b].n_closed += 1
    ws.island.n_integrated = ws.island.n_spans = 0
    for contact in ws.contacts:
        number = _independent_body(ws, contact)
        # group_members groups the contacts that are marked so
        contact.is_in_problem = number != _NO_BODY
        if contact.is_in_problem:
            integrate(ws, number)
    if ws.island.n_integrated > 0:
        integrate_velocities(ws)
        group_members(ws)
    return int(ws.island.n_integrated)


@kernel("void(GuardRecord, f8, b1)")
def _extend_range(guard: GuardRecord, value: float, is_first: bool) -> None:
    """Extend the range of a guard's values by ``value``, or start it there if it ``is_first``."""
    # the range is stored from base to at_end, which are free until the next common step writes the guards
    guard.base = value if is_first else min(guard.base, value)
    guard.at_end = value if is_first else max(guard.at_end, value)


@kernel("void(ws, b1)")
def _extend_ranges(ws: Workspace, is_first: bool) -> None:
    """Extend the ranges of normal force and static margin of the grouped contacts by a sample of an own step [N].

    From the least and the largest sample, :func:`begin_own_steps` finds whether a contact may open or slip within the
    step. A sample rules the own step out if the features in contact are others than at the first one, or have ended, if
    friction does not hold the contact, or if its other body moves.
    """
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        normal, friction = normal_of(ws, contact), friction_of(ws, contact)
        _extend_range(normal, value_of_normal_guard(ws, contact.index), is_first)
        _extend_range(friction, contact.static_margin, is_first)
        # here is_armed of the normal guard means that no sample has ruled the own step out: the common step, which
        # arms guards to fire, writes it again
        if is_first:
            contact.feature, normal.is_armed = int(contact.feature_now), True
        # past_feature is the distance past the end of the features [m], negative within, 0 if they have no end
        has_same_features = contact.past_feature <= 0.0 and int(contact.feature_now) == contact.feature
        if not has_same_features or not _has_body_at_rest(ws, contact) or not contact.is_held_by_friction:
            normal.is_armed = False


@kernel("b1(GuardRecord)")
def _keeps_distance(guard: GuardRecord) -> bool:
    """True if the samples of a guard, ``base`` to ``at_end``, are positive and differ too little for a root between."""
    # base is the least sample, at_end the largest one
    return guard.base > 0.0 and guard.base >= _LARGEST_DROP * guard.at_end


@kernel("f8(ws, f8, f8)")
def _find_step(ws: Workspace, usual: float, longest: float) -> float:
    """Step the independent bodies to ``y_new``. Length of the step that meets the tolerance [s], or 0 if none does.

    The first length that is tried is that of the last own step, or ``usual`` [s]. None exceeds ``longest`` [s], nor the
    common end of the present own steps. ``own_step`` becomes the length to try next.
    """
    wanted = min(ws.island.own_step if ws.island.own_step > 0.0 else usual, ws.tolerance.largest_step)
    h = min(wanted, longest, ws.island.own_steps_end - ws.island.time)
    for _attempt in range(_ATTEMPTS):
        error = explicit_step(ws, h)
        # of an error that is not finite no factor can be estimated
        factor = step_factor(error) if error < math.inf else SHRINK
        if error <= 1.0:
            # a step that was cut short to its end does not shorten the next one
            ws.island.own_step = max(wanted, h * factor) if h < wanted else h * factor
            return float(h)
        h *= factor
        ws.island.own_step = wanted = h
    return 0.0


@kernel("void(ws, BodyRecord, f8)")
def _store_step(ws: Workspace, body: BodyRecord, h: float) -> None:
    """Give a body an own step of ``h`` [s] from the present time. Stores its start and slopes for the interpolant.

    They are those of the coordinates and velocities of the body alone, in all stages of the step taken last.
    """
    body.has_own_step, body.own_step_time, body.own_step = True, ws.island.time, h
    # coordinates, then velocities
    for part in range(2):
        first, n = (body.q, body.n_q) if part == 0 else (ws.model.n_q + body.u, body.n_u)
        for i in range(first, first + n):
            ws.island.own_start[i] = ws.island.y[i]
            for stage in range(N_STAGES):
                ws.island.own_slopes[stage * ws.model.n_y + i] = ws.island.slopes[stage * ws.model.n_y + i]


@kernel("void(ws, f8, f8)")
def begin_own_steps(ws: Workspace, usual: float, longest: float) -> None:
    """Begin own steps of all bodies that may take one, before the first common step after an event.

    Until its end such a body moves along the interpolant of its step, whatever happens elsewhere. The first length that
    is tried is that of the last own step, or ``usual`` [s]. None exceeds ``longest`` [s]. Afterwards the bodies are
    evaluated at another state. Systems with loads, joints or inner states of laws have no own steps.
    """
    # loads and joints couple bodies, and an own step stores coordinates and velocities only
    if ws.model.n_loads + ws.model.n_joints + ws.model.n_states > 0 or _group_independent_bodies(ws) == 0:
        return
    h = _try_own_step(ws, usual, longest)
    # no step meets the tolerance
    if h == 0.0:
        return
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        normal, friction = normal_of(ws, contact), friction_of(ws, contact)
        # the least normal force in the stages of the step is a sample, too
        _extend_range(normal, contact.least_force, is_first=False)
        # is_armed: no sample has ruled the own step out
        if normal.is_armed and _keeps_distance(normal) and _keeps_distance(friction):
            # the other body is at rest
            number = contact.body_b if ws.bodies[contact.body_b].n_u > 0 else contact.body_a
            _store_step(ws, ws.bodies[number], h)
            # all own steps end at one instant: h is at most the time up to the end of those that began before
            ws.island.own_steps_end = min(ws.island.own_steps_end, ws.island.time + h)


@kernel("f8(ws, f8, f8)")
def _try_own_step(ws: Workspace, usual: float, longest: float) -> float:
    """Step the independent bodies, and sample the ranges of their guards at start, end and middle of the step.

    Length of the step [s], or 0 if none meets the tolerance. From the samples the caller finds which guards cannot fire
    within it.
    """
    # the explicit step sets it to zero; it decides whether the next common step is implicit
    stage_time = ws.island.stage_time
    # the evaluations below lower it to the least force
    for i in range(ws.island.n_grouped):
        ws.contacts[ws.island.grouped[i]].least_force = math.inf
    slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=False)
    _extend_ranges(ws, is_first=True)
    h = _find_step(ws, usual, longest)
    ws.island.stage_time = stage_time
    if h > 0.0:
        # the last stage of the step has evaluated its end
        _extend_ranges(ws, is_first=False)
        # a sample in the middle, too
        dense_state(ws, ws.island.y.start, ws.island.slopes.start, ws.model.n_y, h, 0.5, ws.step.y_stage.start)
        right_hand_side(ws, ws.island.time + 0.5 * h, ws.step.y_stage.start, may_choose=False, of_all_bodies=False)
        _extend_ranges(ws, is_first=False)
    return h


@kernel("b1(ws, ContactRecord)")
def _has_drifted(ws: Workspace, contact: ContactRecord) -> bool:
    """True if a closed contact has left its constraints by more than ``_DRIFT`` tolerances, at the end of the step.

    Constraints are a gap and a gap rate of zero, and no slip if it sticks. A compliant contact constrains only its
    slip. Contacts with averaged forces are projected at the end of their span.
    """
    if contact.mode == Mode.OPEN or contact.is_averaged:
        return False
    # velocity_at_end is gap rate and slip
    rate, gap = abs(contact.velocity_at_end[0]), abs(contact.gap_at_end)
    if contact.is_compliant:
        rate = gap = 0.0
    if contact.mode == Mode.STICK:
        rate += abs(contact.slip_at_end[0]) + abs(contact.slip_at_end[1])
    return rate > _DRIFT * ws.tolerance.velocity or gap > _DRIFT * ws.tolerance.gap


@kernel("b1(ws)")
def has_drifted(ws: Workspace) -> bool:
    """True if some closed contact has left its constraints by more than ``_DRIFT`` tolerances.

    The closed contacts are then projected: put back on their constraints.
    """
    for contact in ws.contacts:
        if _has_drifted(ws, contact):
            return True
    return False


@kernel("i8(ws)")
def end_own_steps(ws: Workspace) -> int:
    """End all own steps if the common end is reached, else those whose contacts have drifted. Number that ended.

    If any ends, the closed contacts must be grouped anew. A drifted contact takes part in the next projection.
    """
    # without own steps the common end is infinite
    n_ended, is_end = 0, ws.island.own_steps_end - ws.island.time <= ws.tolerance.time
    if is_end:
        ws.island.own_steps_end = math.inf
    for contact in ws.contacts:
        if has_own_step(ws, contact.index) and (is_end or _has_drifted(ws, contact)):
            n_ended += end_own_steps_of(ws, contact.index)
    return n_ended
