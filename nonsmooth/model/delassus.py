"""A Delassus matrix given in full, in and out of the blocks of the engine's memory."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import MOST_BLOCKS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.errors import InvalidInput

Floats = NDArray[np.float64]


def write_delassus(memory: Memory, matrix: Floats) -> None:
    """Lay a matrix of shape [3 n, 3 n] into the memory, for the contacts 0 to n - 1 in this order.

    Contacts whose blocks are zero both ways do not act on each other.

    Raises
    ------
    InvalidInput
        If there are more blocks than the memory has room for.
    """
    n = len(matrix) // 3
    blocks = np.reshape(matrix, (n, 3, n, 3)).transpose(0, 2, 1, 3)
    coupled = np.any(blocks != 0.0, axis=(2, 3))
    coupled |= coupled.T | np.eye(n, dtype=bool)
    rows, columns = np.nonzero(coupled)
    if len(columns) > MOST_BLOCKS:
        remedy = "Solve contacts that do not act on each other apart."
        raise InvalidInput("contacts", f"must couple in at most {MOST_BLOCKS} pairs", len(columns), remedy)
    memory[owners.Island.block_start][: n + 1] = np.searchsorted(rows, np.arange(n + 1))
    memory[owners.Island.block_column][: len(columns)] = columns
    memory[owners.ActiveContact.diagonal_block][:n] = np.flatnonzero(rows == columns)
    memory[owners.Island.delassus][: 9 * len(columns)] = blocks[coupled].ravel()


def read_delassus(memory: Memory, n: int) -> Floats:
    """Return the matrix of the contacts 0 to n - 1, shape [3 n, 3 n]."""
    starts = memory[owners.Island.block_start][: n + 1]
    columns = memory[owners.Island.block_column][: int(starts[-1])]
    rows = np.repeat(np.arange(n), np.diff(starts))
    blocks = np.zeros((n, n, 3, 3))
    blocks[rows, columns] = memory[owners.Island.delassus][: 9 * len(columns)].reshape(-1, 3, 3)
    return np.ascontiguousarray(blocks.transpose(0, 2, 1, 3)).reshape(3 * n, 3 * n)
