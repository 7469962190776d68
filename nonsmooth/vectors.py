"""Checks and products of vectors that users give in the frame of a body."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from nonsmooth.errors import InvalidInput

_UNIT = 1e-9
_ROUND_OFF = 1e-15
UNIT_PART: Mapping[str, Any] = MappingProxyType({"minimum": -1.0 - 0.5 * _UNIT, "maximum": 1.0 + 0.5 * _UNIT})
"""Bounds of a component of a unit vector, with a margin for round-off."""


def vector(thing: str, value: Sequence[float], size: int, unit: str) -> tuple[float, ...]:
    """Vector as a tuple of ``size`` floats; ``unit`` is for messages.

    Raises
    ------
    InvalidInput
        If the value does not have ``size`` finite components.
    """
    try:
        numbers = tuple(math.nan if isinstance(x, (str, bool)) else float(x) for x in value)
    except (TypeError, ValueError, OverflowError):
        numbers = ()
    if len(numbers) != size or not all(math.isfinite(x) for x in numbers):
        raise InvalidInput(thing, f"must be {size} finite numbers", value, f"Give them in [{unit}].")
    return numbers


def unit_vector(thing: str, value: Sequence[float], size: int = 3) -> tuple[float, ...]:
    """Vector of unit length as a tuple of ``size`` floats, normalised to round-off.

    Raises
    ------
    InvalidInput
        If the value does not have ``size`` finite components, or its length differs from 1 by more than 1e-9.
    """
    numbers = vector(thing, value, size, "1")
    norm = math.sqrt(sum(x * x for x in numbers))
    if abs(norm - 1.0) > _UNIT:
        raise InvalidInput(thing, "must have unit length", list(numbers), f"Divide it by its length {norm:.6g}.")
    # a vector that was normalised before is returned unchanged, to the last bit
    return numbers if abs(norm - 1.0) <= _ROUND_OFF else tuple(x / norm for x in numbers)


def direction(thing: str, value: Sequence[float]) -> tuple[float, ...]:
    """Unit vector along a vector of any length, as a tuple of three floats.

    Raises
    ------
    InvalidInput
        If the value does not have three finite components, or all of them are zero.
    """
    numbers = vector(thing, value, 3, "1")
    norm = math.sqrt(sum(x * x for x in numbers))
    if norm == 0.0:
        raise InvalidInput(thing, "must have a direction", list(numbers), "Give a vector that is not zero.")
    # a vector that was normalised before is returned unchanged, to the last bit
    return numbers if abs(norm - 1.0) <= _ROUND_OFF else tuple(x / norm for x in numbers)


def perpendiculars(axis: Sequence[float]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Two unit vectors t1, t2 that make a right-handed orthonormal triple (axis, t1, t2) with a unit vector."""
    x, y, z = axis
    # the coordinate axis farthest from the direction of ``axis``
    least = min(range(3), key=lambda i: abs(axis[i]))
    other = [1.0 if i == least else 0.0 for i in range(3)]
    first = (other[1] * z - other[2] * y, other[2] * x - other[0] * z, other[0] * y - other[1] * x)
    norm = math.sqrt(sum(c * c for c in first))
    u = tuple(c / norm for c in first)
    return u, (y * u[2] - z * u[1], z * u[0] - x * u[2], x * u[1] - y * u[0])
