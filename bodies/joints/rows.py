"""Rows that joints are made of: a point on a plane of the other body, a right angle, a distance."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import JOINT_ROW
from nonsmooth.types import Floats


@compiled
def point_row(a: Floats, b: Floats, out: Floats, row: int, first: Floats, second: Floats, axis: Floats) -> None:
    """Write the row of axis . (P_b - P_a) = 0: points and axis are fixed in their frames, the axis in the first."""
    o = JOINT_ROW * row
    residual = bias = 0.0
    for i in range(3):
        x_a = a[3 + 3 * i] * first[0] + a[4 + 3 * i] * first[1] + a[5 + 3 * i] * first[2]
        x_b = b[3 + 3 * i] * second[0] + b[4 + 3 * i] * second[1] + b[5 + 3 * i] * second[2]
        n = a[3 + 3 * i] * axis[0] + a[4 + 3 * i] * axis[1] + a[5 + 3 * i] * axis[2]
        out[o + 1 + i] = n
        out[o + 4 + i] = 0.0
        # both sides move with the point of the second body, as seen from the first
        out[o + 7 + i] = out[o + 10 + i] = b[i] + x_b
        residual += n * (b[i] + x_b - a[i] - x_a)
    out[o] = residual
    # velocity and acceleration of the second body's point relative to the turning frame of the first
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        p, q = o + 7 + j, o + 7 + k
        d_j, d_k = out[p] - a[j], out[q] - a[k]
        e_j, e_k = out[p] - b[j], out[q] - b[k]
        d_i, e_i = out[o + 7 + i] - a[i], out[o + 7 + i] - b[i]
        # omega x (omega x d) = omega (omega . d) - d omega^2
        along_a = a[15] * (out[o + 7] - a[0]) + a[16] * (out[o + 8] - a[1]) + a[17] * (out[o + 9] - a[2])
        along_b = b[15] * (out[o + 7] - b[0]) + b[16] * (out[o + 8] - b[1]) + b[17] * (out[o + 9] - b[2])
        square_a = a[15] * a[15] + a[16] * a[16] + a[17] * a[17]
        square_b = b[15] * b[15] + b[16] * b[16] + b[17] * b[17]
        acceleration = b[18 + i] + b[21 + j] * e_k - b[21 + k] * e_j + b[15 + i] * along_b - e_i * square_b
        acceleration -= a[18 + i] + a[21 + j] * d_k - a[21 + k] * d_j + a[15 + i] * along_a - d_i * square_a
        v_j = _relative(a, b, out, o, j)
        v_k = _relative(a, b, out, o, k)
        acceleration -= 2.0 * (a[15 + j] * v_k - a[15 + k] * v_j)
        bias += out[o + 1 + i] * acceleration
    out[o + 13] = bias


@compiled
def _relative(a: Floats, b: Floats, out: Floats, o: int, i: int) -> float:
    """Return component i of the velocity of the row's point on the second body relative to that on the first."""
    j, k = (i + 1) % 3, (i + 2) % 3
    first = a[12 + i] + a[15 + j] * (out[o + 7 + k] - a[k]) - a[15 + k] * (out[o + 7 + j] - a[j])
    second = b[12 + i] + b[15 + j] * (out[o + 10 + k] - b[k]) - b[15 + k] * (out[o + 10 + j] - b[j])
    return second - first


@compiled
def angle_row(a: Floats, b: Floats, out: Floats, row: int, first: Floats, second: Floats) -> None:
    """Write the row of e_a . e_b = 0: two directions, each fixed in its frame, keep a right angle."""
    o = JOINT_ROW * row
    residual = bias = 0.0
    for i in range(3):
        # kept where the points of the row would be: a row of angles has none
        out[o + 7 + i] = a[3 + 3 * i] * first[0] + a[4 + 3 * i] * first[1] + a[5 + 3 * i] * first[2]
        out[o + 10 + i] = b[3 + 3 * i] * second[0] + b[4 + 3 * i] * second[1] + b[5 + 3 * i] * second[2]
        out[o + 1 + i] = 0.0
        residual += out[o + 7 + i] * out[o + 10 + i]
    out[o] = residual
    along_a = a[15] * out[o + 10] + a[16] * out[o + 11] + a[17] * out[o + 12]
    along_b = b[15] * out[o + 7] + b[16] * out[o + 8] + b[17] * out[o + 9]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        moment = out[o + 10 + j] * out[o + 7 + k] - out[o + 10 + k] * out[o + 7 + j]
        out[o + 4 + i] = moment
        # (omega_b x e_b) x e_a + e_b x (omega_a x e_a), the rate of the moment
        turned = out[o + 10 + i] * along_b - b[15 + i] * residual + a[15 + i] * residual - out[o + 7 + i] * along_a
        bias += (b[21 + i] - a[21 + i]) * moment + (b[15 + i] - a[15 + i]) * turned
    out[o + 13] = bias


@compiled
def distance_row(a: Floats, b: Floats, out: Floats, first: Floats, second: Floats, length: float) -> None:
    """Write the row of |P_b - P_a| = length."""
    square = 0.0
    for i in range(3):
        out[7 + i] = a[i] + a[3 + 3 * i] * first[0] + a[4 + 3 * i] * first[1] + a[5 + 3 * i] * first[2]
        out[10 + i] = b[i] + b[3 + 3 * i] * second[0] + b[4 + 3 * i] * second[1] + b[5 + 3 * i] * second[2]
        out[4 + i] = 0.0
        square += (out[10 + i] - out[7 + i]) ** 2
    distance = math.sqrt(square)
    out[0] = distance - length
    bias = speed = stretch = 0.0
    square_a = a[15] * a[15] + a[16] * a[16] + a[17] * a[17]
    square_b = b[15] * b[15] + b[16] * b[16] + b[17] * b[17]
    along_a = a[15] * (out[7] - a[0]) + a[16] * (out[8] - a[1]) + a[17] * (out[9] - a[2])
    along_b = b[15] * (out[10] - b[0]) + b[16] * (out[11] - b[1]) + b[17] * (out[12] - b[2])
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        n = (out[10 + i] - out[7 + i]) / distance
        out[1 + i] = n
        velocity = _relative(a, b, out, 0, i)
        speed += velocity * velocity
        stretch += n * velocity
        d_j, d_k = out[7 + j] - a[j], out[7 + k] - a[k]
        e_j, e_k = out[10 + j] - b[j], out[10 + k] - b[k]
        acceleration = b[18 + i] + b[21 + j] * e_k - b[21 + k] * e_j + b[15 + i] * along_b
        acceleration -= (out[10 + i] - b[i]) * square_b
        acceleration -= a[18 + i] + a[21 + j] * d_k - a[21 + k] * d_j + a[15 + i] * along_a
        acceleration += (out[7 + i] - a[i]) * square_a
        bias += n * acceleration
    out[13] = bias + (speed - stretch * stretch) / distance
