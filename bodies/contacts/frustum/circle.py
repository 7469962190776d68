"""The least value of a function of an angle: samples bracket a minimum, Newton's method between bounds finds it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias, TypeVar

from nonsmooth.compiled import compiled

Given = TypeVar("Given")
Rule: TypeAlias = Callable[[Given, float], tuple[float, float, float]]
"""``rule(given, angle)``: value, slope and derivative of the slope of a function at an angle [rad]."""
_STEPS = 60
"""Largest number of Newton steps; each keeps or narrows the bounds of the angle."""


@compiled
def least_sample(rule: Rule[Given], given: Given, begin: float, step: float, n_steps: int) -> tuple[float, float]:
    """Return the angle with the least value among ``n_steps`` + 1 samples, and the derivative of the slope there."""
    least, least_bend, chosen = math.inf, 0.0, 0
    for i in range(n_steps + 1):
        value, _, bend = rule(given, begin + i * step)
        if value < least:
            least, least_bend, chosen = value, bend, i
    return begin + chosen * step, least_bend


@compiled
def zero_of_slope(rule: Rule[Given], given: Given, angle: float, least: float, most: float) -> float:
    """Return the angle between ``least`` and ``most`` at which the slope changes its sign from - to +.

    Newton's method starts at ``angle``.  Without a positive derivative, or out of the bounds, a step is a halving.
    """
    for _ in range(_STEPS):
        _, slope, bend = rule(given, angle)
        if slope > 0.0:
            most = angle
        else:
            least = angle
        after = angle - slope / bend if bend > 0.0 else math.inf
        if after < least or after > most:
            after = 0.5 * (least + most)
        if abs(after - angle) <= 2e-16 * max(abs(angle), 0.1):
            break
        angle = after
    return angle
