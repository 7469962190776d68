"""Jumps of a function of one number."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_PIECES = 64
_SUSPECTS = 3
_HALVINGS = 30
_LEFT = 1e-4
"""Part of a change that is left over 2^-30 of the way where it is a jump; a slope leaves some 1e-9."""


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
