"""Compilation by numba's documented functions, for a version that lacks a name that the engine's own passes need.

Kernels are ``numba.njit`` functions and entry points ``numba.cfunc(cache=True)``. Compiling takes longer, as numba
optimises each kernel alone and again within each caller. The results are the same.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import FunctionType
from typing import Any

import numba

from nonsmooth.engine.native.callees import Kernel, callees_of
from nonsmooth.engine.native.folders import build_name
from nonsmooth.engine.native.numba_names import MISSING, NO_ALLOCATION, NO_WRAPPERS
from nonsmooth.notices import say

_OPTIONS: dict[str, Any] = {"error_model": "numpy"}
_alive: list[Any] = []
"""All C functions: their code must outlive the last call."""


def kernel_dispatcher(function: Callable[..., Any]) -> Any:
    """Numba's dispatcher of a kernel, which does not compile if it allocates memory."""
    return numba.njit(nogil=True, **_OPTIONS, **NO_WRAPPERS, **NO_ALLOCATION)(function)


def law_dispatcher(function: Callable[..., Any]) -> Any:
    """Numba's dispatcher of a plug-in's function, which may allocate memory."""
    return numba.njit(nogil=True, **_OPTIONS, **NO_WRAPPERS)(function)


def is_stored(key: str) -> bool:
    """Always True: numba looks for its files itself when an entry point is compiled."""
    return True


def entry_address(function: Callable[..., Any], signature: Any, key: str) -> int:
    """Address of the C function of an entry point, which is compiled or loaded from numba's files.

    Numba does not tell whether it has a file. So the entry point is compiled first while no kernel can be. This
    succeeds if there is a file, and fails at the first call of a kernel otherwise.
    """
    kernels = callees_of(function)
    with _uncompilable(kernels), contextlib.suppress(numba.TypingError):
        return _address(function, signature, key, **NO_ALLOCATION)
    for kernel in kernels:
        kernel.compile()
    return _address(function, signature, key, **NO_ALLOCATION)


@contextlib.contextmanager
def _uncompilable(kernels: Sequence[Kernel]) -> Iterator[None]:
    """Within a ``with`` block, let numba raise `TypingError` for each call of a kernel that is not compiled yet."""

    def refuse(signature: Any) -> None:
        raise numba.TypingError("to be compiled with the signature that it declares")

    pending = [kernel.dispatcher for kernel in kernels if not kernel.is_compiled]
    for dispatcher in pending:
        dispatcher.compile = refuse
    try:
        yield
    finally:
        for dispatcher in pending:
            del dispatcher.compile


def shim_address(function: Callable[..., Any], signature: Any, key: str) -> int:
    """Address of the C function of a shim. It is compiled in each process, as numba keeps only functions of files."""
    return _address(function, signature, "")


def _address(function: Callable[..., Any], signature: Any, key: str, **options: bool) -> int:
    """Address of a C function, kept in a file of numba's if it has a key and is defined in a file.

    The user is told, once, why compiling takes long.
    """
    say(
        f"numba {numba.__version__} lacks a name that fast compilation needs ({MISSING}): "
        "the engine is compiled by numba.njit(cache=True), which takes some minutes the first time"
    )
    compiler = functools.partial(numba.cfunc, signature, **_OPTIONS, **options)
    if key and Path(function.__code__.co_filename).is_file():
        compiled = compiler(cache=True)(_renamed(function, key))
    else:
        compiled = compiler()(function)
    _alive.append(compiled)
    return int(compiled.address)


def _renamed(function: Callable[..., Any], key: str) -> Callable[..., Any]:
    """Copy a function under a name that changes with any source file of the engine.

    Numba names its files after the function, and would not notice that a kernel in another file has changed.
    """
    renamed = FunctionType(function.__code__, function.__globals__, function.__name__)
    renamed.__qualname__ = f"{key}_{build_name()}".replace("-", "_")
    return renamed
