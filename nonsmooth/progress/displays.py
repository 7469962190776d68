"""Displays of progress: a bar on a terminal, lines elsewhere, or nothing."""

from __future__ import annotations

import io
import math
import sys
import threading
from abc import ABC, abstractmethod
from multiprocessing import parent_process
from typing import TYPE_CHECKING, TextIO, final

if TYPE_CHECKING:
    from rich.progress import Progress


class Display(ABC):
    """Shows the progress of a computation."""

    patience: float
    """Wall time of the computation before its progress is shown for the first time [s]."""
    interval: float
    """Wall time between two updates of the display [s]."""

    @abstractmethod
    def show(self, part: float, reached: str, details: str) -> None:
        """Show the state of the computation.

        Parameters
        ----------
        part : float
            Completed part, from 0 to 1.
        reached : str
            Progress in words, "12 of 40 runs".
        details : str
            Percentage, counts and remaining time in words.
        """

    @abstractmethod
    def close(self) -> None:
        """End the display, and remove it from the screen if it is temporary."""


@final
class Bar(Display):
    """A bar on a terminal; it vanishes at the end.

    Parameters
    ----------
    stream : file
        The terminal.
    patience : float
        Wall time before the bar appears [s].
    """

    interval = 0.2

    def __init__(self, stream: TextIO, patience: float = 1.0) -> None:
        self._stream, self.patience = stream, patience
        self._bar: Progress | None = None

    def show(self, part: float, reached: str, details: str) -> None:
        """Draw the bar again."""
        self._bar = self._bar or self._started()
        self._bar.update(self._bar.task_ids[0], completed=part, reached=reached, details=details)
        self._bar.refresh()

    def close(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.stop()

    def _started(self) -> Progress:
        # imported on use, because the import takes as long as many short runs
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        columns = TextColumn("{task.fields[reached]}"), BarColumn(20), TextColumn("{task.fields[details]}")
        bar = Progress(*columns, console=Console(file=self._stream), auto_refresh=False, transient=True)
        bar.add_task("", total=1.0, reached="", details="")
        bar.start()
        return bar


@final
class Lines(Display):
    """An occasional line on a stream that is not a terminal.

    Parameters
    ----------
    stream : file
        The stream.
    patience, interval : float
        Wall time before the first line, and between two lines [s].
    """

    def __init__(self, stream: TextIO, patience: float = 2.0, interval: float = 10.0) -> None:
        self._stream, self.patience, self.interval = stream, patience, interval

    def show(self, part: float, reached: str, details: str) -> None:
        """Write a line."""
        self._stream.write(f"{reached} ({details})\n")
        self._stream.flush()

    def close(self) -> None:
        """Do nothing, because the lines remain."""


@final
class SameLine(Display):
    """A line that is written again and again at the same place, as the output of a notebook allows.

    Parameters
    ----------
    stream : file
        The output.
    patience : float
        Wall time before the line appears [s].
    """

    interval = 0.5

    def __init__(self, stream: TextIO, patience: float = 1.0) -> None:
        self._stream, self.patience = stream, patience
        self._length = 0

    def show(self, part: float, reached: str, details: str) -> None:
        """Write the line over the one before."""
        self._write(f"{reached} ({details})")

    def close(self) -> None:
        """Erase the line."""
        if self._length:
            self._write("")
            self._write("")

    def _write(self, text: str) -> None:
        self._stream.write(f"\r{text.ljust(self._length)}")
        self._stream.flush()
        self._length = len(text)


@final
class Quiet(Display):
    """Shows nothing: ``continuation(..., display=Quiet())``."""

    patience, interval = math.inf, math.inf

    def show(self, part: float, reached: str, details: str) -> None:
        """Show nothing."""

    def close(self) -> None:
        """Do nothing."""


_LONG = 3.0
"""Wall time after which a run shows its progress [s] if the user has set no display; a shorter run prints nothing."""


def of_long_run() -> Display | None:
    """Return a display on standard error for a run of more than 3 s, if a person can see it; else None.

    A person sees the terminal, or the output of a notebook. Runs in other threads and processes have no display,
    because their bars would overwrite one another.
    """
    stream = sys.stderr
    if stream is None or threading.current_thread() is not threading.main_thread() or parent_process() is not None:
        return None
    if stream.isatty():
        return Bar(stream, _LONG)
    return SameLine(stream, _LONG) if _is_notebook() else None


def _is_notebook() -> bool:
    """True if this process is the kernel of a notebook. IPython is not imported for this."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")


def on_standard_error() -> Display:
    """Return a bar if standard error is a terminal, else lines."""
    stream = sys.stderr or io.StringIO()  # sys.stderr is None if it was closed before the start
    return Bar(stream) if stream.isatty() else Lines(stream)
