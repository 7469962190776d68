"""Copies of a memory, for another thread: the tables of meshes are shared, as they may be large."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.native.kernel import PLAIN


def copied(memory: Memory) -> Memory:
    """Memory with the same content, except for empty buffers of output, that reads the same tables.

    The number that refers to a table is a distance in floats. Pointers of the compiled engine have no bounds, so it may
    point into the other memory. In plain mode there are arrays instead, and the tables are copied.
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
    for new, old in zip(made.early, memory.early, strict=True):
        new[:] = old
    floats[memory.tables :] = owner.floats[memory.tables : len(floats)]
    distance = 0 if PLAIN else (owner.floats.ctypes.data - floats.ctypes.data) // floats.itemsize
    for place, start, table in memory.references:
        floats[place] = table - start + distance
    return made
