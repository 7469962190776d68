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
"""Least part of a change that must remain after 30 halvings of its interval, so that the change is treated as a jump.
The change of a smooth function shrinks to 1e-9."""
_SAME = 1e-6
"""Allowed deviation of a derivative from its differences, relative to the size of the differences."""
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
    """Compare a derivative ``given`` with one ``found`` by :func:`slope`; return a message, "" if they agree.

    ``known`` is the bound of the error of ``found``.
    """
    # at a kink, such as a point of a table with linear interpolation, the bound of the error is large: any value passes
    if np.max(np.abs(given - found)) <= _SAME * np.max(np.abs(found)) + 10.0 * known:
        return ""
    return f"the {name} is {given.tolist()}, the differences give {found.tolist()}"


def smooth_slope(value: Callable[[float], Any], dt: float) -> Array:
    """Return the derivative of a smooth value at 0, by central differences and two steps of Richardson's method."""
    one, two, four = ((np.asarray(value(i * dt)) - value(-i * dt)) / (2.0 * i * dt) for i in (1, 2, 4))
    first, second = (4.0 * one - two) / 3.0, (4.0 * two - four) / 3.0
    return np.asarray((16.0 * first - second) / 15.0)


def spin_of(rates: Array, axes: Array) -> Array:
    """Return the angular velocity of a frame [rad/s], shape [3].

    ``axes`` is the rotation matrix row by row, ``rates`` its derivative in time, shape [9] each.
    """
    spin = rates.reshape(3, 3) @ axes.reshape(3, 3).T
    return 0.5 * np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]])


def rotation_fault(axes: Array) -> str:
    """Return a message if 9 numbers are not a rotation matrix row by row; "" if they are."""
    matrix = axes.reshape(3, 3)
    is_rotation = np.allclose(matrix.T @ matrix, np.eye(3), rtol=0.0, atol=1e-9) and np.linalg.det(matrix) >= 0.0
    return "" if is_rotation else f"the axes are {matrix.tolist()}"


def jump(value: Callable[[float], Any], low: float, high: float, pieces: int = _PIECES) -> tuple[float, Array] | None:
    """Return the place and the size of a jump of a function between two numbers; None if no jump is found.

    Only the pieces with the largest changes are bisected. So a jump that is small compared with ordinary changes is not
    found.
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
