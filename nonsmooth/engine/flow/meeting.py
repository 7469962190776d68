"""First time within a step at which two parts of bodies meet that were apart.

The separation s(n) along a direction n that is fixed to one of the parts is a lower bound of the distance. So nothing
has touched before its first root, whatever the features of the bodies are. The search goes through the step from the
left, part by part:

1. Predictions of s(n) from both ends of the part, and a bound of the acceleration, prove that it stays open.
2. If they do not, n becomes the direction of largest separation at the left end, unless that was done not long before.
3. If that does not suffice, the part is cut: at the root of the secant, or in the middle.
4. If the largest separation at the left end is zero within the tolerance, the parts meet there.

Sampling would miss short dips. The signed distance at the end of a step would miss thin bodies that passed through each
other. The cached direction is that of the time of impact in Box2D; the proof is added here.
"""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.engine.flow.flight import evaluate_within
from nonsmooth.engine.flow.self_check import fail_check
from nonsmooth.engine.memory.layout import LAST_STAGE, NO_PAIR
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.native.kernel import Pair, Workspace, entry_point, kernel, result
from nonsmooth.engine.numerics.tolerances import ADJACENT, NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import dot
from nonsmooth.engine.pairs.apart import budget, renew_direction
from nonsmooth.engine.pairs.motion import (
    acceleration_bound,
    fix_direction,
    predicted_separation,
    rate_of,
    separation_of,
    speed_of,
)

_MOST_EVALUATIONS = 10_000
"""Most parts of one step for which one pair is evaluated. Halving down to the time tolerance needs far fewer."""
_RENEWED = 0.5
"""The direction is searched again once the separation along it is below this part of its last largest value."""
_FINER = 8.0
"""Ratio of successive times at which two parts that touch at the start of a step are tested for being apart."""
_SHORTEST = 1e-3
"""Least time until parts meet, in time tolerances: an event ends a step."""


@result
class Forecast(NamedTuple):
    """What one end of a part of the step tells about the pair within that part."""

    gap: float
    """Separation at this end, less that at which contacts may close [m]."""
    least: float
    """Lower bound of it in the half of the part next to this end, without the effect of accelerations [m]."""
    speed: float
    """Bound of its rate at this end [m/s]."""


@entry_point("f8(ws, f8, f8)")
def first_meeting(ws: Workspace, h: float, high: float) -> float:
    """Fraction of the step of ``h`` [s], below ``high``, at which the first parts meet, or 0 if none do.

    Writes the pair to ``step.meeting``. Bodies are afterwards evaluated at ``high``, unless parts meet.
    """
    found, ws.step.meeting = 0.0, NO_PAIR
    for pair in ws.pairs:
        group, a, b = ws.pairs[pair.group], ws.carriers[pair.carrier_a], ws.carriers[pair.carrier_b]
        if not group.is_guarded or group.is_closed:
            continue
        speed = a.speed_at_start + a.speed_at_end + b.speed_at_start + b.speed_at_end
        # the parts cannot have moved so far
        if budget(ws, pair) > high * h * speed:
            continue
        begin = 0.0 if group.is_apart else _begin_of(ws, h, pair, high)
        theta = _first_root(ws, h, pair, begin, high) if begin < high else 0.0
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
    ws.totals.n_gap_evaluations += 1


@kernel("Forecast(ws, f8, f8, f8, Pair)")
def _forecast(ws: Workspace, h: float, theta: float, reach: float, pair: Pair) -> Forecast:
    """Forecast of a pair from the fraction ``theta`` of the step of ``h`` [s], up to ``theta + reach``."""
    _evaluate(ws, h, theta, pair)
    gap = separation_of(ws, pair) - pair.clearance
    # the least of linear functions of time is least at an end
    return Forecast(gap, min(gap, predicted_separation(ws, pair, reach * h) - pair.clearance), speed_of(ws, pair))


@kernel("f8(ws, f8, f8, Pair)")
def _renewed_gap(ws: Workspace, h: float, theta: float, pair: Pair) -> float:
    """Largest separation at the fraction ``theta`` of the step, less that at which contacts may close [m].

    Stores its direction, fixed to the part for which it lasts longer.
    """
    _evaluate(ws, h, theta, pair)
    separation, speed = renew_direction(ws, pair), speed_of(ws, pair)
    if speed > 0.0:
        # the time after which the parts may meet
        fix_direction(ws, pair, max(separation - pair.clearance, ws.tolerance.gap) / speed)
    return float(separation - pair.clearance)


@kernel("f8(ws, f8, Pair, f8)")
def _begin_of(ws: Workspace, h: float, pair: Pair, high: float) -> float:
    """First tested fraction of the step at which two parts are apart that touch at its start; ``high`` if none is."""
    enough = ADJACENT * ws.tolerance.gap
    _evaluate(ws, h, high, pair)
    speed = speed_of(ws, pair)
    _evaluate(ws, h, 0.0, pair)
    # neighbours at rest stay next to each other
    if high * h * (speed + speed_of(ws, pair)) <= enough:
        return high
    elapsed = ws.tolerance.time
    while elapsed < high * h:
        if _renewed_gap(ws, h, elapsed / h, pair) > enough:
            return elapsed / h
        elapsed *= _FINER
    return high


@kernel("f8(ws, f8, Pair)")
def _acceleration_within(ws: Workspace, h: float, pair: Pair) -> float:
    """Bound of the acceleration of the moving part within the step of ``h`` [s], from those at its ends [m/s^2]."""
    _evaluate(ws, h, 1.0, pair)
    end = acceleration_bound(ws, pair, ws.island.slopes.start + LAST_STAGE * ws.model.n_y + ws.model.n_q)
    _evaluate(ws, h, 0.0, pair)
    start = acceleration_bound(ws, pair, ws.island.slopes.start + ws.model.n_q)
    # within the step it may exceed both
    return max(start, end) + abs(end - start)


@kernel("f8(ws, f8, Pair, f8, f8)")
def _first_root(ws: Workspace, h: float, pair: Pair, begin: float, high: float) -> float:
    """Fraction of the step of ``h`` [s], from ``begin`` to ``high``, at which the parts meet, or 0 if they stay apart.

    The present part of the step is from ``theta`` to ``last``. All before it is proved open.
    """
    if dot(pair.direction, pair.direction) == 0.0:
        _renewed_gap(ws, h, begin, pair)
    theta, last, is_cut_by_secant = begin, high, False
    acceleration, fixed = _acceleration_within(ws, h, pair), pair.is_fixed_to_second
    known, gap = -1.0, 0.0
    for _ in range(_MOST_EVALUATIONS):
        span = last - theta
        left, right = _forecast(ws, h, theta, 0.5 * span, pair), _forecast(ws, h, last, -0.5 * span, pair)
        is_open = _stays_open(ws, span * h, left, right, acceleration)
        is_short = span * h <= NEGLIGIBLE * ws.tolerance.time
        gap = right.gap if is_open else left.gap
        if is_open:
            theta, last = last, min(high, last + 2.0 * span)
            if theta >= high:
                return 0.0
        if is_short or gap <= max(ws.tolerance.gap, _RENEWED * known) or known < 0.0:
            known = _renewed_gap(ws, h, theta, pair)
            # in a short part the gap is known up to its change in the time tolerance
            if known <= ws.tolerance.gap + (ws.tolerance.time * left.speed if is_short else 0.0):
                return _meeting_time(ws, h, pair, theta, known)
            if fixed != pair.is_fixed_to_second:
                acceleration, fixed = _acceleration_within(ws, h, pair), pair.is_fixed_to_second
            last = high if is_short else last
        elif not is_open:
            # a secant that leads to a part which is not open either is followed by the middle
            is_cut_by_secant = right.gap < 0.0 and not is_cut_by_secant
            last = theta + span * (left.gap / (left.gap - right.gap) if is_cut_by_secant else 0.5)
    fail_check(ws, Status.GAP_UNDECIDED, pair.contact, gap, ws.tolerance.gap)
    return 0.0


@kernel("f8(ws, f8, Pair, f8, f8)")
def _meeting_time(ws: Workspace, h: float, pair: Pair, theta: float, gap: float) -> float:
    """Fraction of the step of ``h`` [s] at which parts meet that are evaluated at ``theta``.

    There the ``gap`` [m] is zero within the tolerance.
    """
    rate = rate_of(ws, pair)
    # of a slow approach the root is not sharp: it stays within the time tolerance
    later = min(-gap / rate, ws.tolerance.time) if rate < 0.0 else 0.0
    return float(max(theta + later / h, _SHORTEST * ws.tolerance.time / h))


@kernel("b1(ws, f8, Forecast, Forecast, f8)")
def _stays_open(ws: Workspace, span: float, left: Forecast, right: Forecast, acceleration: float) -> bool:
    """True if parts are proved to stay apart in a ``span`` [s] between two ends, up to the gap tolerance.

    Either end decides on the half next to it. The effect of accelerations there is at most half the bound of the
    ``acceleration`` [m/s^2] times the square of half the span.
    """
    if left.gap + right.gap > span * (left.speed + right.speed):
        return True
    return min(left.least, right.least) - 0.125 * acceleration * span * span >= -ws.tolerance.gap
