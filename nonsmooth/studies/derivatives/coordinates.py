"""Names, units, scales and indices of the coordinates and velocities of a system."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from nonsmooth.errors import UnknownName
from nonsmooth.solution.state import State
from nonsmooth.system.system import System
from nonsmooth.types import Array

TURNS = ("rx", "ry", "rz")
"""Names of rotations of a body about its own axes.  A user names them in ``within`` in place of the four components of
the quaternion."""


def values_of(state: State) -> Array:
    """Return coordinates, then velocities, of a state, shape [n_q + n_u]."""
    return np.concatenate([state.q, state.u])


def scales_of(system: System) -> Array:
    """Return the scale of each coordinate, then of each velocity, in their units, shape [n_q + n_u]."""
    return np.concatenate([body.scales[i] for i in (0, 1) for body in system.bodies])


def labels_of(system: System) -> list[tuple[str, str, str]]:
    """Return body, name and unit of each coordinate, then of each velocity."""
    named = list(zip(system.names.bodies, system.bodies, strict=True))
    coordinates = [(name, *one) for name, body in named for one in body.q_labels]
    return coordinates + [(name, *one) for name, body in named for one in body.u_labels]


def quaternions_of(system: System) -> dict[str, int]:
    """Return the index in q of the first component of each quaternion, by the name of its body."""
    firsts = np.cumsum([0, *(body.n_q for body in system.bodies)]).tolist()
    rows = zip(system.names.bodies, system.bodies, firsts, strict=False)
    return {name: first + body.quaternion for name, body, first in rows if body.quaternion >= 0}


def labels_within(system: System, within: Collection[str] | None) -> dict[str, set[str]]:
    """Return the coordinates, velocities and rotations (:data:`TURNS`) named in ``within``, by body; all by default.

    Raises
    ------
    UnknownName
        If ``within`` contains an unknown name.
    """
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
    """Return the index of a coordinate or velocity, "z" or "ball.z", in the array of :func:`values_of`.

    Raises
    ------
    UnknownName
        If no coordinate or velocity has this name.
    """
    labels = labels_of(system)
    for i, (body, label, _) in enumerate(labels):
        if name in (label, f"{body}.{label}"):
            return i
    raise UnknownName("coordinate", name, {f"{body}.{label}" for body, label, _ in labels})


def whole_name(system: System, number: int) -> str:
    """Return the name of a coordinate or velocity with its body, "ball.z"."""
    return ".".join(labels_of(system)[number][:2])


def unit(system: System, number: int) -> str:
    """Return the unit of a coordinate or velocity."""
    return labels_of(system)[number][2]


def is_in_quaternion(system: System, number: int) -> bool:
    """Return True if a coordinate is one of the four components of a quaternion."""
    return any(start <= number < start + 4 for start in quaternions_of(system).values())
