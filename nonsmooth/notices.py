"""Notices on standard error while a computation takes long."""

from __future__ import annotations

import functools
import sys


@functools.cache
def say(text: str) -> None:
    """Print a line to standard error, once."""
    print(text, file=sys.stderr, flush=True)
