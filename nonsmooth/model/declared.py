"""Parameters of declared contacts, and the histories with which the engine makes the next list of active contacts.

The memory holds a record for each row of contacts and for each kind, from which the parameters of a contact follow
(:mod:`nonsmooth.engine.bodies.declared`). Of its state it holds that of the active contacts only.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import declarations
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.owners.contact import GEOMETRY_OFFSETS, LAW_OFFSETS

Integers = NDArray[np.int64]
_CONTACT = owners.ContactRecord
_STRIDES = {
    **dict.fromkeys(GEOMETRY_OFFSETS, owners.KindRecord.geometry_stride),
    **dict.fromkeys(LAW_OFFSETS, owners.KindRecord.law_stride),
}
"""Stride of each offset that is another one for each contact of a kind, by the name of the field."""
_FRESH = {"direction": (1.0, 0.0), "mean_forces_asked": -math.inf}
"""Numbers of a contact that was never closed, by name, where they are not zero."""


@dataclass(frozen=True, eq=False)
class DeclaredContacts:
    """Some declared contacts of a memory, whose parameters are read by ``self[ContactRecord.frame_a]``.

    Attributes
    ----------
    memory : Memory
        The memory.
    numbers : array
        Numbers of the contacts.
    """

    memory: Memory
    numbers: Integers

    @classmethod
    def of(cls, memory: Memory, numbers: Sequence[int] | Integers) -> DeclaredContacts:
        """The declared contacts with these numbers."""
        return cls(memory, np.asarray(numbers, np.int64))

    @functools.cached_property
    def rows(self) -> Integers:
        """Row of each contact."""
        firsts = self.memory[owners.RowRecord.first_contact]
        return np.asarray(np.searchsorted(firsts, self.numbers, side="right") - 1, np.int64)

    @functools.cached_property
    def _indices(self) -> Integers:
        """Index of each contact in its row."""
        return np.asarray(self.numbers - self.memory[owners.RowRecord.first_contact][self.rows], np.int64)

    @functools.cached_property
    def _kinds(self) -> Integers:
        """Kind of each contact."""
        return np.asarray(self.memory[owners.RowRecord.first_kind][self.rows] + self._indices, np.int64)

    def __getitem__(self, declared: Any) -> np.ndarray:
        """A parameter of each contact, by its declaration in the record of active contacts."""
        name = declared.name
        if declared is _CONTACT.inner_states:
            first = self.memory[owners.RowRecord.inner_states][self.rows]
            return np.asarray(first + self._indices * self[_CONTACT.n_inner_states])
        if declared.is_of_row:
            return np.asarray(self.memory[getattr(owners.RowRecord, name)][self.rows])
        values = np.asarray(self.memory[getattr(owners.KindRecord, name)][self._kinds])
        if name not in _STRIDES:
            return values
        moved = self.memory[owners.RowRecord.rank][self.rows] * self.memory[_STRIDES[name]][self._kinds]
        # an offset of 0 means that there is no block
        return np.where(values > 0, values + moved, 0)


def searched(memory: Memory) -> tuple[Integers, Integers]:
    """Numbers of the contacts whose features are searched for, and offsets of their features among the floats."""
    firsts, counts = memory[owners.Search.first_contact].tolist(), memory[owners.Search.n_contacts].tolist()
    ranges = [np.arange(first, first + n) for first, n in zip(firsts, counts, strict=True)]
    numbers = np.concatenate([np.zeros(0, np.int64), *ranges])
    return numbers, DeclaredContacts.of(memory, numbers)[_CONTACT.features]


def remember(memory: Memory, numbers: Sequence[int] | Integers, states: Mapping[Any, Any]) -> None:
    """Empty the list of active contacts, and write the histories with which the engine makes the next one.

    Parameters
    ----------
    memory : Memory
        The memory.
    numbers : sequence of int
        Numbers of declared contacts. All others are open, as at the start of a run.
    states : mapping
        Values of these contacts, by the declarations in the record of active contacts.
    """
    n = len(numbers)
    memory[owners.Island.n_contacts], memory[owners.Island.n_histories] = 0, n
    values = {"declared": numbers, **{declared.name: value for declared, value in states.items()}}
    for name, one in declarations(owners.HistoryRecord).items():
        if not one.inside[0]:
            memory[one][:n] = values.get(name, _FRESH.get(name, 0))
