"""What a file says of pairs of features: contacts of pools find their way through tables by their numbers."""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.errors import InvalidInput
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.system.contact import Contact

_REMEDY = "It is damaged, or made up: take another."


def check_candidates(model: LaidOut) -> None:
    """Look whether the contacts of pools hold pairs of features that there are.

    Raises
    ------
    InvalidInput
        If one does not.
    """
    places = model.memory.declared(owners.Contact.features)
    numbers = np.flatnonzero(places > 0)
    for number in numbers[model.memory.floats[places[numbers]] != 0.0].tolist():
        contact = model.system.contacts[number]
        kind, *held, apart = model.memory.floats[places[number] :][: CANDIDATE + 1].tolist()
        if not (_are_features(contact, kind, held) and 0.0 <= apart < np.inf):
            raise InvalidInput(
                f"State.continuation: the features of the {contact}",
                f"must be those of {_told(contact)}, and up to some distance",
                (kind, *held, apart),
                _REMEDY,
            )


def _are_features(contact: Contact, kind: float, held: list[float]) -> bool:
    search = contact.kinematics.candidates
    assert search is not None
    counts = search.counts.get(kind, (0, 0))
    return all(number.is_integer() and 0 <= number < count for number, count in zip(held, counts, strict=True))


def _told(contact: Contact) -> str:
    search = contact.kinematics.candidates
    assert search is not None
    kinds = [f"({kind:g}, below {one}, below {two})" for kind, (one, two) in search.counts.items()]
    return " or ".join(kinds)
