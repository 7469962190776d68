"""The heaps of one trajectory: views by name, blocks appended behind the fixed arrays."""

from __future__ import annotations

import functools
from array import array
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from nonsmooth.engine.memory import implicit_tableau, tableau
from nonsmooth.engine.memory.arrays.arrays import Arrays
from nonsmooth.engine.memory.blocks import GEOMETRY, GUARD, PAIR, UNTOUCHED
from nonsmooth.engine.memory.layout import N_STAGES
from nonsmooth.engine.memory.tables import ARRAYS_OF, FLOAT_ARRAYS, INTEGER_ARRAYS, floats_of, integers_of, record_with
from nonsmooth.parameters import Table

NOTHING = Arrays()
"""What an engine has of its own that has nothing."""


class Heap:
    """The blocks that come behind the fixed arrays: output blocks, Jacobians, parameters."""

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._first = len(memory.floats)
        self._values = array("d")
        self._references: list[tuple[int, int, Table]] = []

    def block(self, size: int) -> int:
        """Reserve floats; return their offset."""
        start = self._first + len(self._values)
        self._values.frombytes(bytes(self._values.itemsize * size))
        return start

    def store(self, values: Sequence[float] | np.ndarray) -> int:
        """Append values; return their offset."""
        start = self._first + len(self._values)
        self._values.extend(values)
        return start

    def repeat(self, values: Sequence[float], times: int) -> int:
        """Append the same values so many times; return the offset of the first."""
        start = self._first + len(self._values)
        self._values.extend(times * array("d", values))
        return start

    def refer(self, place: int, start: int, table: Table) -> None:
        """Let the number at an offset say how far behind the offset ``start`` a table lies."""
        self._references.append((place, start, table))

    def output(self, size: int) -> int:
        """Reserve floats that a plug-in writes, and guards behind them; return their offset."""
        return self.store(output_block(size))

    def close(self) -> Memory:
        """Return the memory with all blocks in it, and behind them every table once."""
        old, tables = self._memory, {id(table): table for _, _, table in self._references}
        first, places = self._first + len(self._values), dict[int, int]()
        end = first
        for key, table in tables.items():
            places[key] = end
            end += len(table)
        floats = np.zeros(end + 1)
        written = int(old.scalars[0]["events"])
        floats[:written] = old.floats[:written]
        floats[self._first : first] = self._values
        for key, table in tables.items():
            floats[places[key] : places[key] + len(table)] = table.numbers
        references = tuple((place, start, places[id(table)]) for place, start, table in self._references)
        for place, start, at in references:
            floats[place] = at - start
        return replace(old, floats=floats, tables=first, references=references)


def output_block(size: int) -> list[float]:
    """Return what stands in a block that a plug-in writes before it does, guards included."""
    return size * [0.0] + GUARD * [UNTOUCHED]


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
    own : Arrays
        What its engine has of its own, besides the layers.
    owner : Memory or None
        Whose tables it reads, if it has none of its own.
    """

    scalars: np.ndarray
    floats: np.ndarray
    integers: np.ndarray
    blocks: int
    tables: int
    references: tuple[tuple[int, int, int], ...] = ()
    own: Arrays = NOTHING
    owner: Memory | None = None

    def array(self, name: str, size: int) -> np.ndarray:
        """Return a view of ``size`` entries of the named array."""
        heap, start = self._places[name]
        return heap[start : start + size]

    @functools.cached_property
    def record(self) -> np.void:
        """The record of the scalars: a view, of which one number is read and set most quickly."""
        return cast(np.void, self.scalars[0])

    @functools.cached_property
    def cells(self) -> tuple[np.ndarray, np.ndarray]:
        """All scalars as floats, and as integers, each at its place (:func:`nonsmooth.engine.memory.tables.places`).

        Views, through which short runs read and set a number at a fifth of the time that its name takes.
        """
        return self.scalars.view(np.float64), self.scalars.view(np.int64)

    @functools.cached_property
    def _places(self) -> dict[str, tuple[np.ndarray, int]]:
        heaps = (
            (self.floats, FLOAT_ARRAYS | floats_of([self.own])),
            (self.integers, INTEGER_ARRAYS | integers_of([self.own])),
        )
        starts = dict(zip(self.scalars.dtype.names or (), self.scalars.item(), strict=True))
        return {name: (heap, starts[name]) for heap, names in heaps for name in names}

    @functools.cached_property
    def addresses(self) -> tuple[int, int, int]:
        """Where scalars and heaps stand, for calls of the engine."""
        return self.scalars.ctypes.data, self.floats.ctypes.data, self.integers.ctypes.data

    @functools.cached_property
    def kept(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Views of what a step may find of those before it: neither output nor scratch that it writes itself."""
        events, codes = (int(self.scalars[name][0]) for name in ("events", "event_codes"))
        return self.floats[:events], self.floats[self.blocks : self.tables], self.integers[:codes]

    @functools.cached_property
    def bits(self) -> tuple[np.ndarray, ...]:
        """Views of the scalars and of :attr:`kept` as integers: a number that is not finite differs from itself."""
        return tuple(part.view(np.int64) for part in (self.scalars, *self.kept))


ALWAYS = ("bodies", "pairs", "numerics", "events")
"""Layers whose arrays every engine needs: where things are, coefficients, and what is recorded."""


def allocate(counts: Mapping[str, int], layers: Collection[str], own: Arrays = NOTHING) -> Memory:
    """Lay out the arrays of some layers for the given counts, all of ``COUNTS``; others have no length.

    ``own`` is what an engine brings besides.  Blocks are appended by :class:`Heap`.
    """
    values, totals = _laid(tuple(counts.items()), frozenset(layers), own)
    scalars = np.array([values], record_with(own))
    memory = Memory(scalars, np.zeros(totals[0]), np.zeros(max(totals[1], 1), np.int64), totals[0], totals[0], own=own)
    n = counts["n_slots"]
    memory.array("geometry", GEOMETRY * n).reshape(n, GEOMETRY)[:, PAIR:] = UNTOUCHED
    memory.array("stages", 6 * N_STAGES)[:] = np.ravel(tableau.STAGES)
    memory.array("error_weights", N_STAGES)[:] = tableau.ERROR
    memory.array("implicit_stages", 6 * N_STAGES)[:] = np.ravel(implicit_tableau.STAGES)
    memory.array("implicit_predictor", 6 * N_STAGES)[:] = np.ravel(implicit_tableau.PREDICTOR)
    memory.array("implicit_errors", N_STAGES)[:] = implicit_tableau.ERROR
    memory.array("implicit_bend", N_STAGES)[:] = implicit_tableau.BEND
    memory.array("dense", 4 * N_STAGES)[:] = np.ravel(tableau.DENSE)
    return memory


@functools.lru_cache(maxsize=16)
def _laid(
    counts: tuple[tuple[str, int], ...], layers: frozenset[str], own: Arrays
) -> tuple[tuple[float, ...], tuple[int, int]]:
    """Return the numbers of the record, and the lengths of the heaps of floats and of integers.

    Kept, as systems that differ in their numbers only are laid out alike, and often one after another.
    """
    every = *ARRAYS_OF.values(), own
    laid = [*(ARRAYS_OF[layer] for layer in {*ALWAYS, *layers}), own]
    known = dict(counts)
    values = {name: begin for arrays in every for name, begin in arrays.scalars.items()} | known
    totals: list[int] = []
    for arrays_of in (floats_of, integers_of):
        total, with_length = 0, arrays_of(laid)
        for name in arrays_of(every):
            values[name] = total
            total += with_length[name](known) if name in with_length else 0
        totals.append(total)
    return tuple(values[name] for name in record_with(own).names or ()), (totals[0], totals[1])
