"""Pace: when it is shown how far something is, and how long the rest will take."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from types import TracebackType
from typing import final

from nonsmooth.progress.display import Display


@final
class Pace:
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

    def __enter__(self) -> Pace:
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
