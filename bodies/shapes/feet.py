"""Three small feet on a flat round face: what a body that lies on it stands on."""

from __future__ import annotations

import math

from bodies.shapes.placement import turned
from nonsmooth.errors import InvalidInput

FEET = 3
"""Feet of one face: the least that hold it, and the most whose normal forces are unique."""
CIRCLE = 2.0 / 3.0
"""Radius of the circle of feet over that of the face.

Friction takes as much of a spin about the axis as under an even pressure, mu m g 2 R / 3.
"""
USUAL = 1e-4
"""Height of feet over the radius of the face where none is given."""
HIGHEST = 0.1
"""Largest height of feet over the radius of the face."""

Point = tuple[float, float, float]


def check_feet(name: str, foot_height: float, radius: float, half_length: float = math.inf) -> None:
    """Raise InvalidInput unless the feet are small against the face and shorter than the body."""
    if foot_height > HIGHEST * radius:
        raise InvalidInput(
            f"{name}.foot_height",
            f"must be at most a tenth of the radius, {HIGHEST * radius:g} [m]",
            foot_height,
            "Feet are to hold a flat body, not to change its shape: a ten-thousandth of the radius is usual.",
        )
    if foot_height >= half_length:
        raise InvalidInput(
            f"{name}.foot_height",
            f"must be less than half the length, {half_length:g} [m]",
            foot_height,
            "The rims are set back by it; a disc has no thickness.",
        )


def feet_on(center: Point, axis: Point, radius: float, reach: float) -> tuple[Point, ...]:
    """Return the tips of the feet of both faces, first those against the axis [m].

    Parameters
    ----------
    center, axis : tuple of float
        Of the disc or cylinder in the body frame [m and 1].
    radius : float
        Radius of the faces [m].
    reach : float
        Distance of the tips from the centre along the axis [m].
    """
    first, length = _across(axis), CIRCLE * radius
    tips: list[Point] = []
    for along in (-reach, reach):
        for foot in range(FEET):
            half = math.pi * foot / FEET
            w, s = math.cos(half), math.sin(half)
            x, y, z = turned(w, s * axis[0], s * axis[1], s * axis[2], *first)
            tips.append(
                (
                    center[0] + along * axis[0] + length * x,
                    center[1] + along * axis[1] + length * y,
                    center[2] + along * axis[2] + length * z,
                )
            )
    return tuple(tips)


def _across(axis: Point) -> Point:
    """Return a unit vector across the axis; the first body axis for the third."""
    x, y, z = axis
    if abs(y) <= max(abs(x), abs(z)):
        size = math.hypot(x, z)
        return z / size, 0.0, -x / size
    size = math.hypot(y, z)
    return 0.0, -z / size, y / size
