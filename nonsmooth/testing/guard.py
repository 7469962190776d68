"""Conformance checks of guards: the value is continuous while the state changes.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import numpy as np

from nonsmooth.interfaces import Guard
from nonsmooth.testing.claims import GIVEN, claim, rows
from nonsmooth.testing.differences import jump
from nonsmooth.testing.functions import CheckedFunction, all_rows, plain_caller
from nonsmooth.testing.inputs import Case, Drawn, DrawnNumber, draws
from nonsmooth.testing.outcome import Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.types import Array

_NUMBERS, _DRAWS = 24, 24
_WHILE = 0.5
"""The value of the guard is searched for jumps from this time before each input to this time after it [s]. In this time
a coordinate changes by up to 0.5."""


def check_guard(guard: Guard, *, numbers: int = _NUMBERS) -> list[Property]:
    """Return the properties that every guard must have, each with its check of this guard.

    Parameters
    ----------
    guard : Guard
        The guard; it is checked with coordinates and velocities between -1 and 1.
    numbers : int, optional
        Number of coordinates, and of velocities, that the guard is given.
    """
    return properties(guard, _rows, numbers=numbers)


def _rows(guard: Guard, numbers: int) -> list[Row]:
    found = rows([_no_jumps], lambda: [guard], _DRAWS, [_state_of(numbers)])
    return all_rows(guard, lambda: [_value(guard, numbers)], found)


def _state_of(numbers: int) -> Drawn:
    found = [DrawnNumber("t", 0.0, 1.0)]
    for letter in "qu":
        found += [DrawnNumber(f"{letter}{i + 1}", -1.0, 1.0, 0.1 * (i % 7 - 3)) for i in range(numbers)]
    return Drawn(tuple(found), dict)


def _state(case: Case, dt: float = 0.0) -> tuple[float, Array, Array]:
    q, u = (np.array([value for name, value in case.items() if name.startswith(letter)]) for letter in "qu")
    # an artificial motion in which every entry of q and u changes: the rate of q is u, and the rate of u is q in
    # reverse order. It need not be a motion of a system, since the guard is checked as a function of t, q and u
    return case["t"] + dt, q + dt * u, u + dt * q[::-1]


def _value(guard: Guard, numbers: int) -> CheckedFunction:
    inputs = [(f"t = {case['t']:.3g}, q, u", _state(case)) for case in draws([_state_of(numbers)], 8)]
    return CheckedFunction(guard, "value", "guard", guard.parameters(), inputs)


@claim(GIVEN)
def _no_jumps(guard: Guard, case: Case) -> str:
    """The value of the guard is continuous while the state changes."""
    call = plain_caller(guard.value, "guard", guard.parameters())
    found = jump(lambda dt: [call(*_state(case, dt))], -_WHILE, _WHILE)
    return "" if found is None else f"{found[0]:.6g} s after the input it jumps by {found[1][0]:g}"
