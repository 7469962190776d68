"""The workspace of one trajectory in Python: views by declaration, and the blocks behind the arrays of the table."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from nonsmooth.engine.memory import implicit_tableau, tableau
from nonsmooth.engine.memory.blocks import PAIR, UNTOUCHED
from nonsmooth.engine.memory.declare import Declaration, Singleton, declarations
from nonsmooth.engine.memory.layout import BOOKED, JACOBIANS
from nonsmooth.engine.memory.owners.contact import ContactRecord, HistoryRecord
from nonsmooth.engine.memory.owners.island import Island
from nonsmooth.engine.memory.owners.model import Coefficients, ModelNumbers
from nonsmooth.engine.memory.owners.run import OutputNumbers
from nonsmooth.engine.memory.sizes import Counts
from nonsmooth.engine.memory.tables import (
    COUNTS,
    FIRST_SLOT_FLOATS,
    FIRST_SLOT_INTEGERS,
    OWNERS,
    SLOT_COUNTS,
    Group,
    arrays_of,
    ends_of,
    group_of,
    has_array,
    in_order,
    kept_scalars,
    length_of,
    record_with,
    scalars_of,
    slot_arrays,
    storage_of,
    stride_of,
)

FIXED_PARTS = 4
"""Number of the parts of ``Memory.kept`` that do not depend on the number of slots; they come first."""


def counts_in(record: np.void) -> Counts:
    """The counts that size the arrays of a workspace (bodies, contacts, ...), from its record of scalars."""
    return {name: record[f"{ModelNumbers.key}.{name}"].item() for name in COUNTS}


def view_of(declared: Declaration, record: np.void, counts: Counts, numbers: np.ndarray, first: int = 0) -> np.ndarray:
    """View of the numbers of a declaration in ``numbers``, the floats or the integers of a workspace from ``first`` on.

    A part has one array of numbers. Of records, the first axis is the record; the second is the number within the
    declaration, if it has several. ``record`` are the scalars, which hold the offset of each array.
    """
    # the declaration may be a view of the storage of another one
    storage, start = storage_of(declared), int(record[declared.key]) - first
    numbers = numbers[start : start + length_of(storage, counts)]
    if issubclass(declared.owner, Singleton):
        return numbers
    # entries from one record to the next, position of the declaration in a record, and number of records
    stride, place, n = stride_of(storage), declared.inside[1], declared.owner.capacity(counts)
    if declared.numbers == 1:
        # starts of ranges have one entry more, the end of the last range
        return numbers[place::stride][: n + declared.has_end]
    return numbers[: stride * n].reshape(n, stride)[:, place : place + declared.numbers]


@dataclass(eq=False)
class Memory:
    """All numbers of one trajectory.

    Attributes
    ----------
    scalars : numpy.ndarray
        The record of scalars, shape [1].
    floats : numpy.ndarray
        The arrays of floats, late ones last, then blocks, the arrays that grow with the number of slots, and tables.
    integers : numpy.ndarray
        The arrays of integers, last those that grow with the number of slots.
    blocks, slots : int
        Offsets in ``floats`` of the blocks that the assembly appended, and of the arrays behind them.
    references : array
        For every table that a function reads: the offset of a number that is the distance to the table, the offset from
        which the distance counts, and that of the table behind the first table; shape [n, 3].
    written : array
        For each number of the blocks, True if the engine or a plug-in writes it, False for a parameter.
    own : tuple of type
        Parts that the engine adds to the workspace.
    foreign_tables : array or None
        The tables that it reads in another memory, if it has none itself.
    """

    scalars: np.ndarray
    floats: np.ndarray
    integers: np.ndarray
    blocks: int
    slots: int
    references: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), int))
    written: np.ndarray = field(default_factory=lambda: np.zeros(0, bool))
    own: tuple[type[Singleton], ...] = ()
    foreign_tables: np.ndarray | None = None

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
            self._views[declared] = view_of(declared, self.record, self.counts, numbers)
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
    def counts(self) -> Counts:
        """The counts that size its arrays."""
        return counts_in(self.record)

    @functools.cached_property
    def addresses(self) -> tuple[int, int, int]:
        """Addresses of scalars, floats and integers, for calls of the engine."""
        return self.scalars.ctypes.data, self.floats.ctypes.data, self.integers.ctypes.data

    @functools.cached_property
    def kept(self) -> tuple[np.ndarray, ...]:
        """All numbers that a step may read from earlier steps: scalars, arrays that outlive a step, and blocks.

        Views as integers with the same bits, so that they can be compared: NaN differs from itself. They are scalars,
        floats, integers, blocks, and the floats and the integers that grow with the number of slots.
        """
        floats, integers = self._ends
        last = self.slots + floats[Group.SLOTS_KEPT] - floats[Group.LATE]
        parts = (
            self.scalars,
            self.floats[: floats[Group.KEPT]],
            self.integers[: integers[Group.KEPT]],
            self.floats[self.blocks : self.slots],
            self.floats[self.slots : last],
            self.integers[integers[Group.LATE] : integers[Group.SLOTS_KEPT]],
        )
        return tuple(part.view(np.int64) for part in parts)

    @functools.cached_property
    def changing(self) -> tuple[np.ndarray, ...]:
        """For each number of :attr:`kept`, True if a run may change it.

        Scalars and blocks also hold parameters; arrays that outlive a step hold none.
        """
        _, floats, integers, _, *of_slots = self.kept
        every = (np.ones(len(part), bool) for part in (floats, integers, *of_slots))
        return kept_scalars(self.own), next(every), next(every), self.written, *every

    @functools.cached_property
    def tables(self) -> int:
        """Offset in ``floats`` of the tables, which are last."""
        floats, _ = self._ends
        # one float more: the offset of an empty block at the end is inside of the array, too
        return self.slots + floats[Group.SLOTS_LATE] - floats[Group.LATE] + 1

    @property
    def table_numbers(self) -> np.ndarray:
        """The tables: its own, or those that it reads in another memory."""
        return self.floats[self.tables :] if self.foreign_tables is None else self.foreign_tables

    @functools.cached_property
    def _ends(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """For floats, then for integers: where each group of arrays ends, one behind the other."""
        owners = self._owners
        return ends_of(owners, True, self.counts), ends_of(owners, False, self.counts)

    @property
    def _owners(self) -> tuple[type, ...]:
        """All classes that declare fields of this workspace."""
        return (*OWNERS, *self.own)

    def resize(self, counts: Counts) -> None:
        """Change the number of slots for active contacts, and what follows from it, in place.

        What outlives a step stays, as far as there is space for it. ``counts`` are all counts; only ``SLOT_COUNTS`` may
        differ. Earlier views of floats and integers show the former content.
        """
        old = replace(self, scalars=self.scalars.copy())
        tables = self.table_numbers if self.foreign_tables is None else np.zeros(0)
        self.fill(old, counts, self.floats[self.blocks : self.slots], tables)

    def copied(self, shares_tables: bool) -> Memory:
        """Memory with the same content. With ``shares_tables`` it reads the tables of this one, else it copies them."""
        tables = self.table_numbers
        made = replace(self, scalars=self.scalars.copy(), foreign_tables=tables if shares_tables else None)
        own_tables = tables[: 0 if shares_tables else len(tables)]
        made.fill(self, self.counts, self.floats[self.blocks : self.slots], own_tables)
        return made

    def fill(self, old: Memory, counts: Counts, blocks: np.ndarray, tables: np.ndarray) -> None:
        """Make new floats and integers, with the content of another memory of the same system.

        Late arrays are left out, except records that Python has not read yet. Of slots for active contacts, a memory
        with another number of them leaves out what no later step reads, except histories.

        Parameters
        ----------
        old : Memory
            The memory. It may have other ``counts``, and its blocks may be missing.
        counts : mapping
            All counts.
        blocks, tables : array
            The blocks, and the tables that the new floats are to hold.
        """
        self._write_layout(counts)
        float_ends, integer_ends = self._ends
        self.floats, self.integers = np.zeros(self.tables + len(tables)), np.zeros(max(integer_ends[-1], 1), np.int64)
        self.floats[: float_ends[Group.SHORT]] = old.floats[: float_ends[Group.SHORT]]
        self.integers[: integer_ends[Group.SHORT]] = old.integers[: integer_ends[Group.SHORT]]
        self.floats[self.blocks : self.slots], self.floats[self.tables :] = blocks, tables
        last = Group.SLOTS_SHORT if counts["n_slots"] == old.counts["n_slots"] else Group.SLOTS_KEPT
        lengths: dict[Any, int] = {
            one: length_of(one, old.counts) for one in slot_arrays(self._owners) if group_of(one) <= last
        }
        histories = filter(has_array, declarations(HistoryRecord).values())
        lengths |= {one: one.numbers * old[Island.n_histories] for one in histories}
        samples = old[OutputNumbers.n_samples] * (1 + old[ModelNumbers.n_y] + BOOKED)
        lengths |= {
            OutputNumbers.samples: samples,
            OutputNumbers.event_numbers: old[OutputNumbers.floats_used],
            OutputNumbers.event_codes: old[OutputNumbers.integers_used],
        }
        for one, length in lengths.items():
            source, target = (memory.floats if one.is_float else memory.integers for memory in (old, self))
            first, second, n = old.start(one), self.start(one), min(length, length_of(one, counts))
            target[second : second + n] = source[first : first + n]
        self._write_slots(old.counts["n_slots"])
        self.refer_to_tables()

    def refer_to_tables(self) -> None:
        """Write the numbers by which functions find their tables: the distances [floats] from their parameters.

        They differ in memories with different numbers of slots, or with tables in another memory.
        """
        distance = (self.table_numbers.ctypes.data - self.floats.ctypes.data) // self.floats.itemsize
        places, starts, tables = self.references.T
        self.floats[places] = distance + tables - starts

    def _write_layout(self, counts: Counts) -> None:
        """Write the counts that follow from the number of slots, and the offsets of the arrays with such lengths."""
        names = self.record.dtype.names or ()
        laid = dict(zip(names, _laid(in_order(counts), self.own)[0], strict=True))
        for name in SLOT_COUNTS:
            self.record[f"{ModelNumbers.key}.{name}"] = counts[name]
        for name in _CACHED:
            self.__dict__.pop(name, None)
        # the layout is that of a memory without blocks
        moved = self.slots - self._ends[0][Group.LATE]
        for one in slot_arrays(self._owners):
            self.record[one.key] = laid[one.key] + (moved if one.is_float else 0)

    def _write_slots(self, n_kept: int) -> None:
        """Write what each slot for an active contact has from the start; the first ``n_kept`` have it already."""
        # guards behind the block that the kinematics of a contact writes: they change if it writes too many numbers
        self[ContactRecord.geometry][n_kept:, PAIR:] = UNTOUCHED
        size = 3 * self[ModelNumbers.most_velocities]
        firsts = self.start(Island.jacobians) + JACOBIANS * size * np.arange(self[ModelNumbers.n_slots])
        for i, place in enumerate(_JACOBIANS):
            self[place] = firsts + i * size

    def put_slots(self, scalars: np.ndarray, floats: np.ndarray, integers: np.ndarray) -> None:
        """Write the slots for active contacts of a checkpoint, which may have fewer of them; the others are reset.

        ``scalars``, ``floats`` and ``integers`` are parts of a checkpoint (:attr:`kept`).
        """
        self.clear_slots()
        record = scalars.view(record_with(self.own))[0]
        counts = counts_in(record)
        for one in slot_arrays(self._owners):
            if group_of(one) is Group.SLOTS_KEPT:
                key, source = (FIRST_SLOT_FLOATS, floats) if one.is_float else (FIRST_SLOT_INTEGERS, integers)
                target, n = self.kept[FIXED_PARTS + (not one.is_float)], length_of(one, counts)
                here, there = (int(scalar[one.key] - scalar[key]) for scalar in (self.record, record))
                target[here : here + n] = source[there : there + n]

    def clear_slots(self) -> None:
        """Reset all slots for active contacts to their content before any run."""
        for part in self.kept[FIXED_PARTS:]:
            part[:] = 0
        self._write_slots(0)


_CACHED = "_views", "counts", "addresses", "kept", "changing", "tables", "_ends"
"""Properties of a memory that change with the number of slots."""
_JACOBIANS = ContactRecord.jacobian_a, ContactRecord.jacobian_b, ContactRecord.response_a, ContactRecord.response_b


def allocate(counts: Mapping[str, int], own: tuple[type[Singleton], ...] = ()) -> Memory:
    """Workspace with all arrays for the given counts, all of ``COUNTS``. :class:`Heap` appends the blocks.

    ``own`` are the parts that an engine adds. All numbers have their values before any run, and the coefficients of the
    Runge-Kutta pairs are written.
    """
    values, (n_floats, n_integers) = _laid(in_order(counts), own)
    scalars = np.array([values], record_with(own))
    # an array without entries has no address; the floats always have those of the Runge-Kutta pairs
    floats, integers = np.zeros(n_floats + 1), np.zeros(max(n_integers, 1), np.int64)
    # the blocks, still empty, are behind the arrays that do not depend on the number of slots
    slots = ends_of((*OWNERS, *own), True, counts)[Group.LATE]
    memory = Memory(scalars, floats, integers, blocks=slots, slots=slots, own=own)
    memory._write_slots(0)
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
