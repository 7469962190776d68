"""Gravity, as a user gives it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.parameters import Rule, check_number
from nonsmooth.vectors import vector

_THING, _UNIT, _LARGEST = "System.gravity", "m/s^2", 1e4


def gravity_of(value: float | Sequence[float]) -> tuple[float, float, float]:
    """Return the vector of gravity [m/s^2] that a number, along -z, or a vector means.

    Raises
    ------
    InvalidInput
        If it is neither, not finite or larger than 1e4 m/s^2, or a number below 0.
    """
    if np.shape(value) != ():
        x, y, z = vector(_THING, cast("Sequence[float]", value), 3, _UNIT)
    else:
        check_number(_THING, value, Rule("gravity along -z, or a vector", _UNIT, -_LARGEST, _LARGEST))
        x, y, z = 0.0, 0.0, -float(cast("float", value))
        if z > 0.0:
            remedy = f"Give {z:g}, or a vector where it does not point down: (0.0, 0.0, {z:g}) points up."
            raise InvalidInput(_THING, f"must be >= 0 [{_UNIT}], as it counts along -z", value, remedy)
    if max(abs(x), abs(y), abs(z)) > _LARGEST:
        raise InvalidInput(_THING, f"must be of at most {_LARGEST:g} [{_UNIT}]", value, "Is the unit right?")
    return x, y, z
