"""The workspace of one trajectory in Python: views by declaration, and the blocks behind the arrays of the table."""

from __future__ import annotations

import functools
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from nonsmooth.engine.memory import implicit_tableau, tableau
from nonsmooth.engine.memory.blocks import GUARD, PAIR, UNTOUCHED
from nonsmooth.engine.memory.declare import Declaration, Singleton
from nonsmooth.engine.memory.owners.contact import ContactRecord
from nonsmooth.engine.memory.owners.model import Coefficients, ModelNumbers
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
from nonsmooth.parameters import SharedNumbers


class Heap:
    """The blocks behind the arrays of the table, while a model is assembled: output blocks, Jacobians, parameters.

    Their total length is known only at the end, so that they are collected here and copied by :meth:`close`.
    """

    def __init__(self, memory: Memory) -> None:
        """Begin to collect the blocks that :meth:`close` appends to the floats of ``memory``.

        :func:`allocate` made ``memory``, with all arrays whose size follows from counts.
        """
        self._memory = memory
        # offset of the first block among all floats
        self._first = len(memory.floats)
        self._values = array("d")
        # ranges that change in a run: their offsets from the first block, and the length of each of them
        self._written: list[tuple[np.ndarray, int]] = []
        # numbers by which a function finds a table of shared parameters, such as those of a mesh: offset of the number
        # among all floats, the offset that is subtracted from that of the table, and the table
        self._references: list[tuple[int, int, SharedNumbers]] = []

    def block(self, size: int) -> int:
        """Append ``size`` zeros, for numbers that the engine writes. Result: their offset among all floats."""
        start = self._first + len(self._values)
        # bytes of zeros are the float 0.0
        self._values.frombytes(bytes(self._values.itemsize * size))
        self.write(start, size)
        return start

    def write(self, starts: int | np.ndarray, size: int) -> None:
        """Mark ``size`` numbers from each of the offsets ``starts``: the engine or a plug-in writes them in a run."""
        # all other numbers of the blocks are parameters, the same in every run
        self._written.append((np.atleast_1d(starts) - self._first, size))

    def store(self, values: Sequence[float] | np.ndarray) -> int:
        """Append parameters. Result: their offset among all floats."""
        start = self._first + len(self._values)
        self._values.extend(values)
        return start

    def repeat(self, values: Sequence[float], times: int) -> int:
        """Append the same parameters ``times`` times. Result: the offset of the first among all floats."""
        start = self._first + len(self._values)
        self._values.extend(times * array("d", values))
        return start

    def refer(self, place: int, start: int, table: SharedNumbers) -> None:
        """Let :meth:`close` set the number at offset ``place`` to the distance [floats] of a table from ``start``."""
        # at start begin the parameters of the function that reads the table. It gets only their address, so the table
        # must be found from there. Before close no table has an offset
        self._references.append((place, start, table))

    def output(self, size: int) -> int:
        """Append ``size`` numbers that a plug-in writes, then guards, which show if it wrote too many.

        The result is their offset among all floats.
        """
        start = self.store(output_block(size))
        self.write(start, size)
        return start

    def close(self) -> Memory:
        """A new memory with the content of the old one: its arrays, behind them all blocks, then the tables.

        A table that many contacts refer to is there once. Views of the old memory do not show the new one.
        """
        old, tables = self._memory, {id(table): table for _, _, table in self._references}
        first_table, offsets = self._first + len(self._values), dict[int, int]()
        end = first_table
        for key, table in tables.items():
            offsets[key] = end
            end += len(table)
        # one float more: the offset of an empty block at the end is inside of the array, too
        floats = np.zeros(end + 1)
        # late arrays hold zeros; they are not written, so that the system gives them no memory yet
        arrays = old.early[0]
        floats[: len(arrays)] = arrays
        floats[self._first : first_table] = self._values
        written = np.zeros(len(self._values), bool)
        for starts, size in self._written:
            written[starts[:, None] + np.arange(size)] = True
        for key, table in tables.items():
            floats[offsets[key] : offsets[key] + len(table)] = table.numbers
        references = tuple((place, start, offsets[id(table)]) for place, start, table in self._references)
        for place, start, offset in references:
            floats[place] = offset - start
        return replace(old, floats=floats, tables=first_table, references=references, written=written)


def output_block(size: int) -> list[float]:
    """Content of a block before a plug-in writes it: ``size`` zeros, then guards."""
    # a guard has a value that no plug-in writes by chance; if it changes, the plug-in wrote too many numbers
    return size * [0.0] + GUARD * [UNTOUCHED]


def counts_in(record: np.void) -> Counts:
    """The counts that size the arrays of a workspace (bodies, contacts, ...), from its record of scalars."""
    return {name: record[f"{ModelNumbers.key}.{name}"].item() for name in COUNTS}


def view_of(declared: Declaration, record: np.void, counts: Counts, numbers: np.ndarray) -> np.ndarray:
    """View of the numbers of a declaration in ``numbers``, all floats or all integers of a workspace.

    A part has one array of numbers. Of records, the first axis is the record; the second is the number within the
    declaration, if it has several. ``record`` are the scalars, which hold the offset of each array.
    """
    # the declaration may be a view of the storage of another one
    storage, start = storage_of(declared), int(record[declared.key])
    numbers = numbers[start : start + length_of(storage, counts)]
    if issubclass(declared.owner, Singleton):
        return numbers
    # entries from one record to the next, position of the declaration in a record, and number of records
    stride, first, n = stride_of(storage), declared.inside[1], declared.owner.capacity(counts)
    if declared.numbers == 1:
        # starts of ranges have one entry more, the end of the last range
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
        Offsets in ``floats`` of the blocks that the assembly appended, and of the tables behind them.
    references : tuple
        For every table that a function reads: the offset of a number that is the distance to the table, the offset from
        which the distance counts, and that of the table.
    written : array
        For each number of the blocks, True if the engine or a plug-in writes it, False for a parameter.
    own : tuple of type
        Parts that the engine adds to the workspace.
    owner : Memory or None
        The memory whose tables it reads, if it has none itself.
    """

    scalars: np.ndarray
    floats: np.ndarray
    integers: np.ndarray
    blocks: int
    tables: int
    references: tuple[tuple[int, int, int], ...] = ()
    written: np.ndarray = field(default_factory=lambda: np.zeros(0, bool))
    own: tuple[type[Singleton], ...] = ()
    owner: Memory | None = None

    def __getitem__(self, declared: Any) -> Any:
        """A scalar, or a view of an array: ``memory[Island.time]``, ``memory[ContactRecord.gap]``.

        The first axis of a view of records counts the records. A second axis counts the numbers of each record, if it
        has several.
        """
        return self.record[declared.key].item() if declared.is_scalar else self._view(declared)

    def __setitem__(self, declared: Any, value: Any) -> None:
        """Set a scalar, or all numbers of an array."""
        if declared.is_scalar:
            self.record[declared.key] = value
        else:
            self._view(declared)[...] = value

    def start(self, declared: Any) -> int:
        """Offset of an array among all floats or integers."""
        return int(self.record[declared.key])

    def _view(self, declared: Declaration) -> np.ndarray:
        """View of an array. It is made once and kept, because that takes longer than reading it."""
        if declared not in self._views:
            numbers = self.floats if declared.is_float else self.integers
            self._views[declared] = view_of(declared, self.record, self._counts, numbers)
        return self._views[declared]

    @functools.cached_property
    def _views(self) -> dict[Declaration, np.ndarray]:
        return {}

    @functools.cached_property
    def record(self) -> np.void:
        """The record of scalars. One number is read and set fastest through this view."""
        return cast(np.void, self.scalars[0])

    @functools.cached_property
    def cells(self) -> tuple[np.ndarray, np.ndarray]:
        """Views of all scalars as floats and as integers, by position (:func:`nonsmooth.engine.memory.tables.places`).

        Short runs read and set numbers through them, in a fifth of the time that a name takes.
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
        """All numbers that a step may read from earlier steps: scalars, arrays that outlive a step, and blocks.

        Views as integers with the same bits, so that they can be compared: NaN differs from itself.
        """
        # arrays that outlive a step come first among the floats and among the integers; blocks end where tables begin
        (floats, *_), (integers, *_) = self._lengths
        parts = self.scalars, self.floats[:floats], self.integers[:integers], self.floats[self.blocks : self.tables]
        return tuple(part.view(np.int64) for part in parts)

    @functools.cached_property
    def changing(self) -> tuple[np.ndarray, ...]:
        """For each number of :attr:`kept`, True if a run may change it.

        Scalars and blocks also hold parameters; arrays that outlive a step hold none.
        """
        _, floats, integers, _ = self.kept
        return kept_scalars(self.own), np.ones(len(floats), bool), np.ones(len(integers), bool), self.written

    @functools.cached_property
    def early(self) -> tuple[np.ndarray, ...]:
        """Views of floats, integers and blocks, without late arrays, which most runs leave unused, and tables."""
        # late arrays come last; the second length is without them
        (_, floats, _), (_, integers, _) = self._lengths
        return self.floats[:floats], self.integers[:integers], self.floats[self.blocks : self.tables]

    @functools.cached_property
    def _lengths(self) -> tuple[tuple[int, int, int], ...]:
        """For floats, then for integers: total entries of arrays that outlive a step, of all but late ones, of all."""
        return tuple(lengths_of((*OWNERS, *self.own), of_floats, self._counts) for of_floats in (True, False))


def allocate(counts: Mapping[str, int], own: tuple[type[Singleton], ...] = ()) -> Memory:
    """Workspace with all arrays for the given counts, all of ``COUNTS``. :class:`Heap` appends the blocks.

    ``own`` are the parts that an engine adds. All numbers have their values before any run, and the coefficients of the
    Runge-Kutta pairs are written.
    """
    values, (n_floats, n_integers) = _laid(tuple(counts.items()), own)
    scalars = np.array([values], record_with(own))
    # an array without entries has no address; the floats always have those of the Runge-Kutta pairs
    floats, integers = np.zeros(n_floats), np.zeros(max(n_integers, 1), np.int64)
    # blocks and tables, still empty, begin behind the arrays
    memory = Memory(scalars, floats, integers, blocks=n_floats, tables=n_floats, own=own)
    # guards behind the block that the kinematics of a contact writes: they change if it writes too many numbers
    memory[ContactRecord.geometry][:, PAIR:] = UNTOUCHED
    memory[Coefficients.nodes] = tableau.NODES
    memory[Coefficients.stages] = np.ravel(tableau.STAGES)
    memory[Coefficients.error_weights] = tableau.ERROR
    memory[Coefficients.implicit_nodes] = implicit_tableau.NODES
    memory[Coefficients.implicit_stages] = np.ravel(implicit_tableau.STAGES)
    memory[Coefficients.implicit_predictor] = np.ravel(implicit_tableau.PREDICTOR)
    memory[Coefficients.implicit_errors] = implicit_tableau.ERROR
    memory[Coefficients.implicit_bend] = implicit_tableau.BEND
    memory[Coefficients.dense] = np.ravel(tableau.DENSE)
    return memory


@functools.lru_cache(maxsize=16)
def _laid(
    counts: tuple[tuple[str, int], ...], own: tuple[type[Singleton], ...]
) -> tuple[tuple[float, ...], tuple[int, int]]:
    """Values of the record of scalars before any run, and the numbers of floats and of integers.

    The record has the scalars, among them the counts, and the offset of each array. The result is cached, because
    systems that differ in their parameters only have the same one, and often follow each other.
    """
    owners, known = (*OWNERS, *own), dict(counts)
    values = {**scalars_of(owners), **{f"{ModelNumbers.key}.{name}": number for name, number in counts}}
    totals: list[int] = []
    # all floats are one array, all integers another: offsets begin at 0 in each
    for of_floats in (True, False):
        total = 0
        for name, size in arrays_of(owners, of_floats).items():
            values[name] = total
            total += size(known)
        totals.append(total)
    return tuple(values[name] for name in record_with(own).names or ()), (totals[0], totals[1])
