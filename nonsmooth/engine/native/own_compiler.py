"""The engine's own compiler: numba with the passes of :mod:`nonsmooth.engine.native.passes`, and files of machine code.

It is used if numba has all the names that it needs; see :mod:`nonsmooth.engine.native.compiler`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba

from nonsmooth.engine.native.callees import callees_of
from nonsmooth.engine.native.code_files import write
from nonsmooth.engine.native.numba_names import NO_ALLOCATION, NO_WRAPPERS, cpu_target, rtsys
from nonsmooth.engine.native.passes import CFunction, EntryPasses, KernelPasses, LawPasses, ShimPasses
from nonsmooth.engine.native.signatures import signature_of

KEEPS_FILES = True
"""True: another process can compile entry points into the files that :mod:`.code_files` reads."""
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


def entry_address(function: Callable[..., Any], typed: Any, signature: str, key: str) -> int:
    """Address of the C function of an entry point, which is compiled after the kernels that it calls.

    ``typed`` is the numba signature of the function, and ``signature`` the same types as text.  The machine code is
    written to a file whose name has the ``key``.  With an empty key no file is written.
    """
    # compile each kernel for its declared types first; otherwise numba would compile it for the argument types of each
    # call, and so perhaps several times
    for kernel in callees_of(function):
        kernel.compile()
    return _address(CFunction(function, typed, EntryPasses, **NO_ALLOCATION), signature, key)


def shim_address(function: Callable[..., Any], signature: str, key: str) -> int:
    """Address of the C function of a shim, which passes the engine's arguments to a plug-in's function.

    It is compiled, and written to the file of its ``key``. With an empty key no file is written.
    """
    return _address(CFunction(function, signature_of(signature), ShimPasses), signature, key)


def _address(function: CFunction, signature: str, key: str) -> int:
    """Compile a C function, write its machine code to the file of ``key``, and return its address.

    With an empty key no file is written.

    The address is valid until the process ends, because ``_alive`` refers to the function: numba would free the code of
    a function without references.
    """
    function.compile()
    _alive.append(function)
    if key and (machine_code := function.machine_code(signature)):
        write(key, machine_code)
    return int(function.address or 0)


def start_runtime() -> None:
    """Give LLVM the functions of numba that machine code may need, such as those that allocate memory."""
    # the context registers all functions except those that allocate. numba's `context.refresh` would register these,
    # too, but it imports all of numpy and scipy, which takes a third of the time in which a program starts
    rtsys.initialize(cpu_target.target_context)
