"""Contacts at a state: gaps, relative rates, Jacobians, second-order terms."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.anisotropy import stretch_bias, stretch_tangents
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW, SECOND_ROW
from nonsmooth.engine.native.kernel import (
    Floats,
    Workspace,
    at,
    call_pair,
    entry_point,
    frame_at,
    kernel,
)
from nonsmooth.engine.numerics.linear import multiply, product
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, length, minus, opposite, scaled

UNSEEN = -1
"""A contact that nothing was evaluated of has seen this version of its bodies, which none has."""


@kernel("void(ws, i8)")
def evaluate_geometry(ws: Workspace, c: int) -> None:
    """Write gap, witness points, curvature and the axes n, t1, t2 of contact ``c``."""
    contact = ws.contacts[c]
    call_pair(
        contact.geometry_function,
        at(ws.floats, contact.frame_a),
        at(ws.floats, contact.frame_b),
        at(ws.floats, contact.geometry_parameters),
        contact.geometry,
    )
    contact.axis_n, contact.axis_1 = contact.normal, contact.tangent
    contact.axis_2 = cross(contact.normal, contact.tangent)
    if contact.is_compliant:
        contact.overlap = 0.0
        if contact.gap < 0.0 < contact.past_feature:
            # bodies that press into each other are no sign that a contact was passed, as long as another one presses
            contact.overlap = contact.gap
            contact.gap = length((contact.gap, contact.past_feature))


@kernel("v3(F, i8, v3)")
def _velocity(w: Floats, place: int, point: Vector) -> Vector:
    """Return the velocity of a point fixed to a frame."""
    frame = frame_at(w, place)
    x, y, z = minus(point, frame.origin)
    ox, oy, oz = frame.spin
    ux, uy, uz = frame.velocity
    return ux + oy * z - oz * y, uy + oz * x - ox * z, uz + ox * y - oy * x


@kernel("void(ws, i8)")
def evaluate_rates(ws: Workspace, c: int) -> None:
    """Write the gap rate and slip velocity of contact ``c``, Eqs. (11) and (12)."""
    contact = ws.contacts[c]
    v = minus(
        _velocity(ws.floats, contact.frame_b, contact.point_b), _velocity(ws.floats, contact.frame_a, contact.point_a)
    )
    if contact.is_anisotropic:
        t1, t2 = contact.tangent, cross(contact.normal, contact.tangent)
        contact.slip_of_tangents = dot(t1, v), dot(t2, v)
        stretch_tangents(ws, c, t1, t2)
    contact.velocity = dot(contact.axis_n, v), dot(contact.axis_1, v), dot(contact.axis_2, v)


@kernel("void(ws, i8)")
def evaluate_kinematics(ws: Workspace, c: int) -> None:
    """Write geometry and rates of contact ``c``, unless they are those of its bodies as these stand."""
    contact = ws.contacts[c]
    version_a = ws.bodies[contact.body_a].version
    version_b = ws.bodies[contact.body_b].version
    if contact.version_a == version_a and contact.version_b == version_b:
        return
    evaluate_geometry(ws, c)
    evaluate_rates(ws, c)
    # which way one faces hangs on more than its bodies
    contact.version_a = version_a if not contact.is_anisotropic else UNSEEN
    contact.version_b = version_b


@kernel("f8(F, i8, i8, v3, v3)")
def _entry(w: Floats, column: int, n_u: int, axis: Vector, moment: Vector) -> float:
    """Return what a column of a frame's Jacobian has along an axis and a moment."""
    v, o = column, column + 3 * n_u
    linear = axis[0] * w[v] + axis[1] * w[v + n_u] + axis[2] * w[v + 2 * n_u]
    return linear + moment[0] * w[o] + moment[1] * w[o + n_u] + moment[2] * w[o + 2 * n_u]


@kernel("v3(F, i8, i8, v3, v3)")
def side_entries(w: Floats, frame: int, first: int, axis: Vector, moment: Vector) -> Vector:
    """Return three entries, from the ``first`` on, of the row of a body of six velocities."""
    column = frame + FRAME + first
    return (
        _entry(w, column, 6, axis, moment),
        _entry(w, column + 1, 6, axis, moment),
        _entry(w, column + 2, 6, axis, moment),
    )


@kernel("void(F, i8, v3, v3, i8, i8)")
def side_row(w: Floats, frame: int, point: Vector, axis: Vector, n_u: int, out: int) -> None:
    """Write the row of one body: (axis, rho x axis) . frame Jacobian."""
    if n_u == 0:
        return
    moment, first = cross(minus(point, frame_at(w, frame).origin), axis), frame + FRAME
    if n_u == 6:
        for j in range(6):
            w[out + j] = _entry(w, first + j, 6, axis, moment)
        return
    for j in range(n_u):
        w[out + j] = _entry(w, first + j, n_u, axis, moment)


@kernel("void(F, i8, v3, v3, v3, i8, i8)")
def side_wrench(w: Floats, frame: int, point: Vector, force: Vector, moment: Vector, n_u: int, out: int) -> None:
    """Write the row of one body: of a force at a point and a moment, in world components."""
    side_row(w, frame, point, force, n_u, out)
    for j in range(n_u):
        o = frame + FRAME + j + 3 * n_u
        w[out + j] += moment[0] * w[o] + moment[1] * w[o + n_u] + moment[2] * w[o + 2 * n_u]


@kernel("i8(ws, i8, i8)")
def _row_a(ws: Workspace, c: int, r: int) -> int:
    """Return where row ``r`` of the first Jacobian of contact ``c`` has the coordinates of the body in contact."""
    contact = ws.contacts[c]
    return int(contact.jacobian_a + r * ws.articulations[contact.articulation_a].n_u + contact.column_a)


@kernel("i8(ws, i8, i8)")
def _row_b(ws: Workspace, c: int, r: int) -> int:
    """Return the same of the second Jacobian."""
    contact = ws.contacts[c]
    return int(contact.jacobian_b + r * ws.articulations[contact.articulation_b].n_u + contact.column_b)


@kernel("void(ws, i8, i8, v3, v3)")
def wrench_row(ws: Workspace, c: int, r: int, force: Vector, moment: Vector) -> None:
    """Write row ``r`` of contact ``c``: what a force and a moment on the second body do, in world components."""
    contact, row_a, row_b = ws.contacts[c], _row_a(ws, c, r), _row_b(ws, c, r)
    side_wrench(ws.floats, contact.frame_a, contact.point_a, opposite(force), opposite(moment), contact.n_u_a, row_a)
    side_wrench(ws.floats, contact.frame_b, contact.point_b, force, moment, contact.n_u_b, row_b)


@kernel("void(ws, i8, i8, v3)")
def evaluate_row(ws: Workspace, c: int, r: int, axis: Vector) -> None:
    """Write row ``r`` of the Jacobians of contact ``c``: of the relative velocity along the axis given."""
    contact = ws.contacts[c]
    side_row(ws.floats, contact.frame_a, contact.point_a, opposite(axis), contact.n_u_a, _row_a(ws, c, r))
    side_row(ws.floats, contact.frame_b, contact.point_b, axis, contact.n_u_b, _row_b(ws, c, r))


@kernel("void(ws, i8, i8, i8)")
def evaluate_row_response(ws: Workspace, c: int, r: int, s: int) -> None:
    """Write response ``s`` of contact ``c``: K times row ``r`` of its Jacobians, whose zeros are skipped.

    K is M^-1, less what the joints take.
    """
    contact = ws.contacts[c]
    for side in range(2):
        articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
        n_u = articulation.n_u
        jacobian = (contact.jacobian_a if side == 0 else contact.jacobian_b) + r * n_u
        response = (contact.response_a if side == 0 else contact.response_b) + s * n_u
        multiply(ws.floats, articulation.inverse, n_u, jacobian, response)


@kernel("void(ws, i8, i8, f8, i8)")
def push_response(ws: Workspace, c: int, s: int, force: float, du: int) -> None:
    """Add the accelerations that a force in column ``s`` of contact ``c`` gives to ``du``."""
    contact = ws.contacts[c]
    for side in range(2):
        articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
        response = contact.response_a if side == 0 else contact.response_b
        n_u = articulation.n_u
        for i in range(n_u):
            ws.floats[du + articulation.u + i] += ws.floats[response + s * n_u + i] * force


@kernel("f8(ws, i8, i8, i8)")
def row(ws: Workspace, c: int, r: int, du: int) -> float:
    """Return row ``r`` (n, t1, t2) of [W N]^T du of contact ``c``."""
    contact = ws.contacts[c]
    a, b = ws.articulations[contact.articulation_a], ws.articulations[contact.articulation_b]
    total = product(ws.floats, 0.0, contact.jacobian_a + r * a.n_u, du + a.u, a.n_u)
    return float(product(ws.floats, total, contact.jacobian_b + r * b.n_u, du + b.u, b.n_u))


@kernel("void(ws, i8)")
def evaluate_jacobian(ws: Workspace, c: int) -> None:
    """Write W^T and N^T of contact ``c`` (rows n, t1, t2), K times them, and the prescribed rates."""
    contact = ws.contacts[c]
    evaluate_row(ws, c, NORMAL_ROW, contact.axis_n)
    evaluate_row(ws, c, FIRST_ROW, contact.axis_1)
    evaluate_row(ws, c, SECOND_ROW, contact.axis_2)
    for r in range(3):
        evaluate_row_response(ws, c, r, r)
        contact.prescribed_rate[r] = contact.rate[r] - row(ws, c, r, ws.island.velocities)


@kernel("v3(F, i8, v3, v3, v3)")
def _acceleration(w: Floats, place: int, point: Vector, slide_1: Vector, slide_2: Vector) -> Vector:
    """Return the acceleration of a point that slides along a frame, at the sum of two velocities, as it is carried."""
    frame = frame_at(w, place)
    x, y, z = minus(point, frame.origin)
    ox, oy, oz = frame.spin
    bx, by, bz = frame.spin_acceleration
    cx, cy, cz = frame.acceleration
    vx = oy * z - oz * y + slide_1[0] + slide_2[0]
    vy = oz * x - ox * z + slide_1[1] + slide_2[1]
    vz = ox * y - oy * x + slide_1[2] + slide_2[2]
    return (
        cx + by * z - bz * y + oy * vz - oz * vy,
        cy + bz * x - bx * z + oz * vx - ox * vz,
        cz + bx * y - by * x + ox * vy - oy * vx,
    )


@kernel("void(ws, i8, i8)")
def evaluate_bias(ws: Workspace, c: int, rows: int) -> None:
    """Write S_N and S_T of Eq. (13) with the prescribed accelerations: g'' and v' of contact ``c`` while u' = 0.

    Only the normal one with ``rows`` 1, all with 3.

    The witness points slide over their bodies at u and w, and the normal turns by nu relative to the
    first one: slide_a u = turn_a nu, slide_b w = -turn_b (nu - rho), w = u + g nu - d, with rho the
    relative turning of the bodies and d their relative velocity at the witness points, both in the
    tangent plane (physics of general shapes; for plane and sphere it gives the S terms of Eq. (13)).
    """
    contact = ws.contacts[c]
    n, t1, t2, slip = contact.axis_n, contact.axis_1, contact.axis_2, contact.slip
    if contact.is_anisotropic:
        t1, t2, slip = contact.tangent, cross(contact.normal, contact.tangent), contact.slip_of_tangents
    a, b = frame_at(ws.floats, contact.frame_a), frame_at(ws.floats, contact.frame_b)
    gap = contact.gap
    # turning of the normal with the first body, (omega_A x n) in the tangent plane; rho likewise for B - A
    turn_a1, turn_a2 = dot(a.spin, t2), -dot(a.spin, t1)
    rho1, rho2 = dot(b.spin, t2) - turn_a1, -dot(b.spin, t1) - turn_a2
    v1, v2 = slip
    d1, d2 = v1 - gap * turn_a1, v2 - gap * turn_a2
    # slide and turn of one surface commute, so u = turn_a x, nu = slide_a x leaves two unknowns
    slide_a, turn_a, slide_b, turn_b = contact.slide_a, contact.turn_a, contact.slide_b, contact.turn_b
    r1 = slide_b[0] * d1 + slide_b[1] * d2 + turn_b[0] * rho1 + turn_b[1] * rho2
    r2 = slide_b[2] * d1 + slide_b[3] * d2 + turn_b[2] * rho1 + turn_b[3] * rho2
    (s11, s12, s21, s22), (g11, g12, g21, g22), (h11, h12, h21, h22) = slide_a, slide_b, turn_b
    reach_11, reach_12 = turn_a[0] + gap * s11, turn_a[1] + gap * s12
    reach_21, reach_22 = turn_a[2] + gap * s21, turn_a[3] + gap * s22
    m11 = (g11 * reach_11 + h11 * s11) + (g12 * reach_21 + h12 * s21)
    m12 = (g11 * reach_12 + h11 * s12) + (g12 * reach_22 + h12 * s22)
    m21 = (g21 * reach_11 + h21 * s11) + (g22 * reach_21 + h22 * s21)
    m22 = (g21 * reach_12 + h21 * s12) + (g22 * reach_22 + h22 * s22)
    determinant = m11 * m22 - m12 * m21
    if determinant == 0.0:
        # a trial step far too long; what is not a number rejects it, where plain Python would raise
        determinant = math.nan
    x1, x2 = (m22 * r1 - m12 * r2) / determinant, (m11 * r2 - m21 * r1) / determinant
    u1, u2 = turn_a[0] * x1 + turn_a[1] * x2, turn_a[2] * x1 + turn_a[3] * x2
    nu1, nu2 = slide_a[0] * x1 + slide_a[1] * x2, slide_a[2] * x1 + slide_a[3] * x2
    w1, w2 = u1 + gap * nu1 - d1, u2 + gap * nu2 - d2
    # the witness points' accelerations, second minus first, as the turning bodies carry the sliding points
    acceleration = minus(
        _acceleration(ws.floats, contact.frame_b, contact.point_b, scaled(w1, t1), scaled(w2, t2)),
        _acceleration(ws.floats, contact.frame_a, contact.point_a, scaled(u1, t1), scaled(u2, t2)),
    )
    # the axes themselves turn: n' = omega_A x n + nu, and the tangents spin about n with the first body
    n1, n2 = turn_a1 + nu1, turn_a2 + nu2
    spin, rate = dot(a.spin, n), contact.rate[0]
    contact.bias[0] = dot(n, acceleration) + (n1 * v1 + n2 * v2)
    if rows == 3:
        contact.bias[1] = dot(t1, acceleration) + spin * v2 - n1 * rate
        contact.bias[2] = dot(t2, acceleration) - spin * v1 - n2 * rate
        if contact.is_anisotropic:
            stretch_bias(ws, c)


@entry_point("void(ws, i8, i8)")
def evaluate_contact(ws: Workspace, c: int, rows: int) -> None:
    """Write everything about contact ``c``, the bodies being evaluated; ``rows`` of the bias."""
    evaluate_geometry(ws, c)
    evaluate_rates(ws, c)
    evaluate_jacobian(ws, c)
    evaluate_bias(ws, c, rows)
