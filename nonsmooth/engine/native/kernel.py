"""The switch between compiled and plain: all functions of the engine get their decorators and calls from here.

Kernels take the workspace ``ws``, all numbers of one trajectory by owner (:mod:`nonsmooth.engine.memory.workspace`).
Set the environment variable ``NONSMOOTH_PLAIN=1`` before the first import to run the same source as ordinary Python,
without numba: for the debugger, for coverage, and to check that both agree.

Names that Python and plug-ins use are those of :mod:`nonsmooth.engine.native.machine_code`, which needs no compiler.
All others belong to kernels. Their modules, and numba, are imported when a kernel module is, which happens only if
machine code is missing.

Names in signatures:

==================  ================================================================================
``ws``              the workspace
``f8, i8, b1``      a float, an integer, a boolean
``v2, v3``          a tuple of two or three floats
``void``            no result
``Contact``         a record, by the name of its owner
``Mode``            a member of an enumeration, by the name of its class
``Instant``         a named tuple of numbers, by the name of its class (:data:`result`)
``F, I``            the floats or the integers of the workspace from some place on
==================  ================================================================================
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, TypeVar

from nonsmooth.engine.memory.declare import Singleton
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.owners.active_contact import ActiveContact, Unknown
from nonsmooth.engine.memory.owners.bodies import Articulation, BodyRecord, JointRecord, LoadRecord
from nonsmooth.engine.memory.owners.contact import ContactRecord, HistoryRecord, KindRecord, RowRecord
from nonsmooth.engine.memory.owners.guards import GuardRecord, ImpactGuard, OwnGuard
from nonsmooth.engine.memory.owners.neighbours import BoundingSphere, Carrier, HalfSpaceRecord, Pair, Search
from nonsmooth.engine.memory.workspace import Workspace
from nonsmooth.engine.memory.written import PACKED
from nonsmooth.engine.native.entries import Fingerprint
from nonsmooth.engine.native.forms import FORMS
from nonsmooth.types import Floats, Integers, ReadFloats

PLAIN = os.environ.get("NONSMOOTH_PLAIN", "0") not in ("", "0")

_Function = TypeVar("_Function", bound=Callable[..., Any])
_Class = TypeVar("_Class", bound=type[Any])


class _Decorator(Protocol):
    """Type of :data:`kernel` and :data:`entry_point`."""

    def __call__(self, signature: str = "void(ws)", /) -> Callable[[_Function], _Function]:
        """Decorator of a function with the types of a signature."""


_calls = importlib.import_module(f"nonsmooth.engine.native.{'plain' if PLAIN else 'machine_code'}")
"""Module with the functions below that Python and plug-ins call: ``machine_code``, or ``plain``.

Both define the same names. ``machine_code`` calls compiled code, ``plain`` runs everything as ordinary Python.
"""

entry_addresses: Callable[[], tuple[int, ...]] = _calls.entry_addresses
"""Addresses of all entry points, which the workspace holds."""
prototype_of: Callable[[str], Any] = _calls.prototype_of
"""Type of the C function of an entry point, for :mod:`ctypes`."""
call_entry: Callable[..., Any] = _calls.call_entry
"""``call_entry(name, memory, *numbers)``: call an entry point, or the step of an engine, from Python."""
call_alone: Callable[..., Any] = _calls.call_alone
"""``call_alone(name, memory, *numbers)``: the same for an entry point that calls no other one: only it is compiled."""
at: Callable[[Floats, int], Floats] = _calls.at
"""``at(floats, offset)``: the floats from an offset on, for kernels and for the functions of plug-ins."""
call_support: Callable[[ReadFloats, int, float, float, float], tuple[float, float, float]] = _calls.call_support
"""``call_support(floats, place, x, y, z)``: farthest point in the direction (x, y, z) [m].

``floats[place]`` is the address of ``support(direction, parameters, point)``; its parameters follow.
"""
watch_address: Callable[[Callable[[float], float]], int] = _calls.watch_address
"""``watch_address(function)``: address of a C function that calls the interrupt check, a Python function.

The engine calls it by :func:`call_watch`. The address is valid until :func:`forget_watch`.
"""
forget_watch: Callable[[int], None] = _calls.forget_watch
"""``forget_watch(address)``: free the C function that :func:`watch_address` made. The address is then invalid."""
jit: Callable[[Callable[..., Any]], Any] = _calls.jit
"""``jit(function)``: a plug-in's function, compiled on demand."""
shared: Callable[[_Function], _Function] = _calls.shared
"""Decorator of a function that plug-in functions may call, in compiled code and in Python."""
unshared: Callable[[Any], Any] = _calls.unshared
"""``unshared(value)``: the Python function behind the result of :func:`shared`; other values are unchanged."""
address_of: Callable[[Callable[[], Callable[..., Any]], str, str], int] = _calls.address_of
"""``address_of(make_shim, form, key)``: address of a shim, which is a C function that calls a plug-in's function.

``form`` is the name of its arguments in :data:`nonsmooth.engine.native.forms.FORMS`. The shim is loaded from the file
of its ``key``. Without such a file, ``make_shim`` makes it, and it is compiled. An empty ``key`` means no file.
"""

kernel: _Decorator
"""Decorator of a function of the engine that is compiled into its callers."""
entry_point: _Decorator
"""Decorator of a function of the engine that is compiled apart and called by its address, from Python too."""
result: Callable[[_Class], _Class]
"""Decorator of a named tuple of numbers that a kernel may return. Signatures use the name of its class."""
own_kernel: Callable[[type[Singleton], str], Callable[[_Function], _Function]]
"""Decorator of a kernel of an engine that adds a part of its own to the workspace."""
add_step: Callable[[Callable[..., Any], type[Singleton], str, Fingerprint], str]
"""``add_step(function, own, signature, fingerprint)``: let :data:`call_entry` find a step by the returned name."""

copy_fields: Callable[[Any, Any], None]
"""Copy the numbers that two records of different owners have in common."""
frame_at: Callable[[Floats, int], Any]
"""``frame_at(floats, start)``: the frame that a body writes, by name."""
part_at: Callable[[Floats, int], Any]
"""``part_at(floats, start)``: the numbers of a convex part, by name."""
part_end: Callable[[Floats, int, int], Any]
"""``part_end(floats, start, n)``: end n of the parts of a step, by name."""
joint_row: Callable[[Floats, int, int], Any]
"""``joint_row(floats, joint.out, r)``: row r that a joint writes, by name."""
load_wrench: Callable[[Floats, int], Any]
"""``load_wrench(floats, load.out)``: the force and torque that a load writes, by name."""
impact_state: Callable[[Floats, int, int], Any]
"""``impact_state(floats, start, a)``: active contact a in the state of an impact, or in its slope, by name."""
delassus_block: Callable[[Floats, int, int], Any]
"""``delassus_block(floats, start, block)``: a block on the diagonal of the Delassus matrix, by name."""

_Filling: TypeAlias = Callable[[int, float, Floats, Floats, Floats, Floats], None]

call_scalar: Callable[[int, float, Floats], float]
"""Call ``law(x, parameters)`` at an address."""
call_compliance: Callable[[int, float, float, float, Floats], float]
"""Call ``force(indentation, rate, closing_rate, parameters)`` at an address."""
call_traction: _Filling
"""Call ``traction(normal_force, motion, state, parameters, out)`` at an address."""
call_rates: Callable[[int, float, Floats, Floats, Floats], None]
"""Call ``rates(speed, state, parameters, out)`` at an address."""
call_guard: Callable[[int, float, Floats, Floats, Floats], float]
"""Call ``guard(t, q, u, parameters)`` at an address."""
call_body: _Filling
"""Call ``body(t, q, u, parameters, out)`` at an address."""
call_load: _Filling
"""Call ``load(t, frame_a, frame_b, parameters, out)`` at an address."""
call_pair: Callable[[int, Floats, Floats, Floats, Floats], None]
"""Call ``geometry(frame_a, frame_b, parameters, out)`` at an address."""
call_map: Callable[[int, int, Floats, Floats, Floats, Floats], None]
"""Call ``impact(n, delassus, rates, parameters, impulses)`` at an address."""
call_watch: Callable[[int, float], float]
"""Call the interrupt check at an address: ``check(t)`` returns the next work budget."""

_OF_KERNELS = {
    **dict.fromkeys(("kernel", "entry_point", "own_kernel", "add_step"), "entry_points"),
    "result": "signatures",
    "copy_fields": "views",
    **dict.fromkeys(PACKED, "views"),
    **dict.fromkeys((*(f"call_{form}" for form in FORMS), "call_watch"), "address_calls"),
}
"""Names of this module that only kernels use, each with the module that defines it for compiled code.

They get their values at the first use, because these modules import numba. In plain mode all are in ``plain``.
"""

if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Value of a name that kernels use, from the compiled or the plain module, which is imported here."""
        if name not in _OF_KERNELS:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        half = importlib.import_module(f"nonsmooth.engine.native.{'plain' if PLAIN else _OF_KERNELS[name]}")
        globals()[name] = getattr(half, name)
        return globals()[name]
