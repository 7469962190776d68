"""Functions that the functions of plug-ins call, compiled, and that Python calls as they are."""

from __future__ import annotations

import functools
import importlib
import sys
from collections.abc import Callable
from typing import Any, final


@final
class Shared:
    """A function that has a compiled half for compiled code, and that Python calls as a Python function.

    Parameters
    ----------
    function : callable
        The function.
    compiled : str
        Name, in :mod:`nonsmooth.engine.native.address_calls`, of the function compiled in its place; "" for itself.
    """

    def __init__(self, function: Callable[..., Any], compiled: str = "") -> None:
        """Store the function, and copy its name and docstring."""
        self.function, self.compiled = function, compiled
        functools.update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        """Call the Python function, when Python calls this object."""
        return self.function(*arguments)


shared = Shared
"""Let the compiled functions of plug-ins call a function."""


def unshared(value: Any) -> Any:
    """The Python function of a kernel or of a function made by :func:`shared`; any other value as it is.

    It serves to read the source of a function and to run it in Python.
    """
    if isinstance(value, Shared):
        return value.function
    # a kernel is numba's object for the function. Without numba there are no kernels
    if "numba" not in sys.modules:
        return value
    names = importlib.import_module("nonsmooth.engine.native.numba_names")
    return value.py_func if isinstance(value, names.Dispatcher) else value
