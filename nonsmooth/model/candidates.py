"""Checks of the features that a state from a file gives to contacts.

The kinematics of such a contact uses the numbers of its features as places in a table. A wrong number would read
outside of it.
"""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.errors import InvalidInput
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.system.contact import Contact

_REMEDY = "The file is damaged: take another."


def check_candidates(model: LaidOut) -> None:
    """Check that the features of each contact with a search are features of its shapes.

    Raises
    ------
    InvalidInput
        If a feature does not exist.
    """
    places = model.memory.declared(owners.Contact.features)
    numbers = np.flatnonzero(places > 0)
    for number in numbers[model.memory.floats[places[numbers]] != 0.0].tolist():
        contact = model.system.contacts[number]
        kind, *features, distance = model.memory.floats[places[number] :][: CANDIDATE + 1].tolist()
        if not (_exist(contact, kind, features) and 0.0 <= distance < np.inf):
            raise InvalidInput(
                f"State.continuation: the features of the {contact}",
                f"must be one of {_ranges(contact)}, with a finite distance",
                (kind, *features, distance),
                _REMEDY,
            )


def _exist(contact: Contact, kind: float, features: list[float]) -> bool:
    """True if both features of a pair of a kind exist."""
    search = contact.kinematics.candidates
    assert search is not None
    counts = search.counts.get(kind, (0, 0))
    return all(number.is_integer() and 0 <= number < count for number, count in zip(features, counts, strict=True))


def _ranges(contact: Contact) -> str:
    search = contact.kinematics.candidates
    assert search is not None
    kinds = [f"({kind:g}, below {one}, below {two})" for kind, (one, two) in search.counts.items()]
    return " or ".join(kinds)
