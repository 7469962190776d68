"""What a memory holds between two steps: taken, put back, and kept as what differs from the memory before a run."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import UNTOUCHED
from nonsmooth.engine.memory.declare import Life, Part, declarations
from nonsmooth.engine.memory.memory import Memory, counts_in, view_of
from nonsmooth.engine.memory.modes import SLIDE
from nonsmooth.engine.memory.sizes import Counts
from nonsmooth.engine.memory.tables import FLOAT_ARRAYS, N_SCALARS, SCALARS
from nonsmooth.errors import InvalidInput
from nonsmooth.packing import packed, unpacked
from nonsmooth.types import Array

Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]
_REMEDY = "It is damaged, or of another model: take one that a run left."
_UNTOUCHED = int(np.float64(UNTOUCHED).view(np.int64))


@final
@dataclass(frozen=True)
class Image:
    """The scalars of a memory and its parts that a step may find of those before it.

    Attributes
    ----------
    parts : tuple of array
        Copies of the scalars and of :attr:`nonsmooth.engine.memory.memory.Memory.kept`, as integers of the same bits.
    first : int
        Where in the memory the blocks begin that the assembly appended.
    """

    parts: tuple[Integers, ...]
    first: int

    @classmethod
    def of(cls, memory: Memory) -> Image:
        """Take the image of a memory."""
        return cls(tuple([part.copy() for part in memory.bits]), memory.blocks)

    @functools.cached_property
    def record(self) -> np.void:
        """The scalars, but for those that an engine has of its own."""
        return cast(np.void, self.parts[0][:N_SCALARS].view(SCALARS)[0])

    @functools.cached_property
    def _counts(self) -> Counts:
        return counts_in(self.record)

    @functools.cached_property
    def size(self) -> int:
        """Memory that it takes [bytes]."""
        return sum(part.nbytes for part in self.parts)

    @property
    def blocks(self) -> Array:
        """The blocks that the assembly appended."""
        return self.parts[2].view(np.float64)

    def __getitem__(self, declared: Any) -> Any:
        """Return a scalar, or a view of an array, as the memory does."""
        if declared.size is None and issubclass(declared.owner, Part):
            return self.record[declared.key].item()
        part = self.parts[1].view(np.float64) if declared.key in FLOAT_ARRAYS else self.parts[3]
        return view_of(declared, self.record, self._counts, part)

    def declared(self, declared: Any) -> np.ndarray:
        """Return a view of what the declared contacts hold of a number of contacts."""
        return np.asarray(self[getattr(owners.DeclaredContact, declared.name)])

    def put(self, memory: Memory) -> None:
        """Give a memory of the same system this content."""
        for own, kept in zip(memory.bits, self.parts, strict=True):
            own[:] = kept


@final
@dataclass(frozen=True)
class Guards:
    """The numbers behind blocks that plug-ins write, which nobody may change.

    Attributes
    ----------
    places : array
        Where they stand in the heap of floats.
    content : bytes
        What stands there.
    """

    places: Integers
    content: bytes

    @classmethod
    def of(cls, memory: Memory) -> Guards:
        """Find them in a memory on which nothing was called yet."""
        arrays, blocks = (np.flatnonzero(part == _UNTOUCHED) for part in memory.bits[1:3])
        places = np.concatenate([arrays, memory.blocks + blocks])
        return cls(places, np.full(len(places), UNTOUCHED).tobytes())

    def hold(self, memory: Memory) -> bool:
        """Tell whether all of them are as they were."""
        return memory.floats[self.places].tobytes() == self.content


@final
@dataclass(frozen=True)
class Difference:
    """What an image has that another one has not.

    Attributes
    ----------
    places, bits : tuple of array
        Where they differ, and what stands there, one array for every part.
    """

    places: tuple[Integers, ...]
    bits: tuple[Integers, ...]

    def __reduce__(self) -> tuple[Callable[[bytes], Difference], tuple[bytes]]:
        """Let a pickle hold what is packed."""
        return Difference.unpacked, (self.packed(),)

    def packed(self) -> bytes:
        """Return it as a few bytes; places count from the one before, and next to all of them are 1."""
        sizes = np.array([len(self.places), *map(len, self.places)])
        steps = [np.diff(places, prepend=0) for places in self.places]
        return packed(np.concatenate([sizes, *steps, *self.bits]).astype("<i8"))

    @classmethod
    def unpacked(cls, content: bytes) -> Difference:
        """Return what was packed.

        Raises
        ------
        ValueError, IndexError
            If it is none.
        """
        numbers = unpacked(content, "<i8").astype(np.int64)
        n = int(numbers[0])
        sizes = numbers[1 : n + 1]
        parts = np.split(numbers[n + 1 :], np.cumsum([*sizes, *sizes])[:-1])
        return cls(tuple(np.cumsum(steps) for steps in parts[:n]), tuple(parts[n:]))

    def check(self, memory: Memory) -> None:
        """Look whether it fits a memory.

        Raises
        ------
        InvalidInput
            If it has other parts, or a place that is none.
        """
        limits = [len(own) for own in memory.bits]
        found = [(len(places), len(bits)) for places, bits in zip(self.places, self.bits, strict=False)]
        fits = len(self.places) == len(self.bits) == len(limits) and all(a == b for a, b in found)
        if not fits:
            raise InvalidInput("State.continuation", f"must have {len(limits)} parts", found, _REMEDY)
        for places, limit in zip(self.places, limits, strict=True):
            _check("places", places, limit)

    def within(self, allowed: tuple[Booleans, ...]) -> Difference:
        """Return what of it is at the places of a memory that are allowed."""
        kept = [one[places] for places, one in zip(self.places, allowed, strict=True)]
        return Difference(
            tuple(places[one] for places, one in zip(self.places, kept, strict=True)),
            tuple(bits[one] for bits, one in zip(self.bits, kept, strict=True)),
        )

    @classmethod
    def between(cls, blank: Image, image: Image) -> Difference:
        """Return what ``image`` has that ``blank`` has not."""
        places = tuple(np.flatnonzero(new != old) for old, new in zip(blank.parts, image.parts, strict=True))
        return cls(places, tuple(part[at] for part, at in zip(image.parts, places, strict=True)))

    def put(self, memory: Memory) -> None:
        """Give a memory that holds the blank image what differs from it, which may come from another process.

        Raises
        ------
        InvalidInput
            If something is no contact or no mode that would be one.
        """
        for own, places, bits in zip(memory.bits, self.places, self.bits, strict=True):
            own[places] = bits
        # functions stand elsewhere in every process: listed contacts take them from the declared ones of this one
        n, contact = memory[owners.Island.n_contacts], owners.Contact
        n_declared, n_spheres = memory[owners.Model.n_declared], memory[owners.Model.n_spheres]
        _check("n_contacts", np.array([n]), memory[owners.Model.n_slots] + 1)
        _check("declared", memory[contact.declared][:n], n_declared)
        for mode in (contact.mode, contact.mode_after_averaging):
            _check(mode.name, np.append(memory[mode][:n], memory.declared(mode)), SLIDE + 1)
        _check("sphere_order", memory[owners.Island.sphere_order], n_spheres)
        for name, one in declarations(owners.DeclaredContact).items():
            if one.life is Life.PARAMETER and not one.is_float and not one.inside[0]:
                declared = memory[contact.declared][:n]
                memory[getattr(contact, name)][:n] = memory[one][declared]


def _check(name: str, numbers: Integers, bound: int) -> None:
    """Raise InvalidInput unless all of some indices, codes or counts are below a bound."""
    wrong = numbers[(numbers < 0) | (numbers >= bound)]
    if len(wrong) > 0:
        raise InvalidInput(f"State.continuation: {name}", f"must be from 0 to {bound - 1}", int(wrong[0]), _REMEDY)
