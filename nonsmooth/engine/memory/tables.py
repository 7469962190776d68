"""Layout of the workspace: all scalars in one record, all floats in one array, all integers in another.

The record has an entry for each scalar of a :class:`~nonsmooth.engine.memory.declare.Singleton`, and for the offset of
each declared array among the floats or integers. Entries are named by owner and field: ``"island.time"``,
``"contacts.gap"``. The entries of parts that an engine declares itself come last.

The size of an array is a function of the counts of a system. Another number of bodies or contacts changes the offsets,
and needs no new compilation. The order of the arrays is:

1. arrays that outlive a step, so that a checkpoint copies one piece of the floats and one of the integers;
2. arrays that each step writes anew;
3. late arrays, which most runs leave unused, and which cost no memory before they are written.

Arrays that grow with the number of slots for active contacts come apart, in the same order. All others stay where they
are if the number of slots changes.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterable, Mapping
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.declare import Declaration, Singleton, declarations
from nonsmooth.engine.memory.owners.model import ModelNumbers
from nonsmooth.engine.memory.sizes import Counts, Size
from nonsmooth.engine.memory.workspace import PARTS, RECORDS

COUNTS = tuple(name for name, one in declarations(ModelNumbers).items() if one.kind is int and one.size is None)
"""Counts that size the arrays, and the other integers of a model."""
SLOT_COUNTS = "n_slots", "n_pivoted", "event_floats", "event_integers"
"""Counts that follow from the number of slots for active contacts."""
_ONE_OF_EACH: Counts = dict.fromkeys(COUNTS, 1)
"""Counts of a system with one of each."""
_WITHOUT_SLOTS: Counts = {**_ONE_OF_EACH, **dict.fromkeys(SLOT_COUNTS, 0)}
"""Counts of the same system without slots for active contacts."""


def in_order(counts: Counts) -> tuple[tuple[str, int], ...]:
    """All counts by name, in the order of ``COUNTS``, so that a cache finds equal counts."""
    return tuple((name, counts[name]) for name in COUNTS)


def has_array(declared: Declaration) -> bool:
    """True if a declaration has an array of its own. False for a scalar, and for a view of another storage."""
    return not declared.inside[0] and not declared.is_scalar


def length_of(declared: Declaration, counts: Counts) -> int:
    """Number of entries of the array of a declaration, in a system of the given counts."""
    # only arrays of parts have a size of their own
    if declared.size is not None:
        return declared.size(counts)
    # as many numbers for each record; starts of ranges have one entry more, the end of the last range
    return int(declared.numbers * declared.owner.capacity(counts) + declared.has_end)


def _all(owners: Iterable[type]) -> list[Declaration]:
    return [declared for owner in owners for declared in declarations(owner).values()]


def arrays_of(owners: Iterable[type], of_floats: bool) -> dict[str, Size]:
    """Size of each array of some owners, of floats if ``of_floats``, else of integers.

    Keys are as "contacts.gap". The order is that of the offsets (:class:`Group`).
    """
    return {one.key: functools.partial(length_of, one) for one in _arrays(tuple(owners), of_floats)}


@functools.cache
def _arrays(owners: tuple[type, ...], of_floats: bool) -> tuple[Declaration, ...]:
    """Arrays that ``owners`` declare, by offset: those of floats if ``of_floats``, else those of integers."""
    return tuple(sorted((one for one in _all(owners) if has_array(one) and one.is_float == of_floats), key=group_of))


class Group(IntEnum):
    """Groups of arrays, in the order of their offsets."""

    KEPT = 0
    """A later step reads it."""
    SHORT = 1
    """Every step writes it anew."""
    LATE = 2
    """Most runs never write it, so that it takes no memory (``Declaration.is_late``)."""
    SLOTS_KEPT = 3
    """As ``KEPT``; its length depends on the number of slots."""
    SLOTS_SHORT = 4
    """As ``SHORT``; its length depends on the number of slots."""
    SLOTS_LATE = 5
    """As ``LATE``; its length depends on the number of slots."""


@functools.cache
def group_of(declared: Declaration) -> Group:
    """Group of an array."""
    group = Group.LATE if declared.is_late else Group.KEPT if declared.outlives_a_step else Group.SHORT
    # a length is known as a function of the counts only: does it change without any slot?
    depends = length_of(declared, _ONE_OF_EACH) != length_of(declared, _WITHOUT_SLOTS)
    return Group(group + Group.SLOTS_KEPT) if depends else group


@functools.cache
def slot_arrays(owners: tuple[type, ...]) -> list[Declaration]:
    """Arrays of some owners whose length depends on the number of slots."""
    return [one for one in _all(owners) if has_array(one) and group_of(one) >= Group.SLOTS_KEPT]


def ends_of(owners: Iterable[type], of_floats: bool, counts: Counts) -> tuple[int, ...]:
    """Where each :class:`Group` of arrays ends, of floats if ``of_floats``, else of integers, one behind the other.

    ``counts`` are the numbers of bodies, contacts and so on, on which the sizes depend.
    """
    # cached, because systems that differ in their parameters only have the same lengths, and often follow each other
    return _ends_of(tuple(owners), of_floats, in_order(counts))


@functools.lru_cache(maxsize=16)
def _ends_of(owners: tuple[type, ...], of_floats: bool, counts: tuple[tuple[str, int], ...]) -> tuple[int, ...]:
    """:func:`ends_of` with arguments that a cache can hold."""
    lengths, known = [0] * len(Group), dict(counts)
    for one in _arrays(owners, of_floats):
        lengths[group_of(one)] += length_of(one, known)
    return tuple(itertools.accumulate(lengths))


def scalars_of(owners: Iterable[type]) -> dict[str, float]:
    """Value of each scalar of some owners before any run, by key."""
    return {one.key: one.begin for one in _all(owners) if one.is_scalar}


def _entries(owners: Iterable[type]) -> list[tuple[str, str]]:
    """Entries of the record of scalars: names and types of the scalars of some owners, and offsets of their arrays.

    All have 8 bytes. Integers, booleans and enumerations are stored as i8; the value before any run shows which it is.
    """
    numbers = [(name, "f8" if isinstance(begin, float) else "i8") for name, begin in scalars_of(owners).items()]
    offsets = [*arrays_of(owners, of_floats=True), *arrays_of(owners, of_floats=False)]
    return numbers + [(name, "i8") for name in offsets]


OWNERS: tuple[type, ...] = (*PARTS.values(), *RECORDS.values())
"""All classes that declare fields of the workspace; an engine may add its own."""
FLOAT_ARRAYS: Mapping[str, Size] = arrays_of(OWNERS, of_floats=True)
INTEGER_ARRAYS: Mapping[str, Size] = arrays_of(OWNERS, of_floats=False)
FIRST_SLOT_FLOATS, FIRST_SLOT_INTEGERS = (
    next(one.key for one in sorted(slot_arrays(OWNERS), key=group_of) if one.is_float == of_floats)
    for of_floats in (True, False)
)
"""Keys of the first of the arrays that grow with the number of slots, of floats and of integers."""
SCALARS = np.dtype(_entries(OWNERS), align=True)
"""Type of the record of scalars, which also holds the offsets of arrays."""
N_SCALARS = len(SCALARS.names or ())
"""Number of entries of the record of scalars."""
CONSTANT_SCALARS = frozenset((*(f"{ModelNumbers.key}.{name}" for name in COUNTS), *FLOAT_ARRAYS, *INTEGER_ARRAYS))
"""Scalars that never change after the allocation of the workspace: counts and offsets."""


def kept_scalars(own: Iterable[type[Singleton]]) -> NDArray[np.bool_]:
    """For each entry of the record of scalars, with the parts ``own`` of an engine, True if it outlives a step."""
    kept = {one.key for one in _all((*OWNERS, *own)) if one.outlives_a_step and one.is_scalar}
    return np.array([name in kept for name in record_with(own).names or ()])


@functools.cache
def variable_scalars(own: tuple[type[Singleton], ...]) -> NDArray[np.bool_]:
    """For each entry of the record of scalars, with the parts ``own`` of an engine, False for a count or an offset."""
    fixed = {
        *(f"{ModelNumbers.key}.{name}" for name in COUNTS),
        *(one.key for one in _all((*OWNERS, *own)) if has_array(one)),
    }
    return np.array([name not in fixed for name in record_with(own).names or ()])


def record_with(own: Iterable[type[Singleton]]) -> np.dtype[np.void]:
    """Type of the record of scalars of an engine that adds the parts ``own``, whose scalars come last."""
    return _record_with(tuple(own))


@functools.cache
def _record_with(own: tuple[type[Singleton], ...]) -> np.dtype[np.void]:
    """:func:`record_with`, cached by a tuple, because each run needs it."""
    # without parts of the engine, the common type itself
    entries = _entries(own)
    return np.dtype([*SCALARS.descr, *entries], align=True) if entries else SCALARS


def places(*names: str) -> NDArray[np.int64]:
    """Positions of the scalars with these keys, such as "island.time", in ``Memory.cells``.

    A cell is one scalar of the record, all of which have 8 bytes.
    """
    known = SCALARS.names or ()
    return np.array([known.index(name) for name in names])


def stride_of(storage: Declaration) -> int:
    """Number of entries from one record to the next in a storage.

    The storage is an array of the records, or an array of a part with as many numbers for each active contact.
    """
    if storage.size is None:
        return storage.numbers
    # the size is known as a function of the counts only: the stride is its increase by one active contact
    none: Counts = dict.fromkeys(COUNTS, 0)
    return storage.size({**none, "n_slots": 1}) - storage.size(none)


def storage_of(declared: Declaration) -> Declaration:
    """The declaration that owns the storage of a declaration: itself, unless it is a view of another one."""
    return declared if not declared.inside[0] else _STORAGE[declared.key]


_STORAGE = {one.key: one for one in _all(OWNERS) if not one.inside[0]}
