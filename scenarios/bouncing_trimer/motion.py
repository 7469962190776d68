"""Long-term motion of a trimer: its attractor, how fast it travels and turns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

GRAVITY = 9.81
"""Acceleration of gravity [m/s^2]."""
_LONGEST = 12
"""Longest period that is searched for [plate periods]."""
_CLOSED = 1e-9
"""Largest gap of a trimer at rest on the plate [m]."""
_REPEATS = 1e-3
"""Largest difference of gaps one period apart in a periodic motion, relative to the largest gap."""
_REST, _TUMBLING, _IRREGULAR = "rest", "tumbling", "irregular"
_PERIODS = tuple(f"period_{k}" for k in range(1, _LONGEST + 1))
NAMES = (_REST, *_PERIODS, _TUMBLING, _IRREGULAR)
"""Names of all attractors."""


@dataclass(frozen=True)
class TrimerMotion:
    """Gaps, path and turning of a run.

    Attributes
    ----------
    t : array
        Times [s], shape [n], equally many in every plate period.
    period : float
        Plate period [s].
    gaps : array
        Gaps of the balls [m], shape [n, 3].
    place : array
        Mass centre on the plate [m], shape [n, 2].
    turning : array
        Vertical component of the angular velocity [rad/s], shape [n].
    tilt : array
        Angle from the level [rad], shape [n].
    """

    t: Floats
    period: float
    gaps: Floats
    place: Floats
    turning: Floats
    tilt: Floats

    @property
    def half(self) -> slice:
        """The second half of the samples."""
        return slice(len(self.t) // 2, None)


def repetition(motion: TrimerMotion) -> int | None:
    """Return after how many plate periods the gaps of the last quarter repeat, up to 12; None if they do not."""
    last = motion.gaps[-(len(motion.t) // 4) :]
    per_period = max(1, round(motion.period / (motion.t[1] - motion.t[0])))
    size = float(np.max(last))
    for k in range(1, _LONGEST + 1):
        shift = k * per_period
        if 2 * shift < len(last) and np.max(np.abs(last[shift:] - last[:-shift])) <= _REPEATS * size:
            return k
    return None


def summary(motion: TrimerMotion) -> Mapping[str, Any]:
    """Return the attractor of a run, and numbers of its motion in the second half of the run.

    - ``attractor``: "rest", "period_k" (k plate periods), "tumbling" if the trimer turns over, or "irregular";
    - ``drift``: distance between the first and the last position, divided by the time between them [m/s];
    - ``wandering``: length of the path through one position per plate period, divided by the same time [m/s];
    - ``rotation``, ``turning``: mean of the vertical angular velocity, and of its absolute value [rad/s];
    - ``largest_gap``, ``largest_tilt``: [m], [rad].
    """
    late = motion.half
    t, place, turning = motion.t[late], motion.place[late], motion.turning[late]
    elapsed = float(t[-1] - t[0])
    per_period = max(1, round(motion.period / (motion.t[1] - motion.t[0])))
    steps = np.diff(place[::per_period], axis=0)
    largest = float(np.max(motion.gaps[late]))
    k = repetition(motion)
    largest_tilt = float(np.max(motion.tilt[late]))
    attractor = _IRREGULAR if k is None else _PERIODS[k - 1]
    if largest < _CLOSED:
        attractor = _REST
    elif largest_tilt > 0.5 * np.pi:
        attractor = _TUMBLING
    return {
        "attractor": attractor,
        "drift": float(np.hypot(*(place[-1] - place[0]))) / elapsed,
        "wandering": float(np.sum(np.hypot(*steps.T))) / elapsed,
        "rotation": float(np.mean(turning)),
        "turning": float(np.mean(np.abs(turning))),
        "largest_gap": largest,
        "largest_tilt": largest_tilt,
    }
