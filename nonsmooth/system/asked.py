"""A part of a system, asked for by its name or as the object itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Body
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System


def number_of(where: str, kind: str, asked: object, parts: Sequence[object], names: Callable[[], Sequence[str]]) -> int:
    """Return the number of a part, counted from 0.

    Raises
    ------
    UnknownName
        If none has this name.
    InvalidInput
        If the object is none of them.
    """
    if isinstance(asked, str):
        known = names()
        if asked not in known:
            raise UnknownName(f"{where}: {kind}", asked, known)
        return known.index(asked)
    # parts may be equal and yet not the same
    found = next((number for number, part in enumerate(parts) if part is asked), None)
    if found is None:
        remedy = "Take it, or its name, from solution.system."
        raise InvalidInput(where, f"needs a {kind} of this system, or its name", asked, remedy)
    return found


def body_number(where: str, asked: Body | str, system: System) -> int:
    """Return the number of a body, counted from 0; errors as :func:`number_of`."""
    return number_of(where, "body", asked, system.bodies, lambda: system.names.bodies)


def contact_number(where: str, asked: Contact | str | int, contacts: Sequence[Contact]) -> int:
    """Return the number of a contact, which may be asked for by it, counted from 0; errors as :func:`number_of`."""
    if not isinstance(asked, (int, np.integer)):
        return number_of(where, "contact", asked, contacts, lambda: [one.name for one in contacts])
    if asked not in range(len(contacts)):
        rule = f"must be below {len(contacts)}, the number of contacts"
        raise InvalidInput(f"{where}: contact", rule, asked, "Count from 0.")
    return int(asked)
