"""Writes and reads a full Delassus matrix, which the memory holds as blocks of pairs of contacts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import MOST_BLOCKS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.errors import InvalidInput

Floats = NDArray[np.float64]


def write_delassus(memory: Memory, matrix: Floats) -> None:
    """Write a Delassus matrix [1/kg] of shape [3 n, 3 n] for the contacts 0 to n - 1, in this order.

    The memory gets the blocks (3 x 3) of pairs of contacts, row by row, with the columns of the blocks and where each
    row starts. Two contacts with zero blocks both ways do not act on each other, and get no block.

    Raises
    ------
    InvalidInput
        If there are more blocks than the memory can hold.
    """
    n = len(matrix) // 3
    blocks = np.reshape(matrix, (n, 3, n, 3)).transpose(0, 2, 1, 3)
    coupled = np.any(blocks != 0.0, axis=(2, 3))
    # both blocks of a pair, and the one on the diagonal even if it is zero
    coupled |= coupled.T | np.eye(n, dtype=bool)
    rows, columns = np.nonzero(coupled)
    if len(columns) > MOST_BLOCKS:
        remedy = "Solve groups of contacts that do not act on each other separately."
        raise InvalidInput("contacts", f"must couple in at most {MOST_BLOCKS} pairs", len(columns), remedy)
    memory[owners.Island.block_start][: n + 1] = np.searchsorted(rows, np.arange(n + 1))
    memory[owners.Island.block_column][: len(columns)] = columns
    memory[owners.ActiveContact.diagonal_block][:n] = np.flatnonzero(rows == columns)
    # 9 numbers for each block
    memory[owners.Island.delassus][: 9 * len(columns)] = blocks[coupled].ravel()


def read_delassus(memory: Memory, n: int) -> Floats:
    """Delassus matrix [1/kg] of the contacts 0 to n - 1, shape [3 n, 3 n]; zero where two contacts have no block."""
    starts = memory[owners.Island.block_start][: n + 1]
    columns = memory[owners.Island.block_column][: int(starts[-1])]
    rows = np.repeat(np.arange(n), np.diff(starts))
    blocks = np.zeros((n, n, 3, 3))
    # 9 numbers for each block
    blocks[rows, columns] = memory[owners.Island.delassus][: 9 * len(columns)].reshape(-1, 3, 3)
    return np.ascontiguousarray(blocks.transpose(0, 2, 1, 3)).reshape(3 * n, 3 * n)
