"""The functions of a component, called from Python: as they stand, and as the engine calls them."""

from __future__ import annotations

import ctypes
import functools
import types
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.compile import bind, parameter_names
from nonsmooth.engine.native.kernel import PLAIN, at
from nonsmooth.parameters import Value

Array = NDArray[np.float64]
Caller = Callable[..., Any]
_POINTERS = {
    "body": 4,
    "load": 4,
    "pair": 4,
    "support": 3,
    "map": 4,
    "guard": 3,
    "scalar": 1,
    "compliance": 1,
    "traction": 4,
    "rates": 4,
}
_RETURNING = ("scalar", "guard", "compliance")


def plain_caller(function: Callable[..., Any], form: str, values: Mapping[str, Any]) -> Caller:
    """Return the function with its parameters filled in; of the form "map" they are one number per contact."""
    names = parameter_names(function, form)
    plain = _without_pointers(function)

    def call(*arguments: Any) -> Any:
        return plain(*arguments, **{name: values[name] for name in names})

    return call


@functools.cache
def _without_pointers(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that moves pointers, as those put together from parts do, with slices in their place."""
    scope = getattr(function, "__globals__", {})
    if PLAIN or not any(value is at for value in scope.values()):
        return function
    sliced = {name: _slice if value is at else value for name, value in scope.items()}
    copy = types.FunctionType(function.__code__, sliced, function.__name__, function.__defaults__, function.__closure__)
    copy.__qualname__ = function.__qualname__
    return copy


def _slice(heap: Array, offset: int) -> Array:
    return heap[offset:]


def compiled_caller(function: Callable[..., Any], form: str, values: Mapping[str, Value], owner: str) -> Caller:
    """Return the same, compiled; arguments are numbers and contiguous arrays, as the engine has them.

    Raises
    ------
    UnknownName
        If the function asks for a parameter that nobody gives.
    PluginError
        If the function cannot be compiled.
    """
    address, heap = bind(function, form, values, owner)
    if PLAIN:
        return plain_caller(function, form, values)
    numbers = np.array([*heap, 0.0])
    return _native(address, form, numbers)


def compiled_map(function: Callable[..., Any], vectors: Mapping[str, Array], owner: str) -> Caller:
    """Return a compiled function of the form "map", its parameters one number per contact."""
    address, _ = bind(function, "map", dict.fromkeys(vectors, 0.0), owner)
    if PLAIN:
        return plain_caller(function, "map", vectors)
    numbers = np.concatenate([vectors[name] for name in parameter_names(function, "map")] + [np.zeros(1)])
    return _native(address, "map", numbers)


def _native(address: int, form: str, numbers: Array) -> Caller:
    result = ctypes.c_double if form in _RETURNING else None
    heads: dict[str, list[Any]] = {"pair": [], "map": [ctypes.c_int64], "compliance": [ctypes.c_double] * 3}
    first = heads.get(form, [ctypes.c_double])
    native: Any = ctypes.CFUNCTYPE(result, *first, *[ctypes.c_void_p] * _POINTERS[form])(address)

    def call(*arguments: Any) -> Any:
        given = [a.ctypes.data if isinstance(a, np.ndarray) else a for a in arguments]
        if form in _RETURNING:
            return native(*given, numbers.ctypes.data)
        if form == "rates":
            # called as loads are, with the states in place of both bodies
            given.insert(1, given[1])
        # the engine hands the parameters over before what is to be written
        return native(*given[:-1], numbers.ctypes.data, given[-1])

    return call
