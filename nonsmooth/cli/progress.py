"""Progress of a run on standard error: one updating line on a terminal, an occasional line elsewhere."""

from __future__ import annotations

import contextlib
import io
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TextIO


@dataclass(frozen=True)
class Style:
    """How often to write [s of wall time], and between what."""

    patience: float
    interval: float
    start: str
    end: str
    last: str


TERMINAL = Style(patience=1.0, interval=0.2, start="\r", end="\x1b[K", last="\r\x1b[K")
LINES = Style(patience=2.0, interval=10.0, start="", end="\n", last="")


class Progress:
    """Called with the time reached and the end time [s]; quiet in the first second or two.

    Parameters
    ----------
    stream : file
        Where to write.
    style : Style
        How.
    clock : callable
        Wall time [s].
    """

    def __init__(self, stream: TextIO, style: Style, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream, self._style, self._clock = stream, style, clock
        self._next = clock() + style.patience
        self._first: tuple[float, float] | None = None
        self._share = 0.0
        self._written = False

    def __call__(self, t: float, t_end: float) -> None:
        """Take note of the time reached; write it if it is time to."""
        now, share = self._clock(), t / t_end
        if share < self._share:  # the next of several runs
            self._first = None
        self._share = share
        # what came before the run, as compiling it, says nothing of how long it takes
        self._first = self._first or (now, share)
        if now < self._next:
            return
        self._next = now + self._style.interval
        began, done = self._first
        left = f", about {(now - began) * (1.0 - share) / (share - done):.0f} s to go" if share > done else ""
        self._write(f"{self._style.start}t = {t:.4g} of {t_end:.4g} s ({share:.0%}){left}{self._style.end}")

    def finish(self) -> None:
        """Remove what should not stay."""
        if self._written:
            self._write(self._style.last)

    def _write(self, text: str) -> None:
        with contextlib.suppress(OSError):  # a closed pipe must not cost the run
            self._stream.write(text)
            self._stream.flush()
        self._written = True


def on_standard_error() -> Progress:
    """Return the progress that suits the standard error of this process."""
    stream = sys.stderr or io.StringIO()  # None where it was closed from the start
    return Progress(stream, TERMINAL if stream.isatty() else LINES)
