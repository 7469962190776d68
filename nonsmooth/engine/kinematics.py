"""Bodies and contacts at a state: frames, gaps, relative rates, Jacobians, second-order terms."""

from __future__ import annotations

from nonsmooth.engine.kernel import at, call_body, call_pair, kernel, room
from nonsmooth.engine.linear import eliminate
from nonsmooth.model.layout import FRAME, GEOMETRY


@kernel("void(S, F, I, f8, i8, i8)")
def evaluate_body(S, w, k, t, y, body):
    """Let one body write its output block at time ``t`` and the state at offset ``y``."""
    call_body(
        k[S.body_function + body],
        t,
        at(w, y + k[S.body_q + body]),
        at(w, y + S.n_q + k[S.body_u + body]),
        at(w, k[S.body_parameters + body]),
        at(w, k[S.body_out + body]),
    )


@kernel("void(S, F, I, f8, i8)")
def evaluate_bodies(S, w, k, t, y):
    """Let every body write its output block at time ``t`` and the state at offset ``y``."""
    for body in range(S.n_bodies):
        evaluate_body(S, w, k, t, y, body)


@kernel("void(S, F, I, f8, i8)")
def evaluate_driven_bodies(S, w, k, t, y):
    """Let the bodies without coordinates write their output blocks."""
    for body in range(S.n_bodies):
        if k[S.body_nu + body] == 0:
            evaluate_body(S, w, k, t, y, body)


@kernel("void(S, F, I, f8, i8)")
def evaluate_free_bodies(S, w, k, t, y):
    """Let the bodies that have coordinates write their output blocks; for free flight."""
    for body in range(S.n_bodies):
        if k[S.body_nu + body] > 0:
            evaluate_body(S, w, k, t, y, body)


@kernel("void(S, F, I, i8)")
def evaluate_geometry(S, w, k, c):
    """Write gap, witness points, curvature and the axes n, t1, t2 of contact ``c``."""
    call_pair(
        k[S.geometry_function + c],
        at(w, k[S.body_out + k[S.body_a + c]]),
        at(w, k[S.body_out + k[S.body_b + c]]),
        at(w, k[S.geometry_parameters + c]),
        at(w, S.geometry + GEOMETRY * c),
    )
    n = S.axes + 9 * c
    t = n + 3
    for i in range(6):
        w[n + i] = w[S.geometry + GEOMETRY * c + 1 + i]
    w[n + 6] = w[n + 1] * w[t + 2] - w[n + 2] * w[t + 1]
    w[n + 7] = w[n + 2] * w[t] - w[n] * w[t + 2]
    w[n + 8] = w[n] * w[t + 1] - w[n + 1] * w[t]


@kernel("f8(F, i8, i8, i8)")
def _point_speed(w, frame, point, axis):
    """Return the velocity of the body point at ``point`` along ``axis`` [m/s]."""
    x, y, z = w[point] - w[frame], w[point + 1] - w[frame + 1], w[point + 2] - w[frame + 2]
    ox, oy, oz = w[frame + 15], w[frame + 16], w[frame + 17]
    return (
        w[axis] * (w[frame + 12] + oy * z - oz * y)
        + w[axis + 1] * (w[frame + 13] + oz * x - ox * z)
        + w[axis + 2] * (w[frame + 14] + ox * y - oy * x)
    )


@kernel("void(S, F, I, i8)")
def evaluate_rates(S, w, k, c):
    """Write the gap rate and slip velocity of contact ``c``, Eqs. (11) and (12)."""
    point = S.geometry + GEOMETRY * c + 7
    a, b = k[S.body_out + k[S.body_a + c]], k[S.body_out + k[S.body_b + c]]
    for r in range(3):
        axis = S.axes + 9 * c + 3 * r
        w[S.rate + 3 * c + r] = _point_speed(w, b, point + 3, axis) - _point_speed(w, a, point, axis)


@kernel("void(F, i8, i8, i8, i8, i8, f8)")
def _side_jacobian(w, frame, point, axes, n_u, out, sign):
    """Write the three rows of one body: sign * (axis, rho x axis) . frame Jacobian."""
    x, y, z = w[point] - w[frame], w[point + 1] - w[frame + 1], w[point + 2] - w[frame + 2]
    jacobian = frame + FRAME
    for r in range(3):
        ax, ay, az = w[axes + 3 * r], w[axes + 3 * r + 1], w[axes + 3 * r + 2]
        mx, my, mz = y * az - z * ay, z * ax - x * az, x * ay - y * ax
        for i in range(n_u):
            w[out + r * n_u + i] = sign * (
                ax * w[jacobian + i]
                + ay * w[jacobian + n_u + i]
                + az * w[jacobian + 2 * n_u + i]
                + mx * w[jacobian + 3 * n_u + i]
                + my * w[jacobian + 4 * n_u + i]
                + mz * w[jacobian + 5 * n_u + i]
            )


@kernel("void(F, i8, i8, i8, i8)")
def _side_response(w, jacobian, inverse_mass, n_u, out):
    """Write M^-1 J^T of one body, three rows of n_u."""
    for r in range(3):
        for i in range(n_u):
            total = 0.0
            for j in range(n_u):
                total += w[inverse_mass + i * n_u + j] * w[jacobian + r * n_u + j]
            w[out + r * n_u + i] = total


@kernel("i8(S, F, I, i8)")
def inverse_mass(S, w, k, body):
    """Return the offset of a body's M^-1 in its output block."""
    n_u = k[S.body_nu + body]
    return k[S.body_out + body] + FRAME + 6 * n_u + k[S.body_nq + body] + n_u


@kernel("void(S, F, I, i8, i8)")
def evaluate_jacobian(S, w, k, c, y):
    """Write W^T and N^T of contact ``c`` (rows n, t1, t2), M^-1 times them, and the prescribed rates."""
    point = S.geometry + GEOMETRY * c + 7
    a, b = k[S.body_a + c], k[S.body_b + c]
    n_a, n_b = k[S.body_nu + a], k[S.body_nu + b]
    j_a, j_b = k[S.jacobian_a + c], k[S.jacobian_b + c]
    _side_jacobian(w, k[S.body_out + a], point, S.axes + 9 * c, n_a, j_a, -1.0)
    _side_jacobian(w, k[S.body_out + b], point + 3, S.axes + 9 * c, n_b, j_b, 1.0)
    _side_response(w, j_a, inverse_mass(S, w, k, a), n_a, k[S.response_a + c])
    _side_response(w, j_b, inverse_mass(S, w, k, b), n_b, k[S.response_b + c])
    u_a, u_b = y + S.n_q + k[S.body_u + a], y + S.n_q + k[S.body_u + b]
    for r in range(3):
        own = 0.0
        for i in range(n_a):
            own += w[j_a + r * n_a + i] * w[u_a + i]
        for i in range(n_b):
            own += w[j_b + r * n_b + i] * w[u_b + i]
        w[S.prescribed_rate + 3 * c + r] = w[S.rate + 3 * c + r] - own


@kernel("f8(F, i8, i8, i8, f8, f8, f8)")
def _point_bias(w, frame, point, axis, sx, sy, sz):
    """Return the acceleration along ``axis`` of a witness that slides at (sx, sy, sz) over its body, u' = 0."""
    x, y, z = w[point] - w[frame], w[point + 1] - w[frame + 1], w[point + 2] - w[frame + 2]
    ox, oy, oz = w[frame + 15], w[frame + 16], w[frame + 17]
    bx, by, bz = w[frame + 21], w[frame + 22], w[frame + 23]
    # the witness point's velocity relative to the frame origin, as the turning body carries it
    vx, vy, vz = oy * z - oz * y + sx, oz * x - ox * z + sy, ox * y - oy * x + sz
    return (
        w[axis] * (w[frame + 18] + by * z - bz * y + oy * vz - oz * vy)
        + w[axis + 1] * (w[frame + 19] + bz * x - bx * z + oz * vx - ox * vz)
        + w[axis + 2] * (w[frame + 20] + bx * y - by * x + ox * vy - oy * vx)
    )


@kernel("void(S, F, I, i8, i8)")
def evaluate_bias(S, w, k, c, rows):
    """Write S_N and S_T of Eq. (13) with the prescribed accelerations: g'' and v' of contact ``c`` while u' = 0.

    Only the normal one with ``rows`` 1, all with 3.

    The witness points slide over their bodies at u and w, and the normal turns by nu relative to the
    first one: slide_a u = turn_a nu, slide_b w = -turn_b (nu - rho), w = u + g nu - d, with rho the
    relative turning of the bodies and d their relative velocity at the witness points, both in the
    tangent plane (physics of general shapes; for plane and sphere it gives the S terms of Eq. (13)).
    """
    geometry = S.geometry + GEOMETRY * c
    n = S.axes + 9 * c
    t1, t2 = n + 3, n + 6
    a, b = k[S.body_out + k[S.body_a + c]], k[S.body_out + k[S.body_b + c]]
    gap = w[geometry]
    # turning of the normal with the first body, (omega_A x n) in the tangent plane; rho likewise for B - A
    turn_a1 = w[a + 15] * w[t2] + w[a + 16] * w[t2 + 1] + w[a + 17] * w[t2 + 2]
    turn_a2 = -(w[a + 15] * w[t1] + w[a + 16] * w[t1 + 1] + w[a + 17] * w[t1 + 2])
    rho1 = w[b + 15] * w[t2] + w[b + 16] * w[t2 + 1] + w[b + 17] * w[t2 + 2] - turn_a1
    rho2 = -(w[b + 15] * w[t1] + w[b + 16] * w[t1 + 1] + w[b + 17] * w[t1 + 2]) - turn_a2
    v1, v2 = w[S.rate + 3 * c + 1], w[S.rate + 3 * c + 2]
    d1, d2 = v1 - gap * turn_a1, v2 - gap * turn_a2
    _witness_system(S, w, k, c, rho1, rho2, d1, d2)
    eliminate(w, S.matrix, 4, S.right)
    u1, u2, nu1, nu2 = w[S.right], w[S.right + 1], w[S.right + 2], w[S.right + 3]
    w1, w2 = u1 + gap * nu1 - d1, u2 + gap * nu2 - d2
    point = geometry + 7
    for r in range(rows):
        axis = S.axes + 9 * c + 3 * r
        w[S.bias + 3 * c + r] = _point_bias(
            w,
            b,
            point + 3,
            axis,
            w1 * w[t1] + w2 * w[t2],
            w1 * w[t1 + 1] + w2 * w[t2 + 1],
            w1 * w[t1 + 2] + w2 * w[t2 + 2],
        ) - _point_bias(
            w,
            a,
            point,
            axis,
            u1 * w[t1] + u2 * w[t2],
            u1 * w[t1 + 1] + u2 * w[t2 + 1],
            u1 * w[t1 + 2] + u2 * w[t2 + 2],
        )
    # the axes themselves turn: n' = omega_A x n + nu, and the tangents spin about n with the first body
    n1, n2 = turn_a1 + nu1, turn_a2 + nu2
    spin = w[a + 15] * w[n] + w[a + 16] * w[n + 1] + w[a + 17] * w[n + 2]
    rate = w[S.rate + 3 * c]
    w[S.bias + 3 * c] += n1 * v1 + n2 * v2
    if rows == 3:
        w[S.bias + 3 * c + 1] += spin * v2 - n1 * rate
        w[S.bias + 3 * c + 2] += -spin * v1 - n2 * rate


@kernel("void(S, F, I, i8, f8, f8, f8, f8)")
def _witness_system(S, w, k, c, rho1, rho2, d1, d2):
    """Write the 4 x 4 system for (u, nu): slide_a u - turn_a nu = 0, slide_b (u + g nu - d) + turn_b (nu - rho) = 0."""
    geometry = S.geometry + GEOMETRY * c
    gap = w[geometry]
    slide_a, turn_a, slide_b, turn_b = geometry + 13, geometry + 17, geometry + 21, geometry + 25
    for i in range(2):
        upper, lower = S.matrix + 4 * i, S.matrix + 8 + 4 * i
        for j in range(2):
            w[upper + j] = w[slide_a + 2 * i + j]
            w[upper + 2 + j] = -w[turn_a + 2 * i + j]
            w[lower + j] = w[slide_b + 2 * i + j]
            w[lower + 2 + j] = gap * w[slide_b + 2 * i + j] + w[turn_b + 2 * i + j]
        w[S.right + i] = 0.0
        w[S.right + 2 + i] = (
            w[slide_b + 2 * i] * d1
            + w[slide_b + 2 * i + 1] * d2
            + w[turn_b + 2 * i] * rho1
            + w[turn_b + 2 * i + 1] * rho2
        )


@room("void(S, F, I, i8, i8, i8)")
def evaluate_contact(S, w, k, c, y, rows):
    """Write everything about contact ``c`` at the state ``y``, the bodies being evaluated; ``rows`` of the bias."""
    evaluate_geometry(S, w, k, c)
    evaluate_rates(S, w, k, c)
    evaluate_jacobian(S, w, k, c, y)
    evaluate_bias(S, w, k, c, rows)


@room()
def evaluate_at(S, w, k):
    """Evaluate all bodies and contacts at the present time and state."""
    evaluate_bodies(S, w, k, S.t, S.y)
    for c in range(S.n_contacts):
        evaluate_contact(S, w, k, c, S.y, 3)
