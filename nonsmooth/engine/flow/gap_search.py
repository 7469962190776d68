"""Search within a step for open gaps that close: proof that a gap stays open, or a time at which it has closed.

For a part of the step, the gap and its rate are known at both ends. Bounds are known of the gap's speed and of its
acceleration (:mod:`nonsmooth.engine.flow.clearance`). If these prove that the gap stays open, the part is done.
Otherwise the part is halved. The halving ends if the gap has closed at one of the ends, or if no dip deeper than the
gap tolerance is possible. Sampling alone would miss short dips, and a search for the minimum has no proof.

Features past their ends do not face each other, and have a gap without a rate. Nothing is proved of a part if they do
not face each other at one of its ends. Such a part is halved, too. If they face each other at neither end, the halving
ends at a small displacement.

``part_ends`` stores the ends of parts, with time, gap, rate and geometry of each. Between end 0 and end ``n`` is the
part in question, the first one that is not decided yet.

A gap that is undecided after very many evaluations ends the run.
"""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.engine.bodies.kinematics import evaluate_geometry, evaluate_rates
from nonsmooth.engine.flow.clearance import arm_of, fall_of, too_far
from nonsmooth.engine.flow.deflation import deflated
from nonsmooth.engine.flow.flight import evaluate_within
from nonsmooth.engine.flow.flow import value_of_slip_guard
from nonsmooth.engine.flow.guard_numbers import friction_guard, normal_guard, normal_of
from nonsmooth.engine.flow.guards import NO_GUARD, has_fired
from nonsmooth.engine.memory.layout import LAST_STAGE, NO_PAIR, PARTS
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, entry_point, kernel, part_end, result
from nonsmooth.engine.numerics.tolerances import ADJACENT, ALLOWED, NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import distance

_LARGEST_DISPLACEMENT = 0.02
"""Displacement, relative to the smaller body, below which features that do not face each other are not evaluated."""
_LARGEST_PART = 0.125
"""Fraction of a step within which the gap of neighbours at rest is always evaluated."""
_MOST_EVALUATIONS = 10_000
"""Most evaluations of one gap within one step: then a shorter step is taken. Few steps need so many."""


@result
class GapBounds(NamedTuple):
    """Bounds of the motion of a gap within a step."""

    speed: float
    """Of the rate of the gap [m/s]."""
    acceleration: float
    """Of the acceleration with which the gap closes [m/s^2]."""
    turning: float
    """Of the relative turning of the bodies [1/s], 0 if their witness points are fixed."""
    support_radius: float
    """Radius of the smaller shape about its origin [m]."""


@kernel("void(ws, f8, f8, ContactRecord)")
def _evaluate_geometry_at(ws: Workspace, h: float, theta: float, contact: ContactRecord) -> None:
    """Evaluate the two bodies of a contact at the fraction ``theta`` of the step of ``h`` [s], and its geometry."""
    evaluate_within(ws, h, theta, contact.body_a)
    evaluate_within(ws, h, theta, contact.body_b)
    evaluate_geometry(ws, contact.index)


@kernel("f8(ws, f8, ContactRecord)")
def _acceleration_bound(ws: Workspace, h: float, contact: ContactRecord) -> float:
    """Bound of the acceleration with which a gap closes within the step of ``h`` [s], from those at its ends [m/s^2].

    Each bound grows with the length of the step. The difference of the two is added, as within the step the
    acceleration may exceed both. If the bound at the start is not known, the bodies are evaluated there.
    """
    # NO_BOUND is negative: no step came before this one, or the gap was far from closing in it
    if contact.acceleration_bound_at_start[0] < 0.0:
        _evaluate_geometry_at(ws, h, theta=0.0, contact=contact)
        # the slope at the start holds the accelerations behind the n_q coordinate rates
        contact.acceleration_bound_at_start = fall_of(ws, contact.index, ws.island.slopes.start + ws.model.n_q)
    # each is a bound, its growth per second of the step, and a bound of the turning rate, which is not needed here
    first, grows_first, _ = contact.acceleration_bound_at_start
    last, grows_last, _ = contact.acceleration_bound_at_end
    start, end = first + h * grows_first, last + h * grows_last
    return float(max(start, end) + abs(end - start))


@kernel("f8(ws, ContactRecord, f8)")
def _gap_above_start(ws: Workspace, contact: ContactRecord, gap: float) -> float:
    """A gap [m], or its growth from the start value if it was closed when the step began (a deflated guard)."""
    guard = normal_of(ws, contact)
    return float(gap - guard.base) if guard.is_deflated else gap


@kernel("void(ws, ContactRecord, f8)")
def _write_gap_guard(ws: Workspace, contact: ContactRecord, elapsed: float) -> None:
    """Write the rate and the guard of a gap that was evaluated after ``elapsed`` [s] of the step."""
    # a copy, because later evaluations of the contact overwrite normal_rate
    contact.gap_rate = contact.normal_rate
    normal_of(ws, contact).value = deflated(ws, normal_guard(contact.index), contact.gap, elapsed)


@kernel("void(ws, f8, f8, i8)")
def evaluate_gap_guard(ws: Workspace, h: float, theta: float, c: int) -> None:
    """Evaluate the gap of contact ``c`` alone at the fraction ``theta`` of the step of ``h`` [s], and write its guard.

    A gap needs no forces, so only its two bodies are evaluated.
    """
    _evaluate_geometry_at(ws, h, theta, ws.contacts[c])
    evaluate_rates(ws, c)
    _write_gap_guard(ws, ws.contacts[c], theta * h)


@kernel("void(ws, f8, f8, i8)")
def evaluate_slip_guard(ws: Workspace, h: float, theta: float, c: int) -> None:
    """Evaluate the slip of the rigid contact ``c`` alone at the fraction ``theta`` of the step, and write its guard.

    The slip needs no forces, so only its two bodies are evaluated. The step is one of ``h`` [s].
    """
    _evaluate_geometry_at(ws, h, theta, ws.contacts[c])
    evaluate_rates(ws, c)
    i = friction_guard(ws, c)
    ws.guards[i].value = deflated(ws, i, value_of_slip_guard(ws, c), theta * h)


@kernel("void(ws, f8, f8, ContactRecord, i8)")
def _store_end(ws: Workspace, h: float, theta: float, contact: ContactRecord, n: int) -> None:
    """Store end ``n`` of the parts of a step: the gap as evaluated last, at the fraction ``theta``. Writes its guard.

    Stored are time, gap, gap rate, distance past the features, and offset of the witness point from the body's origin.
    A gap that is positive there arms its guard, so that it fires if it closes later in the step.
    """
    guard, end = normal_of(ws, contact), part_end(ws.floats, ws.step.part_ends.start, n)
    _write_gap_guard(ws, contact, theta * h)
    if guard.value > 0.0:
        guard.is_armed = True
    end.theta, end.gap, end.rate = theta, _gap_above_start(ws, contact, contact.gap), contact.gap_rate
    end.past, end.offset = contact.past_feature, arm_of(ws, contact.index)


@kernel("void(ws, f8, f8, ContactRecord, i8)")
def _evaluate_end(ws: Workspace, h: float, theta: float, contact: ContactRecord, n: int) -> None:
    """Evaluate the gap of a contact at the fraction ``theta`` of the step of ``h`` [s], and store it as end ``n``.

    End ``n`` is one of the ends of the parts of the step between which the gap is bounded.
    """
    evaluate_gap_guard(ws, h, theta, contact.index)
    _store_end(ws, h, theta, contact, n)


@kernel("b1(ws, i8, f8, GapBounds)")
def _stays_open(ws: Workspace, n: int, h: float, bounds: GapBounds) -> bool:
    """True if the bounds prove that a gap stays, within its tolerance, above the lower of 0 and its values at two ends.

    These are ends 0 and ``n`` of the parts. A gap at rest may be negative there, and a gap that closes at ``n`` is
    located by its own guard.

    With the acceleration bound a, the gap is above the parabolas g0 + r0 s - a s^2 / 2 from its start and
    g1 - r1 (T - s) - a (T - s)^2 / 2 from its end, after a time s of T. Their maximum is lowest where they cross.

    A witness point may move farther on its body than the body turns, as on a rim that is nearly flat. Then the rate
    changes by up to the difference of the rates of two points at that distance.
    """
    one, two = part_end(ws.floats, ws.step.part_ends.start, 0), part_end(ws.floats, ws.step.part_ends.start, n)
    span = (two.theta - one.theta) * h
    g0, r0, g1, r1 = one.gap, one.rate, two.gap, two.rate
    # the surfaces cannot move that far in the time
    if too_far(g0, one.past, g1, two.past, span * bounds.speed):
        return True
    # the bounds hold for features that face each other
    if one.past > 0.0 or two.past > 0.0:
        return False
    least = min(0.0, g0, g1) - ws.tolerance.gap
    acceleration, turning = bounds.acceleration, bounds.turning
    if turning > 0.0:
        # speed of the witness point over its body, of which what exceeds the turning of the body counts
        moved = distance(two.offset, one.offset) / span
        acceleration += 2.0 * turning * max(0.0, moved - turning * bounds.support_radius)
    # at the start the gap is `ahead` above the parabola from the end, at the end it is `back` above that from the start
    closing = acceleration * span + r1 - r0
    ahead = g0 - g1 + r1 * span + 0.5 * acceleration * span * span
    back = g1 - g0 - r0 * span + 0.5 * acceleration * span * span
    # the bound is wrong if either parabola passes above the other end
    if min(ahead, back) < -ws.tolerance.gap:
        return False
    # the parabolas do not cross within the part: the gap is lowest at one of its ends
    if closing <= 0.0 or min(ahead, back) <= 0.0:
        return True
    # the time at which they cross
    s = min(ahead / closing, span)
    return bool(g0 + s * (r0 - 0.5 * acceleration * s) >= least)


@kernel("f8(ws, f8, ContactRecord, f8, b1)")
def _first_closing_of(ws: Workspace, h: float, contact: ContactRecord, high: float, is_evaluated: bool) -> float:
    """Fraction of the step, up to ``high``, at which a gap has closed, or 0 if it stays open.

    ``is_evaluated`` is true if the contact was evaluated at ``high``. The step is cut into parts, searched from the
    left. End 0 is the left end of the present part, and is overwritten when that is decided. The ends to the right are
    a stack, whose top, end ``n``, is the right end. A part that is not decided is halved.
    """
    _write_first_end(ws, contact)
    _write_last_end(ws, h, contact, high, is_evaluated)
    left, right = part_end(ws.floats, ws.step.part_ends.start, 0), part_end(ws.floats, ws.step.part_ends.start, 1)
    speed = contact.speed_at_start + contact.speed_at_end
    # for the whole step this was tested when the gaps that may close were listed
    if high < 1.0 and too_far(left.gap, left.past, right.gap, right.past, high * h * speed):
        return 0.0
    bounds, n, n_evaluations = _bounds_of(ws, h, contact), 1, 0
    while n > 0:
        right = part_end(ws.floats, ws.step.part_ends.start, n)
        # with a full stack the part is shorter than doubles resolve, and its open ends decide
        if not _stays_open(ws, n, h, bounds) and n < PARTS and _is_undecided(ws, h, contact, n, speed):
            n_evaluations += 1
            if n_evaluations > _MOST_EVALUATIONS:
                # a shorter step is taken, so the result does not matter
                ws.step.is_undecided = True
                return 0.0
            middle = left.theta + 0.5 * (right.theta - left.theta)
            n += 1
            ws.totals.n_gap_evaluations += 1
            _evaluate_end(ws, h, middle, contact, n)
            if has_fired(ws, normal_guard(contact.index)):
                return float(part_end(ws.floats, ws.step.part_ends.start, n).theta)
            continue
        # the part is decided: the next one begins at its right end; left is end 0 itself, so this overwrites it
        left.theta, left.gap, left.rate = right.theta, right.gap, right.rate
        left.past, left.offset = right.past, right.offset
        n -= 1
    return 0.0


@kernel("void(ws, ContactRecord)")
def _write_first_end(ws: Workspace, contact: ContactRecord) -> None:
    """Write gap, rate and geometry at the start of the step, which are known, as end 0 of its parts."""
    left = part_end(ws.floats, ws.step.part_ends.start, 0)
    left.theta, left.gap = 0.0, _gap_above_start(ws, contact, contact.gap_at_start)
    left.rate, left.past = contact.gap_rate_at_start, contact.past_feature_at_start
    left.offset = contact.offset_at_start


@kernel("void(ws, f8, ContactRecord, f8, b1)")
def _write_last_end(ws: Workspace, h: float, contact: ContactRecord, high: float, is_evaluated: bool) -> None:
    """Write the fraction ``high`` of the step of ``h`` [s] as end 1 of its parts: the end of the search for closings.

    Values at the end of the step are known. Elsewhere the contact is evaluated, unless it ``is_evaluated`` there.
    """
    if high == 1.0:
        right = part_end(ws.floats, ws.step.part_ends.start, 1)
        right.theta, right.gap = 1.0, _gap_above_start(ws, contact, contact.gap_at_end)
        right.rate, right.past = contact.gap_rate_at_end, contact.past_feature_at_end
        right.offset = contact.offset_at_end
    elif is_evaluated:
        _store_end(ws, h, high, contact, n=1)
    else:
        _evaluate_end(ws, h, high, contact, n=1)


@kernel("GapBounds(ws, f8, ContactRecord)")
def _bounds_of(ws: Workspace, h: float, contact: ContactRecord) -> GapBounds:
    """Bounds of the motion of a gap within the step of ``h`` [s], from those at its ends.

    The sum of two bounds is used, because within the step a speed may exceed both.
    """
    acceleration = _acceleration_bound(ws, h, contact)
    radius = min(contact.support_radius_a, contact.support_radius_b)
    # the third of the bounds is that of the turning rate; a smaller shape of radius 0 is a ball about its origin
    bounds_at_start, bounds_at_end = contact.acceleration_bound_at_start, contact.acceleration_bound_at_end
    turning = bounds_at_start[2] + bounds_at_end[2] if radius > 0.0 else 0.0
    return GapBounds(contact.speed_at_start + contact.speed_at_end, acceleration, turning, radius)


@kernel("b1(ws, f8, ContactRecord, i8, f8)")
def _is_undecided(ws: Workspace, h: float, contact: ContactRecord, n: int, speed: float) -> bool:
    """True if the part of the step between ends 0 and ``n``, which the bounds do not decide, must be halved.

    Else the gaps at its ends decide. A part of the length of the time tolerance is not halved. Nor is a short part if
    the surfaces rest next to each other, or any part if they face each other at neither end and move by little at
    ``speed`` [m/s]. A gap that was closed from the start rests if its rate is round-off, as in :func:`has_fired`.
    """
    left, right = part_end(ws.floats, ws.step.part_ends.start, 0), part_end(ws.floats, ws.step.part_ends.start, n)
    span = right.theta - left.theta
    gaps, rates = max(abs(left.gap), abs(right.gap)), max(abs(left.rate), abs(right.rate))
    rests = gaps <= ADJACENT * ws.tolerance.gap and rates <= ADJACENT * ws.tolerance.velocity
    was_closed = normal_of(ws, contact).is_deflated
    rests = rests or (was_closed and rates <= NEGLIGIBLE * ws.tolerance.velocity)
    is_not_facing = left.past > 0.0 and right.past > 0.0
    moves_little = is_not_facing and span * h * speed <= _LARGEST_DISPLACEMENT * contact.size
    return span * h > ws.tolerance.time and not (span <= _LARGEST_PART and rests) and not moves_little


@entry_point("f8(ws, f8, f8, i8)")
def first_closing(ws: Workspace, h: float, high: float, needed: int) -> float:
    """Fraction of the step, up to ``high``, by which a gap that may close has closed, or 0 if all stay open.

    It need not be the first such time: after each closing, ``high`` becomes its time, and the other gaps are searched
    up to there. Contacts must be evaluated at ``high``. If no gap closes, the contacts that the search evaluated within
    the step are evaluated at ``high`` again: all of them if that is the end of the step, else only ``needed``, the
    contact whose guard was located there.
    """
    found, is_evaluated = 0.0, True
    for i in range(ws.step.n_may_close):
        contact = ws.contacts[ws.step.may_close[i]]
        body_a, body_b = ws.bodies[contact.body_a], ws.bodies[contact.body_b]
        # each evaluation of a body raises its version
        versions = body_a.version + body_b.version
        theta = _first_closing_of(ws, h, contact, high, is_evaluated)
        has_moved = body_a.version + body_b.version != versions
        if theta > 0.0:
            # the other contacts are not evaluated at this earlier time
            found = high = theta
            is_evaluated = False
        elif has_moved and (high == 1.0 or contact.index == needed):
            _evaluate_end(ws, h, high, contact, n=0)
    return found


@kernel("b1(ws, ContactRecord)")
def _may_face_between(ws: Workspace, contact: ContactRecord) -> bool:
    """True if features of an open rigid contact that do not face each other at either end of the step may do so within.

    They are features of neighbours whose gap is not among those that may close in the step.
    """
    if contact.mode != Mode.OPEN or contact.is_compliant or contact.pair == NO_PAIR:
        return False
    group, is_listed = ws.pairs[contact.pair], contact.acceleration_bound_at_end[0] >= 0.0
    are_neighbours = group.is_guarded and not group.is_watched
    return are_neighbours and not is_listed and min(contact.past_feature_at_start, contact.past_feature_at_end) > 0.0


@kernel("i8(ws, f8, f8)")
def find_new_overlap(ws: Workspace, h: float, theta: float) -> int:
    """Normal guard of an open gap that overlaps at the fraction ``theta`` of the step of ``h`` [s], or ``NO_GUARD``.

    The crossing of two nearly parallel edges runs along them, faster than the bodies move, when these tilt. So the
    bounds of the speed do not prove that edges that face each other at neither end of the step do not in between. A gap
    that overlaps beyond the tolerances is added to those that may close in the step.
    """
    for contact in ws.contacts:
        if not _may_face_between(ws, contact):
            continue
        _evaluate_geometry_at(ws, h, theta, contact)
        if contact.past_feature <= 0.0 and contact.gap < -ALLOWED * ws.tolerance.gap:
            _evaluate_geometry_at(ws, h, 1.0, contact)
            accelerations = ws.island.slopes.start + LAST_STAGE * ws.model.n_y + ws.model.n_q
            contact.acceleration_bound_at_end = fall_of(ws, contact.index, accelerations)
            ws.step.may_close[ws.step.n_may_close] = contact.index
            ws.step.n_may_close += 1
            evaluate_gap_guard(ws, h, theta, contact.index)
            return normal_guard(contact.index)
    return NO_GUARD
