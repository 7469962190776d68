"""Which of the paper's motions a dumbbell settled into, found from the motion alone."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.events import Events
from nonsmooth.solution.solution import Solution
from scenarios.dumbbell import coordinates

if TYPE_CHECKING:
    from scenarios.dumbbell.scenario import DumbbellScenario

Floats = NDArray[np.float64]

NAMES = ("drift", "jump", "flutter", "rest", "other")
"""All attractors that are distinguished."""
_LONGEST_TAIL, _SHORTEST_TAIL = 40, 4
"""Plate periods: the settled part is the last half of the run, at most the first; below the second, no period."""
_LONGEST_PERIOD = 8
"""Longest period looked for [plate periods]."""
_PERIOD_TOLERANCE = 0.02
"""Deviation from the motion one period before that is ignored, relative to the largest gap and gap rate of the ball,
or to amplitude and peak speed of the plate if these are larger."""
_SECTIONS = 0.9
"""Fraction of the phases that must agree: a few are so close to an impact that its exact time decides."""
_LEVEL = 0.25
"""A tilt that lifts one end by less than this fraction of the largest gap counts as level."""
_SYMMETRIC = 0.1
"""A mean of the extreme tilts below this fraction of their range counts as zero."""
_STANDING = 0.2
"""A ball that is on the plate for this fraction of the time stands on it."""


@dataclass(frozen=True)
class Settled:
    """The settled part of a run.

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
        """Return attractor, period, drift velocity, largest gaps and range of the tilt."""
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
    def gap(self) -> Floats:
        """Gaps between balls and plate [m], shape [n, 2]."""
        return self.motion.gap

    @functools.cached_property
    def scales(self) -> tuple[float, float]:
        """Amplitude [m] and peak speed [m/s] of the plate, or small ones if the plate hardly moves."""
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
        """Period in plate periods, None without one.

        Gaps and gap rates, hence the tilt and its rate, are compared with those p plate periods before, at all phases
        sampled; the horizontal position and the angles theta and gamma do not count.
        """
        if self.cycles < _SHORTEST_TAIL:
            return None
        t, gap_rate, cycle = self.motion.t, self.motion.gap_rate, 1.0 / self.motion.scenario.frequency
        length, speed = self.scales
        lengths = np.maximum(length, self.gap.max(axis=0))
        speeds = np.maximum(speed, np.abs(gap_rate).max(axis=0))
        scaled = np.column_stack([self.gap / lengths, gap_rate / speeds])
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
        strikes, double, standing = self._impacts()
        if not len(strikes) and self.gap.max() <= 1e-6 * self.scales[0]:
            return "rest"
        if period is None:
            return "other"
        return next((name for name, test in _TESTS.items() if test(self, period, strikes, double, standing)), "other")

    def _impacts(self) -> tuple[NDArray[np.int64], NDArray[np.bool_], Floats]:
        """Return of each impact the ball (0 or 1, 2 for both) and whether both touch, and the balls' time on the plate.

        The last is a fraction of the whole, shape [2].
        """
        events, begin, end = self.events, self.motion.t[0], self.motion.t[-1]
        inside = (events.time > begin) & (events.time <= end)
        during = events.during[inside & (events.cause == Cause.IMPACT)]
        during = during[((during & 2) > 0).any(axis=1)]
        struck, touching = (during & 2) > 0, (during & 1) > 0
        balls = np.where(struck.all(axis=1), 2, np.argmax(struck, axis=1))
        edges = np.clip(np.append(events.time, end), begin, end)
        standing = (np.diff(edges)[:, None] * (events.after & 1)).sum(axis=0) / max(end - begin, 1e-300)
        return balls, touching.all(axis=1), standing

    def _largest_gaps(self) -> list[float]:
        """Return the largest gap of each ball [m], between the samples too (constant acceleration there)."""
        rate = self.motion.gap_rate
        v0, v1 = rate[:-1], rate[1:]
        turns = (v0 > 0.0) & (v1 < 0.0)
        steps = np.diff(self.motion.t)[:, None]
        peaks = self.gap[:-1] + 0.5 * steps * np.where(turns, v0, 0.0) ** 2 / np.where(turns, v0 - v1, 1.0)
        return [float(max(peaks[:, ball].max(initial=0.0), self.gap[:, ball].max())) for ball in (0, 1)]


def _jumps(one: Settled, period: int, strikes: Any, double: Any, standing: Any) -> bool:
    """Return True if both balls bounce once per plate period, level."""
    lift = np.abs(one.gap[:, 0] - one.gap[:, 1]).max()
    per_ball = [np.isin(strikes, (ball, 2)).sum() for ball in (0, 1)]
    return (
        period == 1
        and lift <= _LEVEL * float(one.gap.max())
        and float(standing.max()) < _STANDING
        and all(abs(n - one.cycles) <= 1 for n in per_ball)
    )


def _flutters(one: Settled, period: int, strikes: Any, double: Any, standing: Any) -> bool:
    """Return True if the balls strike in turn, each once in two plate periods, and the tilt is symmetric."""
    low, high = one.beta_range
    return (
        period == 2
        and abs(len(strikes) - one.cycles) <= 1
        and bool(np.all(np.diff(strikes) != 0))
        and not bool(np.any(strikes == 2))
        and abs(low + high) <= _SYMMETRIC * (high - low)
    )


def _drifts(one: Settled, period: int, strikes: Any, double: Any, standing: Any) -> bool:
    """Return True if one ball stands a good part of the time and the other strikes once per period: {11,10,11}."""
    resting = int(np.argmax(standing))
    other = strikes == 1 - resting
    return (
        float(standing[resting]) >= _STANDING > float(standing[1 - resting])
        and abs(int(other.sum()) - one.cycles) <= 1
        and bool(np.all(double[other]))
        and not bool(np.any(strikes == 2))
    )


_TESTS: Mapping[str, Callable[..., bool]] = {"jump": _jumps, "flutter": _flutters, "drift": _drifts}
