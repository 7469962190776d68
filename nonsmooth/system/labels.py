"""Names and units of the coordinates of a system."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.system.system import System


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
