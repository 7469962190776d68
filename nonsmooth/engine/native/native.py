"""The compiled half of :mod:`nonsmooth.engine.native.kernel`: kernels, entry points, calls by address, shims."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import importlib
import inspect
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numba
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.dispatcher import Dispatcher
from numba.extending import intrinsic, typeof_impl

from nonsmooth.engine.memory.declare import Part
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import ENUMERATIONS
from nonsmooth.engine.memory.tables import record_with
from nonsmooth.engine.native.build import CFunction, EntryPasses, KernelPasses, LawPasses, ShimPasses, uncollected
from nonsmooth.engine.native.cache import Store, folders
from nonsmooth.engine.native.entries import Fingerprint, known, own_name
from nonsmooth.engine.native.forms import C_TYPES, FORMS
from nonsmooth.engine.native.record_view import copy_fields as copy_fields
from nonsmooth.engine.native.record_view import records as records
from nonsmooth.engine.native.record_view import types_of
from nonsmooth.engine.native.results import type_of_result
from nonsmooth.engine.native.types import FLOATS, INTEGERS, TABLE, Table, call_at, moved
from nonsmooth.engine.native.workspace_view import WORKSPACE, Workspace
from nonsmooth.notices import say

_OPTIONS: dict[str, Any] = {
    "nopython": True,
    "nogil": True,
    "error_model": "numpy",
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
}

_TYPES = {
    "ws": WORKSPACE,
    "S": TABLE,
    "F": FLOATS,
    "I": INTEGERS,
    "f8": types.float64,
    "i8": types.int64,
    "b1": types.boolean,
    **{kind.__name__: type_of_result(kind) for kind in ENUMERATIONS},
    **types_of,
    "v2": types.UniTuple(types.float64, 2),
    "v3": types.UniTuple(types.float64, 3),
    "void": types.void,
}


def result(kind: Any) -> Any:
    """Let a kernel return a named tuple of numbers, or an enumeration; signatures know it by the name of its class."""
    _TYPES[kind.__name__] = type_of_result(kind)
    return kind


_pending: list[tuple[Any, Any]] = []
_alive: list[Any] = []
_entries: dict[str, _Entry] = {}
_callables: dict[str, Callable[..., Any]] = {}
_STUB = "def stub_{name}({names}): return call(ws.model.entry_points[{index}], {names})"


class _Entry(NamedTuple):
    function: Callable[..., Any]
    signature: str
    address: Callable[[], int]


def _signature(text: str, workspace: Any = WORKSPACE) -> Any:
    result, _, arguments = text.partition("(")
    names = [a.strip() for a in arguments.rstrip(")").split(",") if a.strip()]
    known_types = {**_TYPES, "ws": workspace}
    return known_types[result.strip()](*[known_types[a] for a in names])


def kernel(signature: str = "void(ws)") -> Callable[[Callable[..., Any]], Any]:
    """Compile an engine function with an explicit signature, when an entry point first needs it."""
    return _kernel(_signature(signature))


def _kernel(signature: Any) -> Callable[[Callable[..., Any]], Any]:
    def decorate(function: Callable[..., Any]) -> Any:
        dispatcher = numba.jit(pipeline_class=KernelPasses, **_OPTIONS)(function)
        _pending.append((dispatcher, signature))
        return dispatcher

    return decorate


def entry_point(signature: str = "void(ws)") -> Callable[[Callable[..., Any]], Any]:
    """Compile an engine function apart from its callers, which reach it by its address in ``k``.

    A caller does not compile it again as it would a kernel's, and Python can call it: see
    :func:`entry_addresses` and :func:`call_entry`.  Its machine code is cached on disk.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        name = function.__name__
        _entries[name] = _Entry(function, signature, functools.partial(_compiled, name))
        names = ", ".join(inspect.signature(function).parameters)
        scope: dict[str, Any] = {"call": by_address(_signature(signature)), "__name__": __name__}
        exec(_STUB.format(name=name, names=names, index=ENTRY_POINTS.index(name)), scope)
        return kernel(signature)(scope[f"stub_{name}"])

    return decorate


def _workspace_with(own: type[Part]) -> Any:
    """Return the type of the workspace of an engine that has numbers of its own."""
    return Workspace(Table(record_with([own])), {own.key: own})


def own_kernel(own: type[Part], signature: str) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function of an engine that has numbers of its own into its callers, as a kernel."""
    return _kernel(_signature(signature, _workspace_with(own)))


def add_step(function: Callable[..., Any], own: type[Part], signature: str, fingerprint: Fingerprint) -> str:
    """Let :func:`call_entry` find a step of an engine under the name that is returned; it is compiled when called.

    It is kept on disk under what ``fingerprint`` says of it.
    """
    name, typed = own_name(function), _signature(signature, _workspace_with(own))
    _entries[name] = _Entry(function, signature, lambda: _step_address(function, typed, fingerprint))
    # a cell of a notebook that is run again has another function of that name
    _callables.pop(name, None)
    return name


def _step_address(function: Callable[..., Any], signature: Any, fingerprint: Fingerprint) -> int:
    kernels = _kernels_of([function])
    types_of_kernels = [(inner.py_func.__qualname__, str(typed)) for inner, typed in kernels]
    digest = fingerprint(function, repr((str(signature), types_of_kernels)))
    store = Store(f"step-{digest}") if digest else None
    with uncollected():
        if store is None or not store.is_filled():
            _compile(kernels)
        return _address(CFunction(function, signature, store, EntryPasses))


def by_address(signature: Any) -> Any:
    """Return an intrinsic that calls the C function of a signature at an address."""

    def call(typingctx: Any, address: Any, *values: Any) -> Any:
        def lower(context: Any, builder: Any, _: Any, args: Any) -> Any:
            value = call_at(builder, args[0], context.get_value_type(signature.return_type), args[1:])
            return context.get_dummy_value() if signature.return_type is types.void else value

        return signature.return_type(types.int64, *signature.args), lower

    scope: dict[str, Any] = {"call": call}
    names = ", ".join(f"v{i}" for i in range(len(signature.args)))
    exec(f"def typed(typingctx, address, {names}): return call(typingctx, address, {names})", scope)
    return intrinsic(scope["typed"])


@functools.cache
def entry_addresses() -> tuple[int, ...]:
    """Return the addresses of all entry points in the order of ``ENTRY_POINTS``, compiling what the cache lacks."""
    importlib.import_module("nonsmooth.engine.events.event_loop")
    if missing := _missing():
        say("compiling the engine once for this machine (some 20 s, longer where it is busy) ...")
        _compile_apart(missing)
        compile_entries(_missing())
    return tuple(_compiled(name) for name in ENTRY_POINTS)


def _missing() -> tuple[str, ...]:
    return tuple(name for name in ENTRY_POINTS if not _store(name).is_filled())


def _compile_apart(names: tuple[str, ...]) -> None:
    """Compile entry points into the cache, in two processes that begin at either end, or in one on one processor.

    They may fail, as only the cache knows of them.  In this process the compiler would leave half a gigabyte.
    """
    if folders()[1] is None:
        return
    n = min(2, numba.config.NUMBA_DEFAULT_NUM_THREADS)
    with contextlib.ExitStack() as stack:
        for ordered in (names, names[::-1])[:n]:
            if (helper := _helper(ordered)) is not None:
                stack.enter_context(helper)


def _helper(names: tuple[str, ...]) -> subprocess.Popen[bytes] | None:
    # an interpreter of our own: multiprocessing would run the user's script again, a frozen program itself
    if "python" not in Path(sys.executable or "").name:
        return None
    task = (
        f"import sys; sys.path[:] = {sys.path!r}; from nonsmooth.engine.native import native; "
        f"import nonsmooth.engine.events.event_loop; native.compile_entries({names!r})"
    )
    try:
        quiet = subprocess.DEVNULL
        return subprocess.Popen([sys.executable, "-c", task], stdin=quiet, stdout=quiet, stderr=quiet)
    except OSError:
        return None


def compile_entries(names: tuple[str, ...]) -> None:
    """Compile those of some ``ENTRY_POINTS`` that the cache lacks into it, one after another.

    Two that begin at either end meet where both have had as long.
    """
    with uncollected():
        for name in names:
            if not _store(name).is_filled():
                _compile(_kernels_of([_entries[name].function]))
                _compiled(name)


def _compile(kernels: list[tuple[Any, Any]]) -> None:
    for inner, typed in kernels:
        if not inner.overloads:
            inner.compile(typed)
            inner.disable_compile()  # a call with other types converts: none makes a further copy


def _kernels_of(functions: Iterable[Callable[..., Any]]) -> list[tuple[Any, Any]]:
    """Return the kernels that functions call, and those that these call, each before its callers."""
    kernels = {id(inner): (inner, typed) for inner, typed in _pending}
    ordered: list[tuple[Any, Any]] = []

    def visit(function: Callable[..., Any]) -> None:
        for name in function.__code__.co_names:
            called = kernels.pop(id(function.__globals__.get(name)), None)
            if called is not None:
                visit(called[0].py_func)
                ordered.append(called)

    for function in functions:
        visit(function)
    return ordered


@functools.cache
def _store(name: str) -> Store:
    return Store(name)


@functools.cache
def _compiled(name: str) -> int:
    """Return the address of an entry point, and let its code live."""
    entry = _entries[name]
    return _address(CFunction(entry.function, _signature(entry.signature), _store(name), EntryPasses))


def _address(function: CFunction) -> int:
    function.compile()
    _alive.append(function)
    return int(function.address or 0)


def _callable(name: str) -> Callable[..., Any]:
    """Return an entry point, or a step, as a function of the addresses of the three heaps, and of numbers."""
    if name not in _callables:
        entry_addresses()
        _callables[name] = prototype_of(name)(known(_entries, name).address())
    return _callables[name]


def prototype_of(name: str) -> Any:
    """Type of the C function of an entry point or a step, for :mod:`ctypes`."""
    result, _, names = known(_entries, name).signature.partition("(")
    # a member of an enumeration is an integer
    returned, *extra = [C_TYPES.get(n.strip(), ctypes.c_int64) for n in [result, *names.rstrip(")").split(",")[1:]]]
    return ctypes.CFUNCTYPE(returned, *[ctypes.c_void_p] * 3, *extra)


def call_entry(name: str, memory: Memory, *arguments: float) -> Any:
    """Call an entry point, or a step, on the memory of one trajectory; the interpreter's lock is released.

    Raises
    ------
    UnknownName
        If there is none of that name.
    """
    return _callable(name)(*memory.addresses, *arguments)


@intrinsic
def at(typingctx: Any, heap: Any, offset: Any) -> Any:
    """Return a pointer moved by ``offset`` elements."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return moved(context, builder, heap, *args)

    return heap(heap, types.int64), codegen


_watches: dict[int, Any] = {}


def watch_address(function: Callable[[float], float]) -> int:
    """Return the address of a C function that calls ``function``, which is kept alive."""
    callback = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(function)
    address = int(ctypes.c_void_p.from_buffer(callback).value or 0)
    _watches[address] = callback
    return address


def forget_watch(address: int) -> None:
    """Give up the C function."""
    del _watches[address]


calls = {name: by_address(_signature(form.signature)) for name, form in FORMS.items()}
"""What calls a function of each form at an address."""
call_watch = by_address(types.float64(types.float64))


def jit(function: Callable[..., Any]) -> Any:
    """Compile a plug-in's function on demand; it is cached with the shim that calls it, or not at all."""
    return numba.jit(pipeline_class=LawPasses, **_OPTIONS)(function)


class _Shared:
    """A function that compiled functions call compiled, or ``inner`` in its place, and Python calls as it stands."""

    def __init__(self, function: Callable[..., Any], inner: Callable[..., Any] | None = None) -> None:
        self.function = function
        self._compiled = inner or function
        functools.update_wrapper(self, function)

    @functools.cached_property
    def dispatcher(self) -> Any:
        """What numba calls; made when asked for, as a start asks for few."""
        return jit(self._compiled)

    def __call__(self, *arguments: Any) -> Any:
        return self.function(*arguments)


@typeof_impl.register(_Shared)
def _type_of_shared(value: _Shared, context: Any) -> Any:
    return types.Dispatcher(value.dispatcher)


def shared(function: Callable[..., Any]) -> Any:
    """Let the compiled functions of plug-ins call this one; Python calls it as it stands."""
    return _Shared(function)


def unshared(value: Any) -> Any:
    """Return the function out of which :func:`shared` or a kernel has made a value, any other value as it is."""
    if isinstance(value, Dispatcher):
        return value.py_func
    return value.function if isinstance(value, _Shared) else value


@intrinsic
def _support_at(typingctx: Any, heap: Any, place: Any, x: Any, y: Any, z: Any) -> Any:
    point = types.UniTuple(types.float64, 3)

    def lower(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        number, size = ir.DoubleType(), ir.IntType(64)
        way, found = (cgutils.alloca_once(builder, number, 3) for _ in range(2))
        ends = [size(i) for i in range(3)]
        for end, value in zip(ends, args[2:], strict=True):
            builder.store(value, moved(context, builder, FLOATS, way, end))
        if heap == FLOATS:
            address = builder.load(moved(context, builder, heap, args[0], args[1]), typ=number)
            parameters = moved(context, builder, heap, args[0], builder.add(args[1], size(1)))
            call_at(builder, builder.fptosi(address, size), ir.VoidType(), [way, parameters, found])
        values = [builder.load(moved(context, builder, FLOATS, found, end), typ=number) for end in ends]
        return context.make_tuple(builder, point, values)

    return point(heap, types.int64, types.float64, types.float64, types.float64), lower


def _compiled_support(heap: Any, place: int, x: float, y: float, z: float) -> Any:
    return _support_at(heap, place, x, y, z)


def _support(heap: Any, place: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Call ``void support(direction, parameters, point)`` with what stands in a heap; return the point."""
    numbers = (ctypes.c_double * (len(heap) - place))(*heap[place + 1 :])
    way, found = (ctypes.c_double * 3)(x, y, z), (ctypes.c_double * 3)()
    FORMS["support"].prototype()(int(heap[place]))(way, numbers, found)
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
    store = Store(f"shim-{key}") if key else None
    with uncollected():
        return _address(CFunction(shim, _signature(FORMS[form].signature), store, ShimPasses))
