"""A shape, moved within its body."""

from __future__ import annotations

import dataclasses

import numpy as np

from bodies.values import product
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.rotations import rotation


def moved(shape: Shape, position: Vector, orientation: Vector) -> Shape:
    """Return the shape turned by a unit quaternion about the origin of its frame, then shifted.

    A shape says where it stands by its parameters x, y, z [m] and, if it is no sphere, by a unit axis (axis_x, ...) or
    a unit quaternion (orientation_w, ...) in the axes of its body.

    Raises
    ------
    InvalidInput
        If the shape has no x, y, z, as an unbounded plane.
    """
    numbers = shape.parameters()
    if not {"x", "y", "z"} <= set(numbers):
        raise InvalidInput(
            "shape of a part",
            "must have a centre with parameters x, y, z",
            type(shape).__name__,
            "An unbounded shape cannot be moved within a body.",
        )
    turn = rotation(orientation)
    changed = _vector(numbers, "", turn, position)
    if "axis_x" in numbers:
        changed |= _vector(numbers, "axis_", turn, np.zeros(3))
    if "orientation_w" in numbers:
        own = np.array([numbers[f"orientation_{letter}"] for letter in "wxyz"])
        whole = product(orientation, own)
        whole /= np.linalg.norm(whole)
        changed |= {f"orientation_{letter}": x for letter, x in zip("wxyz", whole.tolist(), strict=True)}
    return dataclasses.replace(shape, **changed)  # type: ignore[type-var]


def _vector(numbers: dict[str, float], prefix: str, turn: Vector, shift: Vector) -> dict[str, float]:
    before = np.array([numbers[prefix + letter] for letter in "xyz"])
    return {prefix + letter: x for letter, x in zip("xyz", (turn @ before + shift).tolist(), strict=True)}
