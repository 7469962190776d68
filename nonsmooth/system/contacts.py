"""Contacts of a system: stored as one row for each pair of shapes, and made one by one when they are used.

Two boxes have 160 potential contacts, so that a hundred boxes have 800 000.  All contacts of two shapes differ in their
kinematics and in the number in their name only.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, SupportsIndex, final, overload

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Body, FeaturePair, Shape
from nonsmooth.system.contact import Contact
from nonsmooth.system.materials import ContactLaws
from nonsmooth.system.names import numbered


@final
@dataclass(frozen=True, eq=False)
class ContactRow:
    """All potential contacts of two shapes.

    Attributes
    ----------
    bodies, frames, shapes : tuple
        The two bodies, the number of the frame of each, and its shape.
    kinematics : sequence of FeaturePair
        Geometry of each contact.
    laws : ContactLaws
        Laws of all of them.
    label : str
        Name of the contacts without their number.
    first_number : int
        Number in the name of the first contact; 0 if the name has no number, because the contact is the only one.
    extents, levers : tuple of float
        As in :class:`Contact`.
    """

    bodies: tuple[Body, Body]
    frames: tuple[int, int]
    shapes: tuple[Shape, Shape]
    kinematics: Sequence[FeaturePair]
    laws: ContactLaws
    label: str
    first_number: int
    extents: tuple[float, float]
    levers: tuple[float, float]
    _made: dict[int, Contact] = field(default_factory=dict, init=False, repr=False)
    """Contacts that were used, by their index: each is one object, so that it can be compared by identity."""

    def __len__(self) -> int:
        return len(self.kinematics)

    @property
    def size(self) -> float:
        """The smaller of the extents [m]."""
        return min(self.extents)

    def name(self, index: int) -> str:
        """Name of the contact with an index in the row."""
        return numbered(self.label, self.first_number, index)

    def contact(self, index: int) -> Contact:
        """The contact with an index in the row."""
        if index not in self._made:
            (one, two), laws = self.bodies, self.laws
            self._made[index] = Contact(
                self.name(index),
                one,
                two,
                self.frames,
                self.shapes,
                self.kinematics[index],
                self.extents,
                self.levers,
                laws.normal,
                laws.friction,
                laws.impact,
            )
        return self._made[index]

    @classmethod
    def of(cls, contact: Contact) -> ContactRow:
        """Row of a single given contact, which keeps its name."""
        made = cls(
            (contact.first, contact.second),
            contact.frames,
            contact.shapes,
            (contact.kinematics,),
            ContactLaws(contact.normal, contact.friction, contact.impact),
            contact.name,
            0,
            contact.extents,
            contact.levers,
        )
        made._made[0] = contact
        return made


@final
class Contacts(Sequence[Contact]):
    """Contacts in the order declared. Each is made when it is used first.

    Parameters
    ----------
    rows : iterable of ContactRow
        The rows, in order.
    """

    def __init__(self, rows: Iterable[ContactRow]) -> None:
        self.rows = tuple(rows)
        counts = [len(row) for row in self.rows]
        self.counts: NDArray[np.int64] = np.array(counts, np.int64)
        """Number of contacts of each row."""
        self.starts: NDArray[np.int64] = np.concatenate([[0], np.cumsum(self.counts)]).astype(np.int64)
        """Number of the first contact of each row, then the number of all contacts."""

    def __len__(self) -> int:
        return int(self.starts[-1])

    def __iter__(self) -> Iterator[Contact]:
        return (row.contact(index) for row in self.rows for index in range(len(row)))

    @overload
    def __getitem__(self, index: SupportsIndex) -> Contact: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Contact, ...]: ...
    def __getitem__(self, index: SupportsIndex | slice) -> Contact | tuple[Contact, ...]:
        if isinstance(index, slice):
            return tuple(self[number] for number in range(*index.indices(len(self))))
        number = range(len(self))[operator.index(index)]
        row = int(np.searchsorted(self.starts, number, side="right")) - 1
        return self.rows[row].contact(number - int(self.starts[row]))

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, Sequence) and tuple(self) == tuple(other)

    def __repr__(self) -> str:
        """Number of contacts, and the first three."""
        more = ", ..." if len(self) > 3 else ""
        return f"Contacts({len(self)}: {', '.join(map(repr, self[:3]))}{more})"

    def repeated(self, values: Sequence[Any] | NDArray[Any]) -> NDArray[Any]:
        """Values of the rows, shape [n_rows, ...], repeated for each contact, shape [n_contacts, ...]."""
        return np.repeat(np.asarray(values), self.counts, axis=0)
