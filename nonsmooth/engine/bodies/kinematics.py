"""Kinematics of a contact: gap, relative rates, Jacobians, and accelerations at constant velocities.

The geometry function of a pair of shapes writes gap, normal and witness points. With the axes n, t1, t2 follow

    g' = w_n . u + p_n           gap rate                    Eq. (11)
    v  = w_t . u + p_t           slip velocity               Eq. (12)
    (g'', v') = W^T u' + S       their derivatives           Eq. (13)

where p is prescribed by driven bodies, and S, the bias, collects the second-order terms. Rows are products of an axis
with the Jacobian of a frame, so the engine needs no Jacobian of the gap from the geometry function.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.engine.bodies.anisotropy import stretch_bias, stretch_tangents
from nonsmooth.engine.bodies.support import (
    along_pair,
    farthest_of_first,
    farthest_of_second,
    is_of_one_part_each,
    normal_of_either,
    separates,
)
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.memory.layout import FIRST_ROW, NO_PAIR, NORMAL_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    ContactRecord,
    Floats,
    Workspace,
    at,
    call_pair,
    entry_point,
    frame_at,
    kernel,
    result,
)
from nonsmooth.engine.numerics.linear import multiply, product
from nonsmooth.engine.numerics.tolerances import ADJACENT
from nonsmooth.engine.numerics.vectors import Pair, Vector, are_alike, cross, dot, length, minus, opposite, scaled

NOT_EVALUATED = -1
"""Version of the bodies that is stored for a contact that must be evaluated. No body has this version."""


@result
class WitnessMotion(NamedTuple):
    """Motion of the witness points of a contact over their bodies, along the unit tangents."""

    u1: float
    """Sliding of the first witness point along t1 [m/s]."""
    u2: float
    """Sliding of the first witness point along t2 [m/s]."""
    w1: float
    """Sliding of the second witness point along t1 [m/s]."""
    w2: float
    """Sliding of the second witness point along t2 [m/s]."""
    nu1: float
    """Rate of the normal along t1 relative to the first body [1/s]."""
    nu2: float
    """Rate of the normal along t2 relative to the first body [1/s]."""


@kernel("v3(F, i8, v3)")
def velocity_of_point(floats: Floats, place: int, point: Vector) -> Vector:
    """Velocity of a point that is fixed to the frame at offset ``place`` [m/s]: v + omega x (point - origin)."""
    frame = frame_at(floats, place)
    x, y, z = minus(point, frame.origin)
    ox, oy, oz = frame.spin
    ux, uy, uz = frame.velocity
    return ux + oy * z - oz * y, uy + oz * x - ox * z, uz + ox * y - oy * x


@kernel("v3(ws, ContactRecord)")
def velocity_at(ws: Workspace, contact: ContactRecord) -> Vector:
    """Velocity of the second body at its witness point less that of the first body at its own [m/s]."""
    velocity_b = velocity_of_point(ws.floats, contact.frame_b, contact.point_b)
    return minus(velocity_b, velocity_of_point(ws.floats, contact.frame_a, contact.point_a))


@kernel("b1(ws, ContactRecord, b1, f8)")
def _opens_aside(ws: Workspace, contact: ContactRecord, of_second: bool, near: float) -> bool:
    """True if two convex shapes are apart, and do not approach, along another direction than the contact normal.

    The direction is the one stored for their pair. It turns with the second part if ``of_second``, else with the first.
    The shapes are apart if they overlap by at most ``near`` [m]. The result is False for shapes with feet.
    """
    pair = ws.pairs[contact.pair]
    n, has_feet = normal_of_either(ws, pair, of_second), pair.clearance > 0.0
    if has_feet or not is_of_one_part_each(ws, pair.index) or are_alike(along_pair(pair, contact.normal), n):
        return False
    first, second = farthest_of_first(ws, pair.index, n), farthest_of_second(ws, pair.index, opposite(n))
    if dot(n, n) == 0.0 or dot(n, minus(second, first)) < -near:
        return False
    # the direction is the normal of a face of one part; the nearest point of the other part moves with that part
    point = first if of_second else second
    v = minus(velocity_of_point(ws.floats, pair.frame_b, point), velocity_of_point(ws.floats, pair.frame_a, point))
    # several points of a face are nearest; where the contact is, the shapes must not approach either
    slowest = min(dot(n, v), dot(n, along_pair(pair, velocity_at(ws, contact))))
    return slowest >= -ws.tolerance.velocity


@kernel("b1(ws, ContactRecord, f8)")
def _can_close(ws: Workspace, contact: ContactRecord, near: float) -> bool:
    """True if the shapes of a near contact can meet along its normal.

    Convex shapes do not meet while they are apart along any direction. So they cannot meet along the normal in two
    cases: if they overlap along it, but are apart along the direction of their pair
    (:func:`nonsmooth.engine.bodies.support.separates`); and if they approach along it, but are apart and do not
    approach along the direction of their pair. ``near`` is the largest gap of surfaces next to each other [m].
    """
    if not separates(ws, contact.pair, contact.normal, near):
        return False
    if dot(contact.normal, velocity_at(ws, contact)) >= -ws.tolerance.velocity:
        return True
    return not (_opens_aside(ws, contact, False, near) or _opens_aside(ws, contact, True, near))


@entry_point("void(ws, i8)")
def replace_gap(ws: Workspace, c: int) -> None:
    """Replace the gap of open contact ``c`` [m] by a positive one if its features do not face or cannot meet.

    The gap is at most that of surfaces next to each other. See :func:`evaluate_geometry`.
    """
    contact, near = ws.contacts[c], ADJACENT * ws.tolerance.gap
    if contact.gap < 0.0 < contact.past_feature:
        contact.overlap = contact.gap
        contact.gap = length((contact.gap, contact.past_feature))
    is_near = not contact.is_compliant and contact.gap <= near and contact.past_feature <= 0.0
    if is_near and contact.pair != NO_PAIR and not _can_close(ws, contact, near):
        # a gap as small as that of surfaces next to each other: if only round-off decides, the gap hardly changes
        contact.gap = contact.past_feature = 0.5 * near


@kernel("void(ws, i8)")
def evaluate_geometry(ws: Workspace, c: int) -> None:
    """Write gap [m], witness points, curvature and the axes n, t1, t2 of contact ``c``.

    If ``past_feature`` > 0, the contact points lie past the end of their features, such as a face or an edge. The
    bodies may overlap there while another contact of theirs is closed. The gap then depends on the mode:

    - Open contact with a negative gap: ``overlap`` becomes the gap, and the gap becomes a positive substitute, the
      hypotenuse of gap and ``past_feature``. So this contact does not act. In all other cases ``overlap`` is zero.
    - Closed contact: the gap stays as the geometry function wrote it, until the event in which another contact replaces
      this one. If the function keeps negative gaps past the end, the force does not jump within a step.

    An open rigid contact that is near but cannot close gets a positive substitute, too.

    The gap of a foot that came over the rim of a face counts from its depth there
    (:mod:`nonsmooth.engine.flow.initial_depth`).
    """
    contact = ws.contacts[c]
    a, b, parameters = contact.frame_a, contact.frame_b, at(ws.floats, contact.geometry_parameters)
    call_pair(contact.geometry_function, at(ws.floats, a), at(ws.floats, b), parameters, contact.geometry)
    # the rates replace t1 and t2 by stretched ones if friction is anisotropic
    contact.axis_n, contact.axis_1 = contact.normal, contact.tangent
    contact.axis_2 = cross(contact.normal, contact.tangent)
    contact.overlap = 0.0
    if contact.initial_depth > 0.0 and (contact.mode != Mode.OPEN or contact.past_feature <= ws.tolerance.gap):
        contact.gap += contact.initial_depth
    may_differ = contact.pair != NO_PAIR or contact.past_feature > 0.0
    if may_differ and contact.mode == Mode.OPEN and contact.gap <= ADJACENT * ws.tolerance.gap:
        replace_gap(ws, c)


@kernel("void(ws, i8)")
def evaluate_rates(ws: Workspace, c: int) -> None:
    """Write the gap rate and the slip velocity of contact ``c`` [m/s] along its axes n, t1 and t2.

    They are the velocity of the second body at its witness point less that of the first. Anisotropic friction first
    stretches t1 and t2, which may depend on the slip along the unit tangents.
    """
    contact = ws.contacts[c]
    v = velocity_at(ws, contact)
    if contact.is_anisotropic:
        t1, t2 = contact.tangent, cross(contact.normal, contact.tangent)
        contact.slip_of_tangents = dot(t1, v), dot(t2, v)
        stretch_tangents(ws, c, t1, t2)
    contact.velocity = dot(contact.axis_n, v), dot(contact.axis_1, v), dot(contact.axis_2, v)


@kernel("void(ws, i8)")
def evaluate_kinematics(ws: Workspace, c: int) -> None:
    """Write geometry and rates of contact ``c``. Nothing is written if its bodies were not evaluated in the meantime.

    Each evaluation of a body has a version number. Past the end of features the gap depends on whether the contact is
    open, so a contact that has opened or closed since is evaluated again. The stretched tangents of an anisotropic
    contact depend on its mode too, so such a contact is always evaluated: ``NOT_EVALUATED`` differs from every version.
    """
    contact = ws.contacts[c]
    version_a, version_b = ws.bodies[contact.body_a].version, ws.bodies[contact.body_b].version
    is_open = contact.mode == Mode.OPEN
    if contact.version_a == version_a and contact.version_b == version_b and contact.was_evaluated_open == is_open:
        return
    evaluate_geometry(ws, c)
    evaluate_rates(ws, c)
    contact.version_a = version_a if not contact.is_anisotropic else NOT_EVALUATED
    contact.version_b = version_b
    contact.was_evaluated_open = is_open


@kernel("f8(F, i8, i8, v3, v3)")
def entry_of_column(floats: Floats, column: int, n_u: int, axis: Vector, moment: Vector) -> float:
    """Product of a force (``axis``) and a ``moment`` with one column of a frame's Jacobian, with ``n_u`` columns.

    ``column`` is the offset of the first entry of the column. The product is a generalised force, or for a unit
    vector ``axis`` an entry of a contact row.
    """
    # three rows of the velocity, then three of the angular velocity
    v, o = column, column + 3 * n_u
    linear = axis[0] * floats[v] + axis[1] * floats[v + n_u] + axis[2] * floats[v + 2 * n_u]
    return linear + moment[0] * floats[o] + moment[1] * floats[o + n_u] + moment[2] * floats[o + 2 * n_u]


@kernel("v3(F, i8, i8, v3, v3)")
def side_entries(floats: Floats, frame: int, first: int, axis: Vector, moment: Vector) -> Vector:
    """Three entries, from entry ``first`` (0 or 3) on, of the row of a body with six velocities: (axis, moment) . J.

    J is the Jacobian of the frame at offset ``frame``. The closed form of the force of a single sliding contact takes
    the entries directly, which is faster than a row in the workspace.
    """
    column = frame + FRAME + first
    return (
        entry_of_column(floats, column, 6, axis, moment),
        entry_of_column(floats, column + 1, 6, axis, moment),
        entry_of_column(floats, column + 2, 6, axis, moment),
    )


@kernel("void(F, i8, v3, v3, i8, i8)")
def side_row(floats: Floats, frame: int, point: Vector, axis: Vector, n_u: int, out: int) -> None:
    """Write the row of one body to ``out``: (axis, rho x axis) . J, of the velocity of a ``point`` along an ``axis``.

    rho leads from the origin of the body's frame to the point. J is the Jacobian of the frame, with ``n_u`` columns.
    """
    # a driven body has no velocities, so its row has no entries
    if n_u == 0:
        return
    moment, first = cross(minus(point, frame_at(floats, frame).origin), axis), frame + FRAME
    # free bodies are most frequent, and a loop of known length is faster
    if n_u == 6:
        for j in range(6):
            floats[out + j] = entry_of_column(floats, first + j, 6, axis, moment)
        return
    for j in range(n_u):
        floats[out + j] = entry_of_column(floats, first + j, n_u, axis, moment)


@kernel("void(F, i8, v3, v3, v3, i8, i8)")
def side_wrench(floats: Floats, frame: int, point: Vector, force: Vector, moment: Vector, n_u: int, out: int) -> None:
    """Write the generalised forces of a ``force`` at a ``point`` and a ``moment`` on one body to ``out``.

    Force, moment and point are in world components. ``frame`` is the offset of the body's frame, ``n_u`` the number of
    its velocities.
    """
    side_row(floats, frame, point, force, n_u, out)
    for j in range(n_u):
        # the angular part of column j of the Jacobian, behind three rows of the velocity
        o = frame + FRAME + j + 3 * n_u
        floats[out + j] += moment[0] * floats[o] + moment[1] * floats[o + n_u] + moment[2] * floats[o + 2 * n_u]


@kernel("i8(ws, i8, i8)")
def _row_a(ws: Workspace, c: int, r: int) -> int:
    """Offset of the entries of the first body in row ``r`` (n, t1, t2) of the first Jacobian of contact ``c``.

    The row has a column for each velocity of the articulation, the bodies that joints tie together.
    """
    contact = ws.contacts[c]
    return int(contact.jacobian_a + r * ws.articulations[contact.articulation_a].n_u + contact.column_a)


@kernel("i8(ws, i8, i8)")
def _row_b(ws: Workspace, c: int, r: int) -> int:
    """Offset of the entries of the second body in row ``r`` (n, t1, t2) of the second Jacobian of contact ``c``.

    The row has a column for each velocity of the articulation, the bodies that joints tie together.
    """
    contact = ws.contacts[c]
    return int(contact.jacobian_b + r * ws.articulations[contact.articulation_b].n_u + contact.column_b)


@kernel("void(ws, i8, i8, v3, v3)")
def wrench_row(ws: Workspace, c: int, r: int, force: Vector, moment: Vector) -> None:
    """Write row ``r`` of the Jacobians of contact ``c``: the generalised forces of a force and a moment.

    They act on the second body, and on the first one with the opposite sign. Both are in world components.
    """
    contact, row_a, row_b = ws.contacts[c], _row_a(ws, c, r), _row_b(ws, c, r)
    side_wrench(ws.floats, contact.frame_a, contact.point_a, opposite(force), opposite(moment), contact.n_u_a, row_a)
    side_wrench(ws.floats, contact.frame_b, contact.point_b, force, moment, contact.n_u_b, row_b)


@kernel("void(ws, i8, i8, v3)")
def evaluate_row(ws: Workspace, c: int, r: int, axis: Vector) -> None:
    """Write row ``r`` of the Jacobians of contact ``c``, of the relative velocity along ``axis``.

    The relative velocity is that of the second body at its witness point less that of the first.
    """
    contact = ws.contacts[c]
    side_row(ws.floats, contact.frame_a, contact.point_a, opposite(axis), contact.n_u_a, _row_a(ws, c, r))
    side_row(ws.floats, contact.frame_b, contact.point_b, axis, contact.n_u_b, _row_b(ws, c, r))


@kernel("void(ws, i8, i8, i8)")
def evaluate_row_response(ws: Workspace, c: int, r: int, s: int) -> None:
    """Write response ``s`` of contact ``c``: K times row ``r`` of its Jacobians, the acceleration by a unit force.

    K is the inverse mass matrix of an articulation, a body or several tied by joints, with the joints eliminated. ``s``
    differs from ``r`` if the solver needs another row in its one response.
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
    """Add to the accelerations at ``du`` those of a ``force`` [N] along response ``s`` of contact ``c``.

    An impulse [N s] changes velocities at ``du`` in the same way. The response holds the accelerations of both bodies,
    or of all bodies tied to them by joints, per unit force.
    """
    contact = ws.contacts[c]
    for side in range(2):
        articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
        response = contact.response_a if side == 0 else contact.response_b
        n_u = articulation.n_u
        for i in range(n_u):
            ws.floats[du + articulation.u + i] += ws.floats[response + s * n_u + i] * force


@kernel("f8(ws, i8, i8, i8)")
def row(ws: Workspace, c: int, r: int, du: int) -> float:
    """Product of row ``r`` (n, t1, t2) of the Jacobians of contact ``c`` with velocities or accelerations at ``du``.

    It is the relative velocity or acceleration along the row, without the parts that driven bodies prescribe.
    """
    contact = ws.contacts[c]
    a, b = ws.articulations[contact.articulation_a], ws.articulations[contact.articulation_b]
    total = product(ws.floats, 0.0, contact.jacobian_a + r * a.n_u, du + a.u, a.n_u)
    return float(product(ws.floats, total, contact.jacobian_b + r * b.n_u, du + b.u, b.n_u))


@kernel("f8(ws, i8, i8, i8)")
def row_size(ws: Workspace, c: int, r: int, du: int) -> float:
    """Size of the two parts of :func:`row`, of which each body has one: the round-off of their sum is relative to it.

    Where two bodies fall together, their parts cancel each other, and the sum is round-off alone.
    """
    contact = ws.contacts[c]
    a, b = ws.articulations[contact.articulation_a], ws.articulations[contact.articulation_b]
    part_a = product(ws.floats, 0.0, contact.jacobian_a + r * a.n_u, du + a.u, a.n_u)
    part_b = product(ws.floats, 0.0, contact.jacobian_b + r * b.n_u, du + b.u, b.n_u)
    return float(max(abs(part_a), abs(part_b)))


@kernel("void(ws, i8)")
def evaluate_jacobian(ws: Workspace, c: int) -> None:
    """Write the rows n, t1, t2 of the Jacobians of contact ``c``, their responses, and the prescribed rates [m/s].

    Axes and rates must be evaluated. Driven bodies prescribe the part of the rates that the coordinates do not cause.
    """
    contact = ws.contacts[c]
    evaluate_row(ws, c, NORMAL_ROW, contact.axis_n)
    evaluate_row(ws, c, FIRST_ROW, contact.axis_1)
    evaluate_row(ws, c, SECOND_ROW, contact.axis_2)
    for r in range(3):
        evaluate_row_response(ws, c, r, r)
        contact.prescribed_rate[r] = contact.rate[r] - row(ws, c, r, ws.island.velocities)


@kernel("v3(F, i8, v3, v3, v3)")
def acceleration_at(floats: Floats, place: int, point: Vector, slide_1: Vector, slide_2: Vector) -> Vector:
    """Derivative of the velocity of the body at its witness point, while the body's velocities are constant [m/s^2].

    It is c + b x r + omega x (omega x r + slide), with r = point - origin. The point slides relative to the frame at
    ``place`` with the velocity slide = ``slide_1`` + ``slide_2`` [m/s]. c and b are the accelerations of origin and
    rotation at constant velocities.
    """
    frame = frame_at(floats, place)
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
    """Write the bias of contact ``c``: the second derivatives g'' and v' while u' = 0 [m/s^2].

    With ``rows`` = 1 only that of the gap is written, which is enough for a contact that slides; with 3 all.

    The witness points slide over their bodies at u and w, and the normal turns by nu relative to the first body. In the
    tangent plane, with d the relative velocity of the bodies there and rho their relative turning,

        slide_a u = turn_a nu,    slide_b w = -turn_b (nu - rho),    w = u + g nu - d.

    ``slide`` and ``turn`` describe the curvature of each surface.
    """
    contact = ws.contacts[c]
    n, t1, t2, slip = contact.axis_n, contact.axis_1, contact.axis_2, contact.slip
    # on unit tangents first: the axes of anisotropic friction are stretched
    if contact.is_anisotropic:
        t1, t2, slip = contact.tangent, cross(contact.normal, contact.tangent), contact.slip_of_tangents
    a = frame_at(ws.floats, contact.frame_a)
    # turning of the normal with the first body, omega_A x n in the tangent plane
    turn_1, turn_2 = dot(a.spin, t2), -dot(a.spin, t1)
    v1, v2 = slip
    motion = _witness_motion(ws, contact, t1, t2, slip)
    # accelerations of the witness points, second minus first, as the turning bodies carry the sliding points
    acceleration = minus(
        acceleration_at(ws.floats, contact.frame_b, contact.point_b, scaled(motion.w1, t1), scaled(motion.w2, t2)),
        acceleration_at(ws.floats, contact.frame_a, contact.point_a, scaled(motion.u1, t1), scaled(motion.u2, t2)),
    )
    # the axes turn: n' = omega_A x n + nu, and the tangents spin about n with the first body
    n1, n2 = turn_1 + motion.nu1, turn_2 + motion.nu2
    spin, rate = dot(a.spin, n), contact.rate[0]
    contact.bias[0] = dot(n, acceleration) + (n1 * v1 + n2 * v2)
    if rows == 3:
        contact.bias[1] = dot(t1, acceleration) + spin * v2 - n1 * rate
        contact.bias[2] = dot(t2, acceleration) - spin * v1 - n2 * rate
        if contact.is_anisotropic:
            stretch_bias(ws, c)


@kernel("WitnessMotion(ws, ContactRecord)")
def motion_of(ws: Workspace, contact: ContactRecord) -> WitnessMotion:
    """Sliding of the witness points and turning of the normal of a contact. Rates must be evaluated."""
    slip = contact.slip_of_tangents if contact.is_anisotropic else contact.slip
    return _witness_motion(ws, contact, contact.tangent, cross(contact.normal, contact.tangent), slip)


@kernel("WitnessMotion(ws, ContactRecord, v3, v3, v2)")
def _witness_motion(ws: Workspace, contact: ContactRecord, t1: Vector, t2: Vector, slip: Pair) -> WitnessMotion:
    """Sliding of the witness points and turning of the normal of a contact, in components along its unit tangents.

    The witness points slide over their bodies at u and w, the normal turns by nu relative to the first body, and

        slide_a u = turn_a nu,    slide_b w = -turn_b (nu - rho),    w = u + g nu - d.

    ``slide`` and ``turn`` of one surface, 2 x 2 matrices row by row, commute. So u = turn_a x and nu = slide_a x solve
    the first equation for every x. The other two give M x = r, with M = slide_b (turn_a + g slide_a) + turn_b slide_a.
    """
    a, b = frame_at(ws.floats, contact.frame_a), frame_at(ws.floats, contact.frame_b)
    gap = contact.gap
    # omega x n in the tangent plane: of the first body, and of the second relative to it
    turn_a1, turn_a2 = dot(a.spin, t2), -dot(a.spin, t1)
    rho1, rho2 = dot(b.spin, t2) - turn_a1, -dot(b.spin, t1) - turn_a2
    # relative velocity of the bodies, less the part that the turning of the first causes across the gap
    d1, d2 = slip[0] - gap * turn_a1, slip[1] - gap * turn_a2
    slide_a, turn_a, slide_b, turn_b = contact.slide_a, contact.turn_a, contact.slide_b, contact.turn_b
    r1 = slide_b[0] * d1 + slide_b[1] * d2 + turn_b[0] * rho1 + turn_b[1] * rho2
    r2 = slide_b[2] * d1 + slide_b[3] * d2 + turn_b[2] * rho1 + turn_b[3] * rho2
    # reach is turn_a + gap slide_a
    (s11, s12, s21, s22), (g11, g12, g21, g22), (h11, h12, h21, h22) = slide_a, slide_b, turn_b
    reach_11, reach_12 = turn_a[0] + gap * s11, turn_a[1] + gap * s12
    reach_21, reach_22 = turn_a[2] + gap * s21, turn_a[3] + gap * s22
    m11 = (g11 * reach_11 + h11 * s11) + (g12 * reach_21 + h12 * s21)
    m12 = (g11 * reach_12 + h11 * s12) + (g12 * reach_22 + h12 * s22)
    m21 = (g21 * reach_11 + h21 * s11) + (g22 * reach_21 + h22 * s21)
    m22 = (g21 * reach_12 + h21 * s12) + (g22 * reach_22 + h22 * s22)
    determinant = m11 * m22 - m12 * m21
    if determinant == 0.0:
        # after a trial step that is far too long: NaN rejects the step, while a division by zero raises in plain Python
        determinant = math.nan
    x1, x2 = (m22 * r1 - m12 * r2) / determinant, (m11 * r2 - m21 * r1) / determinant
    u1, u2 = turn_a[0] * x1 + turn_a[1] * x2, turn_a[2] * x1 + turn_a[3] * x2
    nu1, nu2 = slide_a[0] * x1 + slide_a[1] * x2, slide_a[2] * x1 + slide_a[3] * x2
    return WitnessMotion(u1, u2, u1 + gap * nu1 - d1, u2 + gap * nu2 - d2, nu1, nu2)


@entry_point("void(ws, i8, i8)")
def evaluate_contact(ws: Workspace, c: int, rows: int) -> None:
    """Write geometry, rates, Jacobians and bias of contact ``c``, whose bodies must be evaluated.

    Of the bias, the acceleration while the velocities are constant, ``rows`` are written: 1 (along n) or 3.
    """
    evaluate_geometry(ws, c)
    evaluate_rates(ws, c)
    evaluate_jacobian(ws, c)
    evaluate_bias(ws, c, rows)
