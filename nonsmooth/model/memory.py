"""The heaps of one trajectory: views by name, blocks appended behind the fixed arrays."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from nonsmooth.model import tableau
from nonsmooth.model.layout import (
    FLOAT_ARRAYS,
    GEOMETRY,
    GUARD,
    INTEGER_ARRAYS,
    N_STAGES,
    PAIR,
    SCALARS,
    UNTOUCHED,
)
from nonsmooth.parameters import Table


class Heap:
    """The blocks that come behind the fixed arrays: output blocks, Jacobians, parameters."""

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._blocks: list[np.ndarray] = []
        self._next = len(memory.floats)
        self._references: list[tuple[np.ndarray, int, int, Table]] = []

    def block(self, size: int) -> int:
        """Reserve floats; return their offset."""
        return self.store(np.zeros(size))

    def store(self, values: Sequence[float] | np.ndarray) -> int:
        """Append values; return their offset."""
        start = self._next
        self._blocks.append(np.asarray(values, dtype=float))
        self._next += len(values)
        return start

    def store_with_tables(self, values: Sequence[float], tables: Mapping[int, Table]) -> int:
        """Append values, of which some say how far behind their beginning a table lies; return their offset."""
        start = self.store(values)
        self._references += [(self._blocks[-1], place, start, table) for place, table in tables.items()]
        return start

    def output(self, size: int) -> int:
        """Reserve floats that a plug-in writes, and guards behind them; return their offset."""
        return self.store(np.append(np.zeros(size), np.full(GUARD, UNTOUCHED)))

    def close(self) -> Memory:
        """Return the memory with all blocks in it, and behind them every table once."""
        old, places, references = self._memory, dict[int, int](), []
        tables = self._next
        for block, place, start, table in self._references:
            if id(table) not in places:
                places[id(table)] = self.store(table.numbers)
            block[place] = places[id(table)] - start
            references.append((start + place, start, places[id(table)]))
        floats = np.zeros(self._next + 1)
        written = int(old.scalars[0]["delassus"])
        floats[:written] = old.floats[:written]
        if self._blocks:
            np.concatenate(self._blocks, out=floats[len(old.floats) : -1])
        return Memory(old.scalars, floats, old.integers, len(old.floats), tables, tuple(references))


@dataclass(frozen=True)
class Memory:
    """Scalars and heaps of one trajectory.

    Attributes
    ----------
    scalars : numpy.ndarray
        The record ``S``, shape [1].
    floats : numpy.ndarray
        The heap ``w``: the arrays of the table, then the blocks that the assembly appended.
    integers : numpy.ndarray
        The heap ``k``.
    blocks, tables : int
        Where in ``floats`` the blocks that the assembly appended begin, and the tables behind them.
    references : tuple
        (place of a number, the place from which that number counts, place of the table that it leads to), for every
        table that a function reads.
    owner : Memory or None
        Whose tables it reads, if it has none of its own.
    """

    scalars: np.ndarray
    floats: np.ndarray
    integers: np.ndarray
    blocks: int
    tables: int
    references: tuple[tuple[int, int, int], ...] = ()
    owner: Memory | None = None

    def array(self, name: str, size: int) -> np.ndarray:
        """Return a view of ``size`` entries of the named array."""
        heap = self.floats if name in FLOAT_ARRAYS else self.integers
        start = int(self.scalars[name][0])
        return heap[start : start + size]

    @functools.cached_property
    def kept(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Views of what a step may find of those before it: neither output nor scratch that it writes itself."""
        events, codes = (int(self.scalars[name][0]) for name in ("events", "event_codes"))
        return self.floats[:events], self.floats[self.blocks : self.tables], self.integers[:codes]


def allocate(counts: Mapping[str, int]) -> Memory:
    """Lay out the arrays for the given counts, all of ``COUNTS``; blocks are appended by :class:`Heap`."""
    values: dict[str, float] = dict.fromkeys(SCALARS.names or (), 0)
    totals: list[int] = []
    for table in (FLOAT_ARRAYS, INTEGER_ARRAYS):
        total = 0
        for name, size in table.items():
            values[name] = total
            total += size(counts)
        totals.append(total)
    values.update(counts)
    scalars = np.array([tuple(values.values())], SCALARS)
    memory = Memory(scalars, np.zeros(totals[0]), np.zeros(max(totals[1], 1), np.int64), totals[0], totals[0])
    n = counts["n_slots"]
    memory.array("geometry", GEOMETRY * n).reshape(n, GEOMETRY)[:, PAIR:] = UNTOUCHED
    memory.array("stages", 6 * N_STAGES)[:] = np.ravel(tableau.STAGES)
    memory.array("error_weights", N_STAGES)[:] = tableau.ERROR
    memory.array("dense", 4 * N_STAGES)[:] = np.ravel(tableau.DENSE)
    return memory
