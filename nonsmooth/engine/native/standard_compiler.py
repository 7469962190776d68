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
from nonsmooth.engine.native.signatures import signature_of
from nonsmooth.notices import say

KEEPS_FILES = False
"""False: compiled entry points are kept in files of numba, not of the engine, so no other process compiles them."""
_OPTIONS: dict[str, Any] = {"error_model": "numpy"}
_alive: list[Any] = []
"""All C functions: their code must outlive the last call."""


def kernel_dispatcher(function: Callable[..., Any]) -> Any:
    """Numba's object for a kernel, its dispatcher, which callers call and by which the kernel is compiled."""
    # with NO_ALLOCATION a kernel that allocates memory does not compile
    return numba.njit(nogil=True, **_OPTIONS, **NO_WRAPPERS, **NO_ALLOCATION)(function)


def law_dispatcher(function: Callable[..., Any]) -> Any:
    """Numba's object for a plug-in's function, which is compiled when compiled code calls it."""
    # it may allocate memory, unlike a kernel: impact laws need arrays whose length is the number of contacts
    return numba.njit(nogil=True, **_OPTIONS, **NO_WRAPPERS)(function)


def entry_address(function: Callable[..., Any], typed: Any, signature: str, key: str) -> int:
    """Address of the C function of an entry point, which is compiled or loaded from numba's files.

    ``typed`` is the numba signature, and ``key`` names the file. Numba does not show whether it has a file of the entry
    point. To avoid compiling its kernels in vain, a first attempt makes numba refuse to compile any kernel. If there is
    a file, the entry point is loaded from it. If there is none, the attempt fails at the first call of a kernel. Then
    the kernels are compiled, each for its declared types, and after them the entry point.
    """
    kernels = callees_of(function)
    with _uncompilable(kernels), contextlib.suppress(numba.TypingError):
        return _address(function, typed, key, **NO_ALLOCATION)
    for kernel in kernels:
        kernel.compile()
    return _address(function, typed, key, **NO_ALLOCATION)


@contextlib.contextmanager
def _uncompilable(kernels: Sequence[Kernel]) -> Iterator[None]:
    """Within a ``with`` block, let numba raise `TypingError` for each call of a kernel that is not compiled yet.

    Numba calls the method ``compile`` of a kernel's dispatcher when it compiles a caller. An attribute of the same name
    hides this method until it is deleted.
    """

    def refuse(signature: Any) -> None:
        """Fail in place of compiling a kernel, with the error that numba expects of a function that has no type."""
        raise numba.TypingError("to be compiled with the signature that it declares")

    pending = [kernel.dispatcher for kernel in kernels if not kernel.is_compiled]
    for dispatcher in pending:
        dispatcher.compile = refuse
    try:
        yield
    finally:
        for dispatcher in pending:
            del dispatcher.compile


def shim_address(function: Callable[..., Any], signature: str, key: str) -> int:
    """Address of the C function of a shim, which passes the engine's arguments to a plug-in's function."""
    # no key, so that each process compiles it: numba keeps on disk only functions that are defined in files
    return _address(function, signature_of(signature), "")


def _address(function: Callable[..., Any], signature: Any, key: str, **options: bool) -> int:
    """Address of a C function, kept in a file of numba's if it has a key and is defined in a file.

    The function is compiled, or loaded from its file; without a file each process compiles it. ``options`` are further
    ones of the compiler. A notice gives the reason, once, why compiling takes long.
    """
    say(
        f"numba {numba.__version__} lacks a name that fast compilation needs ({MISSING}): "
        "the engine is compiled by numba.njit(cache=True), which takes some minutes the first time"
    )
    compiler = functools.partial(numba.cfunc, signature, **_OPTIONS, **options)
    # numba finds the file of a function by that of its source, which one typed at a prompt does not have
    if key and Path(function.__code__.co_filename).is_file():
        compiled = compiler(cache=True)(_renamed(function, key))
    else:
        compiled = compiler()(function)
    _alive.append(compiled)
    return int(compiled.address)


def _renamed(function: Callable[..., Any], key: str) -> Callable[..., Any]:
    """Copy of a function under a name that changes with any source file of the engine.

    Numba names its files after the function, and would not notice that a kernel in another file has changed. The name
    is made one of a function, without hyphens.
    """
    renamed = FunctionType(function.__code__, function.__globals__, function.__name__)
    renamed.__qualname__ = f"{key}_{build_name()}".replace("-", "_")
    return renamed
