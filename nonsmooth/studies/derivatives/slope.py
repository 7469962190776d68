"""Derivatives by differences, taken only where all runs pass the same events."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput, NonsmoothError
from nonsmooth.studies.derivatives.passage import Signature

Floats = NDArray[np.float64]
CENTRAL = ((-2, 1.0 / 12.0), (-1, -2.0 / 3.0), (1, 2.0 / 3.0), (2, -1.0 / 12.0))
FORWARD = ((0, -25.0 / 12.0), (1, 4.0), (2, -3.0), (3, 4.0 / 3.0), (4, -0.25))
BACKWARD = tuple((-i, -weight) for i, weight in FORWARD)
"""Offsets in steps, and weights, of differences of fourth order; to one side where there is no other one."""
SECOND = ((-1, -0.5), (1, 0.5))
"""The same of second order, where some digits are enough: of systems that are each built for it."""
Stencil = tuple[tuple[int, float], ...]
Sampled = Callable[[float], tuple[Floats, Signature]]
"""What comes of a small change, and the events on the way."""


class OrderOfEvents(NonsmoothError):
    """A small change reorders events, or adds some: there is no derivative.

    Attributes
    ----------
    one, two : Signature
        Events without the change, and with it.
    """

    def __init__(self, one: Signature, two: Signature) -> None:
        super().__init__("a small change reorders events")
        self.one, self.two = one, two


def slope(sampled: Sampled, step: float, expected: Signature, stencil: Stencil = CENTRAL) -> Floats:
    """Return the derivative at 0 of what comes of a small change.

    Parameters
    ----------
    sampled : callable
        The function.
    step : float
        The unit of the changes.
    expected : Signature
        Events without a change.
    stencil : Stencil
        Offsets and weights.

    Raises
    ------
    OrderOfEvents
        If the events with a change are others.
    """
    (first, _), *others = stencil
    # weights add up to 0: without the first value in all of them what does not change is 0 without round-off
    origin = _expected(sampled(first * step), expected)
    total = np.zeros_like(origin)
    for offset, weight in others:
        total = total + weight * (_expected(sampled(offset * step), expected) - origin)
    return np.asarray(total / step)


def _expected(sample: tuple[Floats, Signature], expected: Signature) -> Floats:
    value, signature = sample
    if signature != expected:
        raise OrderOfEvents(expected, signature)
    return value


def steady(found_with: Callable[[float], Floats], steps: Sequence[float]) -> tuple[Floats, float, float]:
    """Return the derivative that changes least with the next smaller step, its step, and by how much.

    Where motions are as small as a change the larger steps say nothing, and of the smaller ones round-off is left.
    The change is relative to the largest number of the derivative; nan where only one step gives any.

    Raises
    ------
    OrderOfEvents
        If all steps change the order of events.
    InvalidInput
        If no change makes a system and a start.
    """
    best: tuple[Floats, float, float] | None = None
    last: tuple[Floats, float] | None = None
    trouble: OrderOfEvents | InvalidInput | None = None
    for step in steps:
        try:
            found = found_with(step)
        except (OrderOfEvents, InvalidInput) as error:
            # a start that overlaps is refused: that change was too large, too
            trouble, last = error, None
            continue
        if last is not None:
            largest = max(float(np.max(np.abs(found), initial=0.0)), np.finfo(float).tiny)
            differs = float(np.max(np.abs(found - last[0]), initial=0.0)) / largest
            if best is None or differs < best[2]:
                best = (*last, differs)
            else:
                return best
        last = found, step
    if best is not None:
        return best
    if last is not None:
        return (*last, np.nan)
    assert trouble is not None
    raise trouble
