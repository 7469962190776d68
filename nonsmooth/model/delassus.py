"""A Delassus matrix of contacts that all act on one another, in and out of the engine's memory."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.model.memory import Memory

Floats = NDArray[np.float64]


def write_delassus(memory: Memory, matrix: Floats) -> None:
    """Lay a matrix of shape [3 n, 3 n] into the memory as n^2 blocks, of the contacts 0 to n - 1."""
    n = len(matrix) // 3
    memory.array("block_start", n + 1)[:] = n * np.arange(n + 1)
    memory.array("block_column", n * n)[:] = np.tile(np.arange(n), n)
    memory.array("own_block", n)[:] = (n + 1) * np.arange(n)
    memory.array("delassus", 9 * n * n)[:] = np.reshape(matrix, (n, 3, n, 3)).transpose(0, 2, 1, 3).ravel()


def read_delassus(memory: Memory, n: int) -> Floats:
    """Return a matrix that :func:`write_delassus` has laid, shape [3 n, 3 n]."""
    blocks = memory.array("delassus", 9 * n * n).reshape(n, n, 3, 3)
    return np.ascontiguousarray(blocks.transpose(0, 2, 1, 3)).reshape(3 * n, 3 * n)
