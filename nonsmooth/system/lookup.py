"""Parts of a system by their names, and names of its coordinates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Body
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System


def number_of(where: str, kind: str, part: object, parts: Sequence[object], names: Callable[[], Sequence[str]]) -> int:
    """Number of a part, from its name or the object itself, counted from 0.

    Raises
    ------
    UnknownName
        If no part has this name.
    InvalidInput
        If the object is not a part of the system.
    """
    if isinstance(part, str):
        known = names()
        if part not in known:
            raise UnknownName(f"{where}: {kind}", part, known)
        return known.index(part)
    # different parts may be equal
    found = next((number for number, one in enumerate(parts) if one is part), None)
    if found is None:
        remedy = "Take it, or its name, from solution.system."
        raise InvalidInput(where, f"needs a {kind} of this system, or its name", part, remedy)
    return found


def body_number(where: str, part: Body | str, system: System) -> int:
    """Number of a body, counted from 0. Errors as :func:`number_of`."""
    return number_of(where, "body", part, system.bodies, lambda: system.names.bodies)


def contact_number(where: str, part: Contact | str | int, contacts: Sequence[Contact]) -> int:
    """Number of a contact, from its name, its number or the object, counted from 0. Errors as :func:`number_of`."""
    if not isinstance(part, (int, np.integer)):
        return number_of(where, "contact", part, contacts, lambda: [one.name for one in contacts])
    if part not in range(len(contacts)):
        rule = f"must be below {len(contacts)}, the number of contacts"
        raise InvalidInput(f"{where}: contact", rule, part, "Count from 0.")
    return int(part)


@final
@dataclass(frozen=True)
class Labels:
    """Names of the coordinates and velocities of a system, in its order.

    Attributes
    ----------
    coordinates, velocities : tuple of tuple of str
        Body, name with the body's, unit.
    """

    coordinates: tuple[tuple[str, str, str], ...]
    velocities: tuple[tuple[str, str, str], ...]


def labels(system: System) -> Labels:
    """Labels of the coordinates and velocities of a system, such as "ball 2 x" [m]."""
    pairs = list(zip(system.bodies, system.names.bodies, strict=True))
    return Labels(
        tuple((label, f"{label} {name}", unit) for body, label in pairs for name, unit in body.q_labels),
        tuple((label, f"{label} {name}", unit) for body, label in pairs for name, unit in body.u_labels),
    )
