"""Calls of plain Python functions that may not come back."""

from __future__ import annotations

import ctypes
import inspect
import sys
import threading
import time
import types
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, final

from nonsmooth.engine.native.kernel import unshared

SECONDS = 1.0
"""What one call of a law's function in plain Python may take [s]."""


@final
@dataclass(frozen=True)
class Call:
    """A call to be made: what for, of which function, and the call itself."""

    words: str
    function: Callable[..., Any]
    make: Callable[[], Any]


class OutOfTime(Exception):
    """A call that did not come back in time; says where it was."""


def where(function: Callable[..., Any]) -> str:
    """Return name, file and line of a function."""
    code = inspect.unwrap(unshared(function)).__code__
    return f"{function.__qualname__} in {code.co_filename}, line {code.co_firstlineno}"


def make_all(calls: Sequence[Call], seconds: float = SECONDS) -> None:
    """Make calls one after the other in a thread that is watched, and left behind if one takes too long.

    Raises
    ------
    OutOfTime
        If one call takes longer than ``seconds``.
    """
    made: list[float] = []
    errors: list[BaseException] = []

    def work() -> None:
        for call in calls:
            made.append(time.perf_counter())
            try:
                call.make()
            except BaseException as error:
                errors.append(error)
                return

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(0.02)
        if thread.is_alive() and made and time.perf_counter() - made[-1] > seconds:
            call = calls[len(made) - 1]
            place = _line(thread, call.function)
            _stop(thread)
            raise OutOfTime(f"{call.words} takes longer than {seconds:g} s in {where(call.function)}, {place}")
    if errors:
        raise errors[0]


def _line(thread: threading.Thread, function: Callable[..., Any]) -> str:
    """Return the line at which a thread is, in the file of a function."""
    frame: types.FrameType | None = sys._current_frames().get(thread.ident or 0)
    file = inspect.unwrap(unshared(function)).__code__.co_filename
    while frame is not None and frame.f_code.co_filename != file:
        frame = frame.f_back
    return f"at line {frame.f_lineno}" if frame is not None else "at an unknown line"


def _stop(thread: threading.Thread) -> None:
    """Raise SystemExit in a thread, at its next line of Python."""
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident or 0), ctypes.py_object(SystemExit))
