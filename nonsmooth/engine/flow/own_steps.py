"""Own steps of bodies (multirate): a body that rolls or lies on one contact with a body at rest needs no common step.

Every event ends the step of all bodies that are integrated together. A body that sticks to a body at rest by a single
contact acts on nothing else. So it takes a step of its own. Until that step ends, the body moves along its interpolant
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
from nonsmooth.engine.native.kernel import Body, Contact, Guard, Workspace, frame_at, kernel
from nonsmooth.engine.numerics.runge_kutta import SHRINK, dense_state, step_factor
from nonsmooth.engine.numerics.vectors import dot

_DRIFT = 0.3
"""Gap or rate of a closed contact at which its own step ends, in tolerances."""
_LARGEST_DROP = 0.5
"""Least value of a guard relative to its largest one in the samples of a step, at which it is taken not to fire."""
_ATTEMPTS = 3
"""Most lengths of an own step that are tried at once. The next attempt starts with what was left."""
_NO_BODY = -1
"""Number in place of a body if there is none."""


@kernel("b1(ws, i8, i8)")
def _is_at_rest(ws: Workspace, number: int, frame: int) -> bool:
    """True if a body is driven and its frame does not move."""
    one = frame_at(ws.floats, frame)
    moves = dot(one.velocity, one.velocity) + dot(one.spin, one.spin)
    return ws.bodies[number].n_u == 0 and moves == 0.0


@kernel("i8(ws, Contact)")
def _independent_body(ws: Workspace, contact: Contact) -> int:
    """Body that sticks by this contact alone to one at rest and has no own step yet, or ``_NO_BODY``.

    It must not be the only body that moves, because then no events of others could interrupt it. A spin that is
    integrated along axes in space has an interpolant of its own, so such bodies are left out.
    """
    is_rigid = not contact.is_compliant and not contact.is_averaged and not contact.is_anisotropic
    if contact.mode != Mode.STICK or not is_rigid or contact.past_feature > 0.0:
        return _NO_BODY
    number = contact.body_b
    if not _is_at_rest(ws, contact.body_a, contact.frame_a):
        number = contact.body_a
        if not _is_at_rest(ws, contact.body_b, contact.frame_b):
            return _NO_BODY
    body = ws.bodies[number]
    is_alone = body.n_closed == 1 and not body.has_own_step
    return int(number) if is_alone and 0 < body.n_u < ws.model.n_u and body.spin < 0 else _NO_BODY


@kernel("i8(ws)")
def _group_independent_bodies(ws: Workspace) -> int:
    """Let the integrator step the independent bodies only, and group their contacts. Number of these bodies."""
    for body in ws.bodies:
        body.n_closed = 0
    for contact in ws.contacts:
        if contact.mode != Mode.OPEN:
            ws.bodies[contact.body_a].n_closed += 1
            ws.bodies[contact.body_b].n_closed += 1
    ws.island.n_integrated = ws.island.n_spans = 0
    for contact in ws.contacts:
        number = _independent_body(ws, contact)
        contact.is_in_problem = False
        if number != _NO_BODY:
            contact.is_in_problem = True
            integrate(ws, number)
    if ws.island.n_integrated > 0:
        integrate_velocities(ws)
        group_members(ws)
    return int(ws.island.n_integrated)


@kernel("void(Guard, f8, b1)")
def _extend_range(guard: Guard, value: float, is_first: bool) -> None:
    """Extend the range of a guard, from ``base`` to ``at_end``, by a value, or start it there."""
    guard.base = value if is_first else min(guard.base, value)
    guard.at_end = value if is_first else max(guard.at_end, value)


@kernel("void(ws, b1)")
def _extend_ranges(ws: Workspace, is_first: bool) -> None:
    """Extend the ranges of the force guards of the grouped contacts by their present values.

    A normal guard stays armed as long as its contact has the same features, sticks by friction, and its other body is
    at rest.
    """
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        normal, friction = normal_of(ws, contact), friction_of(ws, contact)
        _extend_range(normal, value_of_normal_guard(ws, contact.index), is_first)
        _extend_range(friction, contact.static_margin, is_first)
        if is_first:
            contact.feature, normal.is_armed = int(contact.feature_now), True
        has_same_features = contact.past_feature <= 0.0 and int(contact.feature_now) == contact.feature
        is_one_at_rest = _is_at_rest(ws, contact.body_a, contact.frame_a) or _is_at_rest(
            ws, contact.body_b, contact.frame_b
        )
        if not has_same_features or not is_one_at_rest or not contact.is_held_by_friction:
            normal.is_armed = False


@kernel("b1(Guard)")
def _keeps_distance(guard: Guard) -> bool:
    """True if a guard stayed positive, with a drop too small to reach zero within the step."""
    return guard.base > 0.0 and guard.base >= _LARGEST_DROP * guard.at_end


@kernel("f8(ws, f8, f8)")
def _find_step(ws: Workspace, usual: float, longest: float) -> float:
    """Step the independent bodies. Length of the step that meets the tolerance [s], or 0 if none was found.

    The first length that is tried is that of the last own step, or ``usual`` [s]. None exceeds ``longest`` [s].
    """
    wanted = min(ws.island.own_step if ws.island.own_step > 0.0 else usual, ws.tolerance.largest_step)
    h = min(wanted, longest, ws.island.own_steps_end - ws.island.time)
    for _attempt in range(_ATTEMPTS):
        error = explicit_step(ws, h)
        factor = step_factor(error) if error < math.inf else SHRINK
        if error <= 1.0:
            ws.island.own_step = max(wanted, h * factor) if h < wanted else h * factor
            return float(h)
        h *= factor
        ws.island.own_step = wanted = h
    return 0.0


@kernel("void(ws, Body, f8)")
def _store_step(ws: Workspace, body: Body, h: float) -> None:
    """Give a body the own step of ``h`` [s] that was found, with its start and its slopes for the interpolant."""
    body.has_own_step, body.own_step_time, body.own_step = True, ws.island.time, h
    for part in range(2):
        first, n = (body.q, body.n_q) if part == 0 else (ws.model.n_q + body.u, body.n_u)
        for i in range(first, first + n):
            ws.island.own_start[i] = ws.island.y[i]
            for stage in range(N_STAGES):
                ws.island.own_slopes[stage * ws.model.n_y + i] = ws.island.slopes[stage * ws.model.n_y + i]


@kernel("void(ws, f8, f8)")
def begin_own_steps(ws: Workspace, usual: float, longest: float) -> None:
    """Begin own steps of all bodies that may take one, at the first step after an event.

    The first length that is tried is ``usual`` [s]. None exceeds ``longest`` [s]. The bodies are evaluated elsewhere
    afterwards. Systems with loads, joints or inner states of laws have no own steps.
    """
    if ws.model.n_loads + ws.model.n_joints + ws.model.n_states > 0 or _group_independent_bodies(ws) == 0:
        return
    h = _try_own_step(ws, usual, longest)
    if h == 0.0:
        return
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        normal, friction = normal_of(ws, contact), friction_of(ws, contact)
        _extend_range(normal, contact.least_force, is_first=False)
        if normal.is_armed and _keeps_distance(normal) and _keeps_distance(friction):
            number = contact.body_b if ws.bodies[contact.body_b].n_u > 0 else contact.body_a
            _store_step(ws, ws.bodies[number], h)
            ws.island.own_steps_end = min(ws.island.own_steps_end, ws.island.time + h)


@kernel("f8(ws, f8, f8)")
def _try_own_step(ws: Workspace, usual: float, longest: float) -> float:
    """Step the independent bodies, and write the ranges of their guards at start, end and middle of the step.

    Returns the length of the step [s], or 0 if none was found.
    """
    stage_time = ws.island.stage_time
    for i in range(ws.island.n_grouped):
        ws.contacts[ws.island.grouped[i]].least_force = math.inf
    slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=False)
    _extend_ranges(ws, is_first=True)
    h = _find_step(ws, usual, longest)
    ws.island.stage_time = stage_time
    if h > 0.0:
        _extend_ranges(ws, is_first=False)
        dense_state(ws, ws.island.y.start, ws.island.slopes.start, ws.model.n_y, h, 0.5, ws.step.y_stage.start)
        right_hand_side(ws, ws.island.time + 0.5 * h, ws.step.y_stage.start, may_choose=False, of_all_bodies=False)
        _extend_ranges(ws, is_first=False)
    return h


@kernel("b1(ws, Contact)")
def _has_drifted(ws: Workspace, contact: Contact) -> bool:
    """True if a closed contact has left its constraints by more than ``_DRIFT`` tolerances."""
    if contact.mode == Mode.OPEN or contact.is_averaged:
        return False
    rate, gap = abs(contact.velocity_at_end[0]), abs(contact.gap_at_end)
    if contact.is_compliant:
        rate = gap = 0.0
    if contact.mode == Mode.STICK:
        rate += abs(contact.slip_at_end[0]) + abs(contact.slip_at_end[1])
    return rate > _DRIFT * ws.tolerance.velocity or gap > _DRIFT * ws.tolerance.gap


@kernel("b1(ws)")
def has_drifted(ws: Workspace) -> bool:
    """True if some closed contact has left its constraints by more than ``_DRIFT`` tolerances."""
    for contact in ws.contacts:
        if _has_drifted(ws, contact):
            return True
    return False


@kernel("i8(ws)")
def end_own_steps(ws: Workspace) -> int:
    """End all own steps at their common end, and before it those whose contacts have drifted. Number that ended."""
    n_ended, is_end = 0, ws.island.own_steps_end - ws.island.time <= ws.tolerance.time
    if is_end:
        ws.island.own_steps_end = math.inf
    for contact in ws.contacts:
        if has_own_step(ws, contact.index) and (is_end or _has_drifted(ws, contact)):
            n_ended += end_own_steps_of(ws, contact.index)
    return n_ended
