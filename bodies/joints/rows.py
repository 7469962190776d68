"""Rows that joints are made of: a point on a plane of the other body, a right angle, a distance."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
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
from nonsmooth.types import Floats


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
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        p, q = o + POINT_A + j, o + POINT_A + k
        d_j, d_k = out[p] - a[j], out[q] - a[k]
        e_j, e_k = out[p] - b[j], out[q] - b[k]
        d_i, e_i = out[o + POINT_A + i] - a[i], out[o + POINT_A + i] - b[i]
        # omega x (omega x d) = omega (omega . d) - d omega^2
        along_a = (
            a[SPIN] * (out[o + POINT_A] - a[POSITION])
            + a[SPIN + 1] * (out[o + POINT_A + 1] - a[POSITION + 1])
            + a[SPIN + 2] * (out[o + POINT_A + 2] - a[POSITION + 2])
        )
        along_b = (
            b[SPIN] * (out[o + POINT_A] - b[POSITION])
            + b[SPIN + 1] * (out[o + POINT_A + 1] - b[POSITION + 1])
            + b[SPIN + 2] * (out[o + POINT_A + 2] - b[POSITION + 2])
        )
        square_a = a[SPIN] * a[SPIN] + a[SPIN + 1] * a[SPIN + 1] + a[SPIN + 2] * a[SPIN + 2]
        square_b = b[SPIN] * b[SPIN] + b[SPIN + 1] * b[SPIN + 1] + b[SPIN + 2] * b[SPIN + 2]
        acceleration = (
            b[ACCELERATION + i]
            + b[SPIN_ACCELERATION + j] * e_k
            - b[SPIN_ACCELERATION + k] * e_j
            + b[SPIN + i] * along_b
            - e_i * square_b
        )
        acceleration -= (
            a[ACCELERATION + i]
            + a[SPIN_ACCELERATION + j] * d_k
            - a[SPIN_ACCELERATION + k] * d_j
            + a[SPIN + i] * along_a
            - d_i * square_a
        )
        v_j = _relative(a, b, out, o, j)
        v_k = _relative(a, b, out, o, k)
        acceleration -= 2.0 * (a[SPIN + j] * v_k - a[SPIN + k] * v_j)
        bias += out[o + AXIS + i] * acceleration
    out[o + ROW_BIAS] = bias


@compiled
def _relative(a: Floats, b: Floats, out: Floats, o: int, i: int) -> float:
    """Return component i of the velocity of the row's point on the second body relative to that on the first."""
    j, k = (i + 1) % 3, (i + 2) % 3
    first = a[VELOCITY + i] + a[SPIN + j] * (out[o + POINT_A + k] - a[k]) - a[SPIN + k] * (out[o + POINT_A + j] - a[j])
    second = b[VELOCITY + i] + b[SPIN + j] * (out[o + POINT_B + k] - b[k]) - b[SPIN + k] * (out[o + POINT_B + j] - b[j])
    return second - first


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
def distance_row(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, length: float) -> None:
    """Write the row of |P_b - P_a| = length."""
    square = 0.0
    for i in range(3):
        r = ROTATION + 3 * i
        out[POINT_A + i] = a[i] + a[r] * first[0] + a[r + 1] * first[1] + a[r + 2] * first[2]
        out[POINT_B + i] = b[i] + b[r] * second[0] + b[r + 1] * second[1] + b[r + 2] * second[2]
        out[MOMENT + i] = 0.0
        square += (out[POINT_B + i] - out[POINT_A + i]) ** 2
    distance = math.sqrt(square)
    out[RESIDUAL] = distance - length
    bias = speed = stretch = 0.0
    square_a = a[SPIN] * a[SPIN] + a[SPIN + 1] * a[SPIN + 1] + a[SPIN + 2] * a[SPIN + 2]
    square_b = b[SPIN] * b[SPIN] + b[SPIN + 1] * b[SPIN + 1] + b[SPIN + 2] * b[SPIN + 2]
    along_a = (
        a[SPIN] * (out[POINT_A] - a[POSITION])
        + a[SPIN + 1] * (out[POINT_A + 1] - a[POSITION + 1])
        + a[SPIN + 2] * (out[POINT_A + 2] - a[POSITION + 2])
    )
    along_b = (
        b[SPIN] * (out[POINT_B] - b[POSITION])
        + b[SPIN + 1] * (out[POINT_B + 1] - b[POSITION + 1])
        + b[SPIN + 2] * (out[POINT_B + 2] - b[POSITION + 2])
    )
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        n = (out[POINT_B + i] - out[POINT_A + i]) / distance
        out[AXIS + i] = n
        velocity = _relative(a, b, out, 0, i)
        speed += velocity * velocity
        stretch += n * velocity
        d_j, d_k = out[POINT_A + j] - a[j], out[POINT_A + k] - a[k]
        e_j, e_k = out[POINT_B + j] - b[j], out[POINT_B + k] - b[k]
        acceleration = (
            b[ACCELERATION + i]
            + b[SPIN_ACCELERATION + j] * e_k
            - b[SPIN_ACCELERATION + k] * e_j
            + b[SPIN + i] * along_b
        )
        acceleration -= (out[POINT_B + i] - b[i]) * square_b
        acceleration -= (
            a[ACCELERATION + i]
            + a[SPIN_ACCELERATION + j] * d_k
            - a[SPIN_ACCELERATION + k] * d_j
            + a[SPIN + i] * along_a
        )
        acceleration += (out[POINT_A + i] - a[i]) * square_a
        bias += n * acceleration
    out[ROW_BIAS] = bias + (speed - stretch * stretch) / distance
