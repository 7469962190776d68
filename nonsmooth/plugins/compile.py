"""From a plain Python function with named parameters to an address that the engine calls."""

from __future__ import annotations

import ctypes
import functools
import inspect
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from nonsmooth.engine.kernel import COMPILATION_ERRORS, PLAIN, address_of, at, call_scalar, jit
from nonsmooth.errors import PluginError, UnknownName
from nonsmooth.parameters import Value

ROLES = {
    "scalar": ("x",),
    "guard": ("t", "q", "u"),
    "body": ("t", "q", "u", "out"),
    "load": ("t", "a", "b", "out"),
    "pair": ("a", "b", "out"),
    "map": ("n", "delassus", "rates", "out"),
}
"""What the engine passes to a function of each form, before the function's own parameters."""

_FAILS = " except Exception: "
_SHIMS = {
    "scalar": "def shim(x, p):\n try: return law(x{unpacked})\n" + _FAILS + "return nan",
    "guard": "def shim(t, q, u, p):\n try: return law(t, q, u{unpacked})\n" + _FAILS + "return nan",
    "body": "def shim(t, q, u, p, out):\n try: law(t, q, u, out{unpacked})\n" + _FAILS + "out[0] = nan",
    "load": "def shim(t, a, b, p, out):\n try: law(t, a, b, out{unpacked})\n" + _FAILS + "out[0] = nan",
    "pair": "def shim(a, b, p, out):\n try: law(a, b, out{unpacked})\n" + _FAILS + "out[0] = nan",
    "map": "def shim(n, delassus, rates, p, out):\n try: law(n, delassus, rates, out{unpacked})\n"
    + _FAILS
    + "out[0] = nan",
}
"""What the engine calls; a compiled function cannot raise into it, so that an exception becomes a number not finite."""


def parameter_names(function: Callable[..., Any], form: str) -> tuple[str, ...]:
    """Return the names of a function's own parameters, in order."""
    return tuple(inspect.signature(function).parameters)[len(ROLES[form]) :]


def bind(
    function: Callable[..., Any], form: str, values: Mapping[str, Value], owner: str
) -> tuple[int, tuple[float, ...]]:
    """Compile a law function and pick its parameters out of ``values`` by name.

    Parameters
    ----------
    function : callable
        A plain function whose first arguments are those of ``ROLES[form]``.
    form : str
        "scalar", "guard", "body", "load", "pair" or "map".
    values : mapping of str to float or tuple of float
        The parameters that the law's object and its surroundings offer; the function gets a tuple as a heap.
    owner : str
        The law, for messages.

    Returns
    -------
    tuple of int and tuple of float
        The address, and what the function's parameters need on the heap: one number each, in the order of the
        signature, then the tuples; the number of a tuple says where it begins.

    Raises
    ------
    UnknownName
        If the function asks for a parameter that nobody gives.
    PluginError
        If the function cannot be compiled.
    """
    names = parameter_names(function, form)
    for name in names:
        if name not in values:
            raise UnknownName(f"{owner}: {function.__qualname__} asks for a parameter whose", name, values)
    vectors = tuple(isinstance(values[name], tuple) for name in names)
    heap: list[float] = [0.0] * len(names)
    for i, name in enumerate(names):
        value = values[name]
        if isinstance(value, tuple):
            heap[i] = float(len(heap))
            heap += [float(x) for x in value]
        else:
            heap[i] = float(value)
    try:
        return _address(function, form, vectors), tuple(heap)
    except COMPILATION_ERRORS as error:
        raise PluginError(
            f"{owner}: {function.__qualname__}({', '.join(ROLES[form] + names)}) cannot be compiled. "
            f"Run with NONSMOOTH_PLAIN=1 to debug it as plain Python. {error}"
        ) from error


@functools.cache
def _address(function: Callable[..., Any], form: str, vectors: tuple[bool, ...]) -> int:
    item = "at(p, {0} * n)" if form == "map" else "p[{0}]"
    items = ["at(p, int(p[{0}]))" if vector else item for vector in vectors]
    unpacked = "".join(", " + text.format(i) for i, text in enumerate(items))
    scope: dict[str, Any] = {"law": jit(function), "at": at, "nan": math.nan}
    exec(_SHIMS[form].format(unpacked=unpacked), scope)  # the shim's text is ours, never the user's
    return address_of(scope["shim"], form)


def evaluate(address: int, parameters: tuple[float, ...], x: float) -> float:
    """Return what the function of the form "scalar" at an address, as :func:`bind` gives both, makes of ``x``."""
    heap = np.array(parameters, dtype=float)
    if PLAIN:
        return float(call_scalar(address, x, memoryview(heap.data)))
    function = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.c_void_p)(address)
    return float(function(x, heap.ctypes.data))
