"""Properties of shapes; what they do in a contact is looked at with the kinematics of their pairs."""

from __future__ import annotations

import math

from nonsmooth.interfaces import Shape
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.property import Broken, Property, properties


def check_shape(shape: Shape) -> list[Property]:
    """Return the properties of a shape.

    Parameters
    ----------
    shape : Shape
        The shape.
    """
    rows = [
        ("length", "its length is finite and not negative", lambda: _check_length(shape)),
        ("extent", "a ball of its extent holds what is as far away as its length", lambda: _check_extent(shape)),
    ]
    return properties(shape, [*component_rows(shape), *rows])


def _check_length(shape: Shape) -> None:
    if not (math.isfinite(shape.length) and shape.length >= 0.0):
        raise Broken("it must be finite and not negative [m]", "length", shape.length)


def _check_extent(shape: Shape) -> None:
    if not shape.extent >= shape.length:
        raise Broken(f"it must not be below the length {shape.length:g} m", "extent", shape.extent)
