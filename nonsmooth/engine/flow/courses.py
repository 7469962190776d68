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

from nonsmooth.engine.bodies.courses import end_courses_of, is_on_course
from nonsmooth.engine.delassus.islands import group_members
from nonsmooth.engine.flow.flight import integrate, integrate_velocities
from nonsmooth.engine.flow.flow import hold_guard, right_hand_side, slope
from nonsmooth.engine.flow.guard_numbers import friction_guard, normal_guard
from nonsmooth.engine.flow.step import explicit_step
from nonsmooth.engine.memory.layout import N_STAGES
from nonsmooth.engine.memory.modes import OPEN, STICK
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    body_at,
    contact_at,
    frame_at,
    guard_at,
    kernel,
)
from nonsmooth.engine.numerics.runge_kutta import SHRINK, dense_state, step_factor
from nonsmooth.engine.numerics.vectors import dot

_DRIFT = 0.3
"""A closed contact leaves its constraints by this part of the tolerances at most before it is put back."""
_KEPT = 0.5
"""A force that keeps this part of its greatest at the ends and in the middle of a step is at its bound nowhere."""
_ATTEMPTS = 3
"""Lengths that are tried of a course; where none does, the next one begins with what was left."""


@kernel("i8(S, F, I, i8, i8)")
def _rests(S: Scalars, w: Floats, k: Integers, number: int, frame: int) -> int:
    """Return 1 if a body has no coordinates, and a frame of it no velocity."""
    one = frame_at(w, frame)
    moves = dot(one.velocity, one.velocity) + dot(one.spin, one.spin)
    return 1 if body_at(S, w, k, number).nu == 0 and moves == 0.0 else 0


@kernel("i8(S, F, I, i8)")
def _rider(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return the body that sticks by contact ``c`` alone to one at rest, and is not on its course, or -1.

    It is not the only one that moves: with nothing else there are no events but its own.
    """
    contact = contact_at(S, w, k, c)
    rigid = contact.normal_function == 0 and contact.averaged == OPEN and contact.oriented == 0
    if contact.mode != STICK or not rigid or contact.beyond > 0.0:
        return -1
    number = contact.body_b
    if _rests(S, w, k, contact.body_a, contact.frame_a) == 0:
        number = contact.body_a
        if _rests(S, w, k, contact.body_b, contact.frame_b) == 0:
            return -1
    body = body_at(S, w, k, number)
    alone = body.closed == 1 and body.course == 0
    # a spin along axes in space has an interpolant of its own
    return int(number) if alone and 0 < body.nu < S.n_u and body.spin < 0 else -1


@kernel("i8(S, F, I)")
def _find_riders(S: Scalars, w: Floats, k: Integers) -> int:
    """Group the contacts of the bodies that may set off, and let these alone be integrated; return how many."""
    for number in range(S.n_bodies):
        body_at(S, w, k, number).closed = 0
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.mode != OPEN:
            body_at(S, w, k, contact.body_a).closed += 1
            body_at(S, w, k, contact.body_b).closed += 1
    S.n_integrated = S.n_spans = 0
    for c in range(S.n_contacts):
        number = _rider(S, w, k, c)
        contact_at(S, w, k, c).member = 0
        if number >= 0:
            contact_at(S, w, k, c).member = 1
            integrate(S, w, k, number)
    if S.n_integrated > 0:
        integrate_velocities(S, w, k)
        group_members(S, w, k)
    return int(S.n_integrated)


@kernel("void(S, F, I, i8, f8, i8)")
def _widen(S: Scalars, w: Floats, k: Integers, i: int, value: float, anew: int) -> None:
    """Let the range of guard ``i`` reach to a value."""
    guard = guard_at(S, w, k, i)
    guard.start = value if anew == 1 else min(guard.start, value)
    guard.end = value if anew == 1 else max(guard.end, value)


@kernel("void(S, F, I, i8)")
def _look_at_forces(S: Scalars, w: Floats, k: Integers, anew: int) -> None:
    """Let the ranges of the forces of the grouped contacts reach to what they are.

    Its guard stays armed if at all looks it has the same features, sticks by friction, and what bears it rests.
    """
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        _widen(S, w, k, normal_guard(c), hold_guard(S, w, k, c), anew)
        _widen(S, w, k, friction_guard(S, c), contact.static_margin, anew)
        normal = guard_at(S, w, k, normal_guard(c))
        if anew == 1:
            contact.feature, normal.armed = int(contact.feature_now), 1
        is_same = contact.beyond <= 0.0 and int(contact.feature_now) == contact.feature
        bears = _rests(S, w, k, contact.body_a, contact.frame_a) + _rests(S, w, k, contact.body_b, contact.frame_b)
        if not is_same or bears == 0 or contact.holds == 0:
            normal.armed = 0


@kernel("i8(S, F, I, i8)")
def _stays_far(S: Scalars, w: Floats, k: Integers, i: int) -> int:
    """Return 1 if a guard keeps so much of its greatest that it comes near no bound."""
    guard = guard_at(S, w, k, i)
    return 1 if guard.start > 0.0 and guard.start >= _KEPT * guard.end else 0


@kernel("f8(S, F, I, f8, f8)")
def _step_alone(S: Scalars, w: Floats, k: Integers, usual: float, longest: float) -> float:
    """Take a step of the bodies that may set off; return its length, or 0 where none was found."""
    wanted = min(S.h_course if S.h_course > 0.0 else usual, S.h_max)
    h = min(wanted, longest, S.course_end - S.t)
    for _attempt in range(_ATTEMPTS):
        error = explicit_step(S, w, k, h)
        factor = step_factor(error) if error < 1e300 else SHRINK
        if error <= 1.0:
            S.h_course = max(wanted, h * factor) if h < wanted else h * factor
            return float(h)
        h *= factor
        S.h_course = wanted = h
    return 0.0


@kernel("void(S, F, I, i8, f8)")
def _begin(S: Scalars, w: Floats, k: Integers, number: int, h: float) -> None:
    """Let a body be on the course that its step of ``h`` has found."""
    body = body_at(S, w, k, number)
    body.course, body.course_t, body.course_h = 1, S.t, h
    for part in range(2):
        first, n = (body.q, body.nq) if part == 0 else (S.n_q + body.u, body.nu)
        for i in range(first, first + n):
            w[S.course_start + i] = w[S.y + i]
            for stage in range(N_STAGES):
                w[S.course_slopes + stage * S.n_y + i] = w[S.slopes + stage * S.n_y + i]


@kernel("void(S, F, I, f8, f8)")
def set_off(S: Scalars, w: Floats, k: Integers, usual: float, longest: float) -> None:
    """Let bodies set off on their courses that can, where a step begins behind an event; bodies do not stand there.

    No course is longer than ``longest``; the first one that is tried is as long as is ``usual``.
    """
    if S.n_loads + S.n_joints + S.n_states > 0 or _find_riders(S, w, k) == 0:
        return
    stage_time = S.stage_time
    for i in range(S.n_grouped):
        contact_at(S, w, k, k[S.grouped + i]).least_force = 1e300
    slope(S, w, k, S.t, S.y, S.slopes, 0, 0)
    _look_at_forces(S, w, k, 1)
    h = _step_alone(S, w, k, usual, longest)
    S.stage_time = stage_time
    if h == 0.0:
        return
    _look_at_forces(S, w, k, 0)
    dense_state(S, w, S.y, S.slopes, S.n_y, h, 0.5, S.y_stage)
    right_hand_side(S, w, k, S.t + 0.5 * h, S.y_stage, 0, 0)
    _look_at_forces(S, w, k, 0)
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        _widen(S, w, k, normal_guard(c), contact.least_force, 0)
        far = _stays_far(S, w, k, normal_guard(c)) + _stays_far(S, w, k, friction_guard(S, c))
        if guard_at(S, w, k, normal_guard(c)).armed == 1 and far == 2:
            number = contact.body_b if body_at(S, w, k, contact.body_b).nu > 0 else contact.body_a
            _begin(S, w, k, number, h)
            S.course_end = min(S.course_end, S.t + h)


@kernel("i8(S, F, I, i8)")
def _is_off(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return 1 if a closed contact has left its constraints by more than a part of the tolerances."""
    contact = contact_at(S, w, k, c)
    if contact.mode == OPEN or contact.averaged != OPEN:
        return 0
    rate, gap = abs(contact.rate_end[0]), abs(contact.gap_end)
    if contact.normal_function != 0:
        rate = gap = 0.0
    if contact.mode == STICK:
        rate += abs(contact.slip_end[0]) + abs(contact.slip_end[1])
    return 1 if rate > _DRIFT * S.velocity_tolerance or gap > _DRIFT * S.gap_tolerance else 0


@kernel("i8(S, F, I)")
def drifted(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if some closed contact has left its constraints by more than a part of the tolerances."""
    for c in range(S.n_contacts):
        if _is_off(S, w, k, c) == 1:
            return 1
    return 0


@kernel("i8(S, F, I)")
def end_courses(S: Scalars, w: Floats, k: Integers) -> int:
    """End all courses at their common end, and before it those that have drifted; return how many."""
    ended, over = 0, S.course_end - S.t <= S.time_tolerance
    if over:
        S.course_end = math.inf
    for c in range(S.n_contacts):
        if is_on_course(S, w, k, c) == 1 and (over or _is_off(S, w, k, c) == 1):
            ended += end_courses_of(S, w, k, c)
    return ended
