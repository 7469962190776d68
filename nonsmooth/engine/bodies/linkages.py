"""Linkages: bodies tied by joints, which the rest of the engine sees as one body with fewer ways to move.

With the joints' rows A (A u + prescribed = 0) the accelerations that forces give are K = M^-1 - R^T Y,
R = A M^-1, Y = (A R^T)^-1 R, so that contact forces, impulses and projections respect the joints at all times.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.kinematics import side_row
from nonsmooth.engine.memory.blocks import (
    AXIS,
    FRAME,
    JOINT_ROW,
    MOMENT,
    POINT_A,
    POINT_B,
    RESIDUAL,
    ROW_BIAS,
    SPIN,
    VELOCITY,
)
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, call_pair, kernel

_REDUNDANT = 1e-10
"""A pivot below this part of its diagonal belongs to a row that the rows before it imply."""


@kernel("void(F, i8, i8, i8, f8, i8)")
def _add_moment(w: Floats, frame: int, moment: int, n_u: int, sign: float, out: int) -> None:
    for j in range(n_u):
        o = frame + FRAME + 3 * n_u + j
        w[out + j] += sign * (w[moment] * w[o] + w[moment + 1] * w[o + n_u] + w[moment + 2] * w[o + 2 * n_u])


@kernel("f8(F, i8, i8, i8, i8)")
def _speed(w: Floats, frame: int, axis: int, point: int, moment: int) -> float:
    """Return how fast a frame moves along a row: axis . velocity of the point + moment . angular velocity."""
    x, y, z = w[point] - w[frame], w[point + 1] - w[frame + 1], w[point + 2] - w[frame + 2]
    ox, oy, oz = w[frame + SPIN], w[frame + SPIN + 1], w[frame + SPIN + 2]
    return (
        w[axis] * (w[frame + VELOCITY] + oy * z - oz * y)
        + w[axis + 1] * (w[frame + VELOCITY + 1] + oz * x - ox * z)
        + w[axis + 2] * (w[frame + VELOCITY + 2] + ox * y - oy * x)
        + w[moment] * ox
        + w[moment + 1] * oy
        + w[moment + 2] * oz
    )


@kernel("i8(S, F, I, i8, i8)")
def _rows(S: Scalars, w: Floats, k: Integers, joint: int, linkage: int) -> int:
    """Write rows, residuals, rates and biases of one joint behind those of the joints before; return their number."""
    frame_a, frame_b, out = k[S.joint_frame_a + joint], k[S.joint_frame_b + joint], k[S.joint_out + joint]
    call_pair(
        k[S.joint_function + joint], at(w, frame_a), at(w, frame_b), at(w, k[S.joint_parameters + joint]), at(w, out)
    )
    n = k[S.linkage_nu + linkage]
    first = k[S.joint_first + joint]
    n_a, n_b = k[S.joint_nu_a + joint], k[S.joint_nu_b + joint]
    for r in range(k[S.joint_rows + joint]):
        o = out + JOINT_ROW * r
        axis, moment = o + AXIS, o + MOMENT
        line = k[S.linkage_jacobian + linkage] + (first + r) * n
        side_a, side_b = line + k[S.joint_shift_a + joint], line + k[S.joint_shift_b + joint]
        side_row(w, frame_a, o + POINT_A, -w[axis], -w[axis + 1], -w[axis + 2], n_a, side_a)
        side_row(w, frame_b, o + POINT_B, w[axis], w[axis + 1], w[axis + 2], n_b, side_b)
        _add_moment(w, frame_a, moment, n_a, -1.0, side_a)
        _add_moment(w, frame_b, moment, n_b, 1.0, side_b)
        w[k[S.linkage_residual + linkage] + first + r] = w[o + RESIDUAL]
        w[k[S.linkage_bias + linkage] + first + r] = w[o + ROW_BIAS]
        w[k[S.linkage_rate + linkage] + first + r] = _speed(w, frame_b, axis, o + POINT_B, moment) - _speed(
            w, frame_a, axis, o + POINT_A, moment
        )
    return k[S.joint_rows + joint]


@kernel("void(S, F, I, i8)")
def _inverse_masses(S: Scalars, w: Floats, k: Integers, linkage: int) -> None:
    """Write M^-1 of the linkage's bodies to K and R = A M^-1."""
    n, m = k[S.linkage_nu + linkage], k[S.linkage_rows + linkage]
    matrix, jacobian, r = k[S.linkage_inverse + linkage], k[S.linkage_jacobian + linkage], k[S.linkage_r + linkage]
    for i in range(n * n):
        w[matrix + i] = 0.0
    for i in range(n * m):
        w[r + i] = 0.0
    for body in range(k[S.linkage_body + linkage], k[S.linkage_body + linkage] + k[S.linkage_bodies + linkage]):
        n_u = k[S.body_nu + body]
        shift = k[S.body_u + body] - k[S.linkage_u + linkage]
        inverse = k[S.body_tail + body] + k[S.body_nq + body] + n_u
        for i in range(n_u):
            for j in range(n_u):
                entry = w[inverse + i * n_u + j]
                if entry != 0.0:
                    w[matrix + (shift + i) * n + shift + j] = entry
                    for line in range(m):
                        w[r + line * n + shift + i] += entry * w[jacobian + line * n + shift + j]


@kernel("void(F, i8, i8)")
def _factorise(w: Floats, a: int, n: int) -> None:
    """Overwrite the symmetric matrix at ``a`` by its Cholesky factor; rows that others imply get a zero pivot."""
    for j in range(n):
        own = w[a + j * n + j]
        pivot = own
        for i in range(j):
            pivot -= w[a + j * n + i] * w[a + j * n + i]
        if not pivot > _REDUNDANT * own:
            for i in range(j, n):
                w[a + i * n + j] = 0.0
            continue
        root = math.sqrt(pivot)
        w[a + j * n + j] = root
        for i in range(j + 1, n):
            total = w[a + i * n + j]
            for c in range(j):
                total -= w[a + i * n + c] * w[a + j * n + c]
            w[a + i * n + j] = total / root


@kernel("void(F, i8, i8, i8, i8)")
def _substitute(w: Floats, a: int, n: int, x: int, stride: int) -> None:
    """Solve with the factor at ``a`` in place, the right-hand side at ``x`` in steps of ``stride``."""
    for i in range(n):
        total = w[x + i * stride]
        for c in range(i):
            total -= w[a + i * n + c] * w[x + c * stride]
        w[x + i * stride] = total / w[a + i * n + i] if w[a + i * n + i] > 0.0 else 0.0
    for i in range(n - 1, -1, -1):
        total = w[x + i * stride]
        for c in range(i + 1, n):
            total -= w[a + c * n + i] * w[x + c * stride]
        w[x + i * stride] = total / w[a + i * n + i] if w[a + i * n + i] > 0.0 else 0.0


@kernel("void(S, F, I, i8)")
def evaluate_linkage(S: Scalars, w: Floats, k: Integers, linkage: int) -> None:
    """Write K, Y, residuals and rates of the joints, the part of u that is not prescribed, and the driven power."""
    for joint in range(k[S.linkage_joint + linkage], k[S.linkage_joint + linkage] + k[S.linkage_joints + linkage]):
        _rows(S, w, k, joint, linkage)
    _inverse_masses(S, w, k, linkage)
    n, m = k[S.linkage_nu + linkage], k[S.linkage_rows + linkage]
    jacobian, r, y = k[S.linkage_jacobian + linkage], k[S.linkage_r + linkage], k[S.linkage_y + linkage]
    matrix, factor = k[S.linkage_inverse + linkage], k[S.linkage_factor + linkage]
    for i in range(m):
        for j in range(i + 1):
            total = 0.0
            for c in range(n):
                total += w[jacobian + i * n + c] * w[r + j * n + c]
            w[factor + i * m + j] = total
    _factorise(w, factor, m)
    for i in range(m * n):
        w[y + i] = w[r + i]
    for c in range(n):
        _substitute(w, factor, m, y + c, n)
    for i in range(n):
        for line in range(m):
            entry = w[r + line * n + i]
            if entry != 0.0:
                for j in range(n):
                    w[matrix + i * n + j] -= entry * w[y + line * n + j]
    _prescribe(S, w, k, linkage)


@kernel("f8(S, F, I, i8)")
def _power(S: Scalars, w: Floats, k: Integers, linkage: int) -> float:
    """Return the power of the bodies' own forces on the velocities ``u_own``."""
    power = 0.0
    for body in range(k[S.linkage_body + linkage], k[S.linkage_body + linkage] + k[S.linkage_bodies + linkage]):
        for i in range(k[S.body_nu + body]):
            power += w[k[S.body_tail + body] + k[S.body_nq + body] + i] * w[S.u_own + k[S.body_u + body] + i]
    return power


@kernel("void(S, F, I, i8)")
def _prescribe(S: Scalars, w: Floats, k: Integers, linkage: int) -> None:
    """Take off the velocities that driven bodies impose through joints, and book their power but for contact forces."""
    if k[S.linkage_driven + linkage] == 0:
        return
    n, m = k[S.linkage_nu + linkage], k[S.linkage_rows + linkage]
    u, x = S.u_own + k[S.linkage_u + linkage], k[S.linkage_x + linkage]
    S.driven_power -= _power(S, w, k, linkage)
    for line in range(m):
        total = 0.0
        for c in range(n):
            total += w[k[S.linkage_jacobian + linkage] + line * n + c] * w[u + c]
        w[x + line] = total
    for line in range(m):
        for c in range(n):
            w[u + c] -= w[k[S.linkage_y + linkage] + line * n + c] * w[x + line]
    S.driven_power += _power(S, w, k, linkage)
    _substitute(w, k[S.linkage_factor + linkage], m, x, 1)
    for line in range(m):
        S.driven_power -= w[x + line] * w[k[S.linkage_bias + linkage] + line]


@kernel("void(S, F, I, i8)")
def constrain(S: Scalars, w: Floats, k: Integers, linkage: int) -> None:
    """Subtract from the accelerations ``du`` of a linkage what its joints do not allow: Y^T (A du + bias)."""
    n, m = k[S.linkage_nu + linkage], k[S.linkage_rows + linkage]
    du, x = S.du + k[S.linkage_u + linkage], k[S.linkage_x + linkage]
    for line in range(m):
        total = w[k[S.linkage_bias + linkage] + line]
        for c in range(n):
            total += w[k[S.linkage_jacobian + linkage] + line * n + c] * w[du + c]
        w[x + line] = total
    for line in range(m):
        for c in range(n):
            w[du + c] -= w[k[S.linkage_y + linkage] + line * n + c] * w[x + line]
