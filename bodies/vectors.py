"""Vectors of three numbers in functions that the engine compiles; they are tuples, which stay in registers."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats, ReadFloats

Vector3: TypeAlias = tuple[float, float, float]
"""A vector of three numbers, as compiled functions take and return it."""


@compiled
def vector_at(table: ReadFloats, place: int) -> Vector3:
    """Return the vector that begins at a place of a block or table."""
    return table[place], table[place + 1], table[place + 2]


@compiled
def write_vector(out: Floats, place: int, v: Vector3) -> None:
    """Write a vector, or a row of a matrix, from a place of a block on."""
    out[place], out[place + 1], out[place + 2] = v


@compiled
def plus(a: Vector3, b: Vector3) -> Vector3:
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@compiled
def minus(a: Vector3, b: Vector3) -> Vector3:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@compiled
def scaled(factor: float, a: Vector3) -> Vector3:
    """Return a multiple of a vector."""
    return factor * a[0], factor * a[1], factor * a[2]


@compiled
def plus_scaled(a: Vector3, way: float, along: Vector3) -> Vector3:
    """Return a + way along, such as the point at a distance from a in the direction of a unit vector."""
    return a[0] + way * along[0], a[1] + way * along[1], a[2] + way * along[2]


@compiled
def divided(a: Vector3, divisor: float) -> Vector3:
    """Return a vector divided by a number."""
    return a[0] / divisor, a[1] / divisor, a[2] / divisor


@compiled
def opposite(a: Vector3) -> Vector3:
    """Return -a."""
    return -a[0], -a[1], -a[2]


@compiled
def dot(a: Vector3, b: Vector3) -> float:
    """Return the scalar product a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def cross(a: Vector3, b: Vector3) -> Vector3:
    """Return the vector product a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled
def norm(a: Vector3) -> float:
    """Return the length of a vector."""
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
