"""Progress meters that count runs, the time that a run has reached, or orbits over a range of a parameter.

A meter decides when the display is refreshed, and estimates the remaining time.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.progress.displays import Display


@final
class ProgressMeter:
    """Context in which a display shows the completed part of a computation, at the intervals of the display.

    Parameters
    ----------
    display : Display
        Display of the completed part.
    clock : callable
        Returns the wall time [s].
    """

    def __init__(self, display: Display, clock: Callable[[], float] = time.monotonic) -> None:
        self._display, self._clock = display, clock
        self._next = self._began = self._first = 0.0
        self._part = float("inf")

    def __enter__(self) -> ProgressMeter:
        return self

    def __exit__(self, *error: Any) -> None:
        with contextlib.suppress(OSError):
            self._display.close()

    def show(self, part: float, words: Callable[[float], tuple[str, str]]) -> None:
        """Note the completed part, and show it if it is time.

        Parameters
        ----------
        part : float
            Completed part, from 0 to 1. A value below the previous one means that another computation has begun.
        words : callable
            Function of the time since the computation began [s]. It returns the progress in words, and details.
        """
        now = self._clock()
        if part < self._part:
            # another computation begins: the time to go must not depend on an earlier one, such as compiling
            self._next = max(self._next, now + self._display.patience)
            self._began, self._first = now, part
        self._part = part
        if now <= self._next:
            return
        self._next = now + self._display.interval
        elapsed, done = now - self._began, part - self._first
        reached, counted = words(elapsed)
        left = f"about {elapsed * (1.0 - part) / done:.0f} s to go" if done > 0.0 else ""
        with contextlib.suppress(OSError):  # a closed pipe must not end the computation
            self._display.show(part, reached, ", ".join(filter(None, (f"{part:.0%}", counted, left))))


@final
class RunsDone:
    """Counts completed runs.

    Parameters
    ----------
    meter : ProgressMeter
        Shows the count.
    total, done : int
        Number of all runs, and of the runs completed before.
    """

    def __init__(self, meter: ProgressMeter, total: int, done: int = 0) -> None:
        self._meter, self._total = meter, total
        self._before, self._done, self._failed = done, done, 0
        self.add(0, 0)

    def add(self, runs: int, failed: int) -> None:
        """Count completed runs, and how many of them failed."""
        self._done, self._failed = self._done + runs, self._failed + failed
        self._meter.show(self._done / self._total, self._words)

    def _words(self, elapsed: float) -> tuple[str, str]:
        rate = (self._done - self._before) / elapsed
        return f"{self._done} of {self._total} runs", f"{self._failed} failed, {rate:.3g} per s"


@final
@dataclass(frozen=True)
class TimeReached:
    """Shows the time that a run has reached.

    Attributes
    ----------
    meter : ProgressMeter
        Shows the time.
    """

    meter: ProgressMeter

    def __call__(self, t: float, t_end: float, events: int | None = None) -> None:
        """Note the time reached and the end time [s], and the number of events so far."""
        counted = "" if events is None else f"{events} events"
        self.meter.show(t / t_end, lambda _: (f"t = {t:.4g} of {t_end:.4g} s", counted))


@final
class RangeCovered:
    """Counts the orbits along a parameter, which are computed from a first value in both directions.

    Parameters
    ----------
    meter : ProgressMeter
        Shows the count.
    name : str
        Name of the parameter.
    value : float
        First value of the parameter.
    span : tuple of float
        Range of the parameter. The remaining time is the time until both ends are reached.
    """

    def __init__(self, meter: ProgressMeter, name: str, value: float, span: tuple[float, float]) -> None:
        self._meter, self._name, self._range = meter, name, span[1] - span[0]
        self._least = self._most = value
        self._count = 0
        self._show(value)

    def add(self, value: float) -> None:
        """Count one more orbit; ``value`` is the value of the parameter for which the orbit was computed."""
        self._count += 1
        self._least, self._most = min(self._least, value), max(self._most, value)
        self._show(value)

    def _show(self, value: float) -> None:
        def words(elapsed: float) -> tuple[str, str]:
            return f"orbit {self._count}, {self._name} = {value:.6g}", f"{self._count / elapsed:.3g} per s"

        self._meter.show((self._most - self._least) / self._range, words)
