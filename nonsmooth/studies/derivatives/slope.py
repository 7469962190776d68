"""Derivatives by differences of fourth order, taken only where all runs pass the same events."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import NonsmoothError
from nonsmooth.studies.derivatives.passage import Signature

Floats = NDArray[np.float64]
Key = TypeVar("Key")
CENTRAL = ((-2, 1.0 / 12.0), (-1, -2.0 / 3.0), (1, 2.0 / 3.0), (2, -1.0 / 12.0))
FORWARD = ((0, -25.0 / 12.0), (1, 4.0), (2, -3.0), (3, 4.0 / 3.0), (4, -0.25))
BACKWARD = tuple((-i, -weight) for i, weight in FORWARD)
"""Offsets in steps, and weights, of differences of fourth order; to one side where there is no other one."""
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
    total: Floats | None = None
    for offset, weight in stencil:
        value, signature = sampled(offset * step)
        if signature != expected:
            raise OrderOfEvents(expected, signature)
        total = weight * value if total is None else total + weight * value
    assert total is not None
    return np.asarray(total / step)
