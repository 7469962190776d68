"""Kernels, which are compiled into their callers, and entry points, which are compiled apart and called by address.

Numba optimises a kernel again within each of its callers. An entry point ends this: its callers read its address from
the workspace. Python calls entry points, too. Their machine code is kept on disk. Nothing is compiled when a module is
imported: a kernel is compiled when an entry point that calls it is.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import importlib
import inspect
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numba

from nonsmooth.engine.memory.declare import Part
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.native.address_calls import by_address
from nonsmooth.engine.native.callees import KERNELS, Kernel, callees_of
from nonsmooth.engine.native.collector import uncollected
from nonsmooth.engine.native.compiler import entry_address, is_stored, kernel_dispatcher
from nonsmooth.engine.native.entries import Fingerprint, known, own_name
from nonsmooth.engine.native.folders import folders
from nonsmooth.engine.native.forms import C_TYPES
from nonsmooth.engine.native.signatures import signature_of, workspace_with
from nonsmooth.notices import say

_STUB = "def stub_{name}({names}): return call(ws.model.entry_points[{index}], {names})"


class Entry(NamedTuple):
    """An entry point, or a step of an engine.

    Attributes
    ----------
    function : callable
        The function.
    signature : str
        Its signature.
    address : callable
        Function that compiles or loads it, and returns its address.
    """

    function: Callable[..., Any]
    signature: str
    address: Callable[[], int]


ENTRIES: dict[str, Entry] = {}
"""Entry points and steps of engines by name."""
_callables: dict[str, Callable[..., Any]] = {}
"""Those that Python has called, by name, as C functions."""


def kernel(signature: str = "void(ws)") -> Callable[[Callable[..., Any]], Any]:
    """Decorator of a kernel: a function of the engine that is compiled into its callers, with these types."""
    return _kernel(signature_of(signature))


def own_kernel(own: type[Part], signature: str) -> Callable[[Callable[..., Any]], Any]:
    """Decorator of a kernel of an engine that adds numbers of its own, the part ``own``, to the workspace."""
    return _kernel(signature_of(signature, workspace_with(own)))


def _kernel(signature: Any) -> Callable[[Callable[..., Any]], Any]:
    """Decorator of a kernel of a numba signature."""

    def decorate(function: Callable[..., Any]) -> Any:
        """Register the kernel, to be compiled with an entry point that calls it. Numba's object takes its place."""
        dispatcher = kernel_dispatcher(function)
        KERNELS.append(Kernel(dispatcher, signature))
        return dispatcher

    return decorate


def entry_point(signature: str = "void(ws)") -> Callable[[Callable[..., Any]], Any]:
    """Decorator of an entry point: a function that is compiled apart, and that kernels call by its address.

    For kernels its name becomes that of a stub, a kernel that reads the address from the workspace and calls it.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        """Register the function, to be compiled at the first use of the engine. The stub takes its place."""
        name = function.__name__
        ENTRIES[name] = Entry(function, signature, functools.partial(_address, name))
        # the stub has the same parameters, as kernels cannot pass on any number of them. The first is ws
        names = ", ".join(inspect.signature(function).parameters)
        scope: dict[str, Any] = {"call": by_address(signature_of(signature)), "__name__": __name__}
        exec(_STUB.format(name=name, names=names, index=ENTRY_POINTS.index(name)), scope)
        return kernel(signature)(scope[f"stub_{name}"])

    return decorate


def add_step(function: Callable[..., Any], own: type[Part], signature: str, fingerprint: Fingerprint) -> str:
    """Register the step function of a plug-in's engine. Its name for :func:`call_entry`, whose first call compiles it.

    ``own`` is the part of the workspace that the engine adds. The machine code is kept on disk if ``fingerprint`` gives
    a digest of the function; if not, each process compiles it.
    """
    name, typed = own_name(function), signature_of(signature, workspace_with(own))
    ENTRIES[name] = Entry(function, signature, lambda: _step_address(function, typed, fingerprint))
    # a cell of a notebook that is run again defines another function of the same name
    _callables.pop(name, None)
    return name


def _step_address(function: Callable[..., Any], signature: Any, fingerprint: Fingerprint) -> int:
    """Address of the C function of a step, compiled or loaded from the file whose key ``fingerprint`` computes.

    The step includes the kernels that it calls. So their names and types are part of the key, with those of the step.
    An empty digest means that the code of the step has no key: it is compiled, and not kept on disk.
    """
    callees = [(one.dispatcher.py_func.__qualname__, str(one.signature)) for one in callees_of(function)]
    digest = fingerprint(function, repr((str(signature), callees)))
    return entry_address(function, signature, f"step-{digest}" if digest else "")


@functools.cache
def _address(name: str) -> int:
    """Address of the C function of an entry point, compiled or loaded once in a process, from the file of its name."""
    entry = ENTRIES[name]
    return entry_address(entry.function, signature_of(entry.signature), name)


@functools.cache
def entry_addresses() -> tuple[int, ...]:
    """Addresses of all entry points, in the order of ``ENTRY_POINTS``. The first call compiles those not on disk."""
    with uncollected():
        # this module imports all those that define entry points
        importlib.import_module("nonsmooth.engine.events.event_loop")
        if missing := tuple(name for name in ENTRY_POINTS if not is_stored(name)):
            say("compiling the engine once for this machine (some 20 s, longer where it is busy) ...")
            _compile_apart(missing)
        return tuple(_address(name) for name in ENTRY_POINTS)


def _compile_apart(names: tuple[str, ...]) -> None:
    """Compile entry points into files, in two processes that begin at either end; in one on a single processor.

    The compiler would leave half a gigabyte in this process. If the others fail, this process compiles what is missing.
    """
    # without a folder to write files to nothing could be handed over: this process compiles
    if folders()[1] is None:
        return
    # at most one for each processor that this process may use
    n = min(2, numba.config.NUMBA_DEFAULT_NUM_THREADS)
    # the end of the block waits for both processes
    with contextlib.ExitStack() as stack:
        for ordered in (names, names[::-1])[:n]:
            if (helper := _helper(ordered)) is not None:
                stack.enter_context(helper)


def _helper(names: tuple[str, ...]) -> subprocess.Popen[bytes] | None:
    """Start a process that compiles entry points into files, in this order. None if it cannot be started.

    It finds modules in the same places as this process, and prints nothing.
    """
    # no multiprocessing, which would run the user's script again. A frozen program has no interpreter
    if "python" not in Path(sys.executable or "").name:
        return None
    task = (
        f"import sys; sys.path[:] = {sys.path!r}; import nonsmooth.engine.events.event_loop; "
        f"from {__name__} import compile_entries; compile_entries({names!r})"
    )
    try:
        quiet = subprocess.DEVNULL
        return subprocess.Popen([sys.executable, "-c", task], stdin=quiet, stdout=quiet, stderr=quiet)
    except OSError:
        return None


def compile_entries(names: tuple[str, ...]) -> None:
    """Compile entry points into files, one after another, in a process of :func:`_compile_apart`.

    Those on disk are left out: the other process, which takes them in the opposite order, may have compiled them.
    """
    with uncollected():
        for name in names:
            if not is_stored(name):
                _address(name)


def call_entry(name: str, memory: Memory, *arguments: float) -> Any:
    """Call an entry point, or the step of an engine, on the memory of one trajectory, which it changes. Its result.

    Other threads of Python run meanwhile, as C functions do not hold the interpreter's lock.

    Raises
    ------
    UnknownName
        If the name is that of no entry point and no step.
    """
    return _callable(name)(*memory.addresses, *arguments)


def _callable(name: str) -> Callable[..., Any]:
    """An entry point, or the step of an engine, as a function that Python can call. It is made at the first call.

    Its arguments are the addresses of scalars, floats and integers, then numbers.
    """
    if name not in _callables:
        # all entry points are compiled or loaded first, as each may call others by their addresses
        entry_addresses()
        _callables[name] = prototype_of(name)(known(ENTRIES, name).address())
    return _callables[name]


def prototype_of(name: str) -> Any:
    """Type of the C function of an entry point or a step, for :mod:`ctypes`.

    The workspace ``ws``, the first argument, is passed as three pointers: to scalars, floats and integers.
    """
    # "f8(ws, i8)": the type of the result, then those of the arguments, the first of which is ws
    result, _, names = known(ENTRIES, name).signature.partition("(")
    # a name that is not in C_TYPES is that of an enumeration, whose members are integers
    returned, *extra = [C_TYPES.get(n.strip(), ctypes.c_int64) for n in [result, *names.rstrip(")").split(",")[1:]]]
    return ctypes.CFUNCTYPE(returned, *[ctypes.c_void_p] * 3, *extra)
