"""Derivatives and jumps of functions of a single number, by differences."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.types import Array

_PIECES = 64
_SUSPECTS = 3
_HALVINGS = 30
_LEFT = 1e-4
"""Part of a change that is left over 2^-30 of the way where the function jumps; a slope leaves some 1e-9."""
_SAME = 1e-6
"""Deviation of a derivative from differences that counts as none, relative to its size."""
_ROUND_OFF = 1e-14
"""Round-off of a value, relative to its size."""


def slope(value: Callable[[float], Any], dt: float) -> tuple[Array, float]:
    """Return the derivative of a value at 0 by differences of fourth order, and a bound of their error."""
    at = {i: np.asarray(value(i * dt), dtype=float) for i in (-4, -2, -1, 1, 2, 4)}
    fine = (8.0 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12.0 * dt)
    coarse = (8.0 * (at[2] - at[-2]) - (at[4] - at[-4])) / (24.0 * dt)
    noise = _ROUND_OFF * max(float(np.max(np.abs(values), initial=0.0)) for values in at.values()) / dt
    return np.asarray(fine), float(np.max(np.abs(fine - coarse), initial=0.0)) + noise


def slope_fault(name: str, given: Array, found: Array, known: float) -> str:
    """Return that a value is not the derivative by :func:`slope`, which is known that well; "" if it is."""
    # at a knot of a table the differences know little, and nothing is asked
    if np.max(np.abs(given - found)) <= _SAME * np.max(np.abs(found)) + 10.0 * known:
        return ""
    return f"the {name} is {given.tolist()}, the differences give {found.tolist()}"


def smooth_slope(value: Callable[[float], Any], dt: float) -> Array:
    """Return the derivative of a smooth value at 0, by central differences and two steps of Richardson's method."""
    one, two, four = ((np.asarray(value(i * dt)) - value(-i * dt)) / (2.0 * i * dt) for i in (1, 2, 4))
    first, second = (4.0 * one - two) / 3.0, (4.0 * two - four) / 3.0
    return np.asarray((16.0 * first - second) / 15.0)


def spin_of(rates: Array, axes: Array) -> Array:
    """Return the angular velocity of a frame from its rotation matrix and the derivative of that, both [9] numbers."""
    spin = rates.reshape(3, 3) @ axes.reshape(3, 3).T
    return 0.5 * np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]])


def rotation_fault(axes: Array) -> str:
    """Return the fault of axes that are no rotation matrix, 9 numbers; "" if they are."""
    matrix = axes.reshape(3, 3)
    is_rotation = np.allclose(matrix.T @ matrix, np.eye(3), rtol=0.0, atol=1e-9) and np.linalg.det(matrix) >= 0.0
    return "" if is_rotation else f"the axes are {matrix.tolist()}"


def jump(value: Callable[[float], Any], low: float, high: float, pieces: int = _PIECES) -> tuple[float, Array] | None:
    """Return where a function jumps between two numbers and by how much, None where it does not seem to.

    The largest changes are followed down, so that a jump that is small beside ordinary changes is not found.
    """
    places = np.linspace(low, high, pieces + 1)
    values = [np.asarray(value(float(x)), dtype=float) for x in places]
    changes = np.array([np.max(np.abs(b - a)) for a, b in itertools.pairwise(values)])
    size = max(float(np.max(np.abs(v))) for v in values)
    for i in np.argsort(changes)[::-1][:_SUSPECTS]:
        left, right = float(places[i]), float(places[i + 1])
        first, last = values[i], values[i + 1]
        for _ in range(_HALVINGS):
            middle = 0.5 * (left + right)
            here = np.asarray(value(middle), dtype=float)
            if np.max(np.abs(here - first)) > np.max(np.abs(last - here)):
                right, last = middle, here
            else:
                left, first = middle, here
        if np.max(np.abs(last - first)) > _LEFT * changes[i] + 1e-12 * size:
            return 0.5 * (left + right), last - first
    return None
