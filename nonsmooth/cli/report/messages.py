"""Messages: results go to standard output, all else to standard error."""

from __future__ import annotations

import contextlib
import os
import re
import sys
from collections.abc import Callable
from typing import Any

from nonsmooth.errors import NonsmoothWarning

_CONTROLS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""Characters that control a terminal or the direction of text, except tabulators and line breaks."""


def _printable(text: str) -> str:
    """Return a text with its control characters escaped, because a title may come from a file of another person."""
    return _CONTROLS.sub(lambda found: repr(found[0])[1:-1], text)


def say(text: str) -> None:
    """Print a result to standard output.

    Raises
    ------
    FileError
        If standard output cannot be written, for example because the disk is full.
    """
    try:
        print(_printable(text), flush=True)
    except OSError as error:
        # imported on use: `nonsmooth --help` starts faster without it
        from nonsmooth.storage.files import FileError

        discard_output()
        if isinstance(error, BrokenPipeError):
            # the reader has closed the pipe because it needs no more lines, as `head` does
            return
        raise FileError("standard output", error) from error


def discard_output() -> None:
    """Send standard output to nowhere, because the interpreter writes the rest at exit, and would fail again."""
    with contextlib.suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def tell(text: str) -> None:
    """Print a message to standard error; a message that cannot be printed must not end a run."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError):
            print(_printable(text), file=sys.stderr, flush=True)


def complain(text: str) -> None:
    """Print an error to standard error."""
    tell(f"error: {text}")


def warn_plainly(otherwise: Callable[..., None]) -> Callable[..., None]:
    """Return a replacement of ``warnings.showwarning`` that prints each warning of nonsmooth once, in one line.

    The replacement passes warnings of other packages to ``otherwise``.
    """
    printed: set[str] = set()

    def show(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
        if not issubclass(category, NonsmoothWarning):
            otherwise(message, category, *where, **more)
            return
        line = " ".join(str(message).split())
        if line not in printed:
            tell(f"warning: {line}")
        printed.add(line)

    return show
