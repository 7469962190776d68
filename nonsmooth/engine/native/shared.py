"""Functions that both Python and the compiled functions of plug-ins can call."""

from __future__ import annotations

import functools
import importlib
import sys
from collections.abc import Callable
from typing import Any, final


@final
class Shared:
    """A function that Python calls as it is, and that compiled functions of plug-ins call in a compiled version.

    Parameters
    ----------
    function : callable
        The Python function.
    compiled : str
        Name of the function in :mod:`nonsmooth.engine.native.address_calls` that compiled code calls instead; "" if
        compiled code calls ``function``, compiled.
    """

    def __init__(self, function: Callable[..., Any], compiled: str = "") -> None:
        """Store the function, and copy its name and docstring."""
        self.function, self.compiled = function, compiled
        functools.update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        """Call the Python function, when Python calls this object."""
        return self.function(*arguments)


shared = Shared
"""Decorator of a function that compiled functions of plug-ins may call."""


def unshared(value: Any) -> Any:
    """The Python function of a kernel or of a function made by :func:`shared`; any other value as it is.

    It serves to read the source of a function and to run it in Python.
    """
    if isinstance(value, Shared):
        return value.function
    # if numba is not imported, no kernel has been made, so the value is no kernel
    if "numba" not in sys.modules:
        return value
    names = importlib.import_module("nonsmooth.engine.native.numba_names")
    return value.py_func if isinstance(value, names.Dispatcher) else value
