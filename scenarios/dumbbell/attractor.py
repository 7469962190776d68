"""Finds which motion of the paper a dumbbell settled into, from the gaps, tilts and impacts of its run."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.events import Events
from nonsmooth.solution.solution import Solution

from . import coordinates

if TYPE_CHECKING:
    from .scenario import DumbbellScenario

Floats = NDArray[np.float64]

NAMES = ("drift", "jump", "flutter", "rest", "other")
"""Names of the attractors."""
_LONGEST_TAIL, _SHORTEST_TAIL = 40, 4
"""Largest number of plate periods in the settled part of a run; smallest number in which a period is searched."""
_LONGEST_PERIOD = 8
"""Longest period that is searched for [plate periods]."""
_PERIOD_TOLERANCE = 0.02
"""Largest change of a gap or gap rate from period to period in a periodic motion, relative to its largest value."""
_SECTIONS = 0.9
"""Fraction of the samples that must repeat; the others may be so close to an impact that its exact time matters."""
_LEVEL = 0.25
"""Largest difference between the gaps of the two balls in a level motion, relative to the largest gap of a ball.

In a level motion both balls move alike.
"""
_SYMMETRIC = 0.1
"""Largest sum of the least and the largest tilt of a symmetric motion, relative to their difference."""
_STANDING = 0.2
"""Least fraction of the time in contact with the plate for a ball that stays on the plate.

A ball with a smaller fraction bounces.
"""


@dataclass(frozen=True)
class Settled:
    """The settled part of a run: its last half, but at most 40 plate periods.

    Attributes
    ----------
    motion : DumbbellMotion
        The motion at its samples.
    events : Events
        Events of the whole run; contacts 0 and 1 are balls 1 and 2.
    cycles : int
        Number of plate periods.
    """

    motion: coordinates.DumbbellMotion
    events: Events
    cycles: int

    @classmethod
    def of(cls, scenario: DumbbellScenario, solution: Solution) -> Settled:
        """Return the settled part of a run."""
        t = scenario.motion(solution).t
        period = 1.0 / scenario.frequency
        cycles = min(_LONGEST_TAIL, math.floor((t[-1] - t[0]) / period / 2.0 + 1e-9))
        start = float(t[-1] - cycles * period if cycles else t[0])
        return cls(scenario.motion(solution, start - 1e-9 / scenario.frequency), solution.events, cycles)

    def summary(self) -> Mapping[str, Any]:
        """Return the properties of the settled motion by name.

        - ``attractor``: name of the attractor;
        - ``period``: [plate periods], None at rest or if the motion does not repeat;
        - ``drift_velocity``: mean horizontal velocity of the centre [m/s], two numbers;
        - ``max_gap``: largest gap of each ball [m];
        - ``beta_range``: least and largest tilt [rad].
        """
        period, t, centre = self.period, self.motion.t, self.motion.centre
        attractor = self._attractor(period)
        elapsed = float(t[-1] - t[0])
        moved = (centre[-1] - centre[0]) / elapsed if elapsed > 0.0 else np.zeros(2)
        return {
            "attractor": attractor,
            "period": None if attractor == "rest" else period,
            "drift_velocity": moved.tolist(),
            "max_gap": self._largest_gaps(),
            "beta_range": list(self.beta_range),
        }

    @functools.cached_property
    def scales(self) -> tuple[float, float]:
        """Amplitude [m] and peak speed [m/s] of the plate; at least the values for an amplitude of 1e-3 ball radii."""
        scenario = self.motion.scenario
        length = max(scenario.amplitude, 1e-3 * scenario.radius)
        return length, 2.0 * math.pi * scenario.frequency * length

    @functools.cached_property
    def beta_range(self) -> tuple[float, float]:
        """Smallest and largest tilt [rad], impacts included."""
        t, events = self.motion.t, self.events
        inside = (events.time >= t[0]) & (events.time <= t[-1])
        tilts = np.concatenate([self.motion.q[:, 4], coordinates.tilt(events.q)[inside]])
        return float(tilts.min()), float(tilts.max())

    @functools.cached_property
    def period(self) -> int | None:
        """Period p of the motion [plate periods]; None if the motion does not repeat.

        p is the least number for which gaps and gap rates at the samples equal their values p plate periods earlier.
        Gaps and gap rates determine tilt and tilt rate.  The horizontal position and the angles theta and gamma are not
        compared, because the dumbbell may drift, turn and roll.
        """
        if self.cycles < _SHORTEST_TAIL:
            return None
        t, gap_rate, cycle = self.motion.t, self.motion.gap_rate, 1.0 / self.motion.scenario.frequency
        length, speed = self.scales
        lengths = np.maximum(length, self.motion.gap.max(axis=0))
        speeds = np.maximum(speed, np.abs(gap_rate).max(axis=0))
        scaled = np.column_stack([self.motion.gap / lengths, gap_rate / speeds])
        longest = math.floor((t[-1] - t[0]) / cycle / 2.0 + 1e-9)
        for p in range(1, min(_LONGEST_PERIOD, longest) + 1):
            earlier = t - p * cycle
            keep = earlier >= t[0] - 1e-9 * cycle
            before = np.column_stack([np.interp(earlier[keep], t, column) for column in scaled.T])
            deviation = np.abs(scaled[keep] - before).max(axis=1)
            if np.quantile(deviation, _SECTIONS) <= _PERIOD_TOLERANCE:
                return p
        return None

    def _attractor(self, period: int | None) -> str:
        """Return the name of the attractor; ``period`` is the period in plate periods."""
        if not len(self._strikes[0]) and self.motion.gap.max() <= 1e-6 * self.scales[0]:
            return "rest"
        tests = {"jump": self._jumps, "flutter": self._flutters, "drift": self._drifts}
        return next((name for name, test in tests.items() if period is not None and test(period)), "other")

    def _jumps(self, period: int) -> bool:
        """Return True if both balls bounce once per plate period and the dumbbell stays level."""
        struck, _ = self._strikes
        lift = np.abs(self.motion.gap[:, 0] - self.motion.gap[:, 1]).max()
        level = lift <= _LEVEL * float(self.motion.gap.max()) and float(self._standing.max()) < _STANDING
        return period == 1 and level and all(abs(n - self.cycles) <= 1 for n in struck.sum(axis=0))

    def _flutters(self, period: int) -> bool:
        """Return True if the balls strike in turn, each once in two plate periods, and the tilt is symmetric."""
        struck, _ = self._strikes
        low, high = self.beta_range
        in_turn = bool(np.all(struck.sum(axis=1) == 1) and np.all(struck[1:, 0] != struck[:-1, 0]))
        symmetric = abs(low + high) <= _SYMMETRIC * (high - low)
        return period == 2 and abs(len(struck) - self.cycles) <= 1 and in_turn and symmetric

    def _drifts(self, period: int) -> bool:
        """Return True if one ball stays on the plate, and the other strikes once per plate period while both touch.

        With ball 1 on the plate, the strike has the mode word {11,10,11}: both closed, ball 2 approaches, both slip.
        """
        struck, touching = self._strikes
        resting = int(np.argmax(self._standing))
        other = struck[:, 1 - resting]
        stands = float(self._standing[resting]) >= _STANDING > float(self._standing[1 - resting])
        double = bool(np.all(touching[other].all(axis=1)) and not np.any(struck.all(axis=1)))
        return stands and abs(int(other.sum()) - self.cycles) <= 1 and double

    @functools.cached_property
    def _strikes(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return two arrays for the n impacts and both balls, shape [n, 2].

        The first is True for a ball that strikes: it approaches the plate and collides.  The second is True for a ball
        in contact with the plate, whether it collides or not.
        """
        events = self.events
        inside = (events.time > self.motion.t[0]) & (events.time <= self.motion.t[-1])
        during = events.during[inside & (events.cause == Cause.IMPACT)]
        during = during[((during & 2) > 0).any(axis=1)]
        return (during & 2) > 0, (during & 1) > 0

    @functools.cached_property
    def _standing(self) -> Floats:
        """Fractions of the time in which the balls are on the plate, shape [2]."""
        events, begin, end = self.events, self.motion.t[0], self.motion.t[-1]
        edges = np.clip(np.append(events.time, end), begin, end)
        standing: Floats = (np.diff(edges)[:, None] * (events.after & 1)).sum(axis=0) / max(end - begin, 1e-300)
        return standing

    def _largest_gaps(self) -> list[float]:
        """Return the largest gap of each ball [m]; a maximum between samples is computed for constant acceleration."""
        rate = self.motion.gap_rate
        v0, v1 = rate[:-1], rate[1:]
        turns = (v0 > 0.0) & (v1 < 0.0)
        steps = np.diff(self.motion.t)[:, None]
        peaks = self.motion.gap[:-1] + 0.5 * steps * np.where(turns, v0, 0.0) ** 2 / np.where(turns, v0 - v1, 1.0)
        return [float(max(peaks[:, ball].max(initial=0.0), self.motion.gap[:, ball].max())) for ball in (0, 1)]
