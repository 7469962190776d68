"""Checkpoints: a copy of all numbers of a memory that a step may read from earlier steps.

These are the numbers that outlive a step by the field table, and the blocks that plug-ins write. Every other number is
written before it is read, so a run from a checkpoint gives the same bits. Parameters, sizes and addresses are left out,
so that a file cannot change them. An active contact, which is a declared contact on the neighbour list, has copies of
its parameters; they are copied again if a checkpoint changes the list.

The engine uses integers of a checkpoint as offsets and as codes without any check, so a wrong one from a file would
read outside of an array. The field table declares the range of each.
"""

from __future__ import annotations

import functools
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, cast, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Declaration, Singleton, declarations
from nonsmooth.engine.memory.memory import FIXED_PARTS, Memory, counts_in, view_of
from nonsmooth.engine.memory.sizes import Counts
from nonsmooth.engine.memory.tables import (
    FIRST_SLOT_FLOATS,
    FIRST_SLOT_INTEGERS,
    FLOAT_ARRAYS,
    N_SCALARS,
    OWNERS,
    SCALARS,
    Group,
    group_of,
    storage_of,
    variable_scalars,
)
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.errors import InvalidInput
from nonsmooth.types import Array

Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]
_REMEDY = "It is damaged, or of another model: take the state of a run of this model."
_CHECKED = tuple(
    one
    for owner in OWNERS
    for one in declarations(owner).values()
    if one.outlives_a_step and not one.inside[0] and (one.below is not None or one.kind not in (int, float))
)
"""Numbers that outlive a step and are offsets, codes or booleans."""


@final
@dataclass(frozen=True)
class Checkpoint:
    """Content of a memory between two steps.

    Attributes
    ----------
    parts : tuple of array
        Copies of :attr:`nonsmooth.engine.memory.memory.Memory.kept`, as integers of the same bits.
    """

    parts: tuple[Integers, ...]

    @classmethod
    def of(cls, memory: Memory) -> Checkpoint:
        """Copy all numbers of a memory that a step may read from earlier steps."""
        return cls(tuple([part.copy() for part in memory.kept]))

    @functools.cached_property
    def record(self) -> np.void:
        """Record of the scalars that all engines share, a view of the first part."""
        return cast(np.void, self.parts[0][:N_SCALARS].view(SCALARS)[0])

    @functools.cached_property
    def _counts(self) -> Counts:
        """Counts of bodies, contacts, ... in the record, which give the lengths of the arrays."""
        return counts_in(self.record)

    @property
    def n_slots(self) -> int:
        """Number of slots for active contacts in the memory."""
        return int(self[owners.ModelNumbers.n_slots])

    @functools.cached_property
    def size(self) -> int:
        """Size [bytes]."""
        return sum(part.nbytes for part in self.parts)

    @property
    def blocks(self) -> Array:
        """View of the blocks that the assembly appended to the floats: the fourth of the parts."""
        return self.parts[3].view(np.float64)

    def __getitem__(self, declared: Any) -> Any:
        """A scalar, or a view of an array that outlives a step, as the memory gives it."""
        if declared.size is None and issubclass(declared.owner, Singleton):
            return self.record[declared.key].item()
        # the parts are scalars, floats, integers, blocks, and floats and integers that grow with the number of slots
        is_float = declared.key in FLOAT_ARRAYS
        grows = group_of(storage_of(declared)) >= Group.SLOTS_KEPT
        part = self.parts[(4 if is_float else 5) if grows else (1 if is_float else 2)]
        first = int(self.record[FIRST_SLOT_FLOATS if is_float else FIRST_SLOT_INTEGERS]) if grows else 0
        return view_of(declared, self.record, self._counts, part.view(np.float64) if is_float else part, first)

    def put(self, memory: Memory) -> None:
        """Write this content into a memory of the same model. The memory grows if it has fewer slots.

        The parameters of active contacts, which are not part of it, are copied anew if the neighbour list differs.
        """
        active, n_slots = _active(memory).copy(), int(memory[owners.ModelNumbers.n_slots])
        if n_slots < self.n_slots:
            memory.resize(self._counts)
        if n_slots > self.n_slots:
            varies = variable_scalars(memory.own)
            memory.kept[0][varies] = self.parts[0][varies]
            for numbers, kept in zip(memory.kept[1:FIXED_PARTS], self.parts[1:FIXED_PARTS], strict=True):
                numbers[:] = kept
            memory.put_slots(self.parts[0], *self.parts[FIXED_PARTS:])
        else:
            for numbers, kept in zip(memory.kept, self.parts, strict=True):
                numbers[:] = kept
        # the distances to the tables may be those of another number of slots
        memory.refer_to_tables()
        # a memory that has grown has lost the parameters
        if n_slots < self.n_slots or not np.array_equal(active, _active(memory)):
            call_entry("copy_parameters", memory)


@final
@dataclass(frozen=True)
class Difference:
    """Difference of a checkpoint from the blank one, in a form for files.

    Attributes
    ----------
    places, bits : tuple of array
        Places of the numbers that differ, and their bits, one array for each part.
    n_slots : int
        Number of slots for active contacts in the memory of the checkpoint.
    """

    places: tuple[Integers, ...]
    bits: tuple[Integers, ...]
    n_slots: int

    def __reduce__(self) -> tuple[Callable[[bytes], Difference], tuple[bytes]]:
        """Pickled as the packed difference, which takes less memory than its arrays."""
        return Difference.unpacked, (self.packed(),)

    @classmethod
    def between(cls, blank: Checkpoint, checkpoint: Checkpoint, changing: tuple[Booleans, ...]) -> Difference:
        """Difference of a checkpoint from a blank one, in the numbers that a run may change.

        ``changing`` is True for these, one array per part that does not depend on the number of slots. The other parts
        are compared with zeros. The parts are integers, so that NaN equals itself.
        """
        fixed = checkpoint.parts[:FIXED_PARTS]
        triples = zip(blank.parts[:FIXED_PARTS], fixed, changing[:FIXED_PARTS], strict=True)
        places = [np.flatnonzero((new != old) & may_change) for old, new, may_change in triples]
        places += map(np.flatnonzero, checkpoint.parts[FIXED_PARTS:])
        bits = tuple(part[at] for part, at in zip(checkpoint.parts, places, strict=True))
        return cls(tuple(places), bits, checkpoint.n_slots)

    def packed(self) -> bytes:
        """The difference as compressed bytes of little-endian integers, the same on all machines.

        They are the number of slots, the number of parts, the number of places of each, the places, and the bits.
        Places are stored as distances from one to the next, most of which are 1 and so compress well.
        """
        sizes = np.array([self.n_slots, len(self.places), *map(len, self.places)])
        steps = [np.diff(places, prepend=0) for places in self.places]
        return zlib.compress(np.concatenate([sizes, *steps, *self.bits]).astype("<i8").tobytes(), level=1)

    @classmethod
    def unpacked(cls, content: bytes) -> Difference:
        """Return the difference that ``content`` describes; :meth:`packed` made these bytes.

        Raises
        ------
        zlib.error, ValueError, IndexError
            If the bytes are damaged.
        """
        numbers = np.frombuffer(zlib.decompress(content), "<i8").astype(np.int64)
        n_slots, n = numbers[:2].tolist()
        sizes = numbers[2 : n + 2]
        # the places of all parts, then the bits of all parts
        parts = np.split(numbers[n + 2 :], np.cumsum([*sizes, *sizes])[:-1])
        return cls(tuple(np.cumsum(steps) for steps in parts[:n]), tuple(parts[n:]), n_slots)

    def put(self, memory: Memory) -> None:
        """Write the difference into a memory with the blank checkpoint and its slots. It may come from a foreign file.

        Places are checked before anything is written, values afterwards, where their fields are known. Parameters of
        active contacts are no part of it, and are copied anew.

        Raises
        ------
        InvalidInput
            If it does not fit the memory, or a number is outside of its range.
        """
        self._check(memory)
        memory.clear_slots()
        for numbers, places, bits in zip(memory.kept, self.places, self.bits, strict=True):
            numbers[places] = bits
        _check_values(memory)
        call_entry("copy_parameters", memory)

    def _check(self, memory: Memory) -> None:
        """Check that the difference has as many parts as a memory, and that a run may change each of its places.

        Raises
        ------
        InvalidInput
            If it has other parts or another place.
        """
        # other numbers of parts are refused below
        found = [(len(places), len(bits)) for places, bits in zip(self.places, self.bits, strict=False)]
        fits = len(self.places) == len(self.bits) == len(memory.kept) and all(a == b for a, b in found)
        if not fits:
            raise InvalidInput("State.continuation", f"must have {len(memory.kept)} parts", found, _REMEDY)
        for places, may_change in zip(self.places, memory.changing, strict=True):
            wrong = np.setdiff1d(places, np.flatnonzero(may_change))
            if len(wrong) > 0:
                rule = f"must be places of {len(may_change)} numbers that a run may change"
                raise InvalidInput("State.continuation: places", rule, int(wrong[0]), _REMEDY)


def _active(memory: Memory) -> Integers:
    """Number of the declared contact of each active contact, a view."""
    return cast(Integers, memory[owners.ContactRecord.declared][: memory[owners.Island.n_contacts]])


def _check_values(memory: Memory) -> None:
    """Check that each number that the engine uses as an offset, a code or a boolean is within its range.

    Raises
    ------
    InvalidInput
        If a number is no member of its enumeration, or exceeds the count that it refers to.
    """
    counts = counts_in(memory.record)
    for one in _CHECKED:
        numbers = np.atleast_1d(np.asarray(memory[one]))
        # the numbers behind those of the active contacts have no meaning
        if one.owner is owners.ContactRecord:
            numbers = numbers[: memory[owners.Island.n_contacts]]
        least, end = _bounds(one, counts)
        wrong = numbers[(numbers < least) | (numbers >= end)]
        if len(wrong) > 0:
            rule = f"must be from {least} to {end - 1}"
            raise InvalidInput(f"State.continuation: {one.name}", rule, int(wrong[0]), _REMEDY)


def _bounds(one: Declaration, counts: Counts) -> tuple[int, int]:
    """Least value of an offset, code or boolean, and the first value that is too large.

    A number that begins as -1, for none, may have this value. ``below`` is the end of an offset, by the counts of the
    system. An enumeration ends with its last member, a boolean with True.
    """
    least = min(int(one.begin), 0)
    if one.below is not None:
        return least, one.below(counts)
    return least, max(one.kind) + 1 if issubclass(one.kind, IntEnum) else 2
