"""Checks of vectors, quaternions and shapes that a user gives to bodies and motions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from nonsmooth import vectors
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.rotations import rotation

Word = tuple[int, Any, str]
"""Size (0 for a single number), default and unit of a word of a start."""

_UNIT_TOLERANCE = 1e-9
_ROUND_OFF = 1e-15
_QUATERNION = "must be a unit quaternion, scalar first: (cos(angle / 2), axis * sin(angle / 2))"
_AXIS_AND_ANGLE = "Write nonsmooth.turned_about(axis, angle), the angle in [rad]."


def vector(thing: str, value: Any, size: int, unit: str) -> Vector:
    """Return ``value`` as an array of ``size`` finite floats, or of shape [] where the size is 0.

    Raises
    ------
    InvalidInput
        If it has another shape or a number that is not finite.
    """
    if size:
        return np.array(vectors.vector(thing, value, size, unit))
    try:
        return np.array(vectors.vector(thing, (value,), 1, unit)[0])
    except InvalidInput:
        raise InvalidInput(thing, "must be a finite number", value, f"Give it in [{unit}].") from None


def direction(thing: str, value: Any) -> Vector:
    """Return the unit vector along ``value``, shape [3]; raise InvalidInput if it is zero or not three floats."""
    return np.array(vectors.direction(thing, value))


def unit_quaternion(thing: str, value: Any) -> Vector:
    """Return ``value`` as a unit quaternion (scalar first), normalised; raise InvalidInput if it is not one."""
    try:
        array = vector(thing, value, 4, "1")
    except InvalidInput:
        raise InvalidInput(thing, f"{_QUATERNION}, of finite numbers", value, _AXIS_AND_ANGLE) from None
    norm = float(np.linalg.norm(array))
    if abs(norm - 1.0) > _UNIT_TOLERANCE:
        raise InvalidInput(thing, _QUATERNION, array.tolist(), f"Divide it by its length {norm:.6g}. {_AXIS_AND_ANGLE}")
    # one that was normalised before stays the same to the last bit
    return array if abs(norm - 1.0) <= _ROUND_OFF else array / norm


def turned_back(quaternion: Any, value: Any) -> tuple[float, ...]:
    """Return a vector as a frame of the given unit quaternion (scalar first) sees it."""
    return tuple((rotation(quaternion).T @ np.asarray(value)).tolist())


_CHECKS: dict[str, Callable[[str, Any], Vector]] = {
    "direction": direction,
    "axis": direction,
    "normal": direction,
    "orientation": unit_quaternion,
    "velocity": lambda thing, value: vector(thing, value, 3, "m/s"),
}
"""Checks of the fields of bodies and motions by name; all others are positions in [m]."""


def check_fields(component: Any, *names: str) -> None:
    """Check fields of a frozen component, named after what they are, and keep them as tuples of floats.

    Raises
    ------
    InvalidInput
        A value is not a vector, unit vector or unit quaternion, as its name says.
    """
    for name in names:
        thing, value = f"{type(component).__name__}.{name}", getattr(component, name)
        checked = _CHECKS[name](thing, value) if name in _CHECKS else vector(thing, value, 3, "m")
        object.__setattr__(component, name, tuple(checked.tolist()))


def read_start(name: str, words: Mapping[str, Word], start: Mapping[str, Any]) -> dict[str, Vector]:
    """Return the values of all words of a start, given or by default.

    Parameters
    ----------
    name : str
        The body, for messages.
    words : mapping of str to Word
        The words that the body knows.
    start : mapping of str to object
        What the user gave.

    Raises
    ------
    UnknownName
        If a word is not known.
    InvalidInput
        If a value has another shape or a number that is not finite.
    """
    for word in start:
        if word not in words:
            raise UnknownName(f"start of {name}: keyword", word, words)
    given = {word: start.get(word, default) for word, (_, default, _) in words.items()}
    return {
        word: unit_quaternion(f"{word} of {name}", given[word])
        if word == "orientation"
        else vector(f"{word} of {name}", given[word], size, unit)
        for word, (size, _, unit) in words.items()
    }


def product(p: Any, q: Any) -> Vector:
    """Return the product of two quaternions (scalar first): the turn q, then the turn p."""
    a, b, c, d = (float(x) for x in p)
    e, f, g, h = (float(x) for x in q)
    return np.array(
        [
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g + c * e + d * f - b * h,
            a * h + d * e + b * g - c * f,
        ]
    )


def check_carried(thing: str, shapes: Any) -> tuple[Shape, ...]:
    """Return the shapes of a body as a tuple, after a check.

    Raises
    ------
    InvalidInput
        The user gave something else than a tuple or list of Shape objects.
    """
    remedy = "Give shapes, for example (Sphere(0.01), Sphere(0.01, x=0.05))."
    if isinstance(shapes, Shape) or not isinstance(shapes, (tuple, list)):
        raise InvalidInput(thing, "must be a tuple of shapes", shapes, remedy)
    for shape in shapes:
        if not isinstance(shape, Shape):
            raise InvalidInput(thing, "must contain shapes only", shape, remedy)
    return tuple(shapes)


def keep_carried(body: Any) -> None:
    """Check the field ``carried`` of a frozen body, its shapes, and keep it as a tuple."""
    object.__setattr__(body, "carried", check_carried(f"{type(body).__name__}.carried", body.carried))
