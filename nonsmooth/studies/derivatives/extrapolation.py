"""Derivatives of maps with their errors: central differences with smaller and smaller steps, extrapolated to none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.studies.derivatives.passage import Signature
from nonsmooth.studies.derivatives.slope import SECOND, OrderOfEvents, Sampled, slope

Floats = NDArray[np.float64]
_LEAST = 2e-7
"""Smallest step, relative to the first one: rounding of 1e-14 leaves five digits of a derivative of 1 at 1e-9."""
_REFUSED = 0.25
"""Factor of a step whose runs pass other events: ten such steps span six decades."""
_WORSE = 2.0
"""Factor by which the error grows before the search stops: one that grows less may be scatter (Ridders)."""
_SCATTER = 3.0
"""Factor of the error.  Rounding differs from step to step, so differences of two estimates underrate it by chance."""


@final
@dataclass(frozen=True)
class Derivative:
    """A derivative with its error.

    Attributes
    ----------
    value : array
        The derivative, shape [m].
    error : float
        Bound of the error of its largest number, in the same unit; infinite if a single step gave a value.
    step : float
        The smallest step that went into it.
    """

    value: Floats
    error: float
    step: float


def derivative(sampled: Sampled, first: float, expected: Signature, enough: float = 0.0) -> Derivative:
    """Return the derivative at 0 of what comes of a small change, with its error.

    The method is that of Ridders (1982).  The error of a central difference is a series in the square of the step.
    Neville's scheme extrapolates differences with halved steps to a step of 0.  Each extrapolation is compared with
    the two that it is made of.  The one that differs least is returned; the search ends where rounding makes the
    differences grow.  A step is usable only if both of its runs pass the expected events in the same order.

    Parameters
    ----------
    sampled : callable
        The function.
    first : float
        The largest step, in the unit of the changes.
    expected : Signature
        Events without a change.
    enough : float
        Error at which the search ends early, relative to the largest number of the derivative.

    Raises
    ------
    OrderOfEvents
        If all steps change the order of events.
    InvalidInput, RunFailed
        If the smallest step gives no system, no start or no run.
    """
    row, best, after, step = list[Floats](), None, np.inf, first
    trouble: OrderOfEvents | InvalidInput | RunFailed | None = None
    while step >= _LEAST * first:
        try:
            difference = slope(sampled, step, expected, SECOND)
        except (OrderOfEvents, InvalidInput, RunFailed) as error:
            # larger steps that passed the same events say nothing of the derivative at 0
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


def _extrapolated(before: list[Floats], difference: Floats) -> list[Floats]:
    """Return the next row of Neville's scheme for halved steps: orders 2, 4, 6, ... of a central difference."""
    row = [difference]
    for i, one in enumerate(before):
        row.append(row[i] + (row[i] - one) / (4.0 ** (i + 1) - 1.0))
    return row


def _apart(row: list[Floats], before: list[Floats], i: int) -> float:
    """Return by how much an extrapolation differs from the two that it is made of."""
    parents = np.array([row[i - 1], before[i - 1]])
    return float(np.max(np.abs(row[i] - parents), initial=0.0))
