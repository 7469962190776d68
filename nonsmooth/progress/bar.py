"""A bar on a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, TextIO, final

from nonsmooth.progress.display import Display

if TYPE_CHECKING:
    from rich.progress import Progress


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
