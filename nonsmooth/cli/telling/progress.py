"""Progress of a run on standard error: a bar on a terminal, an occasional line elsewhere."""

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

Clock = Callable[[], float]


class Display(ABC):
    """Where it is shown how far a run is."""

    patience: float
    """Wall time of a run before it is shown [s]."""
    interval: float
    """Wall time between two of its states [s]."""

    @abstractmethod
    def show(self, t: float, t_end: float, events: int | None, left: float | None) -> None:
        """Show time reached and end time [s], events so far and wall time left [s], as far as these two are known."""

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

    def show(self, t: float, t_end: float, events: int | None, left: float | None) -> None:
        """Draw the bar anew."""
        self._bar = self._bar or _begun(self._stream)
        before, behind = _words(t, t_end, events, left)
        self._bar.update(self._bar.task_ids[0], completed=t / t_end, before=before, behind=behind)
        self._bar.refresh()

    def close(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.stop()


def _begun(stream: TextIO) -> RichProgress:
    # importing it takes as long as many a run
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = TextColumn("{task.fields[before]}"), BarColumn(20), TextColumn("{task.fields[behind]}")
    bar = Progress(*columns, console=Console(file=stream), auto_refresh=False, transient=True)
    bar.add_task("", total=1.0, before="", behind="")
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

    def show(self, t: float, t_end: float, events: int | None, left: float | None) -> None:
        """Write a line."""
        before, behind = _words(t, t_end, events, left)
        self._stream.write(f"{before} ({behind})\n")
        self._stream.flush()

    def close(self) -> None:
        """Leave what was written."""


def _words(t: float, t_end: float, events: int | None, left: float | None) -> tuple[str, str]:
    counted = [] if events is None else [f"{events} events"]
    rest = [] if left is None else [f"about {left:.0f} s to go"]
    return f"t = {t:.4g} of {t_end:.4g} s", ", ".join([f"{t / t_end:.0%}", *counted, *rest])


@final
class Progress:
    """Called with the time reached and the end time [s]; quiet in the first second or two of a run.

    Parameters
    ----------
    display : Display
        Where to show it.
    clock : callable
        Wall time [s].
    """

    def __init__(self, display: Display, clock: Clock = time.monotonic) -> None:
        self._display, self._clock = display, clock
        self._first: tuple[float, float] | None = None
        self._next = self._share = 0.0

    def __call__(self, t: float, t_end: float, events: int | None = None) -> None:
        """Take note of the time reached, and of the events so far; show it if it is time to."""
        now, share = self._clock(), t / t_end
        if self._first is None or share < self._share:  # the first or the next of several runs
            # what came before the run, as compiling it, says nothing of how long it takes
            self._next = max(self._next, now + self._display.patience)
            self._first = now, share
        self._share = share
        if now < self._next:
            return
        self._next = now + self._display.interval
        began, done = self._first
        left = (now - began) * (1.0 - share) / (share - done) if share > done else None
        with contextlib.suppress(OSError):  # a closed pipe must not cost the run
            self._display.show(t, t_end, events, left)

    def finish(self) -> None:
        """Remove what should not stay."""
        with contextlib.suppress(OSError):
            self._display.close()


def on_standard_error() -> Progress:
    """Return the progress that suits the standard error of this process."""
    stream = sys.stderr or io.StringIO()  # None where it was closed from the start
    return Progress(Bar(stream) if stream.isatty() else Lines(stream))
