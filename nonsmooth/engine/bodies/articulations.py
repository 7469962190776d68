"""Articulations: bodies tied by joints, which the rest of the engine sees as one body with fewer ways to move.

With the joints' rows A (A u + prescribed = 0) the accelerations that forces give are K = M^-1 - R^T Y,
R = A M^-1, Y = (A R^T)^-1 R, so that contact forces, impulses and projections respect the joints at all times.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.kinematics import side_wrench
from nonsmooth.engine.native.kernel import (
    Floats,
    Workspace,
    at,
    call_pair,
    frame_at,
    joint_row,
    kernel,
)
from nonsmooth.engine.numerics.linear import SINGULAR
from nonsmooth.engine.numerics.vectors import Vector, minus, opposite


@kernel("f8(F, i8, v3, v3, v3)")
def _speed(w: Floats, place: int, axis: Vector, point: Vector, moment: Vector) -> float:
    """Return how fast a frame moves along a row: axis . velocity of the point + moment . angular velocity."""
    frame = frame_at(w, place)
    x, y, z = minus(point, frame.origin)
    ox, oy, oz = frame.spin
    vx, vy, vz = frame.velocity
    return float(
        axis[0] * (vx + oy * z - oz * y)
        + axis[1] * (vy + oz * x - ox * z)
        + axis[2] * (vz + ox * y - oy * x)
        + moment[0] * ox
        + moment[1] * oy
        + moment[2] * oz
    )


@kernel("void(ws, i8, i8)")
def _write_rows(ws: Workspace, joint_number: int, number: int) -> None:
    """Write rows, residuals, rates and biases of a joint of an articulation, behind those of the joints before."""
    joint, articulation = ws.joints[joint_number], ws.articulations[number]
    frame_a, frame_b = joint.frame_a, joint.frame_b
    call_pair(
        joint.function,
        at(ws.floats, frame_a),
        at(ws.floats, frame_b),
        at(ws.floats, joint.parameters),
        at(ws.floats, joint.out),
    )
    for r in range(joint.n_rows):
        row, i = joint_row(ws.floats, joint.out, r), joint.first_row + r
        axis, moment = row.axis, row.moment
        line = articulation.jacobian + i * articulation.n_u
        side_a, side_b = line + joint.column_a, line + joint.column_b
        side_wrench(ws.floats, frame_a, row.point_a, opposite(axis), opposite(moment), joint.n_u_a, side_a)
        side_wrench(ws.floats, frame_b, row.point_b, axis, moment, joint.n_u_b, side_b)
        ws.floats[articulation.residual + i] = row.residual
        ws.floats[articulation.bias + i] = row.bias
        ws.floats[articulation.rate + i] = _speed(ws.floats, frame_b, axis, row.point_b, moment) - _speed(
            ws.floats, frame_a, axis, row.point_a, moment
        )


@kernel("void(ws, i8)")
def _inverse_masses(ws: Workspace, number: int) -> None:
    """Write M^-1 of the articulation's bodies to K and R = A M^-1."""
    articulation = ws.articulations[number]
    n, m = articulation.n_u, articulation.n_rows
    matrix, jacobian, r = articulation.inverse, articulation.jacobian, articulation.response
    for i in range(n * n):
        ws.floats[matrix + i] = 0.0
    for i in range(n * m):
        ws.floats[r + i] = 0.0
    for one in range(articulation.first_body, articulation.first_body + articulation.n_bodies):
        body = ws.bodies[one]
        n_u = body.n_u
        shift = body.u - articulation.u
        inverse = body.tail + body.n_q + n_u
        for i in range(n_u):
            for j in range(n_u):
                entry = ws.floats[inverse + i * n_u + j]
                if entry != 0.0:
                    ws.floats[matrix + (shift + i) * n + shift + j] = entry
                    for line in range(m):
                        ws.floats[r + line * n + shift + i] += entry * ws.floats[jacobian + line * n + shift + j]


@kernel("void(F, i8, i8)")
def _factorise(w: Floats, a: int, n: int) -> None:
    """Overwrite the symmetric matrix at ``a`` by its Cholesky factor; rows that others imply get a zero pivot."""
    for j in range(n):
        own = w[a + j * n + j]
        pivot = own
        for i in range(j):
            pivot -= w[a + j * n + i] * w[a + j * n + i]
        if not pivot > SINGULAR * own:
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
def substitute(w: Floats, a: int, n: int, x: int, stride: int) -> None:
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


@kernel("void(ws, i8)")
def evaluate_articulation(ws: Workspace, number: int) -> None:
    """Write K, Y, residuals and rates of the joints, the part of u that is not prescribed, and the driven power."""
    articulation = ws.articulations[number]
    for joint in range(articulation.first_joint, articulation.first_joint + articulation.n_joints):
        _write_rows(ws, joint, number)
    _inverse_masses(ws, number)
    n, m = articulation.n_u, articulation.n_rows
    jacobian, r, y = articulation.jacobian, articulation.response, articulation.solved_response
    matrix, factor = articulation.inverse, articulation.factor
    for i in range(m):
        for j in range(i + 1):
            total = 0.0
            for c in range(n):
                total += ws.floats[jacobian + i * n + c] * ws.floats[r + j * n + c]
            ws.floats[factor + i * m + j] = total
    _factorise(ws.floats, factor, m)
    for i in range(m * n):
        ws.floats[y + i] = ws.floats[r + i]
    for c in range(n):
        substitute(ws.floats, factor, m, y + c, n)
    for i in range(n):
        for line in range(m):
            entry = ws.floats[r + line * n + i]
            if entry != 0.0:
                for j in range(n):
                    ws.floats[matrix + i * n + j] -= entry * ws.floats[y + line * n + j]
    _prescribe(ws, number)


@kernel("f8(ws, i8)")
def _power(ws: Workspace, number: int) -> float:
    """Return the power of the bodies' own forces on the velocities ``u_free``."""
    articulation, power = ws.articulations[number], 0.0
    for one in range(articulation.first_body, articulation.first_body + articulation.n_bodies):
        body = ws.bodies[one]
        for i in range(body.n_u):
            power += ws.floats[body.tail + body.n_q + i] * ws.island.u_free[body.u + i]
    return power


@kernel("void(ws, i8)")
def _prescribe(ws: Workspace, number: int) -> None:
    """Take off the velocities that driven bodies impose through joints, and book their power but for contact forces."""
    articulation = ws.articulations[number]
    if not articulation.is_driven:
        return
    n, m = articulation.n_u, articulation.n_rows
    u, x = ws.island.u_free.start + articulation.u, articulation.forces
    ws.step.driven_power -= _power(ws, number)
    for line in range(m):
        total = 0.0
        for c in range(n):
            total += ws.floats[articulation.jacobian + line * n + c] * ws.floats[u + c]
        ws.floats[x + line] = total
    for line in range(m):
        for c in range(n):
            ws.floats[u + c] -= ws.floats[articulation.solved_response + line * n + c] * ws.floats[x + line]
    ws.step.driven_power += _power(ws, number)
    substitute(ws.floats, articulation.factor, m, x, 1)
    for line in range(m):
        ws.step.driven_power -= ws.floats[x + line] * ws.floats[articulation.bias + line]


@kernel("void(ws, i8)")
def constrain(ws: Workspace, number: int) -> None:
    """Subtract from the accelerations ``du`` of an articulation what its joints do not allow: Y^T (A du + bias)."""
    articulation = ws.articulations[number]
    n, m = articulation.n_u, articulation.n_rows
    du, x = ws.island.du.start + articulation.u, articulation.forces
    for line in range(m):
        total = ws.floats[articulation.bias + line]
        for c in range(n):
            total += ws.floats[articulation.jacobian + line * n + c] * ws.floats[du + c]
        ws.floats[x + line] = total
    for line in range(m):
        for c in range(n):
            ws.floats[du + c] -= ws.floats[articulation.solved_response + line * n + c] * ws.floats[x + line]
