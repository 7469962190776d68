"""Labels for coordinates and velocities, with their units: "ball 2 x" [m]."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Body
from nonsmooth.system.system import System

_POSE = tuple(zip(("x", "y", "z", "q0", "q1", "q2", "q3"), "mmm1111", strict=True))
_TWIST = tuple(zip(("vx", "vy", "vz", "wx", "wy", "wz"), 3 * ["m/s"] + 3 * ["rad/s"], strict=True))
_OF_ITS_OWN = "SI"
"""Unit of a coordinate that only its body knows."""


@final
@dataclass(frozen=True)
class Labels:
    """What the coordinates of a system are called, in its order.

    Attributes
    ----------
    coordinates, velocities : tuple of tuple of str
        Body, name with the body's, unit.
    """

    coordinates: tuple[tuple[str, str, str], ...]
    velocities: tuple[tuple[str, str, str], ...]


def labels(system: System) -> Labels:
    """Return the labels of the coordinates and velocities of a system."""
    pairs = list(zip(system.bodies, system.names.bodies, strict=True))
    return Labels(
        tuple(row for body, label in pairs for row in _rows(body, label, body.n_q, "q", _POSE)),
        tuple(row for body, label in pairs for row in _rows(body, label, body.n_u, "u", _TWIST)),
    )


def _rows(
    body: Body, label: str, size: int, letter: str, of_free: tuple[tuple[str, str], ...]
) -> Iterator[tuple[str, str, str]]:
    """Return body, name and unit of its coordinates or velocities; those of a free body are pose and twist."""
    is_free = (body.n_q, body.n_u, body.quaternion) == (len(_POSE), len(_TWIST), 3)
    names = of_free if is_free else tuple((f"{letter}{i + 1}", _OF_ITS_OWN) for i in range(size))
    return ((label, f"{label} {name}", unit) for name, unit in names)
