"""The plain half of :mod:`nonsmooth.engine.native.kernel`: the same names, as ordinary Python."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from nonsmooth.engine.memory.arrays.arrays import Arrays
from nonsmooth.engine.memory.entry_points import ENTRY_POINTS
from nonsmooth.engine.memory.fields import Field, Fields
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.records import PACKED, RECORDS
from nonsmooth.engine.native.entries import Fingerprint, known, own_name
from nonsmooth.engine.native.forms import FORMS

_functions: list[Callable[..., Any]] = []
_watches: dict[int, Callable[[float], float]] = {}
_entries: dict[str, Callable[..., Any]] = {}


def kernel(signature: str = "void(S, F, I)") -> Callable[[Callable[..., Any]], Any]:
    """Leave the function as it is."""
    return lambda function: function


def entry_point(signature: str = "void(S, F, I)") -> Callable[[Callable[..., Any]], Any]:
    """Leave the function as it is, and let :func:`call_entry` find it."""

    def decorate(function: Callable[..., Any]) -> Any:
        _entries[function.__name__] = function
        return function

    return decorate


def own_kernel(own: Arrays, signature: str) -> Callable[[Callable[..., Any]], Any]:
    """Leave the function as it is."""
    return lambda function: function


def add_step(function: Callable[..., Any], own: Arrays, signature: str, fingerprint: Fingerprint) -> str:
    """Let :func:`call_entry` find a step of an engine under the name that is returned."""
    name = own_name(function)
    _entries[name] = function
    return name


def entry_addresses() -> tuple[int, ...]:
    """Return as many numbers as there are entry points; nothing reads them."""
    importlib.import_module("nonsmooth.engine.events.event_loop")
    return (0,) * len(ENTRY_POINTS)


def call_entry(name: str, memory: Memory, *arguments: float) -> Any:
    """Call an entry point on the memory of one trajectory."""
    entry = known(_entries, name)
    record = memory.scalars[0]
    scalars = SimpleNamespace(**{field: record[field].item() for field in record.dtype.names})
    try:
        return entry(scalars, memoryview(memory.floats.data), memoryview(memory.integers.data), *arguments)
    finally:
        for field, value in vars(scalars).items():
            memory.scalars[field] = value


class _Record:
    """A record whose fields are properties."""

    __slots__ = ("S", "k", "n", "w")

    def __init__(self, scalars: Any, w: Any, k: Any, number: int) -> None:
        self.S, self.w, self.k, self.n = scalars, w, k, number


def _property(field: Field) -> property:
    parts = [f"self.S.{name}" for name in (field.array, field.behind) if name]
    start = " + ".join([*parts, f"{field.stride if field.array else 1} * self.n", str(field.first)])
    heap = "self.w" if field.is_float else "self.k"
    many = f"{heap}[{start} : {start} + {field.numbers}]"
    one = f"{heap}[{start}]"
    found = f"tuple({many})" if field.is_vector else many if field.numbers > 1 else one
    target = ", ".join(f"{heap}[{start} + {i}]" for i in range(field.numbers)) if field.is_vector else one
    scope: dict[str, Any] = {}
    exec(f"def load(self): return {found}\ndef store(self, value): {target} = value", scope)
    return property(scope["load"], scope["store"])


def _kind(kind: str, fields: Fields) -> Any:
    return type(kind, (_Record,), {"__slots__": (), **{name: _property(field) for name, field in fields.items()}})


def _packed(kind: str, fields: Fields) -> Callable[..., Any]:
    record, stride = _kind(kind, fields), next(iter(fields.values())).stride
    return lambda w, start, number=0: record(None, w, None, start + stride * number)


records = {kind: _kind(kind, fields) for kind, fields in RECORDS.items()}
records |= {kind: _packed(kind, fields) for kind, fields in PACKED.items()}


def at(heap: memoryview, offset: int) -> memoryview:
    """Return the view from ``offset`` on."""
    return heap[offset:]


def _call(address: int, *arguments: Any) -> Any:
    """Call the function of a form at an address."""
    return _functions[address - 1](*arguments)


calls = dict.fromkeys(FORMS, _call)


def call_watch(address: int, t: float) -> Any:
    """Call ``float watch(float)``."""
    return _watches[address](t)


def watch_address(function: Callable[[float], float]) -> int:
    """Register ``function`` and return the number it answers to."""
    address = max(_watches, default=0) + 1
    _watches[address] = function
    return address


def forget_watch(address: int) -> None:
    """Give up the number."""
    del _watches[address]


def call_support(heap: Any, place: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Call ``void support(direction, parameters, point)`` with what stands in a heap; return the point."""
    found = [0.0, 0.0, 0.0]
    _functions[int(heap[place]) - 1]([x, y, z], heap[place + 1 :], found)
    return found[0], found[1], found[2]


def block_at(block: Any, place: int) -> Any:
    """Return what stands in a block from a place on."""
    return block[place:]


def jit(function: Callable[..., Any]) -> Callable[..., Any]:
    """Leave the function as it is."""
    return function


def shared(function: Callable[..., Any]) -> Callable[..., Any]:
    """Leave the function as it is."""
    return function


def unshared(value: Any) -> Any:
    """Leave the value as it is."""
    return value


def address_of(shim: Callable[..., Any], form: str, key: str) -> int:
    """Register ``shim`` and return the number it answers to."""
    _functions.append(shim)
    return len(_functions)
