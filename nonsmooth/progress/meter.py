"""Progress of runs, times and ranges, shown now and then."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from dataclasses import dataclass
from types import TracebackType
from typing import final

from nonsmooth.progress.displays import Display


@final
class ProgressMeter:
    """Shows now and then, while entered, how far something is; quiet for the first moments of it.

    Parameters
    ----------
    display : Display
        Where to show it.
    clock : callable
        Wall time [s].
    """

    def __init__(self, display: Display, clock: Callable[[], float] = time.monotonic) -> None:
        self._display, self._clock = display, clock
        self._next = self._began = self._first = 0.0
        self._share = float("inf")

    def __enter__(self) -> ProgressMeter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with contextlib.suppress(OSError):
            self._display.close()

    def show(self, share: float, words: Callable[[float], tuple[str, str]]) -> None:
        """Take note of the share that is done, and show it if it is time to.

        Parameters
        ----------
        share : float
            From 0 to 1; less than before for the next one of several things.
        words : callable
            From the time since the first share [s] to how far it is, and what else there is to say.
        """
        now = self._clock()
        if share < self._share:
            # what came before, as compiling, says nothing of how long it takes
            self._next = max(self._next, now + self._display.patience)
            self._began, self._first = now, share
        self._share = share
        if now <= self._next:
            return
        self._next = now + self._display.interval
        elapsed, done = now - self._began, share - self._first
        before, counted = words(elapsed)
        left = f"about {elapsed * (1.0 - share) / done:.0f} s to go" if done > 0.0 else ""
        with contextlib.suppress(OSError):  # a closed pipe must not cost what is computed
            self._display.show(share, before, ", ".join(filter(None, (f"{share:.0%}", counted, left))))


@final
class RunsDone:
    """Counts runs.

    Parameters
    ----------
    pace : ProgressMeter
        Where they are told.
    total, done : int
        All runs, and those of them that were done before.
    """

    def __init__(self, pace: ProgressMeter, total: int, done: int = 0) -> None:
        self._pace, self._total = pace, total
        self._before, self._done, self._failed = done, done, 0
        self.add(0, 0)

    def add(self, runs: int, failed: int) -> None:
        """Count runs that are done, and those of them that have no records."""
        self._done, self._failed = self._done + runs, self._failed + failed
        self._pace.show(self._done / self._total, self._words)

    def _words(self, elapsed: float) -> tuple[str, str]:
        rate = (self._done - self._before) / elapsed
        return f"{self._done} of {self._total} runs", f"{self._failed} failed, {rate:.3g} per s"


@final
@dataclass(frozen=True)
class TimeReached:
    """Tells the time that a run has reached.

    Attributes
    ----------
    pace : ProgressMeter
        Where it is told.
    """

    pace: ProgressMeter

    def __call__(self, t: float, t_end: float, events: int | None = None) -> None:
        """Take note of the time reached and the end time [s], and of the events so far."""
        told = "" if events is None else f"{events} events"
        self.pace.show(t / t_end, lambda _: (f"t = {t:.4g} of {t_end:.4g} s", told))


@final
class RangeCovered:
    """Counts the orbits that are found over a parameter, from a value on both ways.

    Parameters
    ----------
    pace : ProgressMeter
        Where they are told.
    name : str
        The parameter.
    value : float
        Where it begins.
    span : tuple of float
        Its range: the time left is that to both ends.
    """

    def __init__(self, pace: ProgressMeter, name: str, value: float, span: tuple[float, float]) -> None:
        self._pace, self._name, self._range = pace, name, span[1] - span[0]
        self._least = self._most = value
        self._count = 0
        self._tell(value)

    def add(self, value: float) -> None:
        """Count the orbit at a value."""
        self._count += 1
        self._least, self._most = min(self._least, value), max(self._most, value)
        self._tell(value)

    def _tell(self, value: float) -> None:
        def words(elapsed: float) -> tuple[str, str]:
            return f"orbit {self._count}, {self._name} = {value:.6g}", f"{self._count / elapsed:.3g} per s"

        self._pace.show((self._most - self._least) / self._range, words)
