"""Properties of guards."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.interfaces import Guard
from nonsmooth.testing.callers import compiled_caller, plain_caller
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.draws import Case, Variable, draws
from nonsmooth.testing.examine import examine
from nonsmooth.testing.functions import Function, Functions
from nonsmooth.testing.jumps import jump
from nonsmooth.testing.moving import Array
from nonsmooth.testing.property import Property, properties

_NUMBERS = 24
_DRAWS = 24
_WHILE = 0.5


def check_guard(guard: Guard, *, numbers: int = _NUMBERS) -> list[Property]:
    """Return the properties of a guard.

    Parameters
    ----------
    guard : Guard
        The guard; it is looked at with coordinates and velocities between -1 and 1.
    numbers : int, optional
        How many coordinates, and as many velocities, it is given.
    """
    functions = Functions(lambda: [_value(guard, numbers)])
    rows = [
        (
            "no jumps",
            "its value is continuous where the state moves",
            lambda: examine("no jumps", [guard], _space(numbers), _jumps, _DRAWS),
        )
    ]
    return properties(guard, [*component_rows(guard), *functions.rows(), *functions.guarded(rows)])


def _space(numbers: int) -> list[Variable]:
    space = [Variable("t", 0.0, 1.0)]
    for letter in ("q", "u"):
        space += [Variable(f"{letter}{i + 1}", -1.0, 1.0, 0.1 * (i % 7 - 3)) for i in range(numbers)]
    return space


def _state(case: Case, dt: float = 0.0) -> tuple[float, Array, Array]:
    q, u = (np.array([value for name, value in case.items() if name.startswith(letter)]) for letter in "qu")
    # velocities that stay have the coordinates move; the velocities move, too, by numbers of their own
    return case["t"] + dt, q + dt * u, u + dt * q[::-1]


def _value(guard: Guard, numbers: int) -> Function:
    inputs = [(f"t = {case['t']:.3g}, q, u", _state(case)) for case in draws(_space(numbers), 8, "states")]
    offered, function = guard.parameters(), guard.value

    def compiled() -> Callable[[Any], Any]:
        call = compiled_caller(function, "guard", offered, type(guard).__name__)
        return lambda at: call(*at)

    def plain(at: Any) -> Any:
        return plain_caller(function, "guard", offered)(*at)

    return Function(guard, "value", function, "guard", offered, plain, compiled, inputs)


def _jumps(guard: Guard, case: Case) -> str:
    call = plain_caller(guard.value, "guard", guard.parameters())
    found = jump(lambda dt: [call(*_state(case, dt))], -_WHILE, _WHILE)
    return "" if found is None else f"{found[0]:.6g} s after the input it jumps by {found[1][0]:g}"
