"""Location of the first guard that fires within an accepted step, and the step that ends there.

1. The root of a fired guard is bracketed on the interpolant of the step, by the rule of Anderson and Bjorck
   (:mod:`nonsmooth.engine.numerics.roots`). If another guard has fired before that root, its root is next.
2. The step is taken again to the root. The interpolant is of lower order than the step, so the guard is not quite zero
   there: Newton's method, with the slope of the guard on the interpolant, corrects the length of the step.

The correction costs two or three steps, and makes the error of a switch that of a step. A root on the interpolant alone
would leave an error of lower order at every switch, and the phases of an impact are short.
"""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.engine.impact.guards import NO_GUARD, TOGETHER, evaluate_impact_guards, first_fired, write_impact_guards
from nonsmooth.engine.impact.state import state_size
from nonsmooth.engine.impact.step import try_impact_step
from nonsmooth.engine.memory.layout import LAST_STAGE
from nonsmooth.engine.native.kernel import ImpactGuard, Workspace, kernel, result
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.arrays import subtract_part
from nonsmooth.engine.numerics.roots import SHORT, TRUSTED, weakened
from nonsmooth.engine.numerics.runge_kutta import dense_state

_NEAR = 1e-11
"""Value [1] at which a root on the interpolant is found. The step itself is corrected afterwards."""
_SMALL = 1e-3
"""Value at which a root is accepted, relative to the largest value of its guard in the step.

It is needed for guards whose values are all below ``_NEAR``.
"""
_NARROW = 1e-14
"""Width of the bracket of a root, in fractions of the step, below which it is round-off, and the search ends."""
_ITERATIONS = 60
"""Maximum number of iterations for a root on the interpolant. It ends a search among round-off."""
_VIOLATED_FROM_START = 1e-3
"""Fraction of the step that is taken for a guard that is negative from the start. It has no root in the step."""
_CORRECTIONS = 8
"""Maximum number of steps to a switch. Two or three suffice."""
_LARGEST_CORRECTION = 0.2
"""Largest correction of a step to a switch, relative to its length. The slope of the guard may be poor."""


@result
class Root(NamedTuple):
    """Where a guard of an impact vanishes within a step."""

    guard: int
    """The guard, or ``NO_GUARD``."""
    theta: float
    """Fraction of the step."""
    slope: float
    """Slope of the guard there, per pseudo-time, or 0 if it is unknown."""


@result
class Switch(NamedTuple):
    """A step that ends at a switch of phases, or an accepted step without one."""

    guard: int
    """Guard that has fired, or ``NO_GUARD``."""
    error: float
    """Error of the step, relative to the tolerance. It is 0 for a step that was accepted as it is."""


@kernel("Switch(ws, f8, i8)")
def locate_switch(ws: Workspace, h: float, fired: int) -> Switch:
    """Step to the first guard that fires within ``h``. The guard ``fired`` is negative at the end of the step.

    The error is one of a part of an accepted step, unless the motion is less smooth than it seemed.
    """
    root = _first_root(ws, h, fired)
    step, error = root.theta * h, 0.0
    bound = _LARGEST_CORRECTION * root.theta * h
    for iteration in range(_CORRECTIONS):
        error = try_impact_step(ws, step)
        ws.totals.n_impact_steps += 1
        write_impact_guards(ws, ws.impact.y_new.start)
        if not (root.slope < 0.0 and error <= TRUSTED) or iteration == _CORRECTIONS - 1:
            break
        correction = min(bound, max(-bound, -ws.impact_guards[root.guard].value / root.slope))
        if abs(correction) <= SHORT * h:
            # along the slope at the end; the error of this is the square of the correction
            n = state_size(ws)
            subtract_part(ws.floats, ws.impact.y_new.start, -correction, ws.impact.slopes.start + LAST_STAGE * n, n)
            break
        step += correction
    evaluate_impact_guards(ws, ws.impact.y_new.start)
    return Switch(guard=root.guard, error=error)


@kernel("Root(ws, f8, i8)")
def _first_root(ws: Workspace, h: float, fired: int) -> Root:
    """First root of a guard on the interpolant of a step of ``h``, at whose end the guards are evaluated.

    Each root found is the end of the search for the next one, until no other guard has fired before it. Guards that are
    negative from the start would shorten the step to zero in turn, so the first of them ends the search.
    """
    root = Root(guard=fired, theta=1.0, slope=0.0)
    following = first_fired(ws, NO_GUARD)
    for _ in range(len(ws.impact_guards)):
        if following == NO_GUARD:
            break
        guard = ws.impact_guards[following]
        root = _root(ws, guard, h, root.theta)
        if guard.at_start <= 0.0:
            break
        following = first_fired(ws, root.guard)
        if following != NO_GUARD and ws.impact_guards[following].value >= -TOGETHER:
            break
    return root


@kernel("Root(ws, ImpactGuard, f8, f8)")
def _root(ws: Workspace, guard: ImpactGuard, h: float, high: float) -> Root:
    """Root of a guard on the interpolant of a step of ``h``, between its start and the fraction ``high`` of it.

    Before: the guards are evaluated at ``high``. After: at the root, unless the guard is negative from the start.
    """
    low, g_low, g_high = 0.0, guard.at_start, guard.value
    if g_low <= 0.0:
        return Root(guard=guard.index, theta=_VIOLATED_FROM_START * high, slope=0.0)
    theta = theta_before = high
    g_before, largest = g_high, g_low
    slope = (g_high - g_low) / ((high - low) * h)
    for _ in range(_ITERATIONS):
        theta = high - g_high * (high - low) / (g_high - g_low)
        _evaluate_at(ws, h, theta)
        g = guard.value
        # a slope over a smaller difference would be round-off
        if abs(theta - theta_before) > SHORT:
            slope = (g - g_before) / ((theta - theta_before) * h)
        theta_before, g_before = theta, g
        largest = max(largest, g)
        if abs(g) <= min(_NEAR, _SMALL * largest) or high - low <= _NARROW:
            break
        if g < 0.0:
            g_low = weakened(g_low, g, g_high)
            high, g_high = theta, g
        else:
            g_high = weakened(g_high, g, g_low)
            low, g_low = theta, g
    return Root(guard=guard.index, theta=theta, slope=slope)


@kernel("void(ws, f8, f8)")
def _evaluate_at(ws: Workspace, h: float, theta: float) -> None:
    """Evaluate the guards at the fraction ``theta`` of a step of ``h``, on its interpolant."""
    interrupted(ws, len(ws.actives))
    y = ws.impact.y_stage.start
    dense_state(ws, ws.impact.y.start, ws.impact.slopes.start, state_size(ws), h, theta, y)
    evaluate_impact_guards(ws, y)
