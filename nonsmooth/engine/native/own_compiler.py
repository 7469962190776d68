"""The engine's own compiler: numba with the passes of :mod:`nonsmooth.engine.native.passes`, and files of machine code.

It is used if numba has all the names that it needs; see :mod:`nonsmooth.engine.native.compiler`.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numba

from nonsmooth.engine.native.cache import Store
from nonsmooth.engine.native.callees import callees_of
from nonsmooth.engine.native.collector import uncollected
from nonsmooth.engine.native.numba_names import NO_ALLOCATION, NO_WRAPPERS
from nonsmooth.engine.native.passes import CFunction, EntryPasses, KernelPasses, LawPasses, ShimPasses

_OPTIONS: dict[str, Any] = {"nopython": True, "nogil": True, "error_model": "numpy", **NO_WRAPPERS}
_alive: list[CFunction] = []
"""All C functions: their code must outlive the last call."""


def kernel_dispatcher(function: Callable[..., Any]) -> Any:
    """Numba's object for a kernel, which its callers call: it compiles the kernel by the engine's passes."""
    # with NO_ALLOCATION a kernel that allocates memory does not compile
    return numba.jit(pipeline_class=KernelPasses, **_OPTIONS, **NO_ALLOCATION)(function)


def law_dispatcher(function: Callable[..., Any]) -> Any:
    """Numba's object for a plug-in's function. Its code is kept with that of the shim, the C function that calls it."""
    # it may allocate memory, unlike a kernel: impact laws need arrays whose length is the number of contacts
    return numba.jit(pipeline_class=LawPasses, **_OPTIONS)(function)


@functools.cache
def _store(key: str) -> Store:
    """File of an entry point's machine code. There is one object for each key, so that the file is read only once."""
    return Store(key)


def is_stored(key: str) -> bool:
    """True if there is valid machine code of an entry point on disk under a key. It is read, and kept until loaded."""
    return _store(key).is_filled()


def entry_address(function: Callable[..., Any], signature: Any, key: str) -> int:
    """Address of the C function of an entry point, which is loaded from disk, or compiled after its kernels.

    ``key`` names its file. With an empty key nothing is kept on disk.
    """
    with uncollected():
        # each kernel is compiled with the types that it declares, before a caller needs other ones. Code from a file
        # includes that of its kernels
        if not key or not is_stored(key):
            for kernel in callees_of(function):
                kernel.compile()
        return _address(CFunction(function, signature, _store(key) if key else None, EntryPasses, **NO_ALLOCATION))


def shim_address(function: Callable[..., Any], signature: Any, key: str) -> int:
    """Address of the C function of a shim, which passes the engine's arguments to a plug-in's function.

    It is compiled, or loaded from the file of its ``key``. With an empty key nothing is kept on disk.
    """
    with uncollected():
        return _address(CFunction(function, signature, Store(f"shim-{key}") if key else None, ShimPasses))


def _address(function: CFunction) -> int:
    """Compile or load a C function. Its address, valid until the process ends, as a list keeps the function alive."""
    function.compile()
    _alive.append(function)
    return int(function.address or 0)
