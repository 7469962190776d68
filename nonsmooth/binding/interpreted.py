"""Functions that run in Python because they cannot be compiled; the engine calls them by address like all others.

An exception cannot pass through the engine.  The result becomes a number that is not finite, and the exception is
stored here for the message.  A Ctrl-C within a function is stored until the engine has reached a safe point, and the
call is repeated.  A second Ctrl-C makes the call fail.
"""

from __future__ import annotations

import ctypes
import inspect
import statistics
import time
import types
from collections.abc import Callable
from typing import Any

from nonsmooth.binding.source import raised
from nonsmooth.engine.native.forms import FORMS
from nonsmooth.engine.native.kernel import PLAIN, at, unshared

_Pointer = ctypes.POINTER(ctypes.c_double)
_SECONDS = 5e-3
"""Longest total time of the calls that :func:`cost` measures [s]. It is so short that a run hardly starts later."""
_CALLS = 100
_alive: list[Any] = []
_raised: dict[Callable[..., Any], str] = {}
_held: list[bool] = []


def note(function: Callable[..., Any], error: BaseException) -> None:
    """Store the error that a function has raised, as text for a message."""
    _raised[function] = raised(function, error)


def noted(function: Callable[..., Any]) -> str:
    """Last error of a function with its place, as text; "" if it has raised no error."""
    return _raised.get(function, "")


def forget() -> None:
    """Delete the stored errors and interrupts."""
    _raised.clear()
    _held.clear()


def hold() -> bool:
    """Store a Ctrl-C until the engine can stop; True if an earlier Ctrl-C was stored already."""
    _held.append(True)
    return len(_held) > 1


def let_go() -> bool:
    """Delete the stored Ctrl-C; True if there was one."""
    asked = bool(_held)
    _held.clear()
    return asked


def address(shim: Callable[..., Any], form: str) -> int:
    """Address of a C function that calls a Python function; it is valid until the process ends.

    ``form`` names the C signature, the types of arguments and result (:data:`nonsmooth.engine.native.forms.FORMS`).
    """
    callback = FORMS[form].prototype(_Pointer)(shim)
    _alive.append(callback)
    return int(ctypes.cast(callback, ctypes.c_void_p).value or 0)


def cost(shim: Callable[..., Any], form: str, numbers: tuple[float, ...]) -> str:
    """Sentence with the measured time of a call from the engine to a Python function.

    A function that takes arrays besides its parameters cannot be called without valid input. So an empty function is
    timed in its place, and the sentence says that a call takes longer. ``form`` names the signature, and ``numbers`` is
    the block of parameters.
    """
    kinds, prototype = tuple(FORMS[form].arguments.values()), FORMS[form].prototype(_Pointer)
    heap = (ctypes.c_double * (len(numbers) + 1))(*numbers)
    given = tuple(heap if kind == "F" else 0 if kind == "i8" else 0.0 for kind in kinds)
    if kinds.count("F") == 1:
        return f"A call takes {1e6 * _time(prototype(shim), given):.1f} us, timed just now"
    seconds = _time(prototype(lambda *arguments: 0.0), given)
    return f"A call takes more than {1e6 * seconds:.1f} us, the time of an empty function, measured just now"


def _time(function: Callable[..., Any], arguments: tuple[Any, ...]) -> float:
    """Median time of a call [s]."""
    took: list[float] = []
    began = time.perf_counter()
    while len(took) < _CALLS and time.perf_counter() - began < _SECONDS:
        start = time.perf_counter()
        function(*arguments)
        took.append(time.perf_counter() - start)
    return statistics.median(took)


def in_python(function: Callable[..., Any], move: Callable[..., Any]) -> Callable[..., Any]:
    """Copy of a function that Python can run without compilation.

    In place of the engine's ``at(block, offset)`` the copy calls ``move(block, offset)``. The reason is that ``at``
    moves a pointer, which only compiled functions can do.
    """
    return function if PLAIN else _moving(unshared(function), move)


def _moving(
    function: Callable[..., Any], move: Callable[..., Any], above: tuple[Callable[..., Any], ...] = ()
) -> Callable[..., Any]:
    if not inspect.isfunction(function) or function in above:
        return function
    scope, new = function.__globals__, {}
    for name in function.__code__.co_names:
        value = scope.get(name)
        inner = unshared(value)
        if value is at:
            new[name] = move
        elif inner is not value and (moved := _moving(inner, move, (*above, function))) is not inner:
            new[name] = moved
    if not new:
        return function
    copy = types.FunctionType(
        function.__code__, {**scope, **new}, function.__name__, function.__defaults__, function.__closure__
    )
    copy.__kwdefaults__, copy.__qualname__ = function.__kwdefaults__, function.__qualname__
    return copy


def move(heap: Any, offset: int) -> Any:
    """Pointer to the numbers of a block from an offset on; in plain mode an array that views these numbers."""
    if PLAIN:
        return at(heap, offset)
    start = ctypes.addressof(heap.contents) + offset * ctypes.sizeof(ctypes.c_double)
    return ctypes.cast(start, _Pointer)
