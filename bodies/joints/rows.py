"""Rows that joints are made of: a point on a plane of the other body, a right angle, a distance.

A joint is a table of rows, which :func:`evaluate_rows` evaluates one after the other.
"""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

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
    ROTATION,
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
    def evaluator(self) -> Callable[..., None]:
        """Function that writes the joint's rows: residual, axis, moment and bias of each."""
        return evaluate_rows

    @property
    def ends(self) -> Vector:
        """Positions of the joint in pictures, one in the frame of the first and one in that of the second body [m].

        Shape [2, 3].
        """
        return np.array([self.first, self.second], dtype=float)


def evaluate_rows(a: Floats, b: Floats, out: Floats, n_rows: float, rows: Floats) -> None:
    """Write the rows of a joint to ``out``: residual, axis, moment, points and bias of each condition.

    ``rows`` is the table of the conditions between the frames ``a`` and ``b`` of the first and the second body.  The
    layout of ``out`` is explained in :mod:`nonsmooth.engine.memory.blocks`.
    """
    for i in range(int(n_rows)):
        row = _WIDTH * i
        kind, first, second = int(rows[row]), block_at(rows, row + 1), block_at(rows, row + 4)
        if kind == RowKind.ON_PLANE:
            point_row(a, b, out, i, first, second, block_at(rows, row + 7))
        elif kind == RowKind.RIGHT_ANGLE:
            angle_row(a, b, out, i, first, second)
        else:
            distance_row(a, b, out, i, first, second, rows[row + 7])


@compiled
def _along(frame: Floats, out: Floats, place: int) -> float:
    """Return omega . d, with the offset d of the point at index ``place`` of ``out`` from the origin of a frame."""
    return (
        frame[SPIN] * (out[place] - frame[POSITION])
        + frame[SPIN + 1] * (out[place + 1] - frame[POSITION + 1])
        + frame[SPIN + 2] * (out[place + 2] - frame[POSITION + 2])
    )


@compiled
def _square(frame: Floats) -> float:
    """Return omega^2 of a frame."""
    return frame[SPIN] * frame[SPIN] + frame[SPIN + 1] * frame[SPIN + 1] + frame[SPIN + 2] * frame[SPIN + 2]


@compiled
def _carried(frame: Floats, out: Floats, place: int, along: float, i: int) -> float:
    """Return component i of the acceleration of a point fixed in a frame, without the term -d_i omega^2 [m/s^2].

    The point is at index ``place`` of ``out``; d is its offset from the origin of the frame, omega the angular velocity
    of the frame.  The centripetal part of the acceleration is omega x (omega x d) = omega (omega . d) - d omega^2.  The
    caller passes ``along`` = omega . d and adds the last term itself.
    """
    j, k = (i + 1) % 3, (i + 2) % 3
    return (
        frame[ACCELERATION + i]
        + frame[SPIN_ACCELERATION + j] * (out[place + k] - frame[k])
        - frame[SPIN_ACCELERATION + k] * (out[place + j] - frame[j])
        + frame[SPIN + i] * along
    )


@compiled
def _relative(a: Floats, b: Floats, out: Floats, o: int, i: int) -> float:
    """Return component i of the relative velocity of a row's two points [m/s], second body minus first body."""
    j, k = (i + 1) % 3, (i + 2) % 3
    first = a[VELOCITY + i] + a[SPIN + j] * (out[o + POINT_A + k] - a[k]) - a[SPIN + k] * (out[o + POINT_A + j] - a[j])
    second = b[VELOCITY + i] + b[SPIN + j] * (out[o + POINT_B + k] - b[k]) - b[SPIN + k] * (out[o + POINT_B + j] - b[j])
    return second - first


@compiled
def point_row(a: Floats, b: Floats, out: Floats, row: int, first: Floats, second: Floats, axis: Floats) -> None:
    """Write the row of axis . (P_b - P_a) = 0: points and axis are fixed in their frames, the axis in the first."""
    o = JOINT_ROW * row
    residual = bias = 0.0
    for i in range(3):
        r = ROTATION + 3 * i
        x_a = a[r] * first[0] + a[r + 1] * first[1] + a[r + 2] * first[2]
        x_b = b[r] * second[0] + b[r + 1] * second[1] + b[r + 2] * second[2]
        n = a[r] * axis[0] + a[r + 1] * axis[1] + a[r + 2] * axis[2]
        out[o + AXIS + i] = n
        out[o + MOMENT + i] = 0.0
        # both sides move with the point of the second body, as seen from the first
        out[o + POINT_A + i] = out[o + POINT_B + i] = b[i] + x_b
        residual += n * (b[i] + x_b - a[i] - x_a)
    out[o + RESIDUAL] = residual
    # velocity and acceleration of the second body's point relative to the turning frame of the first
    point, square_a, square_b = o + POINT_A, _square(a), _square(b)
    along_a, along_b = _along(a, out, point), _along(b, out, point)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        acceleration = _carried(b, out, point, along_b, i) - (out[point + i] - b[i]) * square_b
        acceleration -= _carried(a, out, point, along_a, i) - (out[point + i] - a[i]) * square_a
        v_j = _relative(a, b, out, o, j)
        v_k = _relative(a, b, out, o, k)
        acceleration -= 2.0 * (a[SPIN + j] * v_k - a[SPIN + k] * v_j)
        bias += out[o + AXIS + i] * acceleration
    out[o + ROW_BIAS] = bias


@compiled
def angle_row(a: Floats, b: Floats, out: Floats, row: int, first: Floats, second: Floats) -> None:
    """Write the row of e_a . e_b = 0: two directions, each fixed in its frame, keep a right angle."""
    o = JOINT_ROW * row
    residual = bias = 0.0
    for i in range(3):
        r = ROTATION + 3 * i
        # kept where the points of the row would be: a row of angles has none
        out[o + POINT_A + i] = a[r] * first[0] + a[r + 1] * first[1] + a[r + 2] * first[2]
        out[o + POINT_B + i] = b[r] * second[0] + b[r + 1] * second[1] + b[r + 2] * second[2]
        out[o + AXIS + i] = 0.0
        residual += out[o + POINT_A + i] * out[o + POINT_B + i]
    out[o + RESIDUAL] = residual
    along_a = a[SPIN] * out[o + POINT_B] + a[SPIN + 1] * out[o + POINT_B + 1] + a[SPIN + 2] * out[o + POINT_B + 2]
    along_b = b[SPIN] * out[o + POINT_A] + b[SPIN + 1] * out[o + POINT_A + 1] + b[SPIN + 2] * out[o + POINT_A + 2]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        moment = out[o + POINT_B + j] * out[o + POINT_A + k] - out[o + POINT_B + k] * out[o + POINT_A + j]
        out[o + MOMENT + i] = moment
        # (omega_b x e_b) x e_a + e_b x (omega_a x e_a), the rate of the moment
        turned = (
            out[o + POINT_B + i] * along_b
            - b[SPIN + i] * residual
            + a[SPIN + i] * residual
            - out[o + POINT_A + i] * along_a
        )
        bias += (b[SPIN_ACCELERATION + i] - a[SPIN_ACCELERATION + i]) * moment + (b[SPIN + i] - a[SPIN + i]) * turned
    out[o + ROW_BIAS] = bias


@compiled
def distance_row(a: Floats, b: Floats, out: Floats, row: int, first: Floats, second: Floats, length: float) -> None:
    """Write the row of |P_b - P_a| = length."""
    o = JOINT_ROW * row
    square = 0.0
    for i in range(3):
        r = ROTATION + 3 * i
        out[o + POINT_A + i] = a[i] + a[r] * first[0] + a[r + 1] * first[1] + a[r + 2] * first[2]
        out[o + POINT_B + i] = b[i] + b[r] * second[0] + b[r + 1] * second[1] + b[r + 2] * second[2]
        out[o + MOMENT + i] = 0.0
        square += (out[o + POINT_B + i] - out[o + POINT_A + i]) ** 2
    distance = math.sqrt(square)
    out[o + RESIDUAL] = distance - length
    bias = speed = stretch = 0.0
    square_a, square_b = _square(a), _square(b)
    along_a, along_b = _along(a, out, o + POINT_A), _along(b, out, o + POINT_B)
    for i in range(3):
        n = (out[o + POINT_B + i] - out[o + POINT_A + i]) / distance
        out[o + AXIS + i] = n
        velocity = _relative(a, b, out, o, i)
        speed += velocity * velocity
        stretch += n * velocity
        acceleration = _carried(b, out, o + POINT_B, along_b, i) - (out[o + POINT_B + i] - b[i]) * square_b
        acceleration -= _carried(a, out, o + POINT_A, along_a, i)
        acceleration += (out[o + POINT_A + i] - a[i]) * square_a
        bias += n * acceleration
    out[o + ROW_BIAS] = bias + (speed - stretch * stretch) / distance
