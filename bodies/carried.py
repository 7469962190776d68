"""Shapes that a user gives a body to carry."""

from __future__ import annotations

from typing import Any

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Shape


def check_carried(thing: str, shapes: Any) -> tuple[Shape, ...]:
    """Return the shapes as a tuple.

    Raises
    ------
    InvalidInput
        If it is not a sequence of Shape objects.
    """
    remedy = "Give shapes, for example (Sphere(0.01), Sphere(0.01, x=0.05))."
    if isinstance(shapes, Shape) or not isinstance(shapes, (tuple, list)):
        raise InvalidInput(thing, "must be a tuple of shapes", shapes, remedy)
    for shape in shapes:
        if not isinstance(shape, Shape):
            raise InvalidInput(thing, "must contain shapes only", shape, remedy)
    return tuple(shapes)
