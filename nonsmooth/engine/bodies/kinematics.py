"""Contacts at a state: gaps, relative rates, Jacobians, second-order terms."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import stretch_bias, stretch_tangents
from nonsmooth.engine.memory.blocks import (
    ACCELERATION,
    FRAME,
    GAP,
    GEOMETRY,
    NORMAL,
    POINT_A,
    POINT_B,
    SIDE_A,
    SIDE_B,
    SLIDE_MATRIX,
    SPIN,
    SPIN_ACCELERATION,
    TANGENT,
    TURN_MATRIX,
    VELOCITY,
)
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, call_pair, kernel, room


@kernel("void(S, F, I, i8)")
def evaluate_geometry(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Write gap, witness points, curvature and the axes n, t1, t2 of contact ``c``."""
    call_pair(
        k[S.geometry_function + c],
        at(w, k[S.frame_a + c]),
        at(w, k[S.frame_b + c]),
        at(w, k[S.geometry_parameters + c]),
        at(w, S.geometry + GEOMETRY * c),
    )
    n = S.axes + 9 * c
    t = n + 3
    for i in range(6):
        w[n + i] = w[S.geometry + GEOMETRY * c + NORMAL + i]
    w[n + 6] = w[n + 1] * w[t + 2] - w[n + 2] * w[t + 1]
    w[n + 7] = w[n + 2] * w[t] - w[n] * w[t + 2]
    w[n + 8] = w[n] * w[t + 1] - w[n + 1] * w[t]


@kernel("void(S, F, i8)")
def _unit_tangents(S: Scalars, w: Floats, c: int) -> None:
    """Write both unit tangents of contact ``c`` to ``tangents``."""
    n, t, out = S.geometry + GEOMETRY * c + NORMAL, S.geometry + GEOMETRY * c + TANGENT, S.tangents
    for i in range(3):
        w[out + i] = w[t + i]
    w[out + 3] = w[n + 1] * w[t + 2] - w[n + 2] * w[t + 1]
    w[out + 4] = w[n + 2] * w[t] - w[n] * w[t + 2]
    w[out + 5] = w[n] * w[t + 1] - w[n + 1] * w[t]


@kernel("void(S, F, I, i8)")
def evaluate_rates(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Write the gap rate and slip velocity of contact ``c``, Eqs. (11) and (12)."""
    vx = vy = vz = 0.0
    for side in range(2):
        frame = k[S.frame_a + c] if side == 0 else k[S.frame_b + c]
        point = S.geometry + GEOMETRY * c + (POINT_A if side == 0 else POINT_B)
        x, y, z = w[point] - w[frame], w[point + 1] - w[frame + 1], w[point + 2] - w[frame + 2]
        ox, oy, oz = w[frame + SPIN], w[frame + SPIN + 1], w[frame + SPIN + 2]
        vx = w[frame + VELOCITY] + oy * z - oz * y - vx
        vy = w[frame + VELOCITY + 1] + oz * x - ox * z - vy
        vz = w[frame + VELOCITY + 2] + ox * y - oy * x - vz
    if k[S.oriented + c] == 1:
        _unit_tangents(S, w, c)
        for r in range(2):
            t = S.tangents + 3 * r
            w[S.slip + 2 * c + r] = w[t] * vx + w[t + 1] * vy + w[t + 2] * vz
        stretch_tangents(S, w, k, c, S.tangents)
    for r in range(3):
        axis = S.axes + 9 * c + 3 * r
        w[S.rate + 3 * c + r] = w[axis] * vx + w[axis + 1] * vy + w[axis + 2] * vz


@kernel("void(F, i8, i8, f8, f8, f8, i8, i8)")
def side_row(w: Floats, frame: int, point: int, ax: float, ay: float, az: float, n_u: int, out: int) -> None:
    """Write the row of one body: (axis, rho x axis) . frame Jacobian."""
    x, y, z = w[point] - w[frame], w[point + 1] - w[frame + 1], w[point + 2] - w[frame + 2]
    mx, my, mz = y * az - z * ay, z * ax - x * az, x * ay - y * ax
    for j in range(n_u):
        v = frame + FRAME + j
        o = v + 3 * n_u
        w[out + j] = (
            ax * w[v] + ay * w[v + n_u] + az * w[v + 2 * n_u] + mx * w[o] + my * w[o + n_u] + mz * w[o + 2 * n_u]
        )


@kernel("void(F, i8, i8, i8, i8, f8, i8, i8)")
def _side_wrench(w: Floats, frame: int, point: int, force: int, moment: int, sign: float, n_u: int, out: int) -> None:
    """Write the row of one body: of a force at a witness point and a moment, world components at two places."""
    fx, fy, fz = sign * w[force], sign * w[force + 1], sign * w[force + 2]
    side_row(w, frame, point, fx, fy, fz, n_u, out)
    for j in range(n_u):
        o = frame + FRAME + j + 3 * n_u
        w[out + j] += sign * (w[moment] * w[o] + w[moment + 1] * w[o + n_u] + w[moment + 2] * w[o + 2 * n_u])


@kernel("void(S, F, I, i8, i8, i8, i8)")
def wrench_row(S: Scalars, w: Floats, k: Integers, c: int, r: int, force: int, moment: int) -> None:
    """Write row ``r`` of contact ``c``: what a force and a moment on the second body do, in world components."""
    geometry = S.geometry + GEOMETRY * c
    row_a = k[S.jacobian_a + c] + r * k[S.linkage_nu + k[S.linkage_a + c]] + k[S.shift_a + c]
    row_b = k[S.jacobian_b + c] + r * k[S.linkage_nu + k[S.linkage_b + c]] + k[S.shift_b + c]
    _side_wrench(w, k[S.frame_a + c], geometry + POINT_A, force, moment, -1.0, k[S.nu_a + c], row_a)
    _side_wrench(w, k[S.frame_b + c], geometry + POINT_B, force, moment, 1.0, k[S.nu_b + c], row_b)


@kernel("void(S, F, I, i8, i8, f8, f8, f8)")
def evaluate_row(S: Scalars, w: Floats, k: Integers, c: int, r: int, ax: float, ay: float, az: float) -> None:
    """Write row ``r`` of the Jacobians of contact ``c``: of the relative velocity along the axis given."""
    geometry = S.geometry + GEOMETRY * c
    row_a = k[S.jacobian_a + c] + r * k[S.linkage_nu + k[S.linkage_a + c]] + k[S.shift_a + c]
    row_b = k[S.jacobian_b + c] + r * k[S.linkage_nu + k[S.linkage_b + c]] + k[S.shift_b + c]
    side_row(w, k[S.frame_a + c], geometry + POINT_A, -ax, -ay, -az, k[S.nu_a + c], row_a)
    side_row(w, k[S.frame_b + c], geometry + POINT_B, ax, ay, az, k[S.nu_b + c], row_b)


@kernel("void(S, F, I, i8, i8, i8)")
def evaluate_row_response(S: Scalars, w: Floats, k: Integers, c: int, r: int, s: int) -> None:
    """Write response ``s`` of contact ``c``: K times row ``r`` of its Jacobians, whose zeros are skipped.

    K is M^-1, less what the joints take.
    """
    for side in range(2):
        linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
        n_u = k[S.linkage_nu + linkage]
        jacobian = (k[S.jacobian_a + c] if side == 0 else k[S.jacobian_b + c]) + r * n_u
        response = (k[S.response_a + c] if side == 0 else k[S.response_b + c]) + s * n_u
        matrix = k[S.linkage_inverse + linkage]
        for i in range(n_u):
            total = 0.0
            for j in range(n_u):
                entry = w[matrix + i * n_u + j]
                if entry != 0.0:
                    total += entry * w[jacobian + j]
            w[response + i] = total


@kernel("void(S, F, I, i8, i8, f8, i8)")
def push_response(S: Scalars, w: Floats, k: Integers, c: int, s: int, force: float, du: int) -> None:
    """Add the accelerations that a force in column ``s`` of contact ``c`` gives to ``du``."""
    for side in range(2):
        linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
        response = k[S.response_a + c] if side == 0 else k[S.response_b + c]
        n_u = k[S.linkage_nu + linkage]
        for i in range(n_u):
            w[du + k[S.linkage_u + linkage] + i] += w[response + s * n_u + i] * force


@kernel("f8(S, F, I, i8, i8, i8)")
def row(S: Scalars, w: Floats, k: Integers, c: int, r: int, du: int) -> float:
    """Return row ``r`` (n, t1, t2) of [W N]^T du of contact ``c``."""
    total = 0.0
    a, b = k[S.linkage_a + c], k[S.linkage_b + c]
    n_a, n_b = k[S.linkage_nu + a], k[S.linkage_nu + b]
    for i in range(n_a):
        total += w[k[S.jacobian_a + c] + r * n_a + i] * w[du + k[S.linkage_u + a] + i]
    for i in range(n_b):
        total += w[k[S.jacobian_b + c] + r * n_b + i] * w[du + k[S.linkage_u + b] + i]
    return total


@kernel("void(S, F, I, i8)")
def evaluate_jacobian(S: Scalars, w: Floats, k: Integers, c: int) -> None:
    """Write W^T and N^T of contact ``c`` (rows n, t1, t2), K times them, and the prescribed rates."""
    for r in range(3):
        axis = S.axes + 9 * c + 3 * r
        evaluate_row(S, w, k, c, r, w[axis], w[axis + 1], w[axis + 2])
        evaluate_row_response(S, w, k, c, r, r)
        w[S.prescribed_rate + 3 * c + r] = w[S.rate + 3 * c + r] - row(S, w, k, c, r, S.own)


@kernel("void(S, F, I, i8, i8)")
def evaluate_bias(S: Scalars, w: Floats, k: Integers, c: int, rows: int) -> None:
    """Write S_N and S_T of Eq. (13) with the prescribed accelerations: g'' and v' of contact ``c`` while u' = 0.

    Only the normal one with ``rows`` 1, all with 3.

    The witness points slide over their bodies at u and w, and the normal turns by nu relative to the
    first one: slide_a u = turn_a nu, slide_b w = -turn_b (nu - rho), w = u + g nu - d, with rho the
    relative turning of the bodies and d their relative velocity at the witness points, both in the
    tangent plane (physics of general shapes; for plane and sphere it gives the S terms of Eq. (13)).
    """
    geometry = S.geometry + GEOMETRY * c
    n = S.axes + 9 * c
    t1, t2, slip = n + 3, n + 6, S.rate + 3 * c + 1
    if k[S.oriented + c] == 1:
        _unit_tangents(S, w, c)
        t1, t2, slip = S.tangents, S.tangents + 3, S.slip + 2 * c
    a, b = k[S.frame_a + c], k[S.frame_b + c]
    gap = w[geometry + GAP]
    # turning of the normal with the first body, (omega_A x n) in the tangent plane; rho likewise for B - A
    turn_a1 = w[a + SPIN] * w[t2] + w[a + SPIN + 1] * w[t2 + 1] + w[a + SPIN + 2] * w[t2 + 2]
    turn_a2 = -(w[a + SPIN] * w[t1] + w[a + SPIN + 1] * w[t1 + 1] + w[a + SPIN + 2] * w[t1 + 2])
    rho1 = w[b + SPIN] * w[t2] + w[b + SPIN + 1] * w[t2 + 1] + w[b + SPIN + 2] * w[t2 + 2] - turn_a1
    rho2 = -(w[b + SPIN] * w[t1] + w[b + SPIN + 1] * w[t1 + 1] + w[b + SPIN + 2] * w[t1 + 2]) - turn_a2
    v1, v2 = w[slip], w[slip + 1]
    d1, d2 = v1 - gap * turn_a1, v2 - gap * turn_a2
    # slide and turn of one surface commute, so u = turn_a x, nu = slide_a x leaves two unknowns
    slide_a, turn_a = geometry + SIDE_A + SLIDE_MATRIX, geometry + SIDE_A + TURN_MATRIX
    slide_b, turn_b = geometry + SIDE_B + SLIDE_MATRIX, geometry + SIDE_B + TURN_MATRIX
    r1 = w[slide_b] * d1 + w[slide_b + 1] * d2 + w[turn_b] * rho1 + w[turn_b + 1] * rho2
    r2 = w[slide_b + 2] * d1 + w[slide_b + 3] * d2 + w[turn_b + 2] * rho1 + w[turn_b + 3] * rho2
    for i in range(2):
        for j in range(2):
            total = 0.0
            for m in range(2):
                reach = w[turn_a + 2 * m + j] + gap * w[slide_a + 2 * m + j]
                total += w[slide_b + 2 * i + m] * reach + w[turn_b + 2 * i + m] * w[slide_a + 2 * m + j]
            w[S.small + 2 * i + j] = total
    m11, m12, m21, m22 = w[S.small], w[S.small + 1], w[S.small + 2], w[S.small + 3]
    determinant = m11 * m22 - m12 * m21
    if determinant == 0.0:
        # a trial step far too long; what is not a number rejects it, where plain Python would raise
        determinant = math.nan
    x1, x2 = (m22 * r1 - m12 * r2) / determinant, (m11 * r2 - m21 * r1) / determinant
    u1, u2 = w[turn_a] * x1 + w[turn_a + 1] * x2, w[turn_a + 2] * x1 + w[turn_a + 3] * x2
    nu1, nu2 = w[slide_a] * x1 + w[slide_a + 1] * x2, w[slide_a + 2] * x1 + w[slide_a + 3] * x2
    w1, w2 = u1 + gap * nu1 - d1, u2 + gap * nu2 - d2
    # the witness points' accelerations, second minus first, as the turning bodies carry the sliding points
    ax = ay = az = 0.0
    for side in range(2):
        frame = a if side == 0 else b
        s1, s2 = (u1, u2) if side == 0 else (w1, w2)
        point = geometry + (POINT_A if side == 0 else POINT_B)
        x, y, z = w[point] - w[frame], w[point + 1] - w[frame + 1], w[point + 2] - w[frame + 2]
        ox, oy, oz = w[frame + SPIN], w[frame + SPIN + 1], w[frame + SPIN + 2]
        turning = frame + SPIN_ACCELERATION
        bx, by, bz = w[turning], w[turning + 1], w[turning + 2]
        vx = oy * z - oz * y + s1 * w[t1] + s2 * w[t2]
        vy = oz * x - ox * z + s1 * w[t1 + 1] + s2 * w[t2 + 1]
        vz = ox * y - oy * x + s1 * w[t1 + 2] + s2 * w[t2 + 2]
        ax = w[frame + ACCELERATION] + by * z - bz * y + oy * vz - oz * vy - ax
        ay = w[frame + ACCELERATION + 1] + bz * x - bx * z + oz * vx - ox * vz - ay
        az = w[frame + ACCELERATION + 2] + bx * y - by * x + ox * vy - oy * vx - az
    w[S.bias + 3 * c] = w[n] * ax + w[n + 1] * ay + w[n + 2] * az
    # the axes themselves turn: n' = omega_A x n + nu, and the tangents spin about n with the first body
    n1, n2 = turn_a1 + nu1, turn_a2 + nu2
    spin = w[a + SPIN] * w[n] + w[a + SPIN + 1] * w[n + 1] + w[a + SPIN + 2] * w[n + 2]
    rate = w[S.rate + 3 * c]
    w[S.bias + 3 * c] += n1 * v1 + n2 * v2
    if rows == 3:
        w[S.bias + 3 * c + 1] = w[t1] * ax + w[t1 + 1] * ay + w[t1 + 2] * az + spin * v2 - n1 * rate
        w[S.bias + 3 * c + 2] = w[t2] * ax + w[t2 + 1] * ay + w[t2 + 2] * az - spin * v1 - n2 * rate
        if k[S.oriented + c] == 1:
            stretch_bias(S, w, k, c, S.bias + 3 * c)


@room("void(S, F, I, i8, i8)")
def evaluate_contact(S: Scalars, w: Floats, k: Integers, c: int, rows: int) -> None:
    """Write everything about contact ``c``, the bodies being evaluated; ``rows`` of the bias."""
    evaluate_geometry(S, w, k, c)
    evaluate_rates(S, w, k, c)
    evaluate_jacobian(S, w, k, c)
    evaluate_bias(S, w, k, c, rows)
