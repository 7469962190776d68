"""What goes to standard output and what to standard error, and in which form."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable
from typing import Any

from nonsmooth.errors import NonsmoothWarning
from nonsmooth.solution.files import FileError


def say(text: str) -> None:
    """Print a result to standard output.

    Raises
    ------
    FileError
        If it does not take it: a full disk, a closed pipe.
    """
    try:
        print(text, flush=True)
    except OSError as error:
        with contextlib.suppress(OSError):  # else the interpreter tries, and fails, once more when it ends
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise FileError("standard output", error) from error


def tell(text: str) -> None:
    """Print a message to standard error, if that is open and takes it: a message lost must not cost a run."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError):
            print(text, file=sys.stderr, flush=True)


def complain(text: str) -> None:
    """Print an error to standard error."""
    tell(f"error: {text}")


def warn_plainly(otherwise: Callable[..., None]) -> Callable[..., None]:
    """Return a replacement of ``warnings.showwarning`` that prints our warnings as one line each, once."""
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
