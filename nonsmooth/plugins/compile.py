"""From a plain Python function with named parameters to an address that the engine calls."""

from __future__ import annotations

import ctypes
import dis
import functools
import inspect
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from nonsmooth.engine.kernel import COMPILATION_ERRORS, PLAIN, address_of, at, call_scalar, jit
from nonsmooth.errors import PluginError, UnknownName
from nonsmooth.parameters import Value
from nonsmooth.plugins.fingerprint import fingerprint

ROLES = {
    "scalar": ("x",),
    "compliance": ("indentation", "rate", "closing_rate"),
    "traction": ("normal_force", "motion", "state", "out"),
    "rates": ("speed", "state", "out"),
    "guard": ("t", "q", "u"),
    "body": ("t", "q", "u", "out"),
    "load": ("t", "a", "b", "out"),
    "pair": ("a", "b", "out"),
    "map": ("n", "delassus", "rates", "out"),
}
"""What the engine passes to a function of each form, before the function's own parameters."""

_CALLS = {
    "scalar": ("x, p", "return law(x{unpacked})", "return nan"),
    "compliance": ("x, y, z, p", "return law(x, y, z{unpacked})", "return nan"),
    "traction": ("t, a, b, p, out", "law(t, a, b, out{unpacked})", "out[0] = nan"),
    "rates": ("t, a, b, p, out", "law(t, b, out{unpacked})", "out[0] = nan"),
    "guard": ("t, q, u, p", "return law(t, q, u{unpacked})", "return nan"),
    "body": ("t, q, u, p, out", "law(t, q, u, out{unpacked})", "out[0] = nan"),
    "load": ("t, a, b, p, out", "law(t, a, b, out{unpacked})", "out[0] = nan"),
    "pair": ("a, b, p, out", "law(a, b, out{unpacked})", "out[0] = nan"),
    "map": ("n, delassus, rates, p, out", "law(n, delassus, rates, out{unpacked})", "out[0] = nan"),
}
"""What the engine calls with, the call of the function, and what stands for an exception."""
_PLAIN_SHIM = "def shim({arguments}):\n {call}"
_GUARDED_SHIM = "def shim({arguments}):\n try: {call}\n except Exception: {failure}"
"""A compiled function cannot raise into the engine: an exception becomes a number that is not finite.

Compiling the guard takes as long as compiling the function, so that it is left out where nothing raises.
"""


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
        One of ``ROLES``.
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
    scope: dict[str, Any] = {"__name__": __name__, "law": jit(function), "at": at, "nan": math.nan}
    arguments, call, failure = _CALLS[form]
    shim = _GUARDED_SHIM if PLAIN or _may_raise(function) else _PLAIN_SHIM
    text = shim.format(arguments=arguments, call=call.format(unpacked=unpacked), failure=failure)
    exec(text, scope)  # the shim's text is ours, never the user's
    return address_of(scope["shim"], form, fingerprint(function, form + text))


def _may_raise(function: Callable[..., Any]) -> bool:
    """Return whether a function, or one that it names, has a statement that raises."""
    waiting, seen = [inspect.unwrap(function)], set()
    while waiting:
        one = waiting.pop()
        if one in seen or not inspect.isfunction(one):
            continue
        seen.add(one)
        if any(instruction.opname == "RAISE_VARARGS" for instruction in dis.get_instructions(one)):
            return True
        named = inspect.getclosurevars(one)
        waiting += [inspect.unwrap(v) for v in (*named.globals.values(), *named.nonlocals.values()) if callable(v)]
    return False


def evaluate(address: int, parameters: tuple[float, ...], x: float) -> float:
    """Return what the function of the form "scalar" at an address, as :func:`bind` gives both, makes of ``x``."""
    heap = np.array(parameters, dtype=float)
    if PLAIN:
        return float(call_scalar(address, x, memoryview(heap.data)))
    function = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.c_void_p)(address)
    return float(function(x, heap.ctypes.data))
