"""Vectors and matrices of a tangent plane by their components along its two tangents."""

from __future__ import annotations

from typing import TypeAlias

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import NORMAL, SLIDE_MATRIX, TANGENT, TURN_MATRIX
from nonsmooth.types import Floats

from ...rotations import Axes, rotated_back
from ...shapes.support_function import Bends
from ...vectors import Vector3, cross, dot, plus, scaled, vector_at
from .smooth_core import bend

Pair: TypeAlias = tuple[float, float]
"""Components of a vector of a tangent plane along its two tangents."""
Symmetric: TypeAlias = tuple[float, float, float]
"""Elements 11, 12 and 22 of a symmetric matrix of a tangent plane."""
Matrix: TypeAlias = tuple[float, float, float, float]
"""Elements 11, 12, 21 and 22 of a matrix of a tangent plane."""


@compiled
def in_plane(t: Vector3, u: Vector3, v: Vector3) -> Pair:
    """Return the components of a vector along two tangents."""
    return dot(t, v), dot(u, v)


@compiled
def along(v: Pair, t: Vector3, u: Vector3) -> Vector3:
    """Return the vector with the components v along two tangents."""
    return plus(scaled(v[0], t), scaled(v[1], u))


@compiled
def bends_in_plane(h: Bends, t: Vector3, u: Vector3) -> Symmetric:
    """Return the second derivative of a support function along two tangents [m]."""
    return bend(h, t, t), bend(h, t, u), bend(h, u, u)


@compiled
def from_tangents(t: Vector3, u: Vector3, first: Vector3, second: Vector3) -> Matrix:
    """Return the matrix from components along the tangents ``first`` and ``second`` to those along t and u."""
    return dot(t, first), dot(t, second), dot(u, first), dot(u, second)


@compiled
def determinant(m: Matrix) -> float:
    """Return the determinant of a matrix."""
    return m[0] * m[3] - m[1] * m[2]


@compiled
def solved(m: Matrix, det: float, right: Pair) -> Pair:
    """Return x with m x = right, for a matrix m with the determinant ``det``."""
    return (m[3] * right[0] - m[1] * right[1]) / det, (m[0] * right[1] - m[2] * right[0]) / det


@compiled
def by_symmetric(c: Matrix, s: Symmetric) -> Matrix:
    """Return the product C S."""
    return c[0] * s[0] + c[1] * s[1], c[0] * s[1] + c[1] * s[2], c[2] * s[0] + c[3] * s[1], c[2] * s[1] + c[3] * s[2]


@compiled
def turned_matrix(c: Matrix, s: Symmetric) -> Symmetric:
    """Return C S C^T: the matrix S in the tangents to which C converts."""
    e = by_symmetric(c, s)
    return e[0] * c[0] + e[1] * c[1], e[0] * c[2] + e[1] * c[3], e[2] * c[2] + e[3] * c[3]


@compiled
def tangents_in(axes: Axes, out: Floats) -> tuple[Vector3, Vector3]:
    """Return both tangents of a contact in the axes of a core, whose axes in the world are ``axes``.

    The geometry block ``out`` must already hold normal and first tangent.
    """
    t = vector_at(out, TANGENT)
    return rotated_back(axes, t), rotated_back(axes, cross(vector_at(out, NORMAL), t))


@compiled
def write_matrices(out: Floats, side: int, slide: Symmetric, turn: Symmetric) -> None:
    """Write the curvature matrices of a surface, which satisfy slide u = turn nu.

    If the contact point moves by u along the surface [m], the normal turns by nu [rad].  ``side`` is the index of the
    matrices in the geometry block.
    """
    s, t = side + SLIDE_MATRIX, side + TURN_MATRIX
    out[s], out[s + 3], out[t], out[t + 3] = slide[0], slide[2], turn[0], turn[2]
    out[s + 1], out[s + 2], out[t + 1], out[t + 2] = slide[1], slide[1], turn[1], turn[1]
