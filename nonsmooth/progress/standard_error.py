"""The display of a process."""

from __future__ import annotations

import io
import sys

from nonsmooth.progress.bar import Bar
from nonsmooth.progress.display import Display
from nonsmooth.progress.lines import Lines


def on_standard_error() -> Display:
    """Return what suits the standard error of this process."""
    stream = sys.stderr or io.StringIO()  # None where it was closed from the start
    return Bar(stream) if stream.isatty() else Lines(stream)
