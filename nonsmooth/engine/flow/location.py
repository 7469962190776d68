"""Locates the first event of a step, and steps exactly to it.

The root of a guard is found on the interpolant of the step.  If the tolerance limits the step, the root is corrected on
shorter steps, whose order is higher.  If another guard fires before, the search starts again with that guard.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.support import known_direction, separation_along
from nonsmooth.engine.flow.crossing import asks_forces, closed_before, guard_at, guards_within
from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.flow.gap_search import find_new_overlap
from nonsmooth.engine.flow.guard_numbers import (
    contact_of,
    first_end_guard,
    first_user_guard,
    number_of_guards,
)
from nonsmooth.engine.flow.guard_values import write_guards
from nonsmooth.engine.flow.guards import NO_GUARD, DependsOn, first_fired, is_gap, sign_depends_on
from nonsmooth.engine.flow.redundant_forces import blend_chosen_forces
from nonsmooth.engine.flow.step import try_step
from nonsmooth.engine.memory.layout import LAST_STAGE, NO_PAIR, PARTS
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.roots import SHORT, TRUSTED, weakened
from nonsmooth.engine.pairs.motion import rate_of

NEGLIGIBLE = 0.01
"""Error of a step, relative to the tolerance, up to which its interpolant locates an event without a further step."""
_FAINT = 1e-9
"""Start value of a guard, relative to its end value, up to which it is round-off, so that its sign is not trusted."""
_SHORTEST = 1e-4
"""Least time after the start at which a guard is evaluated, in fractions of the step: shorter ones are not resolved."""
_MOST_ROOTS = 30
"""Number of roots in one step, each earlier than the previous one, at which the motion is taken as not smooth.

The step is then shortened.
"""
_FEW_ROOTS = 4
"""Number of successively earlier roots above which a guard that is negative from the start shortens the step.

A guard that is negative from the start has no root in the step.
"""
_JUMP = 1e-3
"""Value of a guard right before its sign change, relative to its start value, above which it has a jump and no root."""
_NEARER = 0.5
"""Largest value of a guard, relative to its start value, at which Newton's estimate of its root is accepted."""
_SLOW = 3
"""Excess of slow over fast iterations above which the bracket of a root is bisected.

A slow iteration leaves more than half of the bracket.
"""
_FINE = 0.01
"""Accuracy of roots, relative to the time tolerance."""


@kernel("f8(ws, f8, f8, i8, b1)")
def _event_fraction(ws: Workspace, h: float, high: float, i: int, needs_forces: bool) -> float:
    """Fraction of the step at which guard ``i`` vanishes on the interpolant.

    Guard ``i`` must be evaluated at the fraction ``high``. Afterwards all guards are evaluated at the root, and
    ``guard_slope`` is the slope of guard ``i`` per second. If the guard jumps, the fraction is right behind the jump
    and the slope is minus infinity.
    """
    theta = _vanishing(ws, h, high, i, needs_forces)
    if sign_depends_on(ws, i) != DependsOn.FORCE:
        guards_within(ws, h, theta, needs_forces)
    return theta


@kernel("f8(ws, f8, f8, i8, b1)")
def _vanishing(ws: Workspace, h: float, high: float, i: int, needs_forces: bool) -> float:
    """The root of :func:`_event_fraction`, by the rule of Anderson and Bjorck, or by Newton's method for a gap.

    Afterwards guard ``i`` is evaluated at the root. If its sign depends on forces, all guards are evaluated there.
    """
    fine = _FINE * ws.tolerance.time
    low, g_low = 0.0, ws.guards[i].initial
    g_high = ws.guards[i].value
    ws.step.guard_slope = 0.0
    rises = ws.guards[i].initial <= 0.0 or ws.guards[i].is_deflated
    while g_low <= _FAINT * abs(g_high) and (rises or is_gap(ws, i)):
        # the guard was armed within the step, or rises from zero with unknown rate: seek a time at which it is positive
        low = 0.5 * high if low == 0.0 else 0.5 * low
        g_low = guard_at(ws, h, low, i, needs_forces)
        if low < _SHORTEST * high:
            if g_low > 0.0 or rises:
                return low
            # the guard was positive at the start and has its root right after it: the bracket is from the start to low
            high, g_high = low, g_low
            low, g_low = 0.0, ws.guards[i].initial
            break
    left = g_first = abs(g_low)
    theta = high - g_high * (high - low) / (g_high - g_low)
    theta_before, g_before = high, g_high
    slow = 0
    for _iteration in range(100):
        # if one end has a huge value, secants stay at the other end: bisect
        if not low < theta <= high or slow > _SLOW:
            theta = 0.5 * (low + high)
        g = guard_at(ws, h, theta, i, needs_forces)
        if theta != theta_before:
            ws.step.guard_slope = (g - g_before) / ((theta - theta_before) * h)
        theta_before, g_before = theta, g
        if is_gap(ws, i):
            ws.step.guard_slope = ws.contacts[contact_of(ws, i)].gap_rate
            if ws.guards[i].is_deflated:
                ws.step.guard_slope = (ws.step.guard_slope - g) / (theta * h)
        # accept no root while the guard is as large as at the start: across a jump the slope is steep, so that
        # Newton's estimate would be wrong. An end guard may be small right behind its jump: test its last positive
        # value, too
        size = max(abs(g), left) if i >= first_end_guard(ws) else abs(g)
        near = abs(g) <= -fine * ws.step.guard_slope and (size <= _NEARER * g_first or is_gap(ws, i))
        if g == 0.0 or (high - low) * h <= fine or near:
            left, span = (g, high - theta) if g > 0.0 else (left, theta - low)
            if left <= _JUMP * g_first or span * h > ws.tolerance.time or is_gap(ws, i):
                return float(theta)
            ws.step.guard_slope = -math.inf
            if g <= 0.0:
                return float(theta)
            guards_within(ws, h, high, needs_forces)
            return high
        way = high - low
        if g < 0.0:
            g_low = weakened(g_low, g, g_high)
            high, g_high = theta, g
        else:
            g_high = weakened(g_high, g, g_low)
            low, g_low = theta, g
            left = g
        slow = slow + 1 if high - low > 0.5 * way else max(slow - 1, 0)
        following = high - g_high * (high - low) / (g_high - g_low)
        if is_gap(ws, i) and ws.step.guard_slope < 0.0:
            newton = theta - g / (ws.step.guard_slope * h)
            if low < newton < high:
                following = newton
        theta = following
    return float(theta)


@kernel("v2(ws, f8, i8)")
def _value_and_slope(ws: Workspace, step: float, i: int) -> tuple[float, float]:
    """Value of guard ``i``, evaluated after a ``step`` [s], and its slope per second; of the meeting pair if no guard.

    Of a gap the slope is its rate. That of another guard is the one at its root on the interpolant.
    """
    if i == NO_GUARD:
        pair = ws.pairs[ws.step.meeting]
        return separation_along(ws, pair.index, known_direction(ws, pair)) - pair.level, rate_of(ws, pair)
    guard = ws.guards[i]
    value = guard.value - (guard.base if guard.is_deflated else 0.0)
    if is_gap(ws, i):
        return value, ws.contacts[contact_of(ws, i)].gap_rate
    return value / step if guard.is_deflated else value, ws.step.guard_slope


@kernel("f8(ws, f8, i8)")
def _corrected(ws: Workspace, root: float, i: int) -> float:
    """Make a step that ends at the root of guard ``i``, which the interpolant has at ``root`` [s].

    For ``NO_GUARD`` it is the root of the separation of the pair that meets.

    Returns the length of the step [s], or -1 if the step is inaccurate or has no root.
    """
    h, step = ws.step.h, root
    # the guard is positive before the first and not after the second of these steps
    early, late = 0.0, math.inf
    # Newton's method on the step length: two or three steps suffice, unless the guard is not smooth; then bisection
    for _halving in range(PARTS):
        ws.step.h = step
        blend_chosen_forces(ws, step / h)
        if not try_step(ws, step) <= TRUSTED:
            return -1.0
        write_guards(ws, ws.island.time + step, ws.step.y_new.start, forces_are_known=True)
        value, slope = _value_and_slope(ws, step, i)
        # the slope of a gap at rest is round-off, and gives no correction
        if not slope < (-ws.tolerance.velocity if i == NO_GUARD or is_gap(ws, i) else 0.0):
            return step
        correction = min(0.2 * root, max(-0.2 * root, -value / slope))
        if abs(correction) <= SHORT * h:
            # over so short a time the motion is linear
            for j in range(ws.model.n_y):
                ws.step.y_new[j] += correction * ws.island.slopes[LAST_STAGE * ws.model.n_y + j]
            return float(step + correction)
        if value > 0.0:
            early = step
        else:
            late = step
        if not early < step + correction < late:
            if late == math.inf or early == 0.0:
                return -1.0
            correction = 0.5 * (early + late) - step
        step += correction
    return -1.0


@entry_point("f8(ws, f8, f8)")
def locate(ws: Workspace, h: float, high: float) -> float:
    """Make a step that ends at the first event before the fraction ``high`` of the step of ``h`` [s].

    Returns the length of the new step [s]. ``ws.step.guard`` becomes the guard that fires. Unless the error of the step
    is negligible, the root on the interpolant is corrected by further steps, because the step has a higher order than
    its interpolant. The result is negative if a shorter step must be tried: if the new step is inaccurate, if many
    guards fire, so that the motion is not smooth, or if a guard jumps and the error of the step is not negligible.
    """
    closed = asks_forces(ws)
    first = first_fired(ws, forces_are_known=True, located=NO_GUARD)
    of_contact = 0 <= first < first_user_guard(ws)
    if ws.island.stage_time > 0.0 and of_contact and ws.contacts[contact_of(ws, first)].mode != Mode.OPEN:
        # refuse this implicit step: a shorter, explicit step locates an event of a closed contact
        return -1.0
    theta = high
    if first < 0 and ws.step.meeting != NO_PAIR:
        # parts meet at that fraction, and no guard has fired before
        first = find_new_overlap(ws, h, theta)
    fired = max(0, first)
    roots = 0
    while first >= 0 and roots < number_of_guards(ws):
        if closed and roots == _MOST_ROOTS:
            return -1.0
        if closed and roots > _FEW_ROOTS and ws.guards[first].initial < 0.0:
            return -1.0
        roots += 1
        later = theta
        theta = _event_fraction(ws, h, later, first, closed)
        if roots > 1 and ws.step.guard_slope == -math.inf and (later - theta) * h <= ws.tolerance.time:
            # both guards jump at the same time: keep the guard that was found before, and end the search
            first = -1
        else:
            fired = first
            first = first_fired(ws, closed, fired)
        # parts that meet after this root do not count
        ws.step.meeting = NO_PAIR
        if first < 0 and ws.step.n_may_close + ws.model.n_pairs > 0:
            earlier = closed_before(ws, h, theta, contact_of(ws, fired))
            if earlier > 0.0:
                theta, first = earlier, first_fired(ws, closed, NO_GUARD)
        if first < 0 and ws.model.n_pairs > 0:
            first = find_new_overlap(ws, h, theta)
    if first >= 0:
        # guards still fire before the last root: an earlier event may be hidden
        return -1.0
    ws.step.guard = fired
    step = theta * h
    if ws.step.meeting != NO_PAIR:
        if ws.step.error > NEGLIGIBLE:
            return _corrected(ws, step, NO_GUARD)
        state_within(ws, h, theta, ws.step.y_new.start)
        return step
    if ws.step.error <= NEGLIGIBLE:
        state_within(ws, h, theta, ws.step.y_new.start)
        return step
    # a jump has no root that Newton's method could correct: shorter steps, of negligible error, need no correction
    if ws.step.guard_slope == -math.inf:
        return -1.0
    return _corrected(ws, step, fired)
