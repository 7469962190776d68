"""The names of the coordinates and velocities of a system, and where they stand."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from nonsmooth.errors import UnknownName
from nonsmooth.system.system import System

TURNS = ("rx", "ry", "rz")
"""Turns of a body with a quaternion about its own axes, which stand for the quaternion's four numbers."""


def labels_of(system: System) -> Iterator[tuple[str, str]]:
    """Give body and name of each coordinate, then of each velocity."""
    for kind in ("q_labels", "u_labels"):
        for name, body in zip(system.names.bodies, system.bodies, strict=True):
            yield from ((name, label) for label, _ in getattr(body, kind))


def quaternions_of(system: System) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Return the bodies that have a quaternion, and where these begin."""
    firsts = np.cumsum([0, *(body.n_q for body in system.bodies)]).tolist()
    found = [
        (name, first + body.quaternion)
        for name, body, first in zip(system.names.bodies, system.bodies, firsts, strict=False)
        if body.quaternion >= 0
    ]
    return tuple(name for name, _ in found), tuple(start for _, start in found)


def labels_within(system: System, within: Collection[str] | None) -> dict[str, set[str]]:
    """Return the names that may change, by body."""
    known = {
        name: {label for label, _ in (*body.q_labels, *body.u_labels)} | (set(TURNS) if body.quaternion >= 0 else set())
        for name, body in zip(system.names.bodies, system.bodies, strict=True)
    }
    if within is None:
        return known
    whole = {f"{body}.{label}" for body, labels in known.items() for label in labels}
    for name in within:
        if name not in whole and not any(name in labels for labels in known.values()):
            raise UnknownName("coordinate", name, whole)
    return {
        body: {label for label in labels if label in within or f"{body}.{label}" in within}
        for body, labels in known.items()
    }


def coordinate_number(system: System, name: str) -> int:
    """Return where a coordinate or velocity stands behind one another with all coordinates and velocities.

    Raises
    ------
    UnknownName
        If there is none of that name.
    """
    labels = list(labels_of(system))
    for i, (body, label) in enumerate(labels):
        if name in (label, f"{body}.{label}"):
            return i
    raise UnknownName("coordinate", name, {f"{body}.{label}" for body, label in labels})


def whole_name(system: System, number: int) -> str:
    """Return the name of a coordinate or velocity with that of its body, "ball.z"."""
    return ".".join(list(labels_of(system))[number])


def unit(system: System, number: int) -> str:
    """Return the unit of a coordinate or velocity."""
    bodies = system.bodies
    labels = [*(one for body in bodies for one in body.q_labels), *(one for body in bodies for one in body.u_labels)]
    return labels[number][1]


def turns(system: System, number: int) -> bool:
    """Tell whether a coordinate is one of the four numbers of a quaternion."""
    return any(start <= number < start + 4 for start in quaternions_of(system)[1])
