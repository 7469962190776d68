"""Another memory of the same system, for another thread."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.native.kernel import PLAIN


def copied(memory: Memory) -> Memory:
    """Return a memory with the same content, but for output and scratch, that reads the same tables.

    The numbers that lead to tables are offsets, and the engine's pointers have no bounds: they may lead into another
    memory.  In plain mode they have, and the tables are copied.
    """
    owner = memory if memory.owner is None else memory.owner
    floats = np.zeros(len(owner.floats) if PLAIN else memory.tables)
    made = replace(
        memory,
        scalars=memory.scalars.copy(),
        floats=floats,
        integers=np.zeros_like(memory.integers),
        owner=None if PLAIN else owner,
    )
    for own, other in zip(made.early, memory.early, strict=True):
        own[:] = other
    floats[memory.tables :] = owner.floats[memory.tables : len(floats)]
    way = 0 if PLAIN else (owner.floats.ctypes.data - floats.ctypes.data) // floats.itemsize
    for place, start, table in memory.references:
        floats[place] = table - start + way
    return made
