"""Rows that joints are made of: a point on a plane of the other body, a right angle, a distance.

A joint is a table of rows, which :func:`evaluate_rows` evaluates one after the other.
"""

from __future__ import annotations

import itertools
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import ClassVar, NamedTuple

import numpy as np

from nonsmooth.compiled import block_at, compiled
from nonsmooth.engine.memory.blocks import (
    ACCELERATION,
    AXIS,
    JOINT_ROW,
    MOMENT,
    POINT_A,
    POINT_B,
    POSITION,
    RESIDUAL,
    ROW_BIAS,
    SPIN,
    SPIN_ACCELERATION,
    VELOCITY,
)
from nonsmooth.interfaces import Joint
from nonsmooth.interfaces.solid import Vector
from nonsmooth.parameters import Value
from nonsmooth.types import Floats
from nonsmooth.vectors import vector

from ..contacts.features.frames import point_in_world, vector_in_world
from ..vectors import Vector3, cross, divided, dot, minus, norm, plus, plus_scaled, scaled, vector_at, write_vector

Point = tuple[float, float, float]
_WIDTH = 10
"""Number of floats of a row in the table: its kind and three vectors."""
AXES: tuple[Point, Point, Point] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""Unit vectors of the axes of a frame."""


class RowKind(IntEnum):
    """Kinds of scalar conditions between two bodies, of which a joint is made."""

    ON_PLANE = 0
    """A point of the second body stays on a plane of the first one."""
    RIGHT_ANGLE = 1
    """Two directions, each fixed in its frame, keep a right angle."""
    AT_DISTANCE = 2
    """Two points keep their distance."""


class JointRow(NamedTuple):
    """One scalar condition of a joint: kind, a vector in the frame of each body, and a third vector.

    - on a plane: a point of each body [m], and the normal of the plane in the frame of the first body;
    - right angle: a direction in each body;
    - at a distance: a point of each body [m], and the distance as first component of the third vector [m].
    """

    kind: RowKind
    first: Sequence[float]
    second: Sequence[float]
    third: Sequence[float] = (0.0, 0.0, 0.0)


def on_planes(first: Sequence[float], second: Sequence[float], normals: Sequence[Sequence[float]]) -> list[JointRow]:
    """Rows that keep a point of the second body on planes through a point of the first one.

    Points are in the frames of their bodies [m], normals in the frame of the first body.
    """
    return [JointRow(RowKind.ON_PLANE, first, second, normal) for normal in normals]


def right_angle(first: Sequence[float], second: Sequence[float]) -> JointRow:
    """Row that keeps a right angle between two directions, each fixed in the frame of its body."""
    return JointRow(RowKind.RIGHT_ANGLE, first, second)


def parallel_axes(axes: Sequence[Sequence[float]], seen: Sequence[Sequence[float]]) -> list[JointRow]:
    """Rows that keep two bodies from turning relative to each other.

    ``axes`` are three perpendicular directions in the frame of the first body, ``seen`` the same three in the frame of
    the second body.
    """
    return [right_angle(axes[i], seen[(i + 1) % 3]) for i in range(3)]


@compiled
def _velocity(frame: Floats, d: Vector3) -> Vector3:
    """Return the velocity of a point fixed in a frame, at the offset d [m] from the origin of the frame [m/s]."""
    v, w = vector_at(frame, VELOCITY), vector_at(frame, SPIN)
    return (
        v[0] + w[1] * d[2] - w[2] * d[1],
        v[1] + w[2] * d[0] - w[0] * d[2],
        v[2] + w[0] * d[1] - w[1] * d[0],
    )


@compiled
def _acceleration(frame: Floats, d: Vector3) -> Vector3:
    """Return the acceleration of a point fixed in a frame, at the offset d [m] from the origin of the frame [m/s^2].

    Its centripetal part is omega x (omega x d) = omega (omega . d) - d omega^2.
    """
    a, w, turn = vector_at(frame, ACCELERATION), vector_at(frame, SPIN), vector_at(frame, SPIN_ACCELERATION)
    along = dot(w, d)
    carried = (
        a[0] + turn[1] * d[2] - turn[2] * d[1] + w[0] * along,
        a[1] + turn[2] * d[0] - turn[0] * d[2] + w[1] * along,
        a[2] + turn[0] * d[1] - turn[1] * d[0] + w[2] * along,
    )
    return plus_scaled(carried, -dot(w, w), d)


@compiled
def _write_row(out: Floats, residual: float, axis: Vector3, moment: Vector3, bias: float) -> None:
    out[RESIDUAL], out[ROW_BIAS] = residual, bias
    write_vector(out, AXIS, axis)
    write_vector(out, MOMENT, moment)


@compiled
def point_row(a: Floats, b: Floats, out: Floats, first: Vector3, second: Vector3, axis: Vector3) -> None:
    """Write the row of axis . (P_b - P_a) = 0: points and axis are fixed in their frames, the axis in the first."""
    n, offset = vector_in_world(a, axis), vector_in_world(b, second)
    point = plus(vector_at(b, POSITION), offset)
    # both sides move with the point of the second body, as seen from the first
    write_vector(out, POINT_A, point)
    write_vector(out, POINT_B, point)
    d_a, d_b = minus(point, vector_at(a, POSITION)), minus(point, vector_at(b, POSITION))
    # acceleration of the second body's point relative to the turning frame of the first
    rate = minus(_velocity(b, d_b), _velocity(a, d_a))
    acceleration = minus(_acceleration(b, d_b), _acceleration(a, d_a))
    acceleration = plus_scaled(acceleration, -2.0, cross(vector_at(a, SPIN), rate))
    residual = dot(n, minus(d_a, vector_in_world(a, first)))
    _write_row(out, residual, n, (0.0, 0.0, 0.0), dot(n, acceleration))


@compiled
def angle_row(a: Floats, b: Floats, out: Floats, first: Vector3, second: Vector3) -> None:
    """Write the row of e_a . e_b = 0: two directions, each fixed in its frame, keep a right angle."""
    e_a, e_b = vector_in_world(a, first), vector_in_world(b, second)
    w_a, w_b, residual = vector_at(a, SPIN), vector_at(b, SPIN), dot(e_a, e_b)
    # kept where the points of the row would be: a row of angles has none
    write_vector(out, POINT_A, e_a)
    write_vector(out, POINT_B, e_b)
    moment = cross(e_b, e_a)
    # (omega_b x e_b) x e_a + e_b x (omega_a x e_a), the rate of the moment
    turned = plus_scaled(plus_scaled(scaled(dot(w_b, e_a), e_b), -residual, w_b), residual, w_a)
    turned = plus_scaled(turned, -dot(w_a, e_b), e_a)
    spin, turn = minus(w_b, w_a), minus(vector_at(b, SPIN_ACCELERATION), vector_at(a, SPIN_ACCELERATION))
    bias = 0.0
    for i in range(3):
        bias += turn[i] * moment[i] + spin[i] * turned[i]
    _write_row(out, residual, (0.0, 0.0, 0.0), moment, bias)


@compiled
def distance_row(a: Floats, b: Floats, out: Floats, first: Vector3, second: Vector3, length: float) -> None:
    """Write the row of |P_b - P_a| = length."""
    point_a, point_b = point_in_world(a, first), point_in_world(b, second)
    write_vector(out, POINT_A, point_a)
    write_vector(out, POINT_B, point_b)
    apart = minus(point_b, point_a)
    distance = norm(apart)
    n, d_a, d_b = (
        divided(apart, distance),
        minus(point_a, vector_at(a, POSITION)),
        minus(point_b, vector_at(b, POSITION)),
    )
    rate = minus(_velocity(b, d_b), _velocity(a, d_a))
    acceleration = minus(_acceleration(b, d_b), _acceleration(a, d_a))
    stretch = dot(n, rate)
    bias = dot(n, acceleration) + (dot(rate, rate) - stretch * stretch) / distance
    _write_row(out, distance - length, n, (0.0, 0.0, 0.0), bias)


def evaluate_rows(a: Floats, b: Floats, out: Floats, n_rows: float, rows: Floats) -> None:
    """Write the rows of a joint to ``out``: residual, axis, moment, points and bias of each condition.

    ``rows`` is the table of the conditions between the frames ``a`` and ``b`` of the first and the second body.  The
    layout of ``out`` is explained in :mod:`nonsmooth.engine.memory.blocks`.
    """
    for i in range(int(n_rows)):
        row, own = _WIDTH * i, block_at(out, JOINT_ROW * i)
        kind, first, second = int(rows[row]), vector_at(rows, row + 1), vector_at(rows, row + 4)
        if kind == RowKind.ON_PLANE:
            point_row(a, b, own, first, second, vector_at(rows, row + 7))
        elif kind == RowKind.RIGHT_ANGLE:
            angle_row(a, b, own, first, second)
        else:
            distance_row(a, b, own, first, second, rows[row + 7])


@dataclass(frozen=True)
class RowsJoint(Joint, ABC):
    """A joint that is a table of rows; subclasses are final and give ``rows``.

    Attributes
    ----------
    first, second : tuple of float
        A point in the frame of the first and of the second body [m], shape [3].
    """

    first: Point = (0.0, 0.0, 0.0)
    second: Point = (0.0, 0.0, 0.0)
    evaluator: ClassVar[Callable[..., None]] = staticmethod(evaluate_rows)

    def _check(self) -> None:
        self.parameters()

    @property
    @abstractmethod
    def rows(self) -> Sequence[JointRow]:
        """Scalar conditions of the joint, one for each degree of freedom that it removes."""

    def parameters(self) -> Mapping[str, Value]:
        """Return the number of rows and the table of the rows, for the evaluator."""
        for name in ("first", "second"):
            vector(f"{type(self).__name__}.{name}", getattr(self, name), 3, "m")
        rows = self.rows
        numbers = (float(x) for row in rows for x in itertools.chain((row.kind,), *row[1:]))
        return {"n_rows": float(len(rows)), "rows": tuple(numbers)}

    @property
    def n_rows(self) -> int:
        """Number of rows: the degrees of freedom that the joint removes."""
        return len(self.rows)

    @property
    def ends(self) -> Vector:
        """Positions of the joint in pictures, one in the frame of the first and one in that of the second body [m].

        Shape [2, 3].
        """
        return np.array([self.first, self.second], dtype=float)
