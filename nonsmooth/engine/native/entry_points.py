"""Kernels, which are compiled into their callers, and entry points, which are compiled apart and called by address.

Numba compiles a kernel again as a part of each of its callers. An entry point is compiled once: its callers read its
address from the workspace and call it there. Python calls entry points, too. Their machine code is stored on disk.

Nothing is compiled when a module is imported. A kernel is compiled together with an entry point that calls it. This
module, and with it numba, is imported only if something must be compiled
(:mod:`nonsmooth.engine.native.machine_code`).
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import inspect
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numba

from nonsmooth.engine.memory.declare import Singleton
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS, MODULES
from nonsmooth.engine.native.address_calls import by_address
from nonsmooth.engine.native.callees import KERNELS, Kernel, callees_of
from nonsmooth.engine.native.code_files import read, written
from nonsmooth.engine.native.compiler import KEEPS_FILES, entry_address, kernel_dispatcher, shim_address
from nonsmooth.engine.native.entries import Fingerprint, own_name
from nonsmooth.engine.native.folders import folders
from nonsmooth.engine.native.loader import load
from nonsmooth.engine.native.machine_code import EntryPoint, add_entry
from nonsmooth.engine.native.signatures import signature_of, workspace_with
from nonsmooth.notices import say
from nonsmooth.progress import Bar, Display, Lines, ProgressMeter, Quiet

_LINES = 15.0
"""Wall time between two lines on a stream that is not a terminal, such as a log file [s]."""
_POLL = 0.1
"""Time between two updates of the progress bar while other processes compile entry points [s]."""
_STUB = "def stub_{name}({names}): return call(ws.model.entry_points[{index}], {names})"


class Source(NamedTuple):
    """An entry point that a kernel module defines: its function and its signature."""

    function: Callable[..., Any]
    signature: str


SOURCES: dict[str, Source] = {}
"""Entry points by name, of the modules that have been imported."""


def kernel(signature: str = "void(ws)") -> Callable[[Callable[..., Any]], Any]:
    """Decorator of a kernel: a function of the engine that is compiled into its callers, with these types."""
    return _kernel(signature_of(signature))


def own_kernel(own: type[Singleton], signature: str) -> Callable[[Callable[..., Any]], Any]:
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
        SOURCES[name] = Source(function, signature)
        # the stub has the same parameters, as kernels cannot pass on any number of them. The first is ws
        names = ", ".join(inspect.signature(function).parameters)
        scope: dict[str, Any] = {"call": by_address(signature_of(signature)), "__name__": __name__}
        exec(_STUB.format(name=name, names=names, index=ENTRY_POINTS.index(name)), scope)
        return kernel(signature)(scope[f"stub_{name}"])

    return decorate


def add_step(function: Callable[..., Any], own: type[Singleton], signature: str, fingerprint: Fingerprint) -> str:
    """Register the step function of a plug-in's engine, and return the name by which ``call_entry`` calls it.

    The first ``call_entry`` with this name compiles the function. ``own`` is the part of the workspace that the engine
    adds. The machine code is kept on disk if ``fingerprint`` gives a digest of the function; if not, each process
    compiles the function.
    """
    name, typed = own_name(function), signature_of(signature, workspace_with(own))
    add_entry(name, EntryPoint(signature, lambda: _step_address(function, typed, signature, fingerprint)))
    return name


def _step_address(function: Callable[..., Any], typed: Any, signature: str, fingerprint: Fingerprint) -> int:
    """Address of the C function of a step, compiled or loaded from the file whose key ``fingerprint`` computes.

    The step includes the kernels that it calls. So their names and types are part of the key, with those of the step.
    An empty digest means that the code of the step has no key: it is compiled, and not kept on disk.
    """
    callees = [(one.dispatcher.py_func.__qualname__, str(one.signature)) for one in callees_of(function)]
    digest = fingerprint(function, repr((str(typed), callees)))
    key = f"step-{digest}" if digest else ""
    if key and (machine_code := read(key)):
        return load(machine_code)
    with _uncollected():
        return entry_address(function, typed, signature, key)


def compile_entry(name: str) -> tuple[str, int]:
    """Compile an entry point in this process and write its file; returns its signature and its address."""
    # these modules import all modules that define entry points
    for module in MODULES:
        importlib.import_module(module)
    function, signature = SOURCES[name]
    with _uncollected():
        return signature, entry_address(function, signature_of(signature), signature, name)


def compile_shim(shim: Callable[..., Any], signature: str, key: str) -> int:
    """Compile a shim: a C function that passes the engine's arguments to a plug-in's function. Address of the shim.

    Its machine code is written to the file of ``key``, if the key is not empty.
    """
    with _uncollected():
        return shim_address(shim, signature, key)


@contextlib.contextmanager
def _uncollected() -> Iterator[None]:
    """Switch the garbage collector off within a ``with`` block. A collector that was off stays off.

    The compiler makes millions of small objects, all of which are needed. The collector would go through them again and
    again, which takes a tenth of the time. One block around many functions saves more than a block around each: after
    each block the collector goes through all objects once.
    """
    is_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if is_enabled:
            gc.enable()


def compile_apart(names: tuple[str, ...]) -> None:
    """Compile entry points into files, in two processes that begin at either end; in one on a single processor.

    The compiler would leave half a gigabyte in this process. If the others fail, this process compiles what is missing.
    """
    # without files of the engine, other processes cannot help: this process compiles later, or loads numba's own files
    if not KEEPS_FILES:
        return
    display = _display()
    if not isinstance(display, Bar):
        say("compiling the engine once for this machine (20 s to 3 minutes) ...")
    # other processes return their machine code through files. Without a folder to write to, only this process compiles
    if folders()[1] is None:
        return
    # at most one for each processor that this process may use
    n = min(2, numba.config.NUMBA_DEFAULT_NUM_THREADS)
    # the end of the block waits for both processes
    with contextlib.ExitStack() as stack:
        meter = stack.enter_context(ProgressMeter(display))
        helpers = [helper for ordered in (names, names[::-1])[:n] if (helper := _helper(ordered)) is not None]
        for helper in helpers:
            stack.enter_context(helper)
        while any(helper.poll() is None for helper in helpers):
            n_written = written(names)
            words = f"compiling the engine once: {n_written} of {len(names)} functions"
            meter.show(n_written / len(names), lambda _, words=words: (words, ""))  # type: ignore[misc]
            time.sleep(_POLL)


def _display() -> Display:
    """Return the display of the compilation on standard error, which is None if it was closed before the start."""
    if sys.stderr is None:
        return Quiet()
    return Bar(sys.stderr) if sys.stderr.isatty() else Lines(sys.stderr, _LINES, _LINES)


def _helper(names: tuple[str, ...]) -> subprocess.Popen[bytes] | None:
    """Start a process that compiles entry points into files, in this order. None if it cannot be started.

    It finds modules in the same places as this process, and prints nothing.
    """
    # no multiprocessing, which would run the user's script again. A frozen program has no interpreter
    if "python" not in Path(sys.executable or "").name:
        return None
    task = f"import sys; sys.path[:] = {sys.path!r}; from {__name__} import compile_entries; compile_entries({names!r})"
    try:
        quiet = subprocess.DEVNULL
        return subprocess.Popen([sys.executable, "-c", task], stdin=quiet, stdout=quiet, stderr=quiet)
    except OSError:
        return None


def compile_entries(names: tuple[str, ...]) -> None:
    """Compile entry points into files, one after another, in a process of :func:`compile_apart`.

    Entry points on disk are left out: the other process, which takes the names in the opposite order, may have compiled
    them.
    """
    with _uncollected():
        for name in names:
            if read(name) is None:
                compile_entry(name)
