"""First time within a step at which two parts of bodies meet that were apart.

The separation along any direction is a lower bound of the distance. So nothing has touched before its first root,
whatever the features of the bodies are. The search goes through the step from the left, part by part:

1. Predictions from both ends of the part, and a bound of accelerations, prove that it stays open.
2. If they do not, the direction of largest separation at the left end is searched, unless that was done not long
   before. It then changes at its rate there (:mod:`nonsmooth.engine.pairs.motion`).
3. If that does not suffice, the part is cut: at the root of the secant, or in the middle.
4. If the largest separation at the left end is zero within the tolerance, the parts meet there.

Sampling would miss short dips. The signed distance at the end of a step would miss thin bodies that passed through each
other. The cached direction is that of the time of impact in Box2D; the proof is added here.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.support import separation_along_held
from nonsmooth.engine.flow.flight import evaluate_within
from nonsmooth.engine.memory.layout import LAST_STAGE, NO_PAIR
from nonsmooth.engine.native.kernel import Pair, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.tolerances import ADJACENT, NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import dot, minus, scaled
from nonsmooth.engine.pairs.apart import budget, renew_direction
from nonsmooth.engine.pairs.motion import (
    acceleration_bound,
    length_of_direction,
    predicted_separation,
    rate_of,
    speed_of,
    speed_of_drift,
)

_MOST_EVALUATIONS = 10_000
"""Most parts of one step for which one pair is evaluated: then a shorter step is taken. Few steps need so many."""
_RENEWED = 0.5
"""The direction is searched again once the separation along it is below this part of its last largest value."""
_LITTLE = 1e-4
"""Displacement of the parts over which the rate of a direction is measured, relative to the size of the pair."""
_LESS = 1e-2
"""The same relative to the first displacement, if the direction jumps over that one: parts in contact overlap by it."""
_JUMP = 100.0
"""Change of a direction, over such a displacement, above which it jumps to other features, and has no rate."""
_NEWTON_STEPS = 3
"""Steps of Newton's method from a gap that is zero within the tolerance to its root. Each squares the error."""
_FINER = 8.0
"""Ratio of successive times at which two parts that touch at the start of a step are tested for being apart."""


@entry_point("void(ws, f8)")
def watch_pairs(ws: Workspace, h: float) -> None:
    """Find the pairs whose separation is searched for a root within the step of ``h`` [s], and where the search begins.

    A pair is searched while no contact of its shapes is closed. If its parts touch at the start of the step, the search
    begins once they are apart. If they stay next to each other, the contacts decide. Contacts of feet close within the
    clearance of a pair: there the contacts decide, too, but the separation of the parts without feet is searched.
    Bodies must be evaluated at the end of the step.
    """
    enough = ADJACENT * ws.tolerance.gap
    for pair in ws.pairs:
        group = ws.pairs[pair.group]
        if pair.index == pair.group:
            group.is_searched = group.is_watched = group.is_guarded and not group.is_closed
        pair.begin, pair.level = 0.0, pair.clearance
        if group.is_searched and not group.is_apart and budget(ws, pair) <= enough:
            pair.begin = _begin_of(ws, h, pair)
            group.is_watched = group.is_watched and pair.begin < 1.0
            if pair.begin == 1.0 and pair.clearance > 0.0:
                # within the clearance the parts without feet may touch: the search begins once they are apart
                pair.level = 0.0
                pair.begin = 0.0 if budget(ws, pair) + pair.clearance > enough else _begin_of(ws, h, pair)
            _evaluate(ws, h, 1.0, pair)


@entry_point("f8(ws, f8, f8)")
def first_meeting(ws: Workspace, h: float, high: float) -> float:
    """Fraction of the step of ``h`` [s], below ``high``, at which the first parts meet, or 0 if none do.

    Writes the pair to ``step.meeting``. Bodies are afterwards evaluated at ``high``, unless parts meet.
    """
    found, ws.step.meeting = 0.0, NO_PAIR
    for pair in ws.pairs:
        a, b = ws.carriers[pair.carrier_a], ws.carriers[pair.carrier_b]
        if not ws.pairs[pair.group].is_searched or pair.begin >= high:
            continue
        speed = a.speed_at_start + a.speed_at_end + b.speed_at_start + b.speed_at_end
        # the parts cannot have moved so far
        if budget(ws, pair) + pair.clearance - pair.level > high * h * speed:
            continue
        theta = _first_root(ws, h, pair, high)
        if theta > 0.0:
            found = high = theta
            ws.step.meeting = pair.index
        else:
            _evaluate(ws, h, high, pair)
    return found


@kernel("void(ws, f8, f8, Pair)")
def _evaluate(ws: Workspace, h: float, theta: float, pair: Pair) -> None:
    """Evaluate the two bodies of a pair at the fraction ``theta`` of the step of ``h`` [s]."""
    evaluate_within(ws, h, theta, ws.carriers[pair.carrier_a].body)
    evaluate_within(ws, h, theta, ws.carriers[pair.carrier_b].body)


@kernel("f8(ws, f8, f8, Pair)")
def _gap_at(ws: Workspace, h: float, theta: float, pair: Pair) -> float:
    """Separation along the direction of a pair at a fraction of the step, less that at which it meets [m]."""
    _evaluate(ws, h, theta, pair)
    return float(predicted_separation(ws, pair, theta * h - pair.searched, 0.0) - pair.level)


@kernel("f8(ws, f8, f8, Pair)")
def _renewed_gap(ws: Workspace, h: float, theta: float, pair: Pair) -> float:
    """Largest separation at the fraction ``theta`` of the step, less that at which the pair meets [m].

    Stores its direction.
    """
    _evaluate(ws, h, theta, pair)
    pair.drift, pair.searched = (0.0, 0.0, 0.0), theta * h
    return float(renew_direction(ws, pair) - pair.level)


@kernel("void(ws, f8, f8, Pair)")
def _measure_drift(ws: Workspace, h: float, theta: float, pair: Pair) -> None:
    """Measure the rate of the direction of a pair, which was searched at the fraction ``theta`` of the step."""
    n, facing, speed = pair.direction, pair.facing, speed_of(ws, pair)
    little = _LITTLE
    for _ in range(2):
        later = min(theta + little * pair.size / (speed * h), 1.0) if speed > 0.0 else theta
        if later <= theta:
            return
        _renewed_gap(ws, h, later, pair)
        span, change = (later - theta) * h, minus(pair.direction, n)
        pair.direction, pair.facing, pair.searched = n, facing, theta * h
        if dot(change, change) <= (_JUMP * little) ** 2:
            pair.drift = scaled(1.0 / span, change)
            return
        little *= _LESS


@kernel("f8(ws, f8, Pair)")
def _begin_of(ws: Workspace, h: float, pair: Pair) -> float:
    """First tested fraction of the step at which two parts are apart that touch at its start; 1 if none is.

    It is 1, too, if they come nearer first, as one corner may close just after another one has opened: the contacts
    decide. They must be apart along the direction at the start: parts that passed through each other are apart along
    others. That direction is held by either part. Of a disc that rocks on a face, the plane of the face separates them,
    or that of the disc, and not both.
    """
    enough, speed = ADJACENT * ws.tolerance.gap, speed_of(ws, pair)
    least = min(_renewed_gap(ws, h, 0.0, pair), 0.0) - enough
    # neighbours at rest stay next to each other
    if h * (speed + speed_of(ws, pair)) <= enough:
        return 1.0
    elapsed = ws.tolerance.time
    while elapsed < h:
        _evaluate(ws, h, elapsed / h, pair)
        gap = separation_along_held(ws, pair) - pair.level
        if gap > enough:
            return elapsed / h
        if gap < least:
            return 1.0
        elapsed *= _FINER
    return 1.0


@kernel("f8(ws, f8, Pair)")
def _acceleration_within(ws: Workspace, h: float, pair: Pair) -> float:
    """Bound of the acceleration of the second part within the step of ``h`` [s], from those at its ends [m/s^2]."""
    _evaluate(ws, h, 1.0, pair)
    end = acceleration_bound(ws, pair, ws.island.slopes.start + LAST_STAGE * ws.model.n_y + ws.model.n_q)
    _evaluate(ws, h, 0.0, pair)
    start = acceleration_bound(ws, pair, ws.island.slopes.start + ws.model.n_q)
    # within the step it may exceed both
    return max(start, end) + abs(end - start)


@kernel("f8(ws, f8, Pair, f8)")
def _first_root(ws: Workspace, h: float, pair: Pair, high: float) -> float:
    """Fraction of the step of ``h`` [s], up to ``high``, at which the parts meet, or 0 if they stay apart.

    The present part of the step is from ``theta`` to ``last``. All before it is proved open.
    """
    if _cannot_reach(ws, h, pair, high):
        return 0.0
    theta, last, is_cut_by_secant = pair.begin, high, False
    acceleration, gap = _acceleration_within(ws, h, pair), _renewed_gap(ws, h, theta, pair)
    known, shortest = gap, NEGLIGIBLE * ws.tolerance.time
    _measure_drift(ws, h, theta, pair)
    for _ in range(_MOST_EVALUATIONS):
        span = last - theta
        is_short = span * h <= shortest
        is_open = _stays_open(ws, h, pair, theta, span, acceleration)
        if is_open:
            theta, last = last, min(high, last + 2.0 * span)
            if theta >= high:
                return 0.0
        gap = _gap_at(ws, h, theta, pair)
        if is_short or gap <= max(ws.tolerance.gap, _RENEWED * known):
            known = _renewed_gap(ws, h, theta, pair)
            # in a short part the gap is known up to its change in the time tolerance
            if known <= ws.tolerance.gap + (ws.tolerance.time * speed_of(ws, pair) if is_short else 0.0):
                return _meeting_time(ws, h, pair, theta, known, acceleration)
            _measure_drift(ws, h, theta, pair)
            last = high if is_short else last
        elif not is_open:
            # a secant that leads to a part which is not open either is followed by the middle
            gap_at_last = _gap_at(ws, h, last, pair)
            is_cut_by_secant = gap_at_last < 0.0 and not is_cut_by_secant
            last = theta + span * (gap / (gap - gap_at_last) if is_cut_by_secant else 0.5)
    ws.step.is_undecided = True
    return 0.0


@kernel("b1(ws, f8, Pair, f8)")
def _cannot_reach(ws: Workspace, h: float, pair: Pair, high: float) -> bool:
    """True if the parts cannot come as near as contacts need, up to the fraction ``high``, by their speeds."""
    begin = pair.begin
    pair.drift, pair.searched = (0.0, 0.0, 0.0), begin * h
    is_known = dot(pair.direction, pair.direction) > 0.0
    gap = _gap_at(ws, h, begin, pair) if is_known else _renewed_gap(ws, h, begin, pair)
    speed = speed_of(ws, pair)
    gap += _gap_at(ws, h, high, pair)
    return gap > (high - begin) * h * (speed + speed_of(ws, pair))


@kernel("f8(ws, f8, Pair, f8, f8, f8)")
def _meeting_time(ws: Workspace, h: float, pair: Pair, theta: float, gap: float, acceleration: float) -> float:
    """Fraction of the step of ``h`` [s] at which parts meet that are evaluated at ``theta``.

    There the ``gap`` [m] is zero within the tolerance, and Newton's method finds its root. It stays so near that the
    ``acceleration`` [m/s^2] changes the gap by no more than that tolerance.
    """
    longest = math.sqrt(2.0 * ws.tolerance.gap / acceleration) if acceleration > 0.0 else math.inf
    at = theta
    for _ in range(_NEWTON_STEPS):
        rate = rate_of(ws, pair)
        if rate >= 0.0 or abs((at - theta) * h - gap / rate) > longest:
            break
        at -= gap / (rate * h)
        gap = _gap_at(ws, h, at, pair)
    return float(max(at, NEGLIGIBLE * ws.tolerance.time / h))


@kernel("b1(ws, f8, Pair, f8, f8, f8)")
def _stays_open(ws: Workspace, h: float, pair: Pair, theta: float, span: float, acceleration: float) -> bool:
    """True if parts are proved to stay apart, up to the gap tolerance, in a ``span`` of the step from ``theta`` on.

    Either end decides on the half next to it, for which it predicts the separation. The least of linear functions of
    time is least at an end of that half. Accelerations lower it by at most half their bound times the square of half
    the span. ``acceleration`` [m/s^2] is that of the points of the second part.
    """
    least, half, bound = math.inf, 0.5 * span * h, acceleration
    for end in range(2):
        at, later = (theta + end * span), (half if end == 0 else -half)
        elapsed = at * h - pair.searched
        _evaluate(ws, h, at, pair)
        gap = predicted_separation(ws, pair, elapsed, 0.0)
        least = min(least, gap - pair.level, predicted_separation(ws, pair, elapsed, later) - pair.level)
        bound = max(bound, acceleration * length_of_direction(ws, pair, elapsed) + speed_of_drift(ws, pair))
    return least - 0.5 * bound * half * half >= -ws.tolerance.gap
