"""The functions of a component, called from Python: as they stand, and as the engine calls them."""

from __future__ import annotations

import functools
import types
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.compile import bind, caller, parameter_names
from nonsmooth.engine.native.kernel import PLAIN, at
from nonsmooth.parameters import Value

Array = NDArray[np.float64]
Caller = Callable[..., Any]


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
    return caller(form, address, np.array([*heap, 0.0]))


def compiled_map(function: Callable[..., Any], vectors: Mapping[str, Array], owner: str) -> Caller:
    """Return a compiled function of the form "map", its parameters one number per contact."""
    address, _ = bind(function, "map", dict.fromkeys(vectors, 0.0), owner)
    if PLAIN:
        return plain_caller(function, "map", vectors)
    numbers = np.concatenate([vectors[name] for name in parameter_names(function, "map")] + [np.zeros(1)])
    return caller("map", address, numbers)
