"""The one switch between compiled and plain: every engine function comes through here.

Engine functions take the workspace ``ws``, all numbers of one trajectory by owner
(:mod:`nonsmooth.engine.memory.workspace`). Set the environment variable ``NONSMOOTH_PLAIN=1`` before the first import to
run the same source as ordinary Python, without numba: for the debugger, for coverage, and to see that both agree.

Signatures are written with ``ws``; ``f8``, ``i8``, ``b1`` and ``void``; ``v2`` and ``v3``, tuples of two and three floats;
the owner of a record, ``Contact``; the name of a result (:data:`result`); and ``F`` and ``I``, the floats and integers of
the workspace from some place on.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Mapping
from typing import Any, Protocol, TypeAlias, TypeVar

from nonsmooth.engine.memory.declare import Part
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.owners.active_contact import ActiveContact, Unknown
from nonsmooth.engine.memory.owners.bodies import Articulation, Body, Joint, Load
from nonsmooth.engine.memory.owners.contact import Contact, DeclaredContact
from nonsmooth.engine.memory.owners.guards import Guard, ImpactGuard, OwnGuard
from nonsmooth.engine.memory.owners.neighbours import Carrier, HalfSpace, Pair, Search, Sphere
from nonsmooth.engine.memory.workspace import Workspace
from nonsmooth.engine.native.entries import Fingerprint
from nonsmooth.types import Floats, Integers

PLAIN = os.environ.get("NONSMOOTH_PLAIN", "0") not in ("", "0")

_Function = TypeVar("_Function", bound=Callable[..., Any])
_Class = TypeVar("_Class", bound=type[Any])


class _Decorator(Protocol):
    def __call__(self, signature: str = "void(ws)", /) -> Callable[[_Function], _Function]: ...


_half = importlib.import_module("nonsmooth.engine.native.plain" if PLAIN else "nonsmooth.engine.native.native")

kernel: _Decorator = _half.kernel
"""An engine function, compiled into its callers."""
result: Callable[[_Class], _Class] = _half.result
"""A named tuple of numbers that a kernel may return; a signature knows it by the name of its class."""
entry_point: _Decorator = _half.entry_point
"""An engine function compiled apart, reached by its address, by Python too."""
entry_addresses: Callable[[], tuple[int, ...]] = _half.entry_addresses
"""The addresses of all entry points, which belong at the head of ``k``."""
call_entry: Callable[..., Any] = _half.call_entry
"""``call_entry(name, memory, *numbers)``: call an entry point, or a step of an engine of one's own, from Python."""
own_kernel: Callable[[type[Part], str], Callable[[_Function], _Function]] = _half.own_kernel
"""A function of an engine with scalars and arrays of its own, compiled into its callers."""
add_step: Callable[[Callable[..., Any], type[Part], str, Fingerprint], str] = _half.add_step
"""``add_step(function, own, signature, fingerprint)``: let :data:`call_entry` find a step by the name returned."""

copy_fields: Callable[[Any, Any], None] = _half.copy_fields
"""Copy the numbers that two records of different owners have in common."""
frame_at: Callable[[Floats, int], Any] = _half.records["frame"]
"""``frame_at(w, place)``: a frame that a body writes by name."""
part_at: Callable[[Floats, int], Any] = _half.records["part"]
"""``part_at(w, place)``: the numbers of a convex part by name."""
joint_row: Callable[[Floats, int, int], Any] = _half.records["joint_row"]
"""``joint_row(w, joint.out, r)``: a row that a joint writes by name."""
load_wrench: Callable[[Floats, int], Any] = _half.records["load_wrench"]
"""``load_wrench(w, load.out)``: what a load writes by name."""
impact_state: Callable[[Floats, int, int], Any] = _half.records["impact_state"]
"""``impact_state(w, y, a)``: an active contact in the state of an impact, or the slope, at ``y``, by name."""
delassus_block: Callable[[Floats, int, int], Any] = _half.records["delassus_block"]
"""``delassus_block(w, S.delassus, block)``: a block on the diagonal of the Delassus matrix by name."""
at: Callable[[Floats, int], Floats] = _half.at
"""The heap from an offset on."""

_Filling: TypeAlias = Callable[[int, float, Floats, Floats, Floats, Floats], None]

calls: Mapping[str, Callable[..., Any]] = _half.calls
"""What calls a function at an address, for each of :data:`nonsmooth.engine.native.forms.FORMS`."""
call_scalar: Callable[[int, float, Floats], float] = calls["scalar"]
"""Call ``law(x, parameters)`` at an address."""
call_compliance: Callable[[int, float, float, float, Floats], float] = calls["compliance"]
"""Call ``force(indentation, rate, closing_rate, parameters)`` at an address."""
call_traction: _Filling = calls["traction"]
"""Call ``traction(normal_force, motion, state, parameters, out)`` at an address."""
call_rates: Callable[[int, float, Floats, Floats, Floats], None] = calls["rates"]
"""Call ``rates(speed, state, parameters, out)`` at an address."""
call_guard: Callable[[int, float, Floats, Floats, Floats], float] = calls["guard"]
"""Call ``guard(t, q, u, parameters)`` at an address."""
call_body: _Filling = calls["body"]
"""Call ``body(t, q, u, parameters, out)`` at an address."""
call_load: _Filling = calls["load"]
"""Call ``load(t, frame_a, frame_b, parameters, out)`` at an address."""
call_pair: Callable[[int, Floats, Floats, Floats, Floats], None] = calls["pair"]
"""Call ``geometry(frame_a, frame_b, parameters, out)`` at an address."""
call_map: Callable[[int, int, Floats, Floats, Floats, Floats], None] = calls["map"]
"""Call ``impact(n, delassus, rates, parameters, impulses)`` at an address."""
call_watch: Callable[[int, float], float] = _half.call_watch
"""Call ``watch(t)`` at an address."""
watch_address: Callable[[Callable[[float], float]], int] = _half.watch_address
"""Return the address of a function that :func:`call_watch` may call until :func:`forget_watch`."""
forget_watch: Callable[[int], None] = _half.forget_watch
"""Give up an address of :func:`watch_address`."""
call_support: Callable[[Floats, int, float, float, float], tuple[float, float, float]] = _half.call_support
"""Call ``support(direction, parameters, point)`` at the address at a place of a heap, the parameters behind it."""

part_end: Callable[[Floats, int, int], Any] = _half.records["part_end"]
"""``part_end(w, S.part_ends, n)``: an end of a part of a step by name."""

block_at: Callable[[Floats, int], Floats] = _half.block_at
"""What stands in a block from a place on, for the functions of plug-ins."""

jit: Callable[[Callable[..., Any]], Any] = _half.jit
"""Compile a plug-in's function on demand."""
shared: Callable[[Callable[..., Any]], Any] = _half.shared
"""Let the functions of plug-ins call this one, compiled or not."""
unshared: Callable[[Any], Any] = _half.unshared
"""The function out of which :func:`shared` has made a value, any other value as it is."""
address_of: Callable[[Callable[..., Any], str, str], int] = _half.address_of
"""Compile a shim of one of :data:`nonsmooth.engine.native.forms.FORMS`, or find it under its key on disk, and
return its address.  Without a key nothing is kept on disk."""

__all__ = [
    "PLAIN",
    "ActiveContact",
    "Articulation",
    "Body",
    "Carrier",
    "Contact",
    "DeclaredContact",
    "Floats",
    "Guard",
    "HalfSpace",
    "ImpactGuard",
    "Integers",
    "Joint",
    "Load",
    "Memory",
    "OwnGuard",
    "Pair",
    "Search",
    "Sphere",
    "Unknown",
    "Workspace",
    "add_step",
    "address_of",
    "at",
    "block_at",
    "call_body",
    "call_compliance",
    "call_entry",
    "call_guard",
    "call_load",
    "call_map",
    "call_pair",
    "call_rates",
    "call_scalar",
    "call_support",
    "call_traction",
    "call_watch",
    "calls",
    "copy_fields",
    "delassus_block",
    "entry_addresses",
    "entry_point",
    "forget_watch",
    "frame_at",
    "impact_state",
    "jit",
    "joint_row",
    "kernel",
    "load_wrench",
    "own_kernel",
    "part_at",
    "part_end",
    "result",
    "shared",
    "unshared",
    "watch_address",
]
