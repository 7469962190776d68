"""Checkpoints: a copy of all numbers of a memory that a step may read from earlier steps.

These are the numbers that outlive a step by the field table, and the blocks that plug-ins write. Every other number is
written before it is read, so a run from a checkpoint gives the same bits. Parameters, sizes and addresses are left out,
so that a file cannot change them.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Part
from nonsmooth.engine.memory.memory import Memory, counts_in, view_of
from nonsmooth.engine.memory.sizes import Counts
from nonsmooth.engine.memory.tables import FLOAT_ARRAYS, N_SCALARS, SCALARS
from nonsmooth.errors import InvalidInput
from nonsmooth.model.active_contacts import active_contacts, copy_parameters
from nonsmooth.model.values import check_values
from nonsmooth.packing import packed, unpacked
from nonsmooth.types import Array

Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]
_REMEDY = "It is damaged, or of another model: take the state of a run of this model."


@final
@dataclass(frozen=True)
class Checkpoint:
    """Content of a memory between two steps.

    Attributes
    ----------
    parts : tuple of array
        Copies of :attr:`nonsmooth.engine.memory.memory.Memory.kept`, as integers of the same bits.
    first : int
        Place of the first block among the floats of the memory.
    """

    parts: tuple[Integers, ...]
    first: int

    @classmethod
    def of(cls, memory: Memory) -> Checkpoint:
        """Copy the content of a memory."""
        return cls(tuple([part.copy() for part in memory.kept]), memory.blocks)

    @functools.cached_property
    def record(self) -> np.void:
        """Record of the scalars that all engines share, a view of the first part."""
        return cast(np.void, self.parts[0][:N_SCALARS].view(SCALARS)[0])

    @functools.cached_property
    def _counts(self) -> Counts:
        return counts_in(self.record)

    @functools.cached_property
    def size(self) -> int:
        """Size [bytes]."""
        return sum(part.nbytes for part in self.parts)

    @property
    def blocks(self) -> Array:
        """The blocks that the assembly appended."""
        return self.parts[3].view(np.float64)

    def __getitem__(self, declared: Any) -> Any:
        """A scalar, or a view of an array that outlives a step, as the memory gives it."""
        if declared.size is None and issubclass(declared.owner, Part):
            return self.record[declared.key].item()
        part = self.parts[1].view(np.float64) if declared.key in FLOAT_ARRAYS else self.parts[2]
        return view_of(declared, self.record, self._counts, part)

    def declared(self, declared: Any) -> np.ndarray:
        """A view of a number of the declared contacts that active contacts have, too."""
        return np.asarray(self[getattr(owners.DeclaredContact, declared.name)])

    def put(self, memory: Memory) -> None:
        """Write this content into a memory of the same model."""
        active = active_contacts(memory).copy()
        for own, kept in zip(memory.kept, self.parts, strict=True):
            own[:] = kept
        if not np.array_equal(active, active_contacts(memory)):
            copy_parameters(memory)


@final
@dataclass(frozen=True)
class Difference:
    """Difference of a checkpoint from the blank one, in a form for files.

    Attributes
    ----------
    places, bits : tuple of array
        Places of the numbers that differ, and their bits, one array for each part.
    """

    places: tuple[Integers, ...]
    bits: tuple[Integers, ...]

    def __reduce__(self) -> tuple[Callable[[bytes], Difference], tuple[bytes]]:
        """Pickle the packed difference."""
        return Difference.unpacked, (self.packed(),)

    @classmethod
    def between(cls, blank: Checkpoint, checkpoint: Checkpoint, changing: tuple[Booleans, ...]) -> Difference:
        """Difference of a checkpoint from a blank one, of the numbers that a run may change."""
        triples = zip(blank.parts, checkpoint.parts, changing, strict=True)
        places = tuple(np.flatnonzero((new != old) & may_change) for old, new, may_change in triples)
        return cls(places, tuple(part[at] for part, at in zip(checkpoint.parts, places, strict=True)))

    def packed(self) -> bytes:
        """The difference as compressed bytes. Places are stored as distances, most of which are 1."""
        sizes = np.array([len(self.places), *map(len, self.places)])
        steps = [np.diff(places, prepend=0) for places in self.places]
        return packed(np.concatenate([sizes, *steps, *self.bits]).astype("<i8"))

    @classmethod
    def unpacked(cls, content: bytes) -> Difference:
        """The difference of packed bytes.

        Raises
        ------
        ValueError, IndexError
            If they are damaged.
        """
        numbers = unpacked(content, "<i8").astype(np.int64)
        n = int(numbers[0])
        sizes = numbers[1 : n + 1]
        parts = np.split(numbers[n + 1 :], np.cumsum([*sizes, *sizes])[:-1])
        return cls(tuple(np.cumsum(steps) for steps in parts[:n]), tuple(parts[n:]))

    def put(self, memory: Memory) -> None:
        """Write the difference into a memory that holds the blank checkpoint. It may come from a foreign file.

        Raises
        ------
        InvalidInput
            If it does not fit the memory, or a number is outside of its range.
        """
        self._check(memory)
        for own, places, bits in zip(memory.kept, self.places, self.bits, strict=True):
            own[places] = bits
        check_values(memory)
        copy_parameters(memory)

    def _check(self, memory: Memory) -> None:
        """Check that it has the parts of a memory, and that a run may change each place.

        Raises
        ------
        InvalidInput
            If that is not so.
        """
        found = [(len(places), len(bits)) for places, bits in zip(self.places, self.bits, strict=False)]
        fits = len(self.places) == len(self.bits) == len(memory.kept) and all(a == b for a, b in found)
        if not fits:
            raise InvalidInput("State.continuation", f"must have {len(memory.kept)} parts", found, _REMEDY)
        for places, may_change in zip(self.places, memory.changing, strict=True):
            wrong = places[(places < 0) | (places >= len(may_change))]
            if len(wrong) == 0:
                wrong = places[~may_change[places]]
            if len(wrong) > 0:
                rule = f"must be places of {len(may_change)} numbers that a run may change"
                raise InvalidInput("State.continuation: places", rule, int(wrong[0]), _REMEDY)
