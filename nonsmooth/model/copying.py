"""Copies of a memory, for another thread: the tables of meshes are shared, as they may be large."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.native.kernel import PLAIN


def copied(memory: Memory) -> Memory:
    """Memory with the same content, for another thread. Buffers of output are empty, and the tables are shared.

    A function finds its table by a distance in floats, a number among its parameters. Pointers of the compiled engine
    have no bounds, so the distance may lead into the memory that owns the tables, which must be kept alive. In plain
    mode (``PLAIN``) there are arrays with bounds instead, and the tables are copied.
    """
    # the memory to be copied may itself share the tables of another one
    owner = memory if memory.owner is None else memory.owner
    # the tables are the last of the floats, from memory.tables on
    floats = np.zeros(len(owner.floats) if PLAIN else memory.tables)
    made = replace(
        memory,
        scalars=memory.scalars.copy(),
        floats=floats,
        integers=np.zeros_like(memory.integers),
        owner=None if PLAIN else owner,
    )
    # all arrays but the late ones, which are buffers and work space, and the blocks
    for new, old in zip(made.early, memory.early, strict=True):
        new[:] = old
    # the tables; empty unless in plain mode
    floats[memory.tables :] = owner.floats[memory.tables : len(floats)]
    distance = 0 if PLAIN else (owner.floats.ctypes.data - floats.ctypes.data) // floats.itemsize
    # distances from the start of the parameters of a function to its table
    for place, start, table in memory.references:
        floats[place] = table - start + distance
    return made
