"""The workspace of one trajectory in Python: views by declaration, and blocks behind the arrays of the table."""

from __future__ import annotations

import functools
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from nonsmooth.engine.memory import implicit_tableau, tableau
from nonsmooth.engine.memory.blocks import GUARD, PAIR, UNTOUCHED
from nonsmooth.engine.memory.declare import Declaration, Part
from nonsmooth.engine.memory.owners.contact import Contact, DeclaredContact
from nonsmooth.engine.memory.owners.model import Coefficients, Model
from nonsmooth.engine.memory.sizes import Counts
from nonsmooth.engine.memory.tables import (
    COUNTS,
    OWNERS,
    arrays_of,
    kept_scalars,
    length_of,
    lengths_of,
    record_with,
    scalars_of,
    storage_of,
    stride_of,
)
from nonsmooth.parameters import Table


class Heap:
    """The blocks that come behind the fixed arrays: output blocks, Jacobians, parameters."""

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._first = len(memory.floats)
        self._values = array("d")
        self._written: list[tuple[np.ndarray, int]] = []
        self._references: list[tuple[int, int, Table]] = []

    def block(self, size: int) -> int:
        """Reserve floats that the engine writes; return their offset."""
        start = self._first + len(self._values)
        self._values.frombytes(bytes(self._values.itemsize * size))
        self.write(start, size)
        return start

    def write(self, starts: int | np.ndarray, size: int) -> None:
        """Note that numbers of blocks are no parameters: the engine or a plug-in writes them."""
        self._written.append((np.atleast_1d(starts) - self._first, size))

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
        start = self.store(output_block(size))
        self.write(start, size)
        return start

    def close(self) -> Memory:
        """The memory with all blocks, and each table once behind them."""
        old, tables = self._memory, {id(table): table for _, _, table in self._references}
        first, places = self._first + len(self._values), dict[int, int]()
        end = first
        for key, table in tables.items():
            places[key] = end
            end += len(table)
        floats = np.zeros(end + 1)
        arrays = old.early[0]
        floats[: len(arrays)] = arrays
        floats[self._first : first] = self._values
        written = np.zeros(len(self._values), bool)
        for starts, size in self._written:
            written[starts[:, None] + np.arange(size)] = True
        for key, table in tables.items():
            floats[places[key] : places[key] + len(table)] = table.numbers
        references = tuple((place, start, places[id(table)]) for place, start, table in self._references)
        for place, start, at in references:
            floats[place] = at - start
        return replace(old, floats=floats, tables=first, references=references, written=written)


def output_block(size: int) -> list[float]:
    """Content of a block before a plug-in has written it, guards included."""
    return size * [0.0] + GUARD * [UNTOUCHED]


def counts_in(record: np.void) -> Counts:
    """Counts that a record of scalars was laid out for."""
    return {name: record[f"{Model.key}.{name}"].item() for name in COUNTS}


def view_of(declared: Declaration, record: np.void, counts: Counts, numbers: np.ndarray) -> np.ndarray:
    """View of the numbers of a declaration among all floats or integers. The record of scalars gives its place."""
    storage, start = storage_of(declared), int(record[declared.key])
    numbers = numbers[start : start + length_of(storage, counts)]
    if issubclass(declared.owner, Part):
        return numbers
    stride, first, n = stride_of(storage), declared.inside[1], declared.owner.capacity(counts)
    if declared.numbers == 1:
        # the end of a range is the start of the next one, in the row behind its own
        return numbers[first::stride][: n + declared.has_end]
    return numbers[: stride * n].reshape(n, stride)[:, first : first + declared.numbers]


@dataclass(frozen=True)
class Memory:
    """All numbers of one trajectory.

    Attributes
    ----------
    scalars : numpy.ndarray
        The record of scalars, shape [1].
    floats : numpy.ndarray
        The arrays of floats, late ones last, then blocks and tables.
    integers : numpy.ndarray
        The arrays of integers.
    blocks, tables : int
        Where in ``floats`` the blocks that the assembly appended begin, and the tables behind them.
    references : tuple
        (place of a number, the place from which that number counts, place of the table that it leads to), for every
        table that a function reads.
    written : array
        Of each number of the blocks whether the engine or a plug-in writes it: the others are parameters.
    own : tuple of type
        Parts of an engine that is no built-in one.
    owner : Memory or None
        Whose tables it reads, if it has none of its own.
    """

    scalars: np.ndarray
    floats: np.ndarray
    integers: np.ndarray
    blocks: int
    tables: int
    references: tuple[tuple[int, int, int], ...] = ()
    written: np.ndarray = field(default_factory=lambda: np.zeros(0, bool))
    own: tuple[type[Part], ...] = ()
    owner: Memory | None = None

    def __getitem__(self, declared: Any) -> Any:
        """A scalar, or a view of an array: ``memory[Island.time]``, ``memory[Contact.gap]``.

        The first axis of the numbers of a record is the record, the second one, if it has several, the number.
        """
        if declared.size is None and issubclass(declared.owner, Part):
            return self.record[declared.key].item()
        return self._view(declared)

    def __setitem__(self, declared: Any, value: Any) -> None:
        """Set a scalar, or all numbers of an array."""
        if declared.size is None and issubclass(declared.owner, Part):
            self.record[declared.key] = value
        else:
            self._view(declared)[...] = value

    def start(self, declared: Any) -> int:
        """Place of the first number of an array among all floats or integers."""
        return int(self.record[declared.key])

    def declared(self, declared: Any) -> np.ndarray:
        """View of a number of all declared contacts, active or not."""
        return self._view(getattr(DeclaredContact, declared.name))

    def _view(self, declared: Declaration) -> np.ndarray:
        if declared not in self._views:
            self._views[declared] = self._made_view(declared)
        return self._views[declared]

    def _made_view(self, declared: Declaration) -> np.ndarray:
        numbers = self.floats if storage_of(declared).is_float else self.integers
        return view_of(declared, self.record, self._counts, numbers)

    @functools.cached_property
    def _views(self) -> dict[Declaration, np.ndarray]:
        return {}

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
    def _counts(self) -> Counts:
        return counts_in(self.record)

    @functools.cached_property
    def addresses(self) -> tuple[int, int, int]:
        """Addresses of scalars, floats and integers, for calls of the engine."""
        return self.scalars.ctypes.data, self.floats.ctypes.data, self.integers.ctypes.data

    @functools.cached_property
    def kept(self) -> tuple[np.ndarray, ...]:
        """All scalars, the arrays that outlive a step, and the blocks: what a step may find of those before it.

        Views of integers with the bits of the numbers: a number that is not finite differs from itself.
        """
        (floats, *_), (integers, *_) = self._lengths
        parts = self.scalars, self.floats[:floats], self.integers[:integers], self.floats[self.blocks : self.tables]
        return tuple(part.view(np.int64) for part in parts)

    @functools.cached_property
    def changing(self) -> tuple[np.ndarray, ...]:
        """Of each number of :attr:`kept` whether a run may change it."""
        _, floats, integers, _ = self.kept
        return kept_scalars(self.own), np.ones(len(floats), bool), np.ones(len(integers), bool), self.written

    @functools.cached_property
    def early(self) -> tuple[np.ndarray, ...]:
        """Views of all arrays that are not late, and of the blocks."""
        (_, floats, _), (_, integers, _) = self._lengths
        return self.floats[:floats], self.integers[:integers], self.floats[self.blocks : self.tables]

    @functools.cached_property
    def _lengths(self) -> tuple[tuple[int, int, int], ...]:
        return tuple(lengths_of((*OWNERS, *self.own), of_floats, self._counts) for of_floats in (True, False))


def allocate(counts: Mapping[str, int], own: tuple[type[Part], ...] = ()) -> Memory:
    """Lay out all arrays for the given counts, all of ``COUNTS``.

    ``own`` are the parts of an engine that is no built-in one. Blocks are appended by :class:`Heap`.
    """
    values, totals = _laid(tuple(counts.items()), own)
    scalars = np.array([values], record_with(own))
    memory = Memory(scalars, np.zeros(totals[0]), np.zeros(max(totals[1], 1), np.int64), totals[0], totals[0], own=own)
    memory[Contact.geometry][:, PAIR:] = UNTOUCHED
    memory[Coefficients.stages] = np.ravel(tableau.STAGES)
    memory[Coefficients.error_weights] = tableau.ERROR
    memory[Coefficients.implicit_stages] = np.ravel(implicit_tableau.STAGES)
    memory[Coefficients.implicit_predictor] = np.ravel(implicit_tableau.PREDICTOR)
    memory[Coefficients.implicit_errors] = implicit_tableau.ERROR
    memory[Coefficients.implicit_bend] = implicit_tableau.BEND
    memory[Coefficients.dense] = np.ravel(tableau.DENSE)
    return memory


@functools.lru_cache(maxsize=16)
def _laid(
    counts: tuple[tuple[str, int], ...], own: tuple[type[Part], ...]
) -> tuple[tuple[float, ...], tuple[int, int]]:
    """Numbers of the record of scalars, and the lengths of floats and integers.

    Kept, as systems that differ in their numbers only are laid out alike, and often one after another.
    """
    owners, known = (*OWNERS, *own), dict(counts)
    values = {**scalars_of(owners), **{f"{Model.key}.{name}": number for name, number in counts}}
    totals: list[int] = []
    for of_floats in (True, False):
        total = 0
        for name, size in arrays_of(owners, of_floats).items():
            values[name] = total
            total += size(known)
        totals.append(total)
    return tuple(values[name] for name in record_with(own).names or ()), (totals[0], totals[1])
