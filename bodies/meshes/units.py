"""Units of length that files of meshes are written in; most formats do not say which."""

from __future__ import annotations

import warnings

from nonsmooth.errors import UnknownName
from nonsmooth.parameters import UnusualValue

METRES = {"m": 1.0, "dm": 0.1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "inch": 0.0254, "foot": 0.3048}
"""Length of one unit [m]."""

SMALLEST, LARGEST = 1e-4, 5.0
"""Largest extent of a body that is taken without a question [m]."""


def metres(thing: str, unit: str) -> float:
    """Return the length of a unit [m]; raise UnknownName if there is none of that name."""
    if unit not in METRES:
        raise UnknownName(f"{thing}: unit", str(unit), METRES)
    return METRES[unit]


def warn_of_size(thing: str, extent: float, unit: str) -> None:
    """Warn if a body with this largest extent [m], read in this unit, suggests another one."""
    if SMALLEST <= extent <= LARGEST:
        return
    others = [name for name, length in METRES.items() if SMALLEST <= extent / METRES[unit] * length <= LARGEST]
    better = " or ".join(repr(name) for name in others if name in ("m", "mm", "inch")) or "another one"
    warnings.warn(
        f"{thing}: the largest extent is {extent:.4g} m, outside of the usual {SMALLEST:g} to {LARGEST:g} m, with its "
        f"numbers read as {unit!r}. Is the unit right? With {better} the body would be of usual size.",
        UnusualValue,
        stacklevel=2,
    )
