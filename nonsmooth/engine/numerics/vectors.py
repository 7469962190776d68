"""Vectors of two and three numbers. They are tuples, which the compiler keeps in registers."""

from __future__ import annotations

import math
from typing import TypeAlias

from nonsmooth.engine.native.kernel import kernel

Pair: TypeAlias = tuple[float, float]
"""A vector of a tangent plane, ``v2`` in signatures."""
Vector: TypeAlias = tuple[float, float, float]
"""A vector of space, ``v3`` in signatures."""
ALIKE = 1e-5
"""Largest difference of two unit vectors that count as equal.

Contacts coincide if their normals differ by no more, and their points by no more relative to the size of the smaller
body. The relative error of the energy of an approach is its square, which is below the energy tolerances.
"""


@kernel("f8(v2)")
def length(v: Pair) -> float:
    """Length of a vector of the plane."""
    return math.sqrt(v[0] * v[0] + v[1] * v[1])


@kernel("v2(v2)")
def unit(v: Pair) -> Pair:
    """Unit vector along a vector of the plane. A zero vector has no direction: the first tangent, (1, 0), serves."""
    size = length(v)
    return (v[0] / size, v[1] / size) if size > 0.0 else (1.0, 0.0)


@kernel("v3(v3, v3)")
def minus(a: Vector, b: Vector) -> Vector:
    """Difference a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@kernel("v3(v3)")
def opposite(a: Vector) -> Vector:
    """Opposite vector -a."""
    return -a[0], -a[1], -a[2]


@kernel("v3(f8, v3)")
def scaled(factor: float, a: Vector) -> Vector:
    """Multiple of a vector."""
    return factor * a[0], factor * a[1], factor * a[2]


@kernel("f8(v3, v3)")
def dot(a: Vector, b: Vector) -> float:
    """Scalar product a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel("f8(v3, v3)")
def distance(a: Vector, b: Vector) -> float:
    """Length of a - b."""
    difference = minus(a, b)
    return math.sqrt(dot(difference, difference))


@kernel("b1(v3, v3)")
def are_alike(a: Vector, b: Vector) -> bool:
    """True if two unit vectors differ by at most ``ALIKE``."""
    # the length of a small difference of two unit vectors is the angle between them [rad]
    return distance(a, b) <= ALIKE


@kernel("v3(v3, v3)")
def cross(a: Vector, b: Vector) -> Vector:
    """Vector product a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
