"""What the functions of a body say at one state, checked for size and finiteness."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bodies.generalised.equations import GUARD, LEADING, Equations, Part, own_names, places, probe
from nonsmooth.binding.call import body_caller
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.parameters import Value

Vector = NDArray[np.float64]

_SENTINEL = -7.0e250
GRAVITY = {"gravity_x": 1.1, "gravity_y": -2.3, "gravity_z": -9.7}
"""Gravity of the checks [m/s^2], which must hold with any."""


def check_signatures(name: str, parts: Sequence[Part], known: Mapping[str, Value]) -> None:
    """Look at what the functions take, besides their leading arguments out of what is known.

    Raises
    ------
    InvalidInput
        If one is not callable or does not begin with the arguments of its role.
    UnknownName
        If one asks for a constant that nobody gives.
    """
    for _, part, role, function, _ in parts:
        expected = LEADING[role]
        if not inspect.isfunction(function):
            raise InvalidInput(f"{name}.{part}", "must be a plain function", function, f"Write {_form(role)}.")
        taken = tuple(inspect.signature(function).parameters)
        if taken[: len(expected)] != expected:
            raise InvalidInput(
                f"{name}.{part}: {function.__qualname__}", f"must begin with {expected}", taken, f"Write {_form(role)}."
            )
        for own in own_names(function, role):
            if own not in known:
                raise UnknownName(f"{name}.{part}: {function.__qualname__} asks for a constant that", own, known)


def _form(role: str) -> str:
    return f"def {role}({', '.join(LEADING[role])}, ...), then constants by name"


class Sampler:
    """Calls the functions of a body just as the engine does, each with room around what it may write."""

    def __init__(self, name: str, equations: Equations, constants: Mapping[str, Value]) -> None:
        self.name = name
        self.equations = equations
        self.places = places(equations)
        self._functions = {part.name: part.function for part in equations.parts()}
        self._call = body_caller(probe(equations), {**constants, **GRAVITY}, name)
        last, start = self.places[-1]
        self._size = start + last.size + GUARD

    def thing(self, part: str) -> str:
        """Return the name of a function for messages."""
        return f"{self.name}.{part}: {self._functions[part].__qualname__}"

    def __call__(self, q: Vector, u: Vector) -> dict[str, Any]:
        """Return what every function says at t = 0, q and u, by its name.

        Raises
        ------
        InvalidInput
            If one writes beyond its size, reads beyond the coordinates, fails, or a number is not finite.
        """
        out = np.full(self._size, _SENTINEL)
        for part, start in self.places:
            out[start : start + part.size] = 0.0
        beyond = np.full(GUARD, np.nan)
        where = f"at q = {q.tolist()}, u = {u.tolist()}"
        try:
            self._call(0.0, np.concatenate([q, beyond]), np.concatenate([u, beyond]), out)
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:  # in plain mode
            raise InvalidInput(
                f"{self.name}", f"must have functions that do not fail {where}", error, "Look at its functions."
            ) from error
        found = {}
        for part, start in self.places:
            end = start + part.size
            around = np.concatenate([out[start - GUARD : start], out[end : end + GUARD]])
            if np.any(around != _SENTINEL):
                raise InvalidInput(
                    self.thing(part.name),
                    f"must write {part.size} numbers",
                    "written outside of these",
                    "Count rows and columns; indices start at 0.",
                )
            values = out[start:end]
            if not np.all(np.isfinite(values)):
                raise InvalidInput(
                    self.thing(part.name),
                    f"must give finite numbers {where}",
                    values.tolist(),
                    "Look for a division by zero, a root of a negative number, an index beyond the coordinates.",
                )
            found[part.name] = values.copy()
        return found
