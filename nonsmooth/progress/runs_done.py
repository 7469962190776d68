"""How many of many runs are done."""

from __future__ import annotations

from typing import final

from nonsmooth.progress.pace import Pace


@final
class RunsDone:
    """Counts runs.

    Parameters
    ----------
    pace : Pace
        Where they are told.
    total, done : int
        All runs, and those of them that were done before.
    """

    def __init__(self, pace: Pace, total: int, done: int = 0) -> None:
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
