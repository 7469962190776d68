"""The compiled half of :mod:`nonsmooth.engine.native.kernel`: all its names, from the modules that define them."""

from __future__ import annotations

from nonsmooth.engine.native.address_calls import (
    address_of,
    at,
    block_at,
    call_support,
    call_watch,
    calls,
    forget_watch,
    watch_address,
    watches,
)
from nonsmooth.engine.native.entry_points import add_step, call_entry, entry_addresses, entry_point, prototype_of
from nonsmooth.engine.native.kernels import kernel, own_kernel
from nonsmooth.engine.native.record_view import copy_fields, records
from nonsmooth.engine.native.shared import jit, shared, unshared
from nonsmooth.engine.native.signatures import result

__all__ = [
    "add_step",
    "address_of",
    "at",
    "block_at",
    "call_entry",
    "call_support",
    "call_watch",
    "calls",
    "copy_fields",
    "entry_addresses",
    "entry_point",
    "forget_watch",
    "jit",
    "kernel",
    "own_kernel",
    "prototype_of",
    "records",
    "result",
    "shared",
    "unshared",
    "watch_address",
    "watches",
]
