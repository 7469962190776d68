"""The compiled half of :mod:`nonsmooth.engine.native.kernel`: kernels, rooms, calls by address, shims."""

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
from typing import Any

import numba
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, typeof_impl

from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.rooms import ROOMS
from nonsmooth.engine.native.build import CFunction, EnginePasses, numbered, raw, raw_inside, typed_once, uncollected
from nonsmooth.engine.native.cache import Store, folders
from nonsmooth.engine.native.contact_view import contact_at as contact_at
from nonsmooth.engine.native.types import FLOATS, INTEGERS, TABLE
from nonsmooth.notices import say

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
_STUB = "def stub_{name}({names}): return call(k[S.rooms + {index}], {names})"


def _signature(text: str) -> Any:
    result, _, arguments = text.partition("(")
    names = [a.strip() for a in arguments.rstrip(")").split(",") if a.strip()]
    return _TYPES[result.strip()](*[_TYPES[a] for a in names])


def kernel(signature: str = "void(S, F, I)") -> Callable[[Callable[..., Any]], Any]:
    """Compile an engine function with an explicit signature, when an entry point first needs it."""

    def decorate(function: Callable[..., Any]) -> Any:
        dispatcher = numba.jit(pipeline_class=EnginePasses, **_OPTIONS)(function)
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
        name = function.__name__
        exec(_STUB.format(name=name, names=names, index=ROOMS.index(name)), scope)
        return kernel(signature)(scope[f"stub_{name}"])

    return decorate


def _room_caller(signature: Any) -> Any:
    result, arguments = signature.return_type, signature.args

    def call(typingctx: Any, address: Any, *values: Any) -> Any:
        return _caller(result, arguments)

    scope: dict[str, Any] = {"call": call}
    names = ", ".join(f"v{i}" for i in range(len(arguments)))
    exec(f"def typed(typingctx, address, {names}): return call(typingctx, address, {names})", scope)
    return intrinsic(scope["typed"])


@functools.cache
def room_addresses() -> tuple[int, ...]:
    """Return the addresses of all rooms in the order of ``ROOMS``, compiling what the cache lacks."""
    importlib.import_module("nonsmooth.engine.events.event_loop")
    if not all(_store(name).is_filled() for name in ROOMS):
        say("compiling the engine once for this machine (some 20 s, longer where it is busy) ...")
        _fill_cache()
    return tuple(_compiled(name) for name in ROOMS)


def _fill_cache() -> None:
    """Compile all rooms, half of them in a process of its own where there are two processors."""
    middle = len(ROOMS) // 2
    helper = _helper(middle) if numba.config.NUMBA_DEFAULT_NUM_THREADS > 1 and folders()[1] else None
    if helper is None:
        compile_rooms(0, len(ROOMS))
    else:
        with helper:
            compile_rooms(0, middle)
        if helper.returncode != 0:
            compile_rooms(middle, len(ROOMS))


def _helper(start: int) -> subprocess.Popen[bytes] | None:
    """Compile the rooms from one on in another process; it may fail, as only the cache knows of it."""
    # an interpreter of our own: multiprocessing would run the user's script again, a frozen program itself
    if "python" not in Path(sys.executable or "").name:
        return None
    task = (
        f"import sys; sys.path[:] = {sys.path!r}; from nonsmooth.engine.native import native; "
        f"import nonsmooth.engine.events.event_loop; native.compile_rooms({start}, {len(ROOMS)})"
    )
    try:
        quiet = subprocess.DEVNULL
        return subprocess.Popen([sys.executable, "-c", task], stdin=quiet, stdout=quiet, stderr=quiet)
    except OSError:
        return None


def compile_rooms(start: int, stop: int) -> None:
    """Compile a range of ``ROOMS`` into the cache."""
    with uncollected(), numbered(ROOMS[start]), typed_once():
        with raw():
            for inner, typed in _kernels_of(ROOMS[start:stop]):
                inner.compile(typed)
        for name in ROOMS[start:stop]:
            _compiled(name)


def _kernels_of(rooms: tuple[str, ...]) -> list[tuple[Any, Any]]:
    """Return the kernels that rooms call, and those that these call, with their signatures, in order of definition."""
    kernels = {id(inner): inner for inner, _ in _pending}
    called: set[int] = set()
    waiting = [_rooms[name][0] for name in rooms]
    while waiting:
        function = waiting.pop()
        named = {id(function.__globals__.get(name)) for name in function.__code__.co_names}
        new = (named & kernels.keys()) - called
        called |= new
        waiting += [kernels[one].py_func for one in new]
    return [(inner, typed) for inner, typed in _pending if id(inner) in called]


@functools.cache
def _store(room: str) -> Store:
    return Store(room)


@functools.cache
def _compiled(room: str) -> int:
    """Return the address of a room, and let its code live."""
    function, signature = _rooms[room]
    return _address(CFunction(function, _signature(signature), _store(room), EnginePasses))


def _address(function: CFunction) -> int:
    function.compile()
    _alive.append(function)
    return int(function.address or 0)


@functools.cache
def _callable(name: str) -> Callable[..., Any]:
    """Return a room as a function of the addresses of the three heaps, and of numbers."""
    _, signature = _rooms[name]
    result, _, names = signature.partition("(")
    extra = [_C_TYPES[n.strip()] for n in names.rstrip(")").split(",")[3:]]
    prototype = ctypes.CFUNCTYPE(_C_TYPES[result], *[ctypes.c_void_p] * 3, *extra)
    return prototype(room_addresses()[ROOMS.index(name)])


def call_room(name: str, memory: Memory, *arguments: float) -> Any:
    """Call a room from Python on the memory of one trajectory; the interpreter's lock is released."""
    return _callable(name)(*memory.addresses, *arguments)


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
def call_watch(typingctx: Any, address: Any, t: Any) -> Any:
    """Call ``float watch(float)`` at an address."""
    return _caller(types.float64, (types.float64,))


_watches: dict[int, Any] = {}


def watch_address(function: Callable[[float], float]) -> int:
    """Return the address of a C function that calls ``function``, which is kept alive."""
    callback = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(function)
    address = int(ctypes.cast(callback, ctypes.c_void_p).value or 0)
    _watches[address] = callback
    return address


def forget_watch(address: int) -> None:
    """Give up the C function."""
    del _watches[address]


@intrinsic
def call_compliance(typingctx: Any, address: Any, x: Any, rate: Any, first: Any, p: Any) -> Any:
    """Call ``float force(indentation, rate, closing_rate, parameters)`` at an address."""
    return _caller(types.float64, (types.float64, types.float64, types.float64, FLOATS))


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
    "compliance": types.float64(types.float64, types.float64, types.float64, FLOATS),
    "traction": types.void(types.float64, FLOATS, FLOATS, FLOATS, FLOATS),
    "rates": types.void(types.float64, FLOATS, FLOATS, FLOATS, FLOATS),
    "body": types.void(types.float64, FLOATS, FLOATS, FLOATS, FLOATS),
    "load": types.void(types.float64, FLOATS, FLOATS, FLOATS, FLOATS),
    "pair": types.void(FLOATS, FLOATS, FLOATS, FLOATS),
    "map": types.void(types.int64, FLOATS, FLOATS, FLOATS, FLOATS),
    "support": types.void(FLOATS, FLOATS, FLOATS),
}


def jit(function: Callable[..., Any]) -> Any:
    """Compile a plug-in's function on demand; it is cached with the shim that calls it, or not at all."""
    return numba.jit(**_OPTIONS)(function)


class _Shared:
    """A function that compiled functions call compiled, or ``inner`` in its place, and Python calls as it stands."""

    def __init__(self, function: Callable[..., Any], inner: Callable[..., Any] | None = None) -> None:
        self.function = function
        self.dispatcher = jit(inner or function)
        functools.update_wrapper(self, function)

    def __call__(self, *arguments: Any) -> Any:
        return self.function(*arguments)


@typeof_impl.register(_Shared)
def _type_of_shared(value: _Shared, context: Any) -> Any:
    return types.Dispatcher(value.dispatcher)


def shared(function: Callable[..., Any]) -> Any:
    """Let the compiled functions of plug-ins call this one; Python calls it as it stands."""
    return _Shared(function)


def unshared(value: Any) -> Any:
    """Return the function out of which :func:`shared` has made a value, any other value as it is."""
    return value.function if isinstance(value, _Shared) else value


@intrinsic
def _support_at(typingctx: Any, heap: Any, place: Any, x: Any, y: Any, z: Any) -> Any:
    point = types.UniTuple(types.float64, 3)

    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        number, size = ir.DoubleType(), ir.IntType(64)
        numbers = number.as_pointer()
        way, found = (cgutils.alloca_once(builder, number, 3) for _ in range(2))
        ends = [size(i) for i in range(3)]
        for end, value in zip(ends, args[2:], strict=True):
            builder.store(value, builder.gep(way, [end]))
        if heap == FLOATS:
            function = ir.FunctionType(ir.VoidType(), [numbers, numbers, numbers]).as_pointer()
            address = builder.fptosi(builder.load(builder.gep(args[0], [args[1]])), size)
            parameters = builder.gep(args[0], [builder.add(args[1], size(1))])
            builder.call(builder.inttoptr(address, function), [way, parameters, found])
        values = [builder.load(builder.gep(found, [end])) for end in ends]
        return context.make_tuple(builder, point, values)

    return point(heap, types.int64, types.float64, types.float64, types.float64), lower


def _compiled_support(heap: Any, place: int, x: float, y: float, z: float) -> Any:
    return _support_at(heap, place, x, y, z)


def _support(heap: Any, place: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Call ``void support(direction, parameters, point)`` with what stands in a heap; return the point."""
    numbers = (ctypes.c_double * (len(heap) - place))(*heap[place + 1 :])
    way, found = (ctypes.c_double * 3)(x, y, z), (ctypes.c_double * 3)()
    ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 3)(int(heap[place]))(way, numbers, found)
    return found[0], found[1], found[2]


call_support = _Shared(_support, _compiled_support)


def _compiled_block(block: Any, place: int) -> Any:
    return at(block, place)


def _block(block: Any, place: int) -> Any:
    """Return what stands in a block from a place on."""
    return block[place:]


block_at = _Shared(_block, _compiled_block)


def address_of(shim: Callable[..., Any], form: str, key: str) -> int:
    """Compile ``shim`` to a C function of the given form, or find it in the cache by its key, and return its address.

    Equal keys must mean equal functions; without a key nothing is cached.
    """
    compiled = CFunction(shim, _C_SIGNATURES[form], Store(f"shim-{key}") if key else None)
    with numbered(key) if key else contextlib.nullcontext(), uncollected(), typed_once(), raw_inside():
        return _address(compiled)
