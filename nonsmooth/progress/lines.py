"""Lines, where there is no terminal."""

from __future__ import annotations

from typing import TextIO, final

from nonsmooth.progress.display import Display


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
