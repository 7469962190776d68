"""Functions that the functions of plug-ins call, compiled, and that Python calls as they are."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, final

from numba import types
from numba.extending import typeof_impl

from nonsmooth.engine.native.compiler import law_dispatcher
from nonsmooth.engine.native.numba_names import Dispatcher

jit = law_dispatcher
"""Compile a plug-in's function on demand. Its code is kept with that of the shim that calls it."""


@final
class Shared:
    """A function that compiled code calls compiled and Python calls as it is.

    Parameters
    ----------
    function : callable
        The function.
    inner : callable, optional
        What is compiled in its place.
    """

    def __init__(self, function: Callable[..., Any], inner: Callable[..., Any] | None = None) -> None:
        """Keep both functions, and take over the name and the docstring."""
        self.function = function
        self._compiled = inner or function
        functools.update_wrapper(self, function)

    @functools.cached_property
    def dispatcher(self) -> Any:
        """Numba's object for the compiled function. It is made at the first use, because a run uses few of them."""
        return jit(self._compiled)

    def __call__(self, *arguments: Any) -> Any:
        """Call the Python function, when Python calls this object."""
        return self.function(*arguments)


@typeof_impl.register(Shared)
def _type_of_shared(value: Shared, context: Any) -> Any:
    """Numba type of a `Shared` that compiled code names: that of its dispatcher, so that a call of it is compiled."""
    return types.Dispatcher(value.dispatcher)


shared = Shared
"""Let the compiled functions of plug-ins call a function."""


def unshared(value: Any) -> Any:
    """The Python function of a kernel or of a function made by :func:`shared`; any other value as it is.

    It serves to read the source of a function and to run it in Python.
    """
    # a kernel is numba's object for the function
    if isinstance(value, Dispatcher):
        return value.py_func
    return value.function if isinstance(value, Shared) else value
