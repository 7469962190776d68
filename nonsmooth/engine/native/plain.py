"""The plain half of :mod:`nonsmooth.engine.native.kernel`: the same names, as ordinary Python."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from nonsmooth.engine.memory.contact_fields import NUMBERS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.rooms import ROOMS
from nonsmooth.engine.memory.tables import FLOAT_ARRAYS, SCALARS
from nonsmooth.engine.native.forms import FORMS

_functions: list[Callable[..., Any]] = []
_watches: dict[int, Callable[[float], float]] = {}
_rooms: dict[str, Callable[..., Any]] = {}


def kernel(signature: str = "void(S, F, I)") -> Callable[[Callable[..., Any]], Any]:
    """Leave the function as it is."""
    return lambda function: function


def room(signature: str = "void(S, F, I)") -> Callable[[Callable[..., Any]], Any]:
    """Leave the function as it is, and let :func:`call_room` find it."""

    def decorate(function: Callable[..., Any]) -> Any:
        _rooms[function.__name__] = function
        return function

    return decorate


def room_addresses() -> tuple[int, ...]:
    """Return as many numbers as there are rooms; nothing reads them."""
    importlib.import_module("nonsmooth.engine.events.event_loop")
    return (0,) * len(ROOMS)


def call_room(name: str, memory: Memory, *arguments: float) -> Any:
    """Call a room on the memory of one trajectory."""
    record = memory.scalars[0]
    scalars = SimpleNamespace(**{field: record[field].item() for field in SCALARS.names or ()})
    try:
        return _rooms[name](scalars, memoryview(memory.floats.data), memoryview(memory.integers.data), *arguments)
    finally:
        for field, value in vars(scalars).items():
            memory.scalars[field] = value


class _Contact:
    """A contact with named fields."""

    __slots__ = ("_heaps", "_number", "_scalars")

    def __init__(self, scalars: Any, w: Any, k: Any, number: int) -> None:
        object.__setattr__(self, "_scalars", scalars)
        object.__setattr__(self, "_heaps", (w, k))
        object.__setattr__(self, "_number", number)

    def _field(self, name: str) -> Any:
        heap, numbers = self._heaps[0 if name in FLOAT_ARRAYS else 1], NUMBERS[name]
        start = getattr(self._scalars, name) + numbers * self._number
        return heap[start : start + numbers]

    def __getattr__(self, name: str) -> Any:
        field = self._field(name)
        return field[0] if NUMBERS[name] == 1 else field

    def __setattr__(self, name: str, value: float) -> None:
        self._field(name)[0] = value


def contact_at(scalars: Any, w: Any, k: Any, c: int) -> Any:
    """Return contact ``c`` with its fields by name."""
    return _Contact(scalars, w, k, c)


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
