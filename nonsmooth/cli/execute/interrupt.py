"""Ctrl-C during a run: it stops at the next safe point."""

from __future__ import annotations

import signal
from types import FrameType
from typing import Any

from nonsmooth.cli.report.messages import tell


class Interrupt:
    """While entered, the first Ctrl-C stops the run in :meth:`check`, a second one at once.

    Without it an interrupt could divide a record.  A background process of a script ignores Ctrl-C from the start;
    ``kill -INT`` stops its run, too, and keeps the results.
    """

    def __init__(self) -> None:
        self.asked = False

    def __enter__(self) -> Interrupt:
        self._previous = signal.signal(signal.SIGINT, self._ask)
        return self

    def __exit__(self, *error: Any) -> None:
        signal.signal(signal.SIGINT, self._previous)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self.asked:
            raise KeyboardInterrupt
        self.asked = True
        tell("\ninterrupt: stopping at the next safe point; once more stops at once")

    def check(self) -> None:
        """Raise KeyboardInterrupt after a first Ctrl-C."""
        if self.asked:
            raise KeyboardInterrupt
