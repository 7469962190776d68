"""Articulations: bodies that joints tie together. The rest of the engine sees each as one body with an inverse mass K.

The joints require A u = w with prescribed rates w. Their forces are eliminated from M u' = h + A^T mu, which gives
u' = K h - Y^T b with

    K = M^-1 - R^T Y,    R = A M^-1,    Y = (A R^T)^-1 R,

where b is the acceleration of the rows while u' = 0. Contact forces, impulses and projections act through K, so they
respect the joints at all times. The alternative, the joints as rows of the contact problem, would put equations of
every joint into every contact problem. K is evaluated once per state. Rows that others imply get a zero pivot in the
factor of A R^T, hence no force.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.kinematics import side_wrench, velocity_of_point
from nonsmooth.engine.memory.layout import SINGULAR
from nonsmooth.engine.native.kernel import (
    Articulation,
    Floats,
    JointRecord,
    Workspace,
    at,
    call_pair,
    frame_at,
    joint_row,
    kernel,
)
from nonsmooth.engine.numerics.linear import product
from nonsmooth.engine.numerics.vectors import Vector, dot, opposite


@kernel("f8(F, i8, v3, v3, v3)")
def _speed_along_row(floats: Floats, place: int, axis: Vector, point: Vector, moment: Vector) -> float:
    """Rate of a joint row due to the body with the frame at offset ``place`` [m/s, or 1/s if the row is an angle].

    It is ``axis`` . velocity of the ``point`` + ``moment`` . angular velocity. A row is a scalar condition of a joint.
    """
    velocity, spin = velocity_of_point(floats, place, point), frame_at(floats, place).spin
    return float(dot(axis, velocity) + moment[0] * spin[0] + moment[1] * spin[1] + moment[2] * spin[2])


@kernel("void(ws, JointRecord, Articulation)")
def _write_rows(ws: Workspace, joint: JointRecord, articulation: Articulation) -> None:
    """Evaluate the rows of a joint, and write them to its articulation, the bodies that joints tie together.

    Written are the Jacobian A, the residuals [m], the rates A u [m/s] and the biases b [m/s^2], or without m if the row
    is an angle. A joint is closed if its residuals are zero, and stays so if A u' + b = 0.
    """
    frame_a, frame_b = joint.frame_a, joint.frame_b
    a, b = at(ws.floats, frame_a), at(ws.floats, frame_b)
    call_pair(joint.function, a, b, at(ws.floats, joint.parameters), at(ws.floats, joint.out))
    for r in range(joint.n_rows):
        row, i = joint_row(ws.floats, joint.out, r), joint.first_row + r
        axis, moment = row.axis, row.moment
        line = articulation.jacobian + i * articulation.n_u
        side_a, side_b = line + joint.column_a, line + joint.column_b
        # a row of A is a unit wrench on the second body, and the opposite one on the first; other bodies keep zeros
        side_wrench(ws.floats, frame_a, row.point_a, opposite(axis), opposite(moment), joint.n_u_a, side_a)
        side_wrench(ws.floats, frame_b, row.point_b, axis, moment, joint.n_u_b, side_b)
        ws.floats[articulation.residual + i] = row.residual
        ws.floats[articulation.bias + i] = row.bias
        # driven bodies have no velocities in A, but their motion is part of the rate
        speed_b = _speed_along_row(ws.floats, frame_b, axis, row.point_b, moment)
        ws.floats[articulation.rate + i] = speed_b - _speed_along_row(ws.floats, frame_a, axis, row.point_a, moment)


@kernel("void(ws, Articulation)")
def _write_responses(ws: Workspace, articulation: Articulation) -> None:
    """Write M^-1 of the bodies of an articulation, and R = A M^-1 with the Jacobian A of its joints.

    M^-1 is block-diagonal, and goes to ``inverse``, which later becomes K, the inverse mass that the joints leave.
    """
    n, m = articulation.n_u, articulation.n_rows
    matrix, jacobian, r = articulation.inverse, articulation.jacobian, articulation.response
    for i in range(n * n):
        ws.floats[matrix + i] = 0.0
    for i in range(n * m):
        ws.floats[r + i] = 0.0
    for number in range(articulation.first_body, articulation.first_body + articulation.n_bodies):
        body = ws.bodies[number]
        # the inverse mass matrix of the body, and its first column in the articulation
        n_u, inverse, shift = body.n_u, body.tail + body.n_q + body.n_u, body.u - articulation.u
        for i in range(n_u):
            for j in range(n_u):
                entry = ws.floats[inverse + i * n_u + j]
                # saves time: many entries are zero
                if entry != 0.0:
                    ws.floats[matrix + (shift + i) * n + shift + j] = entry
                    for line in range(m):
                        ws.floats[r + line * n + shift + i] += entry * ws.floats[jacobian + line * n + shift + j]


@kernel("void(F, i8, i8)")
def _write_factor(floats: Floats, a: int, n: int) -> None:
    """Overwrite the symmetric n x n matrix at ``a`` by its lower Cholesky factor. Its upper half is not used.

    The matrix is A M^-1 A^T of joint rows. Rows that others imply get a zero pivot and column, hence no force.
    """
    for j in range(n):
        diagonal = floats[a + j * n + j]
        pivot = diagonal
        for i in range(j):
            pivot -= floats[a + j * n + i] * floats[a + j * n + i]
        # a row that others imply has a pivot of round-off; NaN counts as one, too
        if not pivot > SINGULAR * diagonal:
            for i in range(j, n):
                floats[a + i * n + j] = 0.0
            continue
        root = math.sqrt(pivot)
        floats[a + j * n + j] = root
        for i in range(j + 1, n):
            total = floats[a + i * n + j]
            for c in range(j):
                total -= floats[a + i * n + c] * floats[a + j * n + c]
            floats[a + i * n + j] = total / root


@kernel("void(F, i8, i8, i8, i8)")
def solve_factorised(floats: Floats, a: int, n: int, x: int, stride: int) -> None:
    """Overwrite the right-hand side at ``x``, with entries ``stride`` apart, by the solution with the factor at ``a``.

    ``a`` holds the n x n Cholesky factor of :func:`_write_factor`. Unknowns of zero pivots are zero. A stride of 1 is
    for a vector, the length of a row for a column of a matrix.
    """
    # forward, then backward substitution
    for i in range(n):
        total = floats[x + i * stride]
        for c in range(i):
            total -= floats[a + i * n + c] * floats[x + c * stride]
        floats[x + i * stride] = total / floats[a + i * n + i] if floats[a + i * n + i] > 0.0 else 0.0
    for i in range(n - 1, -1, -1):
        total = floats[x + i * stride]
        for c in range(i + 1, n):
            total -= floats[a + c * n + i] * floats[x + c * stride]
        floats[x + i * stride] = total / floats[a + i * n + i] if floats[a + i * n + i] > 0.0 else 0.0


@kernel("void(ws, Articulation)")
def evaluate_articulation(ws: Workspace, articulation: Articulation) -> None:
    """Write the rows of the joints of an articulation, the bodies tied together, and its inverse mass K with joints.

    K = M^-1 - R^T Y, with R = A M^-1 and Y = (A R^T)^-1 R, where A is the Jacobian of the joints. The bodies must be
    evaluated. ``u_free`` holds their velocities, and loses the part that driven bodies prescribe through joints.
    """
    for number in range(articulation.first_joint, articulation.first_joint + articulation.n_joints):
        _write_rows(ws, ws.joints[number], articulation)
    _write_responses(ws, articulation)
    n, m = articulation.n_u, articulation.n_rows
    jacobian, r, y = articulation.jacobian, articulation.response, articulation.solved_response
    matrix, factor = articulation.inverse, articulation.factor
    # factor of A R^T: its lower half is enough
    for i in range(m):
        for j in range(i + 1):
            ws.floats[factor + i * m + j] = product(ws.floats, 0.0, jacobian + i * n, r + j * n, n)
    _write_factor(ws.floats, factor, m)
    # Y, solved column by column, whose entries are n apart
    for i in range(m * n):
        ws.floats[y + i] = ws.floats[r + i]
    for k in range(n):
        solve_factorised(ws.floats, factor, m, y + k, n)
    # M^-1 becomes K in place; zero entries are skipped, as there are many
    for i in range(n):
        for line in range(m):
            entry = ws.floats[r + line * n + i]
            if entry != 0.0:
                for j in range(n):
                    ws.floats[matrix + i * n + j] -= entry * ws.floats[y + line * n + j]
    # a joint ties it to a driven body
    if articulation.is_driven:
        _remove_prescribed_velocities(ws, articulation)


@kernel("f8(ws, Articulation)")
def _power(ws: Workspace, articulation: Articulation) -> float:
    """Power of the forces on the bodies of an articulation at the velocities ``u_free`` [W].

    Forces of contacts and joints are not among them.
    """
    power, velocities = 0.0, ws.island.u_free.start
    for number in range(articulation.first_body, articulation.first_body + articulation.n_bodies):
        body = ws.bodies[number]
        # the forces follow the coordinate rates in the output block of a body
        power = product(ws.floats, power, body.tail + body.n_q, velocities + body.u, body.n_u)
    return power


@kernel("void(ws, Articulation, i8, f8, i8)")
def subtract_response(ws: Workspace, articulation: Articulation, line: int, factor: float, out: int) -> None:
    """Subtract ``factor`` times row ``line`` of Y from velocities or accelerations of an articulation at ``out``.

    Row ``line`` of Y = (A M^-1 A^T)^-1 A M^-1 is the change of the velocities that changes the rate of this joint row
    by 1, and no other rate. Bodies without a response keep their numbers even if ``factor`` is infinite, in a step that
    is too long: the next step may not evaluate those in ballistic motion.
    """
    response = articulation.solved_response + line * articulation.n_u
    for i in range(articulation.n_u):
        if ws.floats[response + i] != 0.0:
            ws.floats[out + i] -= ws.floats[response + i] * factor


@kernel("void(ws, Articulation)")
def _remove_prescribed_velocities(ws: Workspace, articulation: Articulation) -> None:
    """Subtract from ``u_free`` the velocities that driven bodies impose through joints, Y^T w with the rates w = A u.

    The power mu . w of the joint forces on the driven bodies is added to ``driven_power`` [W], without the part that
    contact forces cause. With mu = -Y h - (A R^T)^-1 b it has two terms: the power that the forces h lose by the change
    of the velocities, and -w . (A R^T)^-1 b.
    """
    n, m = articulation.n_u, articulation.n_rows
    # x, the place of the joint forces, is a work array here
    u, x = ws.island.u_free.start + articulation.u, articulation.forces
    # first term: power of h after the change less that before it
    ws.step.driven_power -= _power(ws, articulation)
    # all rates w first, because the subtraction changes u
    for line in range(m):
        ws.floats[x + line] = product(ws.floats, 0.0, articulation.jacobian + line * n, u, n)
    for line in range(m):
        subtract_response(ws, articulation, line, ws.floats[x + line], u)
    ws.step.driven_power += _power(ws, articulation)
    # second term: x becomes (A R^T)^-1 w
    solve_factorised(ws.floats, articulation.factor, m, x, stride=1)
    for line in range(m):
        ws.step.driven_power -= ws.floats[x + line] * ws.floats[articulation.bias + line]


@kernel("void(ws, i8)")
def constrain(ws: Workspace, number: int) -> None:
    """Subtract from the accelerations ``du`` of articulation ``number`` what its joints forbid: Y^T (A du + b).

    Afterwards A du + b = 0, the condition that the joints stay closed. b are the accelerations of the rows while
    u' = 0.
    """
    articulation = ws.articulations[number]
    n, m = articulation.n_u, articulation.n_rows
    # x, the place of the joint forces, is a work array here
    du, x = ws.island.du.start + articulation.u, articulation.forces
    # all rows first, because the subtraction changes du
    for line in range(m):
        bias = ws.floats[articulation.bias + line]
        ws.floats[x + line] = product(ws.floats, bias, articulation.jacobian + line * n, du, n)
    for line in range(m):
        subtract_response(ws, articulation, line, ws.floats[x + line], du)
