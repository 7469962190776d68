"""Derivatives of maps by finite differences between runs with equal sequences of events, and their error bounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput, NonsmoothError, RunFailed
from nonsmooth.studies.derivatives.flow import Signature
from nonsmooth.types import Array

Stencil = tuple[tuple[int, float], ...]
"""Terms of a finite difference: offset in steps, and weight."""
Sampled = Callable[[float], tuple[Array, Signature]]
"""Function from a change of the argument to the value of the differentiated map, shape [m], and the events of the run
that computes this value."""
CENTRAL: Stencil = ((-2, 1.0 / 12.0), (-1, -2.0 / 3.0), (1, 2.0 / 3.0), (2, -1.0 / 12.0))
"""Central difference of fourth order."""
FORWARD: Stencil = ((0, -25.0 / 12.0), (1, 4.0), (2, -3.0), (3, 4.0 / 3.0), (4, -0.25))
"""Forward difference of fourth order: all changes are positive or zero."""
BACKWARD: Stencil = tuple((-i, -weight) for i, weight in FORWARD)
"""Backward difference of fourth order: all changes are negative or zero."""
SECOND: Stencil = ((-1, -0.5), (1, 0.5))
"""Central difference of second order.  It needs two runs, a central difference of fourth order needs four."""
_LEAST = 2e-7
"""Smallest step, relative to the largest step.  From a largest step of 5e-3 it is 1e-9.  Rounding of 1e-14 then leaves
five correct digits of a derivative of 1."""
_REFUSED = 0.25
"""Factor that reduces the step if a run with a changed argument has other events than the run without a change.

Ten such reductions span six decades of steps.
"""
_WORSE = 2.0
"""Factor by which the error must grow to stop the search: a smaller growth may be scatter (Ridders)."""
_SCATTER = 3.0
"""Safety factor by which the estimated error of a derivative is multiplied.  The estimate is a difference of two
values, which may agree by chance, because rounding varies with the step."""


class OrderOfEvents(NonsmoothError):
    """A small change reorders, adds or removes events: there is no derivative.

    Attributes
    ----------
    one, two : Signature
        Events without the change, and with it.
    """

    def __init__(self, one: Signature, two: Signature) -> None:
        super().__init__("a small change reorders events")
        self.one, self.two = one, two


@final
@dataclass(frozen=True)
class Derivative:
    """A derivative with its error.

    Attributes
    ----------
    value : array
        The derivative, shape [m].
    error : float
        Bound of the error of each component, in the unit of the derivative; infinite if it is unknown.
    step : float
        Smallest step from which the derivative was computed.
    """

    value: Array
    error: float
    step: float


def slope(sampled: Sampled, step: float, expected: Signature, stencil: Stencil = CENTRAL) -> Array:
    """Return the derivative of a map at 0 by one difference.

    Parameters
    ----------
    sampled : callable
        The map.
    step : float
        The change for an offset of 1.
    expected : Signature
        Events of the run without a change.
    stencil : Stencil
        Offsets and weights.

    Raises
    ------
    OrderOfEvents
        If a changed run passes other events, or the same events in another order.
    """

    def value(offset: int) -> Array:
        found, signature = sampled(offset * step)
        if signature != expected:
            raise OrderOfEvents(expected, signature)
        return found

    (first, _), *others = stencil
    # subtract the first value from all others: the weights add up to 0, so the sum stays the same, and the derivative
    # of a coordinate that does not change is exactly 0
    origin = value(first)
    total = np.zeros_like(origin)
    for offset, weight in others:
        total = total + weight * (value(offset) - origin)
    return np.asarray(total / step)


def steady(found_with: Callable[[float], Array], steps: Sequence[float]) -> tuple[Array, float, float]:
    """Return the derivative that changes least with the next smaller step, its step, and this change.

    Truncation errors dominate at larger steps, round-off at smaller steps.  The change is relative to the largest
    component of the derivative; nan if only one step gives a derivative.

    Raises
    ------
    OrderOfEvents
        If all steps change the order of events.
    InvalidInput
        If no step gives a valid system and start.
    """
    best: tuple[Array, float, float] | None = None
    last: tuple[Array, float] | None = None
    trouble: OrderOfEvents | InvalidInput | None = None
    for step in steps:
        try:
            found = found_with(step)
        except (OrderOfEvents, InvalidInput) as error:
            # a large step may give an invalid system, such as overlapping bodies at the start: try the next step
            trouble, last = error, None
            continue
        if last is not None:
            largest = max(float(np.max(np.abs(found), initial=0.0)), np.finfo(float).tiny)
            differs = float(np.max(np.abs(found - last[0]), initial=0.0)) / largest
            if best is not None and not differs < best[2]:
                return best
            best = (*last, differs)
        last = found, step
    if best is None and last is None:
        assert trouble is not None
        raise trouble
    return best or (*last, np.nan)  # type: ignore[misc]


def derivative(sampled: Sampled, first: float, expected: Signature, enough: float = 0.0) -> Derivative:
    """Return the derivative of a map at a change of 0, its error and its step, by the method of Ridders (1982).

    The error of a central difference is a series in the square of the step.  Neville's scheme extrapolates differences
    with halved steps to a step of 0.  Each extrapolation is compared with the two values from which it is computed.
    The extrapolation that differs least is returned.  The search ends when rounding makes the differences grow.  A step
    is usable only if both of its runs pass the expected events in the same order.

    Parameters
    ----------
    sampled : callable
        ``sampled(change)`` returns the value of the map after a change of its argument, and the events of the run.
    first : float
        The largest change of the argument, in the unit of the argument.
    expected : Signature
        Events of the run without a change.
    enough : float
        Error at which the search ends early, relative to the largest number of the derivative.

    Raises
    ------
    OrderOfEvents
        If all steps change the order of events.
    InvalidInput, RunFailed
        If even the smallest step gives no valid system or start, or its run fails.
    """
    row, best, after, step = list[Array](), None, np.inf, first
    trouble: OrderOfEvents | InvalidInput | RunFailed | None = None
    while step >= _LEAST * first:
        try:
            difference = slope(sampled, step, expected, SECOND)
        except (OrderOfEvents, InvalidInput, RunFailed) as error:
            # larger steps passed the same events by chance: they are discarded
            trouble, row, best, step = error, [], None, _REFUSED * step
            continue
        before, row = row, _extrapolated(row, difference)
        found = [Derivative(row[i], _apart(row, before, i), step) for i in range(1, len(row))]
        least = min(found, key=lambda one: one.error, default=Derivative(difference, np.inf, step))
        if best is None or least.error < best.error:
            best, after = least, np.inf
        else:
            after = min(after, float(np.max(np.abs(least.value - best.value), initial=0.0)))
            if least.error >= _WORSE * best.error:
                break
        if _SCATTER * best.error <= enough * float(np.max(np.abs(best.value), initial=0.0)):
            break
        step *= 0.5
    if best is None:
        assert trouble is not None
        raise trouble
    apart = best.error if np.isinf(after) else max(best.error, after)
    return Derivative(best.value, _SCATTER * apart, best.step)


def _extrapolated(before: list[Array], difference: Array) -> list[Array]:
    """Return the next row of Neville's scheme for halved steps: orders 2, 4, 6, ... of a central difference."""
    row = [difference]
    for i, one in enumerate(before):
        row.append(row[i] + (row[i] - one) / (4.0 ** (i + 1) - 1.0))
    return row


def _apart(row: list[Array], before: list[Array], i: int) -> float:
    """Return the estimated error of the extrapolated derivative ``row[i]``, in the unit of the derivative.

    It is the largest difference of ``row[i]`` from the two values from which it is computed (Ridders).  ``row`` and
    ``before`` are the rows of Neville's scheme for the present step and the previous step.
    """
    parents = np.array([row[i - 1], before[i - 1]])
    return float(np.max(np.abs(row[i] - parents), initial=0.0))
