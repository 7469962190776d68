"""The compiled half of :mod:`nonsmooth.engine.kernel`: numba types, calls by address, the stamped cache."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import gc
import hashlib
import importlib
import inspect
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from llvmlite.binding import get_host_cpu_name
from numba import types
from numba.core.caching import CacheImpl, _CacheLocator
from numba.core.codegen import CPUCodeLibrary, JITCodeLibrary, JITCPUCodegen
from numba.extending import intrinsic, typeof_impl

from nonsmooth.engine.native_types import FLOATS, INTEGERS, TABLE
from nonsmooth.model.layout import ROOMS
from nonsmooth.model.memory import Memory

_PACKAGE = Path(__file__).resolve().parents[1]
_OPTIONS: dict[str, Any] = {
    "nopython": True,
    "nogil": True,
    "error_model": "numpy",
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
}

_TYPES = {
    "S": TABLE,
    "F": FLOATS,
    "I": INTEGERS,
    "f8": types.float64,
    "i8": types.int64,
    "void": types.void,
}
_C_TYPES: dict[str, Any] = {"f8": ctypes.c_double, "i8": ctypes.c_int64, "void": None}
_pending: list[tuple[Any, Any]] = []
_alive: list[Any] = []
_rooms: dict[str, tuple[Callable[..., Any], str]] = {}
_STUB = "def stub({names}): return call(k[S.rooms + {index}], {names})"


def cache_folder() -> Path:
    """Return the folder of the compiled engine, named after a hash over all of its sources.

    An edit of any source file, another numba, another Python or another kind of processor gives another folder: a
    stale cache cannot be met.  Falls back to a temporary folder where the user's cache is not writable.
    """
    return _cache_folder()


@functools.cache
def _cache_folder() -> Path:
    digest = hashlib.sha256(f"{numba.__version__}{np.__version__}{sys.version}{get_host_cpu_name()}".encode())
    for folder in ("engine", "model"):
        for source in sorted((_PACKAGE / folder).glob("*.py")):
            digest.update(source.name.encode() + source.read_bytes())
    name = f"engine-{digest.hexdigest()[:16]}"
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    for root in (home / "nonsmooth", Path(tempfile.gettempdir()) / f"nonsmooth-{os.getuid()}"):
        try:
            (root / name).mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(root / name, os.W_OK):
            return root / name
    raise OSError(f"No folder for the compiled engine: neither {home} nor {tempfile.gettempdir()} can be written to.")


class _StampedLocator(_CacheLocator):
    """Keeps the engine's compiled code in :func:`cache_folder`; leaves other functions alone."""

    def __init__(self, source: str) -> None:
        self._source = source

    def get_cache_path(self) -> str:
        return str(cache_folder())

    def get_source_stamp(self) -> str:
        return cache_folder().name

    def get_disambiguator(self) -> str:
        return Path(self._source).stem

    @classmethod
    def from_function(cls, function: Any, source: str) -> _StampedLocator | None:
        inside = Path(source).resolve().parent == _PACKAGE / "engine"
        return cls(source) if inside else None


CacheImpl._locator_classes.insert(0, _StampedLocator)


def _signature(text: str) -> Any:
    result, _, arguments = text.partition("(")
    names = [a.strip() for a in arguments.rstrip(")").split(",") if a.strip()]
    return _TYPES[result.strip()](*[_TYPES[a] for a in names])


def kernel(signature: str = "void(S, F, I)") -> Callable[[Callable[..., Any]], Any]:
    """Compile an engine function with an explicit signature, when an entry point first needs it."""

    def decorate(function: Callable[..., Any]) -> Any:
        dispatcher = numba.jit(**_OPTIONS)(function)
        _pending.append((dispatcher, _signature(signature)))
        return dispatcher

    return decorate


def room(signature: str = "void(S, F, I)") -> Callable[[Callable[..., Any]], Any]:
    """Compile an engine function apart from its callers, which reach it by its address in ``k``.

    A caller does not compile it again as it would a kernel's, and Python can call it: see
    :func:`room_addresses` and :func:`call_room`.  Its machine code is cached on disk.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        _rooms[function.__name__] = (function, signature)
        names = ", ".join(inspect.signature(function).parameters)
        scope: dict[str, Any] = {"call": _room_caller(_signature(signature))}
        exec(_STUB.format(names=names, index=ROOMS.index(function.__name__)), scope)
        return numba.jit(**_OPTIONS)(scope["stub"])

    return decorate


def _room_caller(signature: Any) -> Any:
    result, arguments = signature.return_type, signature.args

    def call(typingctx: Any, address: Any, *values: Any) -> Any:
        return _caller(result, arguments)

    scope: dict[str, Any] = {"call": call}
    names = ", ".join(f"v{i}" for i in range(len(arguments)))
    exec(f"def typed(typingctx, address, {names}): return call(typingctx, address, {names})", scope)
    return intrinsic(scope["typed"])


_LATER = (
    (CPUCodeLibrary, "_optimize_final_module"),
    (JITCodeLibrary, "_finalize_specific"),
    (JITCPUCodegen, "_add_module"),
    (JITCPUCodegen, "set_env"),
)
"""The steps of numba that optimise a function and make machine code of it."""


@contextlib.contextmanager
def _raw() -> Iterator[None]:
    """Leave what is compiled inside as intermediate code: only the rooms that take it in go on with it, once each."""
    with contextlib.ExitStack() as stack:
        for owner, name in _LATER:
            stack.callback(setattr, owner, name, getattr(owner, name))
            setattr(owner, name, lambda *_: None)
        yield


@functools.cache
def room_addresses() -> tuple[int, ...]:
    """Return the addresses of all rooms in the order of ``ROOMS``, compiling what the cache lacks."""
    importlib.import_module("nonsmooth.engine.hybrid")
    if not _marker().exists():
        print("compiling the engine once for this machine (about 35 s) ...", file=sys.stderr, flush=True)
        # millions of small objects that live: looking for garbage among them is lost time
        collecting = gc.isenabled()
        gc.disable()
        try:
            return _compile_rooms()
        finally:
            if collecting:
                gc.enable()
    return _compile_rooms()


def _compile_rooms() -> tuple[int, ...]:
    if not _marker().exists():
        with _raw():
            for inner, typed in _pending:
                inner.compile(typed)
    addresses = []
    for name in ROOMS:
        function, signature = _rooms[name]
        compiled = numba.cfunc(_signature(signature), cache=True, nopython=True, error_model="numpy")(function)
        _alive.append(compiled)
        addresses.append(int(compiled.address))
    with contextlib.suppress(OSError):
        _marker().touch()
    return tuple(addresses)


def _marker() -> Path:
    """Return the file that says that the cache is complete."""
    return cache_folder() / "complete"


def call_room(name: str, memory: Memory, *arguments: float) -> Any:
    """Call a room from Python on the memory of one trajectory; the interpreter's lock is released."""
    _, signature = _rooms[name]
    result, _, names = signature.partition("(")
    extra = [_C_TYPES[n.strip()] for n in names.rstrip(")").split(",")[3:]]
    prototype = ctypes.CFUNCTYPE(_C_TYPES[result], *[ctypes.c_void_p] * 3, *extra)
    function = prototype(room_addresses()[ROOMS.index(name)])
    heaps = (memory.scalars, memory.floats, memory.integers)
    return function(*[heap.ctypes.data for heap in heaps], *arguments)


@intrinsic
def at(typingctx: Any, heap: Any, offset: Any) -> Any:
    """Return a pointer moved by ``offset`` elements."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.gep(args[0], [args[1]])

    return heap(heap, types.int64), codegen


def _caller(result: Any, arguments: tuple[Any, ...]) -> Any:
    """Make an intrinsic that calls the C function at an address."""

    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        native = ir.FunctionType(context.get_value_type(result), [context.get_value_type(a) for a in arguments])
        function = builder.inttoptr(args[0], ir.PointerType(native))
        value = builder.call(function, args[1:])
        return context.get_dummy_value() if result is types.void else value

    return result(types.int64, *arguments), lower


@intrinsic
def call_scalar(typingctx: Any, address: Any, x: Any, p: Any) -> Any:
    """Call ``float law(float, parameters)`` at an address."""
    return _caller(types.float64, (types.float64, FLOATS))


@intrinsic
def call_body(typingctx: Any, address: Any, t: Any, q: Any, u: Any, p: Any, out: Any) -> Any:
    """Call ``void body(t, q, u, parameters, out)`` at an address."""
    return _caller(types.void, (types.float64, FLOATS, FLOATS, FLOATS, FLOATS))


@intrinsic
def call_load(typingctx: Any, address: Any, t: Any, a: Any, b: Any, p: Any, out: Any) -> Any:
    """Call ``void load(t, frame_a, frame_b, parameters, out)`` at an address."""
    return _caller(types.void, (types.float64, FLOATS, FLOATS, FLOATS, FLOATS))


@intrinsic
def call_pair(typingctx: Any, address: Any, a: Any, b: Any, p: Any, out: Any) -> Any:
    """Call ``void geometry(frame_a, frame_b, parameters, out)`` at an address."""
    return _caller(types.void, (FLOATS, FLOATS, FLOATS, FLOATS))


@intrinsic
def call_map(typingctx: Any, address: Any, n: Any, g: Any, z: Any, p: Any, out: Any) -> Any:
    """Call ``void impact(n, delassus, rates, parameters, impulses)`` at an address."""
    return _caller(types.void, (types.int64, FLOATS, FLOATS, FLOATS, FLOATS))


@intrinsic
def call_guard(typingctx: Any, address: Any, t: Any, q: Any, u: Any, p: Any) -> Any:
    """Call ``float guard(t, q, u, parameters)`` at an address."""
    return _caller(types.float64, (types.float64, FLOATS, FLOATS, FLOATS))


_C_SIGNATURES = {
    "guard": types.float64(types.float64, FLOATS, FLOATS, FLOATS),
    "scalar": types.float64(types.float64, FLOATS),
    "body": types.void(types.float64, FLOATS, FLOATS, FLOATS, FLOATS),
    "load": types.void(types.float64, FLOATS, FLOATS, FLOATS, FLOATS),
    "pair": types.void(FLOATS, FLOATS, FLOATS, FLOATS),
    "map": types.void(types.int64, FLOATS, FLOATS, FLOATS, FLOATS),
}


def jit(function: Callable[..., Any]) -> Any:
    """Compile a plug-in's function on demand; never cached on disk."""
    return numba.jit(**_OPTIONS)(function)


class _Shared:
    """A function that compiled functions call compiled, and Python calls as it stands."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.dispatcher = jit(function)
        functools.update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        return self.function(*arguments)


@typeof_impl.register(_Shared)
def _type_of_shared(value: _Shared, context: Any) -> Any:
    return types.Dispatcher(value.dispatcher)


def shared(function: Callable[..., Any]) -> Any:
    """Let the compiled functions of plug-ins call this one; Python calls it as it stands."""
    return _Shared(function)


def address_of(shim: Callable[..., Any], form: str) -> int:
    """Compile ``shim`` to a C function of the given form and return its address."""
    compiled = numba.cfunc(_C_SIGNATURES[form], nopython=True, error_model="numpy")(shim)
    _alive.append(compiled)
    return int(compiled.address)


COMPILATION_ERRORS: tuple[type[Exception], ...] = (numba.core.errors.NumbaError,)
