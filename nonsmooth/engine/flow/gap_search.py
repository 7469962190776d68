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
from nonsmooth.engine.flow.deflation import deflated
from nonsmooth.engine.flow.flight import body_within
from nonsmooth.engine.flow.flow import value_of_slip_guard
from nonsmooth.engine.flow.guard_numbers import friction_guard, normal_guard
from nonsmooth.engine.flow.guards import has_fired
from nonsmooth.engine.flow.self_check import ADJACENT, NEGLIGIBLE, fail_check
from nonsmooth.engine.memory.layout import PARTS
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.native.kernel import (
    Floats,
    Workspace,
    entry_point,
    kernel,
    part_end,
)
from nonsmooth.engine.numerics.vectors import distance

LARGEST_DISPLACEMENT = 0.02
"""Part of the size of the smaller body that features may move unseen where they do not face each other."""
_LARGEST_PART = 0.125
"""Part of a step to which the gap of neighbours at rest is looked at."""
_MOST_EVALUATIONS = 10_000
"""Looks at one gap within one step; halving ends long before where a gap closes or is proved to stay open."""


@kernel("void(ws, f8, f8, i8)")
def _evaluate_geometry_at(ws: Workspace, h: float, theta: float, c: int) -> None:
    """Put the two bodies of a contact where they are at a fraction of the step, and evaluate its geometry."""
    contact = ws.contacts[c]
    ws.step.is_evaluated = True
    for side in range(2):
        number = contact.body_a if side == 0 else contact.body_b
        body = ws.bodies[number]
        if body.n_u == 0:
            evaluate_driven_bodies(ws, ws.island.time + theta * h, ws.island.y.start)
            continue
        state = ws.island.y.start if theta == 0.0 else ws.step.y_new.start
        if 0.0 < theta < 1.0:
            state = ws.step.y_stage.start
            body_within(ws, h, theta, number, state)
        evaluate_body(ws, ws.island.time + theta * h, state, number)
    evaluate_geometry(ws, c)


@kernel("f8(ws, f8, i8)")
def _acceleration_bound(ws: Workspace, h: float, c: int) -> float:
    """Return how fast the rate of the gap of ``c`` can fall within the step, from how fast it can at its ends."""
    contact = ws.contacts[c]
    if contact.acceleration_bound_at_start[0] < 0.0:
        _evaluate_geometry_at(ws, h, 0.0, c)
        contact.acceleration_bound_at_start = fall_of(ws, c, ws.island.slopes.start + ws.model.n_q)
    (first, grows_first, _), (last, grows_last, _) = (
        contact.acceleration_bound_at_start,
        contact.acceleration_bound_at_end,
    )
    start, end = first + h * grows_first, last + h * grows_last
    return float(max(start, end) + abs(end - start))


@kernel("f8(ws, i8, f8)")
def _gap_above_start(ws: Workspace, c: int, gap: float) -> float:
    """Return the gap, less what it started from if that was zero."""
    guard = ws.guards[normal_guard(c)]
    return float(gap - guard.base) if guard.is_deflated else gap


@kernel("void(ws, i8, f8)")
def _write_gap_guard(ws: Workspace, c: int, elapsed: float) -> None:
    """Write the guard of the gap of ``c``, which has been evaluated when this time of the step had elapsed."""
    contact, guard = ws.contacts[c], ws.guards[normal_guard(c)]
    contact.gap_rate = contact.rate[0]
    guard.value = deflated(ws, normal_guard(c), contact.gap, elapsed)


@kernel("void(ws, f8, f8, i8)")
def evaluate_gap_guard(ws: Workspace, h: float, theta: float, c: int) -> None:
    """Evaluate the gap of ``c`` alone at a fraction of the step, and write its guard."""
    _evaluate_geometry_at(ws, h, theta, c)
    evaluate_rates(ws, c)
    _write_gap_guard(ws, c, theta * h)


@kernel("void(ws, f8, f8, i8)")
def evaluate_slip_guard(ws: Workspace, h: float, theta: float, c: int) -> None:
    """Evaluate the slip of the rigid contact ``c`` alone at a fraction of the step, and write its guard."""
    _evaluate_geometry_at(ws, h, theta, c)
    evaluate_rates(ws, c)
    i = friction_guard(ws, c)
    ws.guards[i].value = deflated(ws, i, value_of_slip_guard(ws, c), theta * h)


@kernel("void(ws, f8, f8, i8, i8)")
def _store_end(ws: Workspace, h: float, theta: float, c: int, n: int) -> None:
    """Keep end ``n`` of the parts of the step, at whose fraction ``theta`` the gap of ``c`` has been evaluated."""
    contact, guard, end = ws.contacts[c], ws.guards[normal_guard(c)], part_end(ws.floats, ws.step.part_ends.start, n)
    _write_gap_guard(ws, c, theta * h)
    if guard.value > 0.0:
        guard.is_armed = True
    end.theta, end.gap, end.rate = theta, _gap_above_start(ws, c, contact.gap), contact.gap_rate
    end.past, end.arm = contact.past_feature, arm_of(ws, c)


@kernel("void(ws, f8, f8, i8, i8)")
def _evaluate_end(ws: Workspace, h: float, theta: float, c: int, n: int) -> None:
    """Evaluate the gap of ``c`` at a fraction of the step and keep it as end ``n`` of the parts of it."""
    evaluate_gap_guard(ws, h, theta, c)
    _store_end(ws, h, theta, c, n)


@kernel("b1(F, i8, i8, f8, f8, f8, f8, f8, f8)")
def stays_open(
    w: Floats, ends: int, n: int, h: float, speed: float, fall: float, turning: float, lever: float, tolerance: float
) -> bool:
    """Return 1 if a gap stays above minus the tolerance between ends 0 and ``n`` of a part of a step, by the bounds.

    It is above both parabolas that fall away from its ends, and lowest where they cross.  A witness point that moves
    farther on its body than the body turns, as on a rim next to flat, makes the rate fall by up to as much as two
    points so far apart can differ in.
    """
    one, two = part_end(w, ends, 0), part_end(w, ends, n)
    span = (two.theta - one.theta) * h
    g0, r0, g1, r1 = one.gap, one.rate, two.gap, two.rate
    if too_far(g0, one.past, g1, two.past, span * speed):
        return True
    if one.past > 0.0 or two.past > 0.0 or min(g0, g1) < -tolerance:
        return False
    if turning > 0.0:
        fall += 2.0 * turning * max(0.0, distance(two.arm, one.arm) / span - turning * lever)
    closing = fall * span + r1 - r0
    ahead = g0 - g1 + r1 * span + 0.5 * fall * span * span
    back = g1 - g0 - r0 * span + 0.5 * fall * span * span
    # the bound is not one if either parabola passes over the other end
    if min(ahead, back) < -tolerance:
        return False
    if closing <= 0.0 or min(ahead, back) <= 0.0:
        return True
    s = min(ahead / closing, span)
    return g0 + s * (r0 - 0.5 * fall * s) >= -tolerance


@kernel("f8(ws, f8, i8, f8, b1)")
def _first_dip(ws: Workspace, h: float, c: int, high: float, stands: bool) -> float:
    """Return a fraction of the step, up to ``high``, at which the gap of ``c`` has closed, or 0 if it stays open.

    It has been evaluated at ``high`` if the contact stands there (1).
    """
    contact = ws.contacts[c]
    left, right, n, looks = (
        part_end(ws.floats, ws.step.part_ends.start, 0),
        part_end(ws.floats, ws.step.part_ends.start, 1),
        1,
        0,
    )
    left.theta, left.gap = 0.0, _gap_above_start(ws, c, contact.gap_at_start)
    left.rate, left.past, left.arm = contact.gap_rate_at_start, contact.past_feature_at_start, contact.offset_at_start
    speed = contact.speed_at_start + contact.speed_at_end
    if high < 1.0:
        if stands:
            _store_end(ws, h, high, c, 1)
        else:
            _evaluate_end(ws, h, high, c, 1)
        if too_far(left.gap, left.past, right.gap, right.past, high * h * speed):
            return 0.0
    else:
        right.theta, right.gap = 1.0, _gap_above_start(ws, c, contact.gap_at_end)
        right.rate, right.past, right.arm = contact.gap_rate_at_end, contact.past_feature_at_end, contact.offset_at_end
    fall = _acceleration_bound(ws, h, c)
    lever = min(contact.support_radius_a, contact.support_radius_b)
    turning = contact.turning_bound_at_start + contact.turning_bound_at_end if lever > 0.0 else 0.0
    while n > 0:
        right = part_end(ws.floats, ws.step.part_ends.start, n)
        span = right.theta - left.theta
        if (
            not stays_open(ws.floats, ws.step.part_ends.start, n, h, speed, fall, turning, lever, ws.tolerance.gap)
            and n < PARTS
        ):
            gaps, rates = max(abs(left.gap), abs(right.gap)), max(abs(left.rate), abs(right.rate))
            rests = gaps <= ADJACENT * ws.tolerance.gap and rates <= ADJACENT * ws.tolerance.velocity
            # closed from the start and moving with what holds the bodies: judged as has_fired judges it
            closed = ws.guards[normal_guard(c)].is_deflated
            rests = rests or (closed and rates <= NEGLIGIBLE * ws.tolerance.velocity)
            astray = left.past > 0.0 or right.past > 0.0
            enough = span <= _LARGEST_PART and (rests or (astray and span * h * speed <= LARGEST_DISPLACEMENT * contact.size))
            if span * h > ws.tolerance.time and not enough:
                n += 1
                ws.totals.n_gap_evaluations += 1
                looks += 1
                if looks > _MOST_EVALUATIONS:
                    fail_check(ws, Status.GAP_UNDECIDED, c, left.gap, ws.tolerance.gap)
                    return 0.0
                _evaluate_end(ws, h, left.theta + 0.5 * span, c, n)
                if has_fired(ws, normal_guard(c)):
                    return float(part_end(ws.floats, ws.step.part_ends.start, n).theta)
                continue
        left.theta, left.gap, left.rate, left.past, left.arm = right.theta, right.gap, right.rate, right.past, right.arm
        n -= 1
    return 0.0


@entry_point("f8(ws, f8, f8, i8)")
def first_closing(ws: Workspace, h: float, high: float, asked: int) -> float:
    """Return a fraction of the step, up to ``high``, by which a doubtful gap has closed, or 0 if all stay open.

    Contacts are to stand at ``high``, unless some are astray.  If none closes, those that were looked at stand at the
    end of the step again, if that is ``high``, and the contact ``asked`` at ``high`` in any case; what others report is
    not asked for at an event.
    """
    found = 0.0
    stands = ws.step.n_not_facing == 0
    for i in range(ws.step.n_may_close):
        c = ws.step.may_close[i]
        ws.step.is_evaluated = False
        theta = _first_dip(ws, h, c, high, stands)
        if theta > 0.0:
            found = high = theta
            stands = False
        elif ws.step.is_evaluated and (high == 1.0 or c == asked):
            _evaluate_end(ws, h, high, c, 0)
    return found
