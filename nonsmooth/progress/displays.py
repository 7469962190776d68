"""Displays of progress: a bar on a terminal, lines elsewhere, nothing."""

from __future__ import annotations

import io
import math
import sys
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, TextIO, final

if TYPE_CHECKING:
    from rich.progress import Progress


class Display(ABC):
    """Where it is shown how far something is."""

    patience: float
    """Wall time of what takes long before it is shown [s]."""
    interval: float
    """Wall time between two of its states [s]."""

    @abstractmethod
    def show(self, share: float, before: str, behind: str) -> None:
        """Show which share is done, in words how far it is, and in words what else is known."""

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
        self._bar: Progress | None = None

    def show(self, share: float, before: str, behind: str) -> None:
        """Draw the bar anew."""
        self._bar = self._bar or self._begun()
        self._bar.update(self._bar.task_ids[0], completed=share, before=before, behind=behind)
        self._bar.refresh()

    def close(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.stop()

    def _begun(self) -> Progress:
        # importing it takes as long as many a run
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        columns = TextColumn("{task.fields[before]}"), BarColumn(20), TextColumn("{task.fields[behind]}")
        bar = Progress(*columns, console=Console(file=self._stream), auto_refresh=False, transient=True)
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

    def show(self, share: float, before: str, behind: str) -> None:
        """Write a line."""
        self._stream.write(f"{before} ({behind})\n")
        self._stream.flush()

    def close(self) -> None:
        """Leave what was written."""


@final
class Quiet(Display):
    """Shows nothing: ``continuation(..., display=Quiet())``."""

    patience, interval = math.inf, math.inf

    def show(self, share: float, before: str, behind: str) -> None:
        """Show nothing."""

    def close(self) -> None:
        """Remove nothing."""


def on_standard_error() -> Display:
    """Return what suits the standard error of this process."""
    stream = sys.stderr or io.StringIO()  # None where it was closed from the start
    return Bar(stream) if stream.isatty() else Lines(stream)
