"""Loads the engine's machine code and calls it from Python: the functions of ``kernel`` for Python and plug-ins.

Entry points and functions of plug-ins are loaded from disk by their names. The compiler, and the kernels that it needs,
are imported only if machine code is missing on disk. Their import takes most of the time in which a program starts.
"""

from __future__ import annotations

import ctypes
import functools
import importlib
from collections.abc import Callable
from typing import Any, NamedTuple

from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.native.code_files import MachineCode, read
from nonsmooth.engine.native.entries import known
from nonsmooth.engine.native.forms import C_TYPES, FORMS
from nonsmooth.engine.native.loader import load
from nonsmooth.engine.native.shared import Shared, shared, unshared

__all__ = ["shared", "unshared"]
"""Names that are imported to be passed on: :mod:`nonsmooth.engine.native.kernel` takes them from this module."""


class EntryPoint(NamedTuple):
    """Signature and address of an entry point, or of the step of an engine, so that Python can call it.

    Attributes
    ----------
    signature : str
        Types of the result and the arguments, such as "f8(ws, i8)".
    address : callable
        Function that compiles or loads the machine code and returns its address.
    """

    signature: str
    address: Callable[[], int]


ENTRIES: dict[str, EntryPoint] = {}
"""Steps of engines by name and, after the first call of :func:`entry_addresses`, all entry points by name."""
_callables: dict[str, Callable[..., Any]] = {}
"""C functions by name, of entry points and of steps of engines; each is stored at its first call from Python."""


def _compiler() -> Any:
    """The module ``entry_points``, which compiles the engine. Its import also imports numba."""
    return importlib.import_module("nonsmooth.engine.native.entry_points")


def add_entry(name: str, entry: EntryPoint) -> None:
    """Let :func:`call_entry` find a function by its name. It replaces an earlier one of this name."""
    ENTRIES[name] = entry
    _callables.pop(name, None)


@functools.cache
def entry_addresses() -> tuple[int, ...]:
    """Addresses of all entry points, in the order of ``ENTRY_POINTS``. The first call compiles those not on disk."""
    codes = {name: read(name) for name in ENTRY_POINTS}
    if missing := tuple(name for name, code in codes.items() if code is None):
        _compiler().compile_apart(missing)
        codes |= {name: read(name) for name in missing}
    # entry points that no other process could compile and write are compiled here
    return tuple(_loaded(name, code) for name, code in codes.items())


def _loaded(name: str, code: MachineCode | None) -> int:
    """Address of an entry point, whose machine code is loaded, or compiled without one. Code is loaded once."""
    if name not in ENTRIES:
        signature, address = (code.signature, load(code)) if code else _compiler().compile_entry(name)
        add_entry(name, EntryPoint(signature, lambda: address))
    return ENTRIES[name].address()


def call_entry(name: str, memory: Memory, *arguments: float) -> Any:
    """Call an entry point, or the step of an engine, on the workspace of one trajectory, and return its result.

    The call changes ``memory``, which is this workspace. Other threads of Python run meanwhile, because C functions do
    not hold the interpreter's lock.

    Raises
    ------
    UnknownName
        If no entry point and no step has the name.
    """
    return _callable(name)(*memory.addresses, *arguments)


def call_alone(name: str, memory: Memory, *arguments: float) -> Any:
    """Call an entry point that calls no other one, as :func:`call_entry` does. Only this one is compiled or loaded."""
    if name not in _callables:
        address = _loaded(name, read(name))
        _callables[name] = _prototype(ENTRIES[name].signature)(address)
    return _callables[name](*memory.addresses, *arguments)


def _callable(name: str) -> Callable[..., Any]:
    """Python function that calls an entry point, or the step of an engine. It is made once for each name.

    Its first three arguments are the addresses of the scalars, the floats and the integers of a workspace. The numbers
    that the entry point takes besides the workspace follow.
    """
    if name not in _callables:
        _callables[name] = prototype_of(name)(known(ENTRIES, name).address())
    return _callables[name]


def prototype_of(name: str) -> Any:
    """Type of the C function of an entry point or a step, for :mod:`ctypes`.

    The workspace ``ws``, the first argument, is passed as three pointers: to scalars, floats and integers.
    """
    # all entry points are compiled or loaded first, as each may call others by their addresses
    entry_addresses()
    return _prototype(known(ENTRIES, name).signature)


def _prototype(signature: str) -> Any:
    """Type of the C function of a signature."""
    # "f8(ws, i8)": the type of the result, then those of the arguments, the first of which is ws
    result, _, names = signature.partition("(")
    # a name that C_TYPES lacks is the name of an enumeration, whose members are integers
    returned, *extra = [C_TYPES.get(n.strip(), ctypes.c_int64) for n in [result, *names.rstrip(")").split(",")[1:]]]
    return ctypes.CFUNCTYPE(returned, *[ctypes.c_void_p] * 3, *extra)


def address_of(make_shim: Callable[[], Callable[..., Any]], form: str, key: str) -> int:
    """Address of a shim, which calls a plug-in's function, as a C function with the arguments of a form.

    It is loaded from the file of machine code of its ``key``, or ``make_shim`` makes it and it is compiled. Equal keys
    must mean equal functions. With an empty key nothing is kept on disk. ``form`` is the name of one of ``FORMS``.
    """
    name = f"shim-{key}" if key else ""
    code = read(name) if name else None
    return load(code) if code else int(_compiler().compile_shim(make_shim(), FORMS[form].signature, name))


def jit(function: Callable[..., Any]) -> Any:
    """Numba's dispatcher for a plug-in's function.

    The machine code of the function becomes part of a shim, a C function that the engine calls by its address. So the
    function is compiled when its shim is compiled.
    """
    return importlib.import_module("nonsmooth.engine.native.compiler").law_dispatcher(function)


watches: dict[int, Any] = {}
"""The C functions of interrupt checks by their addresses. Python would free a function that is not listed here."""


def watch_address(function: Callable[[float], float]) -> int:
    """Address of a C function that calls an interrupt check, a Python function of time [s].

    The check returns how much work may be done until its next call, 0 to stop the run. The address is valid until
    :func:`forget_watch`.
    """
    callback = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(function)
    # an object of ctypes stores the address as its content. "or 0" is for type checkers: it is never None
    address = int(ctypes.c_void_p.from_buffer(callback).value or 0)
    watches[address] = callback
    return address


def forget_watch(address: int) -> None:
    """Release the C function of an interrupt check, whose address must not be called any more."""
    del watches[address]


def _moved(floats: Any, offset: int) -> Any:
    """The floats from an offset on. Python calls this version of :func:`at`, compiled code another version."""
    return floats[offset:]


at = Shared(_moved, "at")


def _support(floats: Any, place: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Farthest point of a body in the direction (x, y, z) [m], by a C function whose address is ``floats[place]``.

    The parameters of the function follow its address. Compiled code calls another version of :func:`call_support`.
    """
    # parameters and direction are copied to C arrays, because floats may be any sequence. The array of parameters has
    # one unused number at its end. The function writes the point to its last argument
    parameters = (ctypes.c_double * (len(floats) - place))(*floats[place + 1 :])
    direction, found = (ctypes.c_double * 3)(x, y, z), (ctypes.c_double * 3)()
    FORMS["support"].prototype()(int(floats[place]))(direction, parameters, found)
    return found[0], found[1], found[2]


call_support = Shared(_support, "support")
