"""Labels for bodies, coordinates and contacts, made from what they are: "ball 1", "ball 2", "plate - ball 2"."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Body
from nonsmooth.system.system import System

_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_POSE = tuple(zip(("x", "y", "z", "q0", "q1", "q2", "q3"), "mmm1111", strict=True))
_TWIST = tuple(zip(("vx", "vy", "vz", "wx", "wy", "wz"), 3 * ["m/s"] + 3 * ["rad/s"], strict=True))
_OF_ITS_OWN = "SI"
"""Unit of a coordinate that only its body knows."""


@final
@dataclass(frozen=True)
class Labels:
    """What the parts of a system are called, in its order.

    Attributes
    ----------
    bodies, contacts : tuple of str
        Each once.
    coordinates, velocities : tuple of tuple of str
        Body, name with the body's, unit.
    """

    bodies: tuple[str, ...]
    contacts: tuple[str, ...]
    coordinates: tuple[tuple[str, str, str], ...]
    velocities: tuple[tuple[str, str, str], ...]


def labels(system: System) -> Labels:
    """Return the labels of a system."""
    bodies = _numbered([_HUMP.sub(" ", type(body).__name__).lower() for body in system.bodies], "{} {}")
    known = dict(zip(map(id, system.bodies), bodies, strict=True))
    contacts = [f"{known[id(contact.first)]} - {known[id(contact.second)]}" for contact in system.contacts]
    pairs = list(zip(system.bodies, bodies, strict=True))
    return Labels(
        bodies,
        _numbered(contacts, "{} ({})"),
        tuple(row for body, label in pairs for row in _rows(body, label, body.n_q, "q", _POSE)),
        tuple(row for body, label in pairs for row in _rows(body, label, body.n_u, "u", _TWIST)),
    )


def _numbered(words: Sequence[str], form: str) -> tuple[str, ...]:
    totals, seen, found = Counter(words), Counter[str](), []
    for word in words:
        seen[word] += 1
        found.append(word if totals[word] == 1 else form.format(word, seen[word]))
    return tuple(found)


def _rows(
    body: Body, label: str, size: int, letter: str, of_free: tuple[tuple[str, str], ...]
) -> Iterator[tuple[str, str, str]]:
    """Return body, name and unit of its coordinates or velocities; those of a free body are pose and twist."""
    is_free = (body.n_q, body.n_u, body.quaternion) == (len(_POSE), len(_TWIST), 3)
    names = of_free if is_free else tuple((f"{letter}{i + 1}", _OF_ITS_OWN) for i in range(size))
    return ((label, f"{label} {name}", unit) for name, unit in names)
