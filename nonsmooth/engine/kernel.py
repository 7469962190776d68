"""The one switch between compiled and plain: every engine function comes through here.

Engine functions take the scalars ``S`` (one record of counts, offsets, tolerances), the heap of
floats ``w`` and the heap of integers ``k`` (see :mod:`nonsmooth.model.layout`).  Set the environment
variable ``NONSMOOTH_PLAIN=1`` before the first import to run the same source as ordinary Python,
without numba: for the debugger, for coverage, and to see that both agree.
"""

from __future__ import annotations

import os

PLAIN = os.environ.get("NONSMOOTH_PLAIN", "0") not in ("", "0")

if PLAIN:
    from nonsmooth.engine.plain import (
        COMPILATION_ERRORS,
        address_of,
        at,
        call_body,
        call_map,
        call_pair,
        call_room,
        call_scalar,
        jit,
        kernel,
        room,
        room_addresses,
    )
else:
    from nonsmooth.engine.native import (
        COMPILATION_ERRORS,
        address_of,
        at,
        call_body,
        call_map,
        call_pair,
        call_room,
        call_scalar,
        jit,
        kernel,
        room,
        room_addresses,
    )

__all__ = [
    "COMPILATION_ERRORS",
    "PLAIN",
    "address_of",
    "at",
    "call_body",
    "call_map",
    "call_pair",
    "call_room",
    "call_scalar",
    "jit",
    "kernel",
    "room",
    "room_addresses",
]
