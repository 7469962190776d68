"""Bodies that go on past events elsewhere: where a body rolls, or lies, on one contact with a body at rest.

Every event ends the step of all that is integrated.  A body that sticks to one at rest by a single contact acts on
nothing else: it has a step of its own, and until that ends it is where its interpolant says (:func:`fly
<nonsmooth.engine.flow.flight.fly>`), whatever happens meanwhile, unless something else touches it
(:mod:`nonsmooth.engine.bodies.courses`).  All courses end at one instant, at which they begin anew: were it one for
each, steps would end at all of them.  Courses are for motions without power of driven bodies and of friction, whose
accounts are those of everything that is integrated.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.courses import end_own_steps_of, has_own_step
from nonsmooth.engine.delassus.islands import group_members
from nonsmooth.engine.flow.flight import integrate, integrate_velocities
from nonsmooth.engine.flow.flow import value_of_normal_guard, right_hand_side, slope
from nonsmooth.engine.flow.guard_numbers import friction_guard, normal_guard
from nonsmooth.engine.flow.step import explicit_step
from nonsmooth.engine.memory.layout import N_STAGES
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    Workspace,
    frame_at,
    kernel,
)
from nonsmooth.engine.numerics.runge_kutta import SHRINK, dense_state, step_factor
from nonsmooth.engine.numerics.vectors import dot

_DRIFT = 0.3
"""A closed contact leaves its constraints by this part of the tolerances at most before it is put back."""
_LARGEST_DROP = 0.5
"""A force that keeps this part of its greatest at the ends and in the middle of a step is at its bound nowhere."""
_ATTEMPTS = 3
"""Lengths that are tried of a course; where none does, the next one begins with what was left."""


@kernel("b1(ws, i8, i8)")
def _is_at_rest(ws: Workspace, number: int, frame: int) -> bool:
    """True if a body has no coordinates, and a frame of it no velocity."""
    one = frame_at(ws.floats, frame)
    moves = dot(one.velocity, one.velocity) + dot(one.spin, one.spin)
    return ws.bodies[number].n_u == 0 and moves == 0.0


@kernel("i8(ws, i8)")
def _independent_body(ws: Workspace, c: int) -> int:
    """Return the body that sticks by contact ``c`` alone to one at rest, and is not on its course, or -1.

    It is not the only one that moves: with nothing else there are no events but its own.
    """
    contact = ws.contacts[c]
    rigid = not contact.is_compliant and not contact.is_averaged and not contact.is_anisotropic
    if contact.mode != Mode.STICK or not rigid or contact.past_feature > 0.0:
        return -1
    number = contact.body_b
    if not _is_at_rest(ws, contact.body_a, contact.frame_a):
        number = contact.body_a
        if not _is_at_rest(ws, contact.body_b, contact.frame_b):
            return -1
    body = ws.bodies[number]
    alone = body.n_closed == 1 and not body.has_own_step
    # a spin along axes in space has an interpolant of its own
    return int(number) if alone and 0 < body.n_u < ws.model.n_u and body.spin < 0 else -1


@kernel("i8(ws)")
def _group_independent_bodies(ws: Workspace) -> int:
    """Group the contacts of the bodies that may set off, and let these alone be integrated; return how many."""
    for number in range(ws.model.n_bodies):
        ws.bodies[number].n_closed = 0
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.mode != Mode.OPEN:
            ws.bodies[contact.body_a].n_closed += 1
            ws.bodies[contact.body_b].n_closed += 1
    ws.island.n_integrated = ws.island.n_spans = 0
    for c in range(ws.island.n_contacts):
        number = _independent_body(ws, c)
        ws.contacts[c].is_in_problem = False
        if number >= 0:
            ws.contacts[c].is_in_problem = True
            integrate(ws, number)
    if ws.island.n_integrated > 0:
        integrate_velocities(ws)
        group_members(ws)
    return int(ws.island.n_integrated)


@kernel("void(ws, i8, f8, b1)")
def _extend_range(ws: Workspace, i: int, value: float, anew: bool) -> None:
    """Let the range of guard ``i`` reach to a value."""
    guard = ws.guards[i]
    guard.base = value if anew else min(guard.base, value)
    guard.at_end = value if anew else max(guard.at_end, value)


@kernel("void(ws, b1)")
def _extend_ranges(ws: Workspace, anew: bool) -> None:
    """Let the ranges of the forces of the grouped contacts reach to what they are.

    Its guard stays armed if at all looks it has the same features, sticks by friction, and what bears it rests.
    """
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        _extend_range(ws, normal_guard(c), value_of_normal_guard(ws, c), anew)
        _extend_range(ws, friction_guard(ws, c), contact.static_margin, anew)
        normal = ws.guards[normal_guard(c)]
        if anew:
            contact.feature, normal.is_armed = int(contact.feature_now), True
        is_same = contact.past_feature <= 0.0 and int(contact.feature_now) == contact.feature
        bears = _is_at_rest(ws, contact.body_a, contact.frame_a) + _is_at_rest(ws, contact.body_b, contact.frame_b)
        if not is_same or bears == 0 or not contact.is_held_by_friction:
            normal.is_armed = False


@kernel("b1(ws, i8)")
def _keeps_distance(ws: Workspace, i: int) -> bool:
    """Return 1 if a guard keeps so much of its greatest that it comes near no bound."""
    guard = ws.guards[i]
    return guard.base > 0.0 and guard.base >= _LARGEST_DROP * guard.at_end


@kernel("f8(ws, f8, f8)")
def _find_step(ws: Workspace, usual: float, longest: float) -> float:
    """Take a step of the bodies that may set off; return its length, or 0 where none was found."""
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


@kernel("void(ws, i8, f8)")
def _store_step(ws: Workspace, number: int, h: float) -> None:
    """Let a body be on the course that its step of ``h`` has found."""
    body = ws.bodies[number]
    body.has_own_step, body.own_step_time, body.own_step = True, ws.island.time, h
    for part in range(2):
        first, n = (body.q, body.n_q) if part == 0 else (ws.model.n_q + body.u, body.n_u)
        for i in range(first, first + n):
            ws.island.own_start[i] = ws.island.y[i]
            for stage in range(N_STAGES):
                ws.island.own_slopes[stage * ws.model.n_y + i] = ws.island.slopes[stage * ws.model.n_y + i]


@kernel("void(ws, f8, f8)")
def begin_own_steps(ws: Workspace, usual: float, longest: float) -> None:
    """Let bodies set off on their courses that can, where a step begins behind an event; bodies do not stand there.

    No course is longer than ``longest``; the first one that is tried is as long as is ``usual``.
    """
    if ws.model.n_loads + ws.model.n_joints + ws.model.n_states > 0 or _group_independent_bodies(ws) == 0:
        return
    stage_time = ws.island.stage_time
    for i in range(ws.island.n_grouped):
        ws.contacts[ws.island.grouped[i]].least_force = math.inf
    slope(ws, ws.island.time, ws.island.y.start, ws.island.slopes.start, may_choose=False, of_all_bodies=False)
    _extend_ranges(ws, anew=True)
    h = _find_step(ws, usual, longest)
    ws.island.stage_time = stage_time
    if h == 0.0:
        return
    _extend_ranges(ws, anew=False)
    dense_state(ws, ws.island.y.start, ws.island.slopes.start, ws.model.n_y, h, 0.5, ws.step.y_stage.start)
    right_hand_side(ws, ws.island.time + 0.5 * h, ws.step.y_stage.start, may_choose=False, of_all_bodies=False)
    _extend_ranges(ws, anew=False)
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        _extend_range(ws, normal_guard(c), contact.least_force, anew=False)
        far = _keeps_distance(ws, normal_guard(c)) + _keeps_distance(ws, friction_guard(ws, c))
        if ws.guards[normal_guard(c)].is_armed and far == 2:
            number = contact.body_b if ws.bodies[contact.body_b].n_u > 0 else contact.body_a
            _store_step(ws, number, h)
            ws.island.own_steps_end = min(ws.island.own_steps_end, ws.island.time + h)


@kernel("b1(ws, i8)")
def _has_drifted(ws: Workspace, c: int) -> bool:
    """Return 1 if a closed contact has left its constraints by more than a part of the tolerances."""
    contact = ws.contacts[c]
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
    """Return 1 if some closed contact has left its constraints by more than a part of the tolerances."""
    for c in range(ws.island.n_contacts):
        if _has_drifted(ws, c):
            return True
    return False


@kernel("i8(ws)")
def end_own_steps(ws: Workspace) -> int:
    """End all courses at their common end, and before it those that have drifted; return how many."""
    ended, over = 0, ws.island.own_steps_end - ws.island.time <= ws.tolerance.time
    if over:
        ws.island.own_steps_end = math.inf
    for c in range(ws.island.n_contacts):
        if has_own_step(ws, c) and (over or _has_drifted(ws, c)):
            ended += end_own_steps_of(ws, c)
    return ended
