"""The force of a rigid contact that slides alone, between a free body and one without coordinates.

This is the most common island of all. :mod:`nonsmooth.engine.contact.closed_contacts` solves any island, but writes
Jacobians and responses to the workspace and reads them again, which takes most of the time of a right-hand side. Here
the rows of the one body stay in registers. The equations are the same: with the force direction p = n - mu d, of which
the friction is a part, the normal force is

    f_n = -(bias + n . a) / (n . K p),

where a is the acceleration without contact forces and K the inverse mass matrix.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_geometry, evaluate_rates, side_entries
from nonsmooth.engine.contact.problem import slip_coefficient, slip_direction
from nonsmooth.engine.memory.modes import NO_CONTACT, Mode
from nonsmooth.engine.native.kernel import Floats, Workspace, frame_at, kernel
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, length, minus


@kernel("i8(ws, i8)")
def lone_sliding_contact(ws: Workspace, group: int) -> int:
    """Contact of an island if :func:`add_lone_slip_force` can find its force in closed form, or -1.

    With -1, the general equations are solved. The contact must be alone, rigid, and slide between a free body in space
    (six velocities, no joint) and one without coordinates. In an implicit stage none qualifies, because the slip is
    part of the problem.
    """
    first = ws.island.group_start[group]
    c = ws.island.grouped[first]
    contact = ws.contacts[c]
    if ws.island.group_start[group + 1] - first != 1 or contact.mode != Mode.SLIDE or ws.problem.stage_time > 0.0:
        return NO_CONTACT
    is_special = contact.is_compliant or contact.is_averaged or contact.is_anisotropic
    n_u_a, n_u_b = contact.n_u_a, contact.n_u_b
    if is_special or n_u_a + n_u_b != 6 or min(n_u_a, n_u_b) != 0:
        return NO_CONTACT
    # the moving body is an articulation (set of bodies that joints connect) of its own, without rows of joints
    one, two = ws.articulations[contact.articulation_a], ws.articulations[contact.articulation_b]
    return int(c if one.n_u + two.n_u == 6 and one.n_rows + two.n_rows == 0 else NO_CONTACT)


@kernel("v3(F, i8, v3, v3)")
def _three_rows_times(floats: Floats, row: int, x: Vector, y: Vector) -> Vector:
    """Three rows of a matrix of six columns, the first at ``row``, times the vector of six numbers (x, y)."""
    a = floats[row] * x[0] + floats[row + 1] * x[1] + floats[row + 2] * x[2]
    b = floats[row + 6] * x[0] + floats[row + 7] * x[1] + floats[row + 8] * x[2]
    c = floats[row + 12] * x[0] + floats[row + 13] * x[1] + floats[row + 14] * x[2]
    return (
        a + floats[row + 3] * y[0] + floats[row + 4] * y[1] + floats[row + 5] * y[2],
        b + floats[row + 9] * y[0] + floats[row + 10] * y[1] + floats[row + 11] * y[2],
        c + floats[row + 15] * y[0] + floats[row + 16] * y[1] + floats[row + 17] * y[2],
    )


@kernel("f8(F, i8, v3, v3)")
def _dot_at(floats: Floats, first: int, x: Vector, y: Vector) -> float:
    """Scalar product of six numbers in the workspace, from ``first`` on, and (x, y)."""
    upper = floats[first], floats[first + 1], floats[first + 2]
    return dot(x, upper) + dot(y, (floats[first + 3], floats[first + 4], floats[first + 5]))


@kernel("void(F, i8, f8, v3)")
def _add_multiple(floats: Floats, first: int, factor: float, x: Vector) -> None:
    """Add ``factor`` times ``x`` to the vector of three numbers in the workspace that begins at ``first``."""
    floats[first] += x[0] * factor
    floats[first + 1] += x[1] * factor
    floats[first + 2] += x[2] * factor


@kernel("b1(ws, i8)")
def add_lone_slip_force(ws: Workspace, c: int) -> bool:
    """Find the force of contact ``c``, which slides alone [N]. Add its response to ``du``, and its power.

    Before: ``du`` holds the acceleration without contact forces. Evaluates geometry, rates and bias of the contact. The
    power is added to that of driven bodies. False, with no force, if it could not accelerate the contact: the general
    equations are then solved.
    """
    contact = ws.contacts[c]
    evaluate_geometry(ws, c)
    evaluate_rates(ws, c)
    evaluate_bias(ws, c, rows=1)
    n, t1, t2, slip = contact.axis_n, contact.axis_1, contact.axis_2, contact.slip
    d1, d2 = slip_direction(ws, c, slip, ws.tolerance.velocity, may_reverse=False)
    mu = slip_coefficient(ws, c, length(slip))
    m1, m2 = mu * d1, mu * d2
    # direction of the contact force, per unit of normal force
    p = n[0] - m1 * t1[0] - m2 * t2[0], n[1] - m1 * t1[1] - m2 * t2[1], n[2] - m1 * t1[2] - m2 * t2[2]
    # the relative motion is that of the second body against the first, of which one has no coordinates
    is_second_moving = contact.n_u_b > 0
    sign = 1.0 if is_second_moving else -1.0
    frame = contact.frame_b if is_second_moving else contact.frame_a
    articulation = ws.articulations[contact.articulation_b if is_second_moving else contact.articulation_a]
    inverse, du, u = articulation.inverse, ws.island.du.start + articulation.u, ws.island.velocities + articulation.u
    offset = minus(contact.point_b if is_second_moving else contact.point_a, frame_at(ws.floats, frame).origin)
    # rows of the Jacobian along n and along p, each in two halves of three numbers
    moment_n, moment_p = cross(offset, n), cross(offset, p)
    n_1, n_2 = side_entries(ws.floats, frame, 0, n, moment_n), side_entries(ws.floats, frame, 3, n, moment_n)
    p_1, p_2 = side_entries(ws.floats, frame, 0, p, moment_p), side_entries(ws.floats, frame, 3, p, moment_p)
    # acceleration of the body per unit of normal force; row 3 of the inverse mass matrix is 18 numbers on
    response_1 = _three_rows_times(ws.floats, inverse, p_1, p_2)
    response_2 = _three_rows_times(ws.floats, inverse + 18, p_1, p_2)
    inverse_mass = dot(n_1, response_1) + dot(n_2, response_2)
    if inverse_mass == 0.0:
        return False
    if inverse_mass < 0.0:
        # more force means more approach (Painleve's paradox): the control of the step halves the step
        ws.island.singular_contact = c
    # along the normal: acceleration of the contact without its force
    free = sign * _dot_at(ws.floats, du, n_1, n_2)
    rate_along_p = sign * _dot_at(ws.floats, u, p_1, p_2)
    force = (-contact.bias[0] - free) / inverse_mass
    _add_multiple(ws.floats, du, sign * force, response_1)
    _add_multiple(ws.floats, du + 3, sign * force, response_2)
    # without a friction moment, unique, and not sticking
    contact.dissipated_by_spin, contact.has_redundant_force, contact.is_held_by_friction = 0.0, False, False
    contact.force[0], contact.force[1], contact.force[2] = force, -m1 * force, -m2 * force
    # power of the force on the free body, less the power on the relative motion: that of the driven body. The friction
    # along t1 and t2 is -m1 and -m2 times the normal force
    ws.step.driven_power += force * (rate_along_p - contact.rate[0] + m1 * slip[0] + m2 * slip[1])
    return True
