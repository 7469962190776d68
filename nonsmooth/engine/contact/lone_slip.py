"""The force of a rigid contact that slides alone, between a free body and one without coordinates: the commonest case.

It does what :mod:`nonsmooth.engine.contact.held_contacts` does for any island, with the rows of the one body in
registers: laid in memory and looked up there they take most of the time of a right-hand side.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import evaluate_bias, evaluate_geometry, evaluate_rates, side_entries
from nonsmooth.engine.contact.problem import slip_coefficient, slip_direction
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    Floats,
    Workspace,
    frame_at,
    kernel,
)
from nonsmooth.engine.numerics.vectors import Vector, cross, dot, length, minus


@kernel("i8(ws, i8)")
def lone_slip(ws: Workspace, group: int) -> int:
    """Return the contact of an island that is a rigid one which slides on a body without coordinates, or -1.

    The other body is a free one in space, of six velocities and no joint.
    """
    first = ws.island.group_start[group]
    c = ws.island.grouped[first]
    contact = ws.contacts[c]
    if ws.island.group_start[group + 1] - first != 1 or contact.mode != Mode.SLIDE or ws.problem.stage_time > 0.0:
        return -1
    special = contact.is_compliant or contact.is_averaged or contact.is_anisotropic
    nu_a, nu_b = contact.n_u_a, contact.n_u_b
    if special or nu_a + nu_b != 6 or min(nu_a, nu_b) != 0:
        return -1
    one, two = ws.articulations[contact.articulation_a], ws.articulations[contact.articulation_b]
    return int(c if one.n_u + two.n_u == 6 and one.n_rows + two.n_rows == 0 else -1)


@kernel("v3(F, i8, v3, v3)")
def _times(w: Floats, row: int, x: Vector, y: Vector) -> Vector:
    """Return three rows of a matrix of six columns, the first at ``row``, times a vector in two halves."""
    a = w[row] * x[0] + w[row + 1] * x[1] + w[row + 2] * x[2]
    b = w[row + 6] * x[0] + w[row + 7] * x[1] + w[row + 8] * x[2]
    c = w[row + 12] * x[0] + w[row + 13] * x[1] + w[row + 14] * x[2]
    return (
        a + w[row + 3] * y[0] + w[row + 4] * y[1] + w[row + 5] * y[2],
        b + w[row + 9] * y[0] + w[row + 10] * y[1] + w[row + 11] * y[2],
        c + w[row + 15] * y[0] + w[row + 16] * y[1] + w[row + 17] * y[2],
    )


@kernel("v3(F, i8)")
def _three(w: Floats, first: int) -> Vector:
    return w[first], w[first + 1], w[first + 2]


@kernel("void(F, i8, f8, v3)")
def _add(w: Floats, first: int, force: float, response: Vector) -> None:
    w[first] += response[0] * force
    w[first + 1] += response[1] * force
    w[first + 2] += response[2] * force


@kernel("b1(ws, i8)")
def hold_lone_slip(ws: Workspace, c: int) -> bool:
    """Evaluate contact ``c``, write its force, add what that does to ``du``, and note the driven body's power.

    The free acceleration stands in ``du``.  Return 0, nothing of this done, if its force moves nothing.
    """
    contact = ws.contacts[c]
    evaluate_geometry(ws, c)
    evaluate_rates(ws, c)
    evaluate_bias(ws, c, 1)
    n, t1, t2, slip = contact.axis_n, contact.axis_1, contact.axis_2, contact.slip
    d1, d2 = slip_direction(ws, c, slip, ws.tolerance.velocity, may_reverse=False)
    mu = slip_coefficient(ws, c, length(slip))
    m1, m2 = mu * d1, mu * d2
    push = (
        n[0] - m1 * t1[0] - m2 * t2[0],
        n[1] - m1 * t1[1] - m2 * t2[1],
        n[2] - m1 * t1[2] - m2 * t2[2],
    )
    second = contact.n_u_b > 0
    sign = 1.0 if second else -1.0
    frame = contact.frame_b if second else contact.frame_a
    moving = ws.articulations[contact.articulation_b if second else contact.articulation_a]
    inverse, du, u = moving.inverse, ws.island.du.start + moving.u, ws.island.velocities + moving.u
    arm = minus(contact.point_b if second else contact.point_a, frame_at(ws.floats, frame).origin)
    held, pushed = cross(arm, n), cross(arm, push)
    held_1, held_2 = side_entries(ws.floats, frame, 0, n, held), side_entries(ws.floats, frame, 3, n, held)
    pushed_1, pushed_2 = (
        side_entries(ws.floats, frame, 0, push, pushed),
        side_entries(ws.floats, frame, 3, push, pushed),
    )
    response_1, response_2 = (
        _times(ws.floats, inverse, pushed_1, pushed_2),
        _times(ws.floats, inverse + 18, pushed_1, pushed_2),
    )
    own = dot(held_1, response_1) + dot(held_2, response_2)
    if own == 0.0:
        return False
    # on which more force gives more approach
    if own < 0.0:
        ws.island.singular_contact = c
    free = sign * (dot(held_1, _three(ws.floats, du)) + dot(held_2, _three(ws.floats, du + 3)))
    on_coordinates = sign * (dot(pushed_1, _three(ws.floats, u)) + dot(pushed_2, _three(ws.floats, u + 3)))
    force = (-contact.bias[0] - free) / own
    _add(ws.floats, du, sign * force, response_1)
    _add(ws.floats, du + 3, sign * force, response_2)
    contact.dissipated_by_spin, contact.has_redundant_force, contact.is_held_by_friction = 0.0, False, False
    contact.force[0], contact.force[1], contact.force[2] = force, -m1 * force, -m2 * force
    ws.step.driven_power += force * (on_coordinates - contact.rate[0] + m1 * slip[0] + m2 * slip[1])
    return True
