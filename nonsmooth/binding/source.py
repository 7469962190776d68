"""Name, file and line of a function, and of an error within it, for messages."""

from __future__ import annotations

import functools
import inspect
import linecache
import sys
import traceback
from collections.abc import Callable, Iterable
from types import CodeType, FrameType
from typing import Any

from nonsmooth.engine.native.kernel import unshared


def name_of(function: Callable[..., Any]) -> str:
    """Qualified name of a function; of an object without a name, its ``repr``."""
    return str(getattr(function, "__qualname__", repr(function)))


def place_of(function: Callable[..., Any]) -> tuple[str, int]:
    """File of a function and its first line after the decorators; ("", 0) if it is not written in Python."""
    code = _code(function)
    if code is None:
        return "", 0
    line = code.co_firstlineno
    while linecache.getline(code.co_filename, line).lstrip().startswith("@"):
        line += 1
    return code.co_filename, line


def described(function: Callable[..., Any]) -> str:
    """Name, file and line of a function, as text."""
    file, line = place_of(function)
    return f"{name_of(function)} in {file}, line {line}" if file else f"{name_of(function)}, which has no source"


def raised(function: Callable[..., Any], error: BaseException) -> str:
    """Text on an error that a call of a function has raised, such as "raises ValueError(...) (line 3, `f(x)`)".

    The line is the last one of the traceback that is in the function's own file. If a function of another file raised
    the error, that file is named, too.
    """
    frames = traceback.extract_tb(error.__traceback__)
    last = _last_own(function, frames)
    beyond = f", from {frames[-1].filename}" if last is not None and frames[-1] is not last else ""
    return f"raises {error!r}{line_of(function, error)}{beyond}"


def line_of(function: Callable[..., Any], error: BaseException) -> str:
    """Text on the line of a function's file where an error was raised or passed on, such as " (line 3, `return x`)".

    It is the last line of the error's traceback that is in this file. Without such a line, it is the function's first.
    """
    file, line = place_of(function)
    last = _last_own(function, traceback.extract_tb(error.__traceback__))
    return _line(file, last.lineno if last is not None and last.lineno is not None else line)


def _last_own(function: Callable[..., Any], frames: Iterable[traceback.FrameSummary]) -> traceback.FrameSummary | None:
    file = place_of(function)[0]
    own = [frame for frame in frames if frame.filename == file and frame.lineno is not None]
    return own[-1] if own else None


def returned(function: Callable[..., Any], *arguments: Any, **more: Any) -> tuple[str, Any]:
    """Call a function; return a text, such as "returns 0.5 (line 3, `return x`)", and the value.

    If the function raises an error, the text is that of :func:`raised`, and the value is None.
    """
    code, lines = _code(function), [0]

    def follow(frame: FrameType, event: str, argument: Any) -> Any:
        if frame.f_code is code:
            lines[0] = frame.f_lineno
            return follow
        return None

    before = sys.gettrace()
    sys.settrace(follow)
    try:
        value = function(*arguments, **more)
    except Exception as error:
        return raised(function, error), None
    finally:
        sys.settrace(before)
    return f"returns {value!r}{_line(place_of(function)[0], lines[0])}", value


def _line(file: str, line: int) -> str:
    text = linecache.getline(file, line).strip()
    return f" (line {line}{f', `{text}`' if text and not text.startswith('raise ') else ''})" if line else ""


def _code(function: Callable[..., Any]) -> CodeType | None:
    inner = inspect.unwrap(unshared(function))
    while isinstance(inner, functools.partial):
        inner = inspect.unwrap(unshared(inner.func))
    if inspect.isfunction(inner) or inspect.ismethod(inner):
        return inner.__code__
    called = type(inner).__call__
    return called.__code__ if inspect.isfunction(called) else None
