"""Where the author of a component finds what a message is about: file and line."""

from __future__ import annotations

import inspect
import sys
from types import TracebackType

_OTHERS = ("nonsmooth", "numpy", "scipy", "numba")
"""Packages in which an exception is raised because of what they are given."""


def place_of(owner: type) -> str:
    """Return name, file and line of a class; nothing where it has no file."""
    try:
        return f"{owner.__name__} in {inspect.getsourcefile(owner)}, line {inspect.getsourcelines(owner)[1]}"
    except (OSError, TypeError):
        return ""


def raised_at(error: BaseException) -> str:
    """Return file and line of the last call that is none of Python, or of packages below; nothing without one."""
    trace, found = error.__traceback__, ""
    while trace is not None:
        if not _is_others(trace):
            found = f", in {trace.tb_frame.f_code.co_filename}, line {trace.tb_lineno}"
        trace = trace.tb_next
    return found


def _is_others(trace: TracebackType) -> bool:
    package = str(trace.tb_frame.f_globals.get("__name__", "")).partition(".")[0]
    return package in _OTHERS or package in sys.stdlib_module_names


def told(error: BaseException) -> str:
    """Return what an exception says, and where it comes from, as a part of a sentence."""
    return f"it raises {type(error).__name__}: {str(error).rstrip('.')}{raised_at(error)}"
