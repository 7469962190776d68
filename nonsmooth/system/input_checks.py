"""Checks of the inputs of a system: gravity, bodies, and their starts."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, cast

import numpy as np

from nonsmooth.checks import check_kind, floats
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import Rule, check_number
from nonsmooth.plugins import registry
from nonsmooth.vectors import vector

_GRAVITY, _GRAVITY_UNIT, _LARGEST = "System.gravity", "m/s^2", 1e4


def gravity_of(value: float | Sequence[float]) -> tuple[float, float, float]:
    """Vector of gravity [m/s^2] from a number, which counts along -z, or from a vector.

    Raises
    ------
    InvalidInput
        If a vector has not 3 components, a component is not finite or above 1e4 m/s^2, or a number is negative.
    """
    if np.shape(value) != ():
        x, y, z = vector(_GRAVITY, cast("Sequence[float]", value), 3, _GRAVITY_UNIT)
    else:
        check_number(_GRAVITY, value, Rule("gravity along -z, or a vector", _GRAVITY_UNIT, -_LARGEST, _LARGEST))
        x, y, z = 0.0, 0.0, -float(cast("float", value))
        if z > 0.0:
            remedy = f"Give {z:g}, or a vector where it does not point down: (0.0, 0.0, {z:g}) points up."
            raise InvalidInput(_GRAVITY, f"must be >= 0 [{_GRAVITY_UNIT}], as it counts along -z", value, remedy)
    if max(abs(x), abs(y), abs(z)) > _LARGEST:
        raise InvalidInput(_GRAVITY, f"must be of at most {_LARGEST:g} [{_GRAVITY_UNIT}]", value, "Is the unit right?")
    return x, y, z


_UNIT = 1e-9
"""Allowed deviation of a quaternion's length from 1, above the round-off that a division by its norm leaves."""


def check_bodies(bodies: Sequence[Body]) -> None:
    """Raise InvalidInput if there is no body, an entry is not a Body, or a body is listed twice."""
    check_kind("System.bodies", bodies, Collection, "Write System([ball, plate]).")
    for body in bodies:
        several = "Unpack a list of bodies by a star: System([plate, *balls])."
        check_kind("System.bodies: each", body, Body, several if isinstance(body, (list, tuple)) else _instead(body))
    if len({id(body) for body in bodies}) != len(bodies) or not bodies:
        raise InvalidInput(
            "System.bodies",
            "must be at least one body, each once",
            [type(b).__name__ for b in bodies],
            "Make a new object for another body of the same kind.",
        )


def stranger(where: str, given: Any) -> InvalidInput:
    """Error for an argument that is not a body of the system."""
    if isinstance(given, Body):
        remedy = "Add it to System([...]) first."
    elif isinstance(given, (list, tuple)):
        remedy = "Give one body at a time, for example in a loop."
    else:
        remedy = _instead(given)
    return InvalidInput(where, "needs a body of this system", given, remedy)


def _instead(given: Any) -> str:
    if isinstance(given, type):
        return f"Make an object of the class: {given.__name__}(...)."
    if isinstance(given, Shape):
        # a body that consists of one shape is installed under the name of the shape
        name = registry.name_of(type(given)) or ""
        known = [registry.load("bodies", name).__name__] if name in registry.names("bodies") else []
        return f"That is a shape; take a body that has it: {' or '.join([*known, 'one of `nonsmooth list bodies`'])}."
    return "Give the object of a body."


def start_of(body: Body, name: str, q: Vector, u: Vector) -> tuple[Vector, Vector]:
    """Coordinates and velocities of a body as new arrays.

    Raises
    ------
    InvalidInput
        If a vector has the wrong number of entries, an entry is not finite, or the length of a quaternion is not 1.
    """
    given = []
    for letter, value, size in (("q", q, body.n_q), ("u", u, body.n_u)):
        numbers = floats(f"System.set_start: {letter}", value)
        if numbers.shape != (size,) or not np.all(np.isfinite(numbers)):
            rule = f"must be {size} finite numbers"
            raise InvalidInput(f"System.set_start: {letter}", rule, value, "See Body.state.")
        given.append(numbers)
    check_quaternion(f"System.set_start: q of {name!r}", body, given[0])
    return given[0], given[1]


def check_quaternion(thing: str, body: Body, q: Vector) -> None:
    """Raise InvalidInput if the length of a body's quaternion is not 1. Bodies without a quaternion pass."""
    if body.quaternion < 0:
        return
    length = float(np.linalg.norm(q[body.quaternion : body.quaternion + 4]))
    if not abs(length - 1.0) <= _UNIT:
        which = f"{thing}: the quaternion q[{body.quaternion}:{body.quaternion + 4}]"
        raise InvalidInput(which, "must have unit length", length, "Divide it by its norm.")
