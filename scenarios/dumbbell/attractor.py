"""What a dumbbell settled into, told from its motion alone."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.solution.events import Events

Floats = NDArray[np.float64]

NAMES = ("drift", "jump", "flutter", "rest", "other")
"""All attractors that are told apart."""
LONGEST_TAIL = 40
"""The settled part is the last half of the run, but not more than so many plate periods."""
SHORTEST_TAIL = 4
"""Below so many plate periods nothing is called periodic."""
LONGEST_PERIOD = 8
"""Longest period looked for, in plate periods."""
PERIOD_TOLERANCE = 0.02
"""Deviation from the section one period before that counts as none, relative to the ball's largest gap and gap
rate, or to the plate's amplitude and peak speed where these are larger."""
SECTIONS = 0.9
"""Share of the phases at which the sections must agree: a few lie so close to an impact that its exact time decides."""
LEVEL = 0.25
"""A tilt that lifts one end by less than this share of the largest gap counts as level."""
SYMMETRIC = 0.1
"""A mean of the extreme tilts below this share of their range counts as zero."""
STANDING = 0.2
"""A ball that is on the plate for this share of the time stands on it."""


@dataclass(frozen=True)
class Motion:
    """A dumbbell's run, as far as the attractor depends on it.

    Attributes
    ----------
    t : array
        Times of the samples [s], shape [n].
    gap, gap_rate : array
        Gaps of the balls [m] and their rates [m/s], shape [n, 2].
    beta : array
        Tilt [rad], shape [n].
    beta_at_events : array
        Tilt at the events, where it may be extreme [rad], shape [n_events].
    centre : array
        Horizontal position of the mass centre [m], shape [n, 2].
    events : Events
        Events; contacts 0 and 1 are balls 1 and 2.
    period : float
        Period of the plate [s].
    length, speed : float
        Amplitude [m] and peak speed [m/s] of the plate, or other scales of the bouncing where it rests.
    """

    t: Floats
    gap: Floats
    gap_rate: Floats
    beta: Floats
    beta_at_events: Floats
    centre: Floats
    events: Events
    period: float
    length: float
    speed: float

    @property
    def beta_range(self) -> tuple[float, float]:
        """Smallest and largest tilt [rad], impacts included."""
        inside = (self.events.time >= self.t[0]) & (self.events.time <= self.t[-1])
        tilts = np.concatenate([self.beta, self.beta_at_events[inside]])
        return float(tilts.min()), float(tilts.max())


def settled(t: Floats, period: float) -> tuple[int, float]:
    """Return how many plate periods the settled part of a run has that was sampled at times [s], and its begin [s]."""
    n = min(LONGEST_TAIL, math.floor((t[-1] - t[0]) / period / 2.0 + 1e-9))
    return n, float(t[-1] - n * period if n else t[0])


def period_of(motion: Motion) -> int | None:
    """Return the period in plate periods, None without one.

    Gaps and gap rates (hence tilt and its rate) are compared with those p plate periods before, at all phases
    sampled; the horizontal position and the angles theta and gamma do not count.
    """
    lengths = np.maximum(motion.length, motion.gap.max(axis=0))
    speeds = np.maximum(motion.speed, np.abs(motion.gap_rate).max(axis=0))
    scaled = np.column_stack([motion.gap / lengths, motion.gap_rate / speeds])
    longest = math.floor((motion.t[-1] - motion.t[0]) / motion.period / 2.0 + 1e-9)
    for p in range(1, min(LONGEST_PERIOD, longest) + 1):
        earlier = motion.t - p * motion.period
        keep = earlier >= motion.t[0] - 1e-9 * motion.period
        before = np.column_stack([np.interp(earlier[keep], motion.t, column) for column in scaled.T])
        deviation = np.abs(scaled[keep] - before).max(axis=1)
        if np.quantile(deviation, SECTIONS) <= PERIOD_TOLERANCE:
            return p
    return None


def classify(motion: Motion, period: int | None, cycles: int) -> str:
    """Name the attractor of a settled motion of so many plate periods: drift, jump, flutter, rest or other."""
    impacts = _Impacts.of(motion)
    if not len(impacts.balls) and motion.gap.max() <= 1e-6 * motion.length:
        return "rest"
    if period is None or cycles < SHORTEST_TAIL:
        return "other"
    for name, test in _TESTS.items():
        if test(motion, period, cycles, impacts):
            return name
    return "other"


@dataclass(frozen=True)
class _Impacts:
    """Impacts of a motion.

    ``balls`` [n]: the ball (0 or 1) that struck, 2 for both; ``double`` [n]: whether the other took part, standing
    or striking; ``standing`` [2]: share of the time that each ball is on the plate.
    """

    balls: NDArray[np.int64]
    double: NDArray[np.bool_]
    standing: Floats

    @classmethod
    def of(cls, motion: Motion) -> _Impacts:
        events = motion.events
        begin, end = motion.t[0], motion.t[-1]
        inside = (events.time > begin) & (events.time <= end)
        during = events.during[inside & (events.cause == Cause.IMPACT)]
        struck = (during & 2) > 0
        struck = struck[struck.any(axis=1)]
        touching = (during & 1) > 0
        touching = touching[((during & 2) > 0).any(axis=1)]
        balls = np.where(struck.all(axis=1), 2, np.argmax(struck, axis=1))
        edges = np.clip(np.append(events.time, end), begin, end)
        standing = (np.diff(edges)[:, None] * (events.after & 1)).sum(axis=0) / max(end - begin, 1e-300)
        return cls(balls, touching.all(axis=1), standing)


def _jump(motion: Motion, period: int, cycles: int, impacts: _Impacts) -> bool:
    """Tell whether both balls bounce once per plate period, level."""
    lift = np.abs(motion.gap[:, 0] - motion.gap[:, 1]).max()
    per_ball = [(np.isin(impacts.balls, (ball, 2))).sum() for ball in (0, 1)]
    return (
        period == 1
        and lift <= LEVEL * float(motion.gap.max())
        and float(impacts.standing.max()) < STANDING
        and all(abs(n - cycles) <= 1 for n in per_ball)
    )


def _flutter(motion: Motion, period: int, cycles: int, impacts: _Impacts) -> bool:
    """Tell whether the balls strike in turn, each once in two plate periods, and the tilt is symmetric."""
    low, high = motion.beta_range
    return (
        period == 2
        and abs(len(impacts.balls) - cycles) <= 1
        and bool(np.all(np.diff(impacts.balls) != 0))
        and not bool(np.any(impacts.balls == 2))
        and abs(low + high) <= SYMMETRIC * (high - low)
    )


def _drift(motion: Motion, period: int, cycles: int, impacts: _Impacts) -> bool:
    """Tell whether one ball stands a good part of the time and its partner strikes once per period: {11,10,11}."""
    stands = int(np.argmax(impacts.standing))
    partner = 1 - stands
    strikes = impacts.balls == partner
    return (
        float(impacts.standing[stands]) >= STANDING > float(impacts.standing[partner])
        and abs(int(strikes.sum()) - cycles) <= 1
        and bool(np.all(impacts.double[strikes]))
        and not bool(np.any(impacts.balls == 2))
    )


_TESTS: dict[str, Callable[[Motion, int, int, _Impacts], bool]] = {"jump": _jump, "flutter": _flutter, "drift": _drift}


def largest_gaps(motion: Motion) -> list[float]:
    """Return the largest gap of each ball [m], between the samples too (constant acceleration there)."""
    v0, v1 = motion.gap_rate[:-1], motion.gap_rate[1:]
    turns = (v0 > 0.0) & (v1 < 0.0)
    steps = np.diff(motion.t)[:, None]
    peaks = motion.gap[:-1] + 0.5 * steps * np.where(turns, v0, 0.0) ** 2 / np.where(turns, v0 - v1, 1.0)
    return [float(max(peaks[:, ball].max(initial=0.0), motion.gap[:, ball].max())) for ball in (0, 1)]


def summary(tail: Motion, cycles: int) -> dict[str, object]:
    """Return attractor, period, drift velocity, largest gaps and range of the tilt of a settled part of such length."""
    period = period_of(tail) if cycles >= SHORTEST_TAIL else None
    attractor = classify(tail, period, cycles)
    elapsed = float(tail.t[-1] - tail.t[0])
    moved = (tail.centre[-1] - tail.centre[0]) / elapsed if elapsed > 0.0 else np.zeros(2)
    return {
        "attractor": attractor,
        "period": None if attractor == "rest" else period,
        "drift_velocity": moved.tolist(),
        "max_gap": largest_gaps(tail),
        "beta_range": list(tail.beta_range),
    }
