"""Calling from Python what the engine calls by address: functions of bodies and of contact pairs outside of a run."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.kernel import PLAIN, call_body, call_pair
from nonsmooth.parameters import Value
from nonsmooth.plugins.compile import bind

Vector = NDArray[np.float64]


def body_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> Callable[[float, Vector, Vector, Vector], None]:
    """Return ``call(t, q, u, out)`` that runs a function of the form "body" just as the engine runs it.

    Its vectors are contiguous arrays of floats, and nobody checks their lengths.

    Raises
    ------
    UnknownName
        If the function asks for a parameter that nobody gives.
    """
    address, heap = bind(function, "body", values, owner)
    numbers = np.array([*heap, 0.0])
    if PLAIN:
        return lambda t, q, u, out: call_body(address, t, q, u, numbers, out)
    native: Any = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.c_void_p] * 4)(address)

    def call(t: float, q: Vector, u: Vector, out: Vector) -> None:
        native(t, q.ctypes.data, u.ctypes.data, numbers.ctypes.data, out.ctypes.data)

    return call


def pair_caller(
    function: Callable[..., None], values: Mapping[str, Value], owner: str
) -> Callable[[Vector, Vector, Vector], None]:
    """Return ``call(a, b, out)`` that runs a function of the form "pair" just as the engine runs it.

    Its vectors are contiguous arrays of floats, and nobody checks their lengths.

    Raises
    ------
    UnknownName
        If the function asks for a parameter that nobody gives.
    """
    address, heap = bind(function, "pair", values, owner)
    numbers = np.array([*heap, 0.0])
    if PLAIN:
        return lambda a, b, out: call_pair(address, a, b, numbers, out)
    native: Any = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(address)
    heap_address = numbers.ctypes.data

    def call(a: Vector, b: Vector, out: Vector, _kept: Vector = numbers) -> None:
        native(a.ctypes.data, b.ctypes.data, heap_address, out.ctypes.data)

    return call
