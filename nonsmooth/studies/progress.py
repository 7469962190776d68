"""How far a study is: runs done, rate, time left and failures, on standard error."""

from __future__ import annotations

import contextlib
import io
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, TextIO, final

if TYPE_CHECKING:
    from rich.progress import Progress as RichProgress


class Display(ABC):
    """Where it is shown; quiet for the first moments of a study."""

    patience: float
    """Wall time of a study before it is shown [s]."""
    interval: float
    """Wall time between two of its states [s]."""

    @abstractmethod
    def show(self, share: float, words: str) -> None:
        """Show which share is done, and how it goes."""

    @abstractmethod
    def close(self) -> None:
        """Remove what should not stay."""


@final
class Bar(Display):
    """A bar on a terminal, gone in the end.

    Parameters
    ----------
    stream : file
        The terminal.
    """

    patience, interval = 1.0, 0.2

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._bar: RichProgress | None = None

    def show(self, share: float, words: str) -> None:
        """Draw the bar anew."""
        self._bar = self._bar or self._begun()
        self._bar.update(self._bar.task_ids[0], completed=share, words=words)
        self._bar.refresh()

    def close(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.stop()

    def _begun(self) -> RichProgress:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        columns = BarColumn(20), TextColumn("{task.percentage:.0f}%, {task.fields[words]}")
        bar = Progress(*columns, console=Console(file=self._stream), auto_refresh=False, transient=True)
        bar.add_task("", total=1.0, words="")
        bar.start()
        return bar


@final
class Lines(Display):
    """A line now and then.

    Parameters
    ----------
    stream : file
        Where to write.
    """

    patience, interval = 2.0, 10.0

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def show(self, share: float, words: str) -> None:
        """Write a line."""
        self._stream.write(f"{share:.0%}: {words}\n")
        self._stream.flush()

    def close(self) -> None:
        """Leave what was written."""


@final
class Progress:
    """Counts runs.

    Parameters
    ----------
    display : Display
        Where to show it.
    total, done : int
        All runs, and those of them that were done before.
    clock : callable
        Wall time [s].
    """

    def __init__(self, display: Display, total: int, done: int, clock: Callable[[], float] = time.monotonic) -> None:
        self._display, self._clock = display, clock
        self._total, self._before, self._done, self._failed = total, done, done, 0
        self._began = clock()
        self._next = self._began + display.patience

    def add(self, runs: int, failed: int) -> None:
        """Count runs that are done, and those of them that have no records; show it if it is time to."""
        self._done, self._failed = self._done + runs, self._failed + failed
        now = self._clock()
        if now >= self._next:
            self._next = now + self._display.interval
            rate = (self._done - self._before) / (now - self._began)
            left = (self._total - self._done) / rate
            counted = f"{self._done} of {self._total} runs, {rate:.3g} per s, about {left:.0f} s to go"
            with contextlib.suppress(OSError):  # a closed pipe must not cost the study
                self._display.show(self._done / self._total, f"{counted}, {self._failed} failed")

    def finish(self) -> None:
        """Remove what should not stay."""
        with contextlib.suppress(OSError):
            self._display.close()


def on_standard_error() -> Display:
    """Return what suits the standard error of this process."""
    stream = sys.stderr or io.StringIO()  # None where it was closed from the start
    return Bar(stream) if stream.isatty() else Lines(stream)
