"""The periodic orbits of the bouncing ball in closed form, and which one a run is on."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_LONGEST = 16


def existence(restitution: float, n: int) -> float:
    """Return n pi (1 - e)/(1 + e), the Gamma above which an orbit with flights of n table periods exists."""
    return n * math.pi * (1.0 - restitution) / (1.0 + restitution)


def stability(restitution: float, n: int) -> float:
    """Return the Gamma up to which that orbit is stable; beyond it the period doubles."""
    e = restitution
    return math.sqrt(existence(e, n) ** 2 + 4.0 * (1.0 + e * e) ** 2 / (1.0 + e) ** 4)


def impact_phase(gamma: float, restitution: float, n: int) -> float:
    """Return the phase of the table [rad] at which the stable n-period orbit hits it; 0 where no orbit exists."""
    return math.acos(min(1.0, existence(restitution, n) / gamma))


def repetition(values: Floats, tolerance: float) -> int | None:
    """Return the least number of values after which the last 32 repeat, up to 16; None if they do not."""
    last = values[-2 * _LONGEST :]
    if len(last) < 2 * _LONGEST:
        return None
    for k in range(1, _LONGEST + 1):
        if np.max(np.abs(last[k:] - last[:-k])) <= tolerance:
            return k
    return None
