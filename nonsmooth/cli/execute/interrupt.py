"""Ctrl-C while the engine runs: stop where nothing is lost."""

from __future__ import annotations

import signal
from types import FrameType, TracebackType

from nonsmooth.cli.report.messages import tell


class Interrupt:
    """While entered, the first Ctrl-C is a wish that :meth:`check` grants; a second one stops at once.

    Without it the interrupt could strike between two halves of a record.  A process in the background of
    a script is started with Ctrl-C ignored; there, too, ``kill -INT`` stops the run and keeps its results.
    """

    def __init__(self) -> None:
        self.asked = False

    def __enter__(self) -> Interrupt:
        self._previous = signal.signal(signal.SIGINT, self._ask)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        signal.signal(signal.SIGINT, self._previous)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True
        tell("\ninterrupt: stopping at the next safe point; once more stops at once")

    def check(self) -> None:
        """Raise KeyboardInterrupt if it was asked for."""
        if self.asked:
            raise KeyboardInterrupt
