"""Notices on standard error while a computation takes long, and warnings at the line of the user."""

from __future__ import annotations

import functools
import sys
import warnings
from pathlib import Path

_HOME = Path(__file__).resolve().parents[1]
_PACKAGES = ("nonsmooth", "bodies", "laws", "scenarios")


def _is_ours(file: str) -> bool:
    """True for a file of this project, and for the constructors that dataclasses write."""
    return file == "<string>" or any(_HOME / package in Path(file).parents for package in _PACKAGES)


@functools.cache
def say(text: str) -> None:
    """Print a line to standard error, once."""
    print(text, file=sys.stderr, flush=True)


def warn(text: str, category: type[Warning]) -> None:
    """Warn at the innermost line outside of this project, which is the user's."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and _is_ours(frame.f_code.co_filename):
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)
