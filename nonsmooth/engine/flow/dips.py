"""Looks into a step at open gaps that may close within it: that they stay open, or where one has closed.

Of a part of the step the gap and its rate are known at both ends, and how fast either can change
(:mod:`nonsmooth.engine.flow.clearance`).  Where these do not show that the gap stays open, the part is halved, until
they do, or the gap has closed at one of the ends, or no dip deeper than the gap tolerance has room.  A gap that is not
decided after very many halvings ends the run by name.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.bodies import evaluate_body, evaluate_driven_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_geometry, evaluate_rates
from nonsmooth.engine.flow.clearance import arm_of, fall_of, too_far
from nonsmooth.engine.flow.flight import body_within
from nonsmooth.engine.flow.flow import slip_guard
from nonsmooth.engine.flow.guard_numbers import friction_guard, normal_guard
from nonsmooth.engine.flow.guards import grown, has_fired
from nonsmooth.engine.flow.self_check import NEAR, NOUGHT, blame
from nonsmooth.engine.memory.layout import PARTS
from nonsmooth.engine.memory.modes import GAP_UNDECIDED
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    body_at,
    contact_at,
    entry_point,
    guard_at,
    kernel,
    part_end,
)
from nonsmooth.engine.numerics.vectors import distance

WAY = 0.02
"""Part of the size of the smaller body that features may move unseen where they do not face each other."""
_COARSE = 0.125
"""Part of a step to which the gap of neighbours at rest is looked at."""
_MOST_LOOKS = 10_000
"""Looks at one gap within one step; halving ends long before where a gap closes or is proved to stay open."""


@kernel("void(S, F, I, f8, f8, i8)")
def _put(S: Scalars, w: Floats, k: Integers, h: float, theta: float, c: int) -> None:
    """Put the two bodies of a contact where they are at a fraction of the step, and evaluate its geometry."""
    contact = contact_at(S, w, k, c)
    S.looked = 1
    for side in range(2):
        number = contact.body_a if side == 0 else contact.body_b
        body = body_at(S, w, k, number)
        if body.nu == 0:
            evaluate_driven_bodies(S, w, k, S.t + theta * h, S.y)
            continue
        state = S.y if theta == 0.0 else S.y_new
        if 0.0 < theta < 1.0:
            state = S.y_stage
            body_within(S, w, k, h, theta, number, state)
        evaluate_body(S, w, k, S.t + theta * h, state, number)
    evaluate_geometry(S, w, k, c)


@kernel("f8(S, F, I, f8, i8)")
def _largest_fall(S: Scalars, w: Floats, k: Integers, h: float, c: int) -> float:
    """Return how fast the rate of the gap of ``c`` can fall within the step, from how fast it can at its ends."""
    contact = contact_at(S, w, k, c)
    if contact.fall_first[0] < 0.0:
        _put(S, w, k, h, 0.0, c)
        contact.fall_first = fall_of(S, w, k, c, S.slopes + S.n_q)
    (first, grows_first, _), (last, grows_last, _) = contact.fall_first, contact.fall_end
    start, end = first + h * grows_first, last + h * grows_last
    return float(max(start, end) + abs(end - start))


@kernel("f8(S, F, I, i8, f8)")
def _above_start(S: Scalars, w: Floats, k: Integers, c: int, gap: float) -> float:
    """Return the gap, less what it started from if that was zero."""
    guard = guard_at(S, w, k, normal_guard(c))
    return float(gap - guard.start) if guard.deflated == 1 else gap


@kernel("void(S, F, I, i8, f8)")
def _write_gap_guard(S: Scalars, w: Floats, k: Integers, c: int, elapsed: float) -> None:
    """Write the guard of the gap of ``c``, which has been evaluated when this time of the step had elapsed."""
    contact, guard = contact_at(S, w, k, c), guard_at(S, w, k, normal_guard(c))
    contact.gap_rate = contact.rate[0]
    guard.value = grown(S, w, k, normal_guard(c), contact.gap, elapsed)


@kernel("void(S, F, I, f8, f8, i8)")
def look_at_gap(S: Scalars, w: Floats, k: Integers, h: float, theta: float, c: int) -> None:
    """Evaluate the gap of ``c`` alone at a fraction of the step, and write its guard."""
    _put(S, w, k, h, theta, c)
    evaluate_rates(S, w, k, c)
    _write_gap_guard(S, w, k, c, theta * h)


@kernel("void(S, F, I, f8, f8, i8)")
def look_at_slip(S: Scalars, w: Floats, k: Integers, h: float, theta: float, c: int) -> None:
    """Evaluate the slip of the rigid contact ``c`` alone at a fraction of the step, and write its guard."""
    _put(S, w, k, h, theta, c)
    evaluate_rates(S, w, k, c)
    i = friction_guard(S, c)
    guard_at(S, w, k, i).value = grown(S, w, k, i, slip_guard(S, w, k, c), theta * h)


@kernel("void(S, F, I, f8, f8, i8, i8)")
def _keep(S: Scalars, w: Floats, k: Integers, h: float, theta: float, c: int, n: int) -> None:
    """Keep end ``n`` of the parts of the step, at whose fraction ``theta`` the gap of ``c`` has been evaluated."""
    contact, guard, end = contact_at(S, w, k, c), guard_at(S, w, k, normal_guard(c)), part_end(w, S.part_ends, n)
    _write_gap_guard(S, w, k, c, theta * h)
    if guard.value > 0.0:
        guard.armed = 1
    end.theta, end.gap, end.rate = theta, _above_start(S, w, k, c, contact.gap), contact.gap_rate
    end.past, end.arm = contact.beyond, arm_of(S, w, k, c)


@kernel("void(S, F, I, f8, f8, i8, i8)")
def _look(S: Scalars, w: Floats, k: Integers, h: float, theta: float, c: int, n: int) -> None:
    """Evaluate the gap of ``c`` at a fraction of the step and keep it as end ``n`` of the parts of it."""
    look_at_gap(S, w, k, h, theta, c)
    _keep(S, w, k, h, theta, c, n)


@kernel("i8(F, i8, i8, f8, f8, f8, f8, f8, f8)")
def stays_open(
    w: Floats, ends: int, n: int, h: float, speed: float, fall: float, turning: float, lever: float, tolerance: float
) -> int:
    """Return 1 if a gap stays above minus the tolerance between ends 0 and ``n`` of a part of a step, by the bounds.

    It is above both parabolas that fall away from its ends, and lowest where they cross.  A witness point that moves
    farther on its body than the body turns, as on a rim next to flat, makes the rate fall by up to as much as two
    points so far apart can differ in.
    """
    one, two = part_end(w, ends, 0), part_end(w, ends, n)
    span = (two.theta - one.theta) * h
    g0, r0, g1, r1 = one.gap, one.rate, two.gap, two.rate
    if too_far(g0, one.past, g1, two.past, span * speed) == 1:
        return 1
    if one.past > 0.0 or two.past > 0.0 or min(g0, g1) < -tolerance:
        return 0
    if turning > 0.0:
        fall += 2.0 * turning * max(0.0, distance(two.arm, one.arm) / span - turning * lever)
    closing = fall * span + r1 - r0
    ahead = g0 - g1 + r1 * span + 0.5 * fall * span * span
    back = g1 - g0 - r0 * span + 0.5 * fall * span * span
    # the bound is not one if either parabola passes over the other end
    if min(ahead, back) < -tolerance:
        return 0
    if closing <= 0.0 or min(ahead, back) <= 0.0:
        return 1
    s = min(ahead / closing, span)
    return 1 if g0 + s * (r0 - 0.5 * fall * s) >= -tolerance else 0


@kernel("f8(S, F, I, f8, i8, f8, i8)")
def _first_dip(S: Scalars, w: Floats, k: Integers, h: float, c: int, high: float, stands: int) -> float:
    """Return a fraction of the step, up to ``high``, at which the gap of ``c`` has closed, or 0 if it stays open.

    It has been evaluated at ``high`` if the contact stands there (1).
    """
    contact = contact_at(S, w, k, c)
    left, right, n, looks = part_end(w, S.part_ends, 0), part_end(w, S.part_ends, 1), 1, 0
    left.theta, left.gap = 0.0, _above_start(S, w, k, c, contact.gap_first)
    left.rate, left.past, left.arm = contact.gap_rate_first, contact.past_first, contact.arm_first
    speed = contact.speed_first + contact.speed_end
    if high < 1.0:
        if stands == 1:
            _keep(S, w, k, h, high, c, 1)
        else:
            _look(S, w, k, h, high, c, 1)
        if too_far(left.gap, left.past, right.gap, right.past, high * h * speed) == 1:
            return 0.0
    else:
        right.theta, right.gap = 1.0, _above_start(S, w, k, c, contact.gap_end)
        right.rate, right.past, right.arm = contact.gap_rate_end, contact.past_end, contact.arm_end
    fall = _largest_fall(S, w, k, h, c)
    lever = min(contact.lever_a, contact.lever_b)
    turning = contact.turning_first + contact.turning_end if lever > 0.0 else 0.0
    while n > 0:
        right = part_end(w, S.part_ends, n)
        span = right.theta - left.theta
        if stays_open(w, S.part_ends, n, h, speed, fall, turning, lever, S.gap_tolerance) == 0 and n < PARTS:
            gaps, rates = max(abs(left.gap), abs(right.gap)), max(abs(left.rate), abs(right.rate))
            rests = gaps <= NEAR * S.gap_tolerance and rates <= NEAR * S.velocity_tolerance
            # closed from the start and moving with what holds the bodies: judged as has_fired judges it
            closed = guard_at(S, w, k, normal_guard(c)).deflated == 1
            rests = rests or (closed and rates <= NOUGHT * S.velocity_tolerance)
            astray = left.past > 0.0 or right.past > 0.0
            enough = span <= _COARSE and (rests or (astray and span * h * speed <= WAY * contact.size))
            if span * h > S.time_tolerance and not enough:
                n += 1
                S.gap_looks += 1
                looks += 1
                if looks > _MOST_LOOKS:
                    blame(S, GAP_UNDECIDED, c, left.gap, S.gap_tolerance)
                    return 0.0
                _look(S, w, k, h, left.theta + 0.5 * span, c, n)
                if has_fired(S, w, k, normal_guard(c)) == 1:
                    return float(part_end(w, S.part_ends, n).theta)
                continue
        left.theta, left.gap, left.rate, left.past, left.arm = right.theta, right.gap, right.rate, right.past, right.arm
        n -= 1
    return 0.0


@entry_point("f8(S, F, I, f8, f8, i8)")
def first_closing(S: Scalars, w: Floats, k: Integers, h: float, high: float, asked: int) -> float:
    """Return a fraction of the step, up to ``high``, by which a doubtful gap has closed, or 0 if all stay open.

    Contacts are to stand at ``high``, unless some are astray.  If none closes, those that were looked at stand at the
    end of the step again, if that is ``high``, and the contact ``asked`` at ``high`` in any case; what others report is
    not asked for at an event.
    """
    found = 0.0
    stands = 1 if S.n_astray == 0 else 0
    for i in range(S.n_doubtful):
        c = k[S.doubtful + i]
        S.looked = 0
        theta = _first_dip(S, w, k, h, c, high, stands)
        if theta > 0.0:
            found = high = theta
            stands = 0
        elif S.looked == 1 and (high == 1.0 or c == asked):
            _look(S, w, k, h, high, c, 0)
    return found
