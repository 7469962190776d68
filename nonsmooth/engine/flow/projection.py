"""Projection: closed contacts and joints are put back on their constraints g = 0, g' = 0, v = 0 after steps and events.

The integrator keeps accelerations only, so gaps and rates drift within its tolerance. The rates are corrected by the
impulses of least kinetic energy, along K W. The gaps are corrected by displacements of the same form, for unit time. So
momentum is conserved, and the corrections respect joints. Baumgarte's stabilisation would put stiff springs into the
motion instead.

Contacts that nearly repeat each other make the problem ill-conditioned. So its diagonal is enlarged slightly (damped
least squares). A correction that is larger than the tolerances allow ends the run.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.engine.bodies.articulations import subtract_response
from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_body, evaluate_free_bodies
from nonsmooth.engine.bodies.equations import coordinate_rates
from nonsmooth.engine.bodies.kinematics import (
    evaluate_jacobian,
    evaluate_kinematics,
    evaluate_row,
    evaluate_row_response,
    push_response,
    row,
)
from nonsmooth.engine.contact.closed_contacts import coupling
from nonsmooth.engine.contact.forces import resolve
from nonsmooth.engine.contact.mean_forces import is_averaged
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus, diagonal_block
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.guard_values import feature_guard
from nonsmooth.engine.flow.self_check import allowed_gap, energies_of_bodies, fail_check, held_gap
from nonsmooth.engine.flow.spins import normalise, square_of_quaternion
from nonsmooth.engine.memory.layout import NORMAL_ROW
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import (
    Articulation,
    BodyRecord,
    ContactRecord,
    Workspace,
    entry_point,
    frame_at,
    kernel,
    result,
)
from nonsmooth.engine.numerics.tolerances import ALLOWED, NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import cross, dot, minus

_ROUND_OFF = 8.0 * 2.0**-52
"""Difference of a squared unit length from 1 that is round-off."""
_DAMPING = 1e-8
"""Damping of a projection, relative to the diagonal of G. A single contact needs none.

It limits the displacement of a body to the gap divided by twice the square root of the damping.
"""
_LARGEST_CORRECTION = 10.0
"""Largest displacement of a body by a projection, relative to the gap that the tolerances allow."""
_MOST_ITERATIONS = 5
"""Most iterations of Newton's method for joints. It converges quadratically, so two or three suffice."""


@result
class Projected(NamedTuple):
    """What the projection of an island has done."""

    loss: float
    """Kinetic energy that it removed [J]."""
    has_moved: bool
    """True if it added velocities that close gaps to ``y_stage``."""


@entry_point("f8(ws, b1)")
def project_rates(ws: Workspace, at_event: bool) -> float:
    """Bring gap rates of the active contacts, and slips of sticking ones, to zero. Energy that is removed [J].

    At an event a slip within the velocity tolerance, whose direction is round-off, is removed too, unless a traction
    law depends on it. The velocities in ``y`` change by the impulses of least kinetic energy, damped, and without
    friction on sliding contacts. The work of driven bodies is added to the totals. The contacts need their Jacobians.
    """
    if ws.problem.n_active == 0:
        return 0.0
    assemble_delassus(ws)
    # a contact problem in rates and impulses, in place of accelerations and forces
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        # a compliant contact does not constrain its gap: its impulse is known to be 0
        active.is_normal_force_unknown = not contact.is_compliant
        active.normal_force = 0.0
        is_slow = max(abs(contact.rate[1]), abs(contact.rate[2])) <= ws.tolerance.velocity
        active.sticks = contact.mode == Mode.STICK or (at_event and is_slow and not contact.has_traction_law)
        active.friction_coefficient, active.direction = 0.0, contact.direction
        for r in range(3):
            active.free[r] = contact.rate[r]
    # only contacts that nearly repeat each other make the problem ill-conditioned
    damping = _DAMPING if ws.problem.n_active > 1 else 0.0
    _damp(ws, damping)
    resolve(ws)
    add_response(ws, ws.problem.forces.start, ws.island.y.start + ws.model.n_q)
    return _removed_energy(ws, damping)


@kernel("f8(ws, f8)")
def _removed_energy(ws: Workspace, damping: float) -> float:
    """Kinetic energy that the impulses of a projection removed [J]. Adds the work of driven bodies to the totals.

    Each impulse does its work on the mean of its rates before and after. Because of the damping the impulses do not
    stop the rates wholly: minus the added diagonal times the impulse remains.
    """
    loss = 0.0
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        for r in range(3):
            impulse = active.force[r]
            # the part of the diagonal of G (entries 0, 4 and 8 of its block) that the damping has added
            added = diagonal_block(ws, active.index).entries[4 * r] * damping / (1.0 + damping)
            loss -= 0.5 * impulse * (contact.rate[r] - added * impulse)
            ws.totals.driven_work -= impulse * contact.prescribed_rate[r]
    return loss


@kernel("void(ws, f8)")
def _damp(ws: Workspace, damping: float) -> None:
    """Enlarge the diagonal of the Delassus matrix G of the active contacts by the factor 1 + ``damping``.

    This bounds the impulses of contacts that nearly repeat each other.
    """
    for active in ws.actives:
        # entries 0, 4 and 8 of the 3 x 3 block
        for r in range(3):
            diagonal_block(ws, active.index).entries[4 * r] *= 1.0 + damping


@kernel("b1(ws)")
def _add_gaps(ws: Workspace) -> bool:
    """Add to ``y_stage`` the velocities that bring the gaps of the active contacts to zero in unit time.

    They are those of damped least squares. The closer a gap is to the allowed one, the more they are damped, so that
    they do not exceed the largest allowed correction. True if they were added, False if all gaps are negligible, or one
    is larger than allowed: the check of gaps then ends the run.
    """
    largest = ratio = 0.0
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        gap = abs(held_gap(contact)) if not contact.is_compliant else 0.0
        largest = max(largest, gap)
        ratio = max(ratio, gap / allowed_gap(ws, active.contact))
    if largest <= NEGLIGIBLE * ws.tolerance.gap or ratio > 1.0:
        return False
    # project_rates has damped the matrix
    assemble_delassus(ws)
    # a contact problem without friction, in gaps in place of accelerations
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        active.is_normal_force_unknown = not contact.is_compliant
        active.sticks = False
        active.normal_force = active.friction_coefficient = 0.0
        active.direction = contact.direction
        active.free[0] = held_gap(contact)
    if ws.problem.n_active > 1:
        # at most the gap over twice the root of the damping: _LARGEST_CORRECTION times the allowed gap
        _damp(ws, max(_DAMPING, (0.5 * ratio / _LARGEST_CORRECTION) ** 2))
    resolve(ws)
    add_response(ws, ws.problem.forces.start, ws.step.y_stage.start + ws.model.n_q)
    return True


@kernel("f8(ws)")
def _project_lone_slip(ws: Workspace) -> float:
    """Remove gap and gap rate of the active contact, a single rigid one that slides. Kinetic energy removed [J].

    It has one scalar equation, for the impulse along the normal. Its geometry and rates must be evaluated. The velocity
    that closes the gap in unit time is added to ``y_stage``, the impulse changes the velocities in ``y``. The work of
    driven bodies is added to the totals.
    """
    c = ws.actives[0].contact
    contact = ws.contacts[c]
    evaluate_row(ws, c, NORMAL_ROW, contact.axis_n)
    evaluate_row_response(ws, c, NORMAL_ROW, NORMAL_ROW)
    g_nn, gap, rate = coupling(ws, c, NORMAL_ROW, c, NORMAL_ROW), held_gap(contact), contact.normal_rate
    # neither body can move along the normal
    if g_nn <= 0.0:
        return 0.0
    # a gap larger than allowed is left: the check of gaps ends the run
    if NEGLIGIBLE * ws.tolerance.gap < abs(gap) <= allowed_gap(ws, c):
        push_response(ws, c, NORMAL_ROW, -gap / g_nn, ws.step.y_stage.start + ws.model.n_q)
    # prescribed is the part of the rate that does not come from velocities, but from driven bodies
    impulse, prescribed = -rate / g_nn, rate - row(ws, c, NORMAL_ROW, ws.island.velocities)
    push_response(ws, c, NORMAL_ROW, impulse, ws.island.y.start + ws.model.n_q)
    ws.totals.driven_work -= impulse * prescribed
    return float(-0.5 * impulse * rate)


@kernel("b1(ws)")
def _is_lone_slip(ws: Workspace) -> bool:
    """True if a single contact is active, which is rigid and slides. Its projection is one scalar equation."""
    contact = ws.contacts[ws.actives[0].contact]
    return ws.problem.n_active == 1 and not contact.is_compliant and contact.mode == Mode.SLIDE


@kernel()
def normalise_quaternions(ws: Workspace) -> None:
    """Bring the quaternion of every body to unit length. A deviation larger than allowed ends the run."""
    for body in ws.bodies:
        # a body without quaternion has -1
        if body.quaternion < 0:
            continue
        q = ws.island.y.start + body.q + body.quaternion
        square = square_of_quaternion(ws.floats, q)
        if abs(square - 1.0) <= _ROUND_OFF:
            continue
        # the tolerance of a step allows 2 rtol of the length, which is 4 rtol of its square
        if abs(square - 1.0) > ALLOWED * 4.0 * ws.tolerance.relative:
            deviation, allowed = math.sqrt(square) - 1.0, ALLOWED * 2.0 * ws.tolerance.relative
            fail_check(ws, Status.QUATERNION_UNEXPLAINED, body.index, deviation, allowed)
        normalise(ws.floats, q)


@kernel("void(ws, i8)")
def _copy_coordinates(ws: Workspace, out: int) -> None:
    """Write the present coordinates q, with all velocities and accounts zero, to the state at ``out``."""
    # displacements of a projection are then added in place of the velocities
    for i in range(ws.model.n_y):
        ws.floats[out + i] = ws.island.y[i] if i < ws.model.n_q else 0.0


@kernel("f8(ws, i8)")
def _allowed_motion(ws: Workspace, i: int) -> float:
    """Change of coordinate ``i`` by a projection that the tolerances of steps, gaps and times allow, in its unit.

    The time tolerance counts by the coordinate's rate at the start of the last step, in ``slopes``.
    """
    step = ws.tolerance.relative * (ws.step.y_scale[i] + abs(ws.island.y[i]))
    return float(
        _LARGEST_CORRECTION * ALLOWED * (step + ws.tolerance.gap + ws.tolerance.time * abs(ws.island.slopes[i]))
    )


@kernel("f8(ws, ContactRecord, i8)")
def _speed_at(ws: Workspace, contact: ContactRecord, number: int) -> float:
    """Speed of the witness point of a contact on body ``number`` [m/s], 0 if the contact is not on that body."""
    fastest = 0.0
    for side in range(2):
        if (contact.body_a if side == 0 else contact.body_b) == number:
            frame = frame_at(ws.floats, contact.frame_a if side == 0 else contact.frame_b)
            point = contact.point_a if side == 0 else contact.point_b
            # v - rho x spin = v + spin x rho
            velocity = minus(frame.velocity, cross(minus(point, frame.origin), frame.spin))
            fastest = max(fastest, math.sqrt(dot(velocity, velocity)))
    return float(fastest)


@kernel("f8(ws, BodyRecord, i8)")
def _allowed_motion_by_gaps(ws: Workspace, body: BodyRecord, i: int) -> float:
    """Change of coordinate ``i`` of a body by a projection of the allowed gaps of its contacts, in its unit.

    The angle that corresponds to a gap depends on the offset of the contact point. So each contact alone pushes the
    body until its witness point has moved by the allowed gap. The sum of these motions is allowed. Afterwards the body
    is evaluated at ``y_stage`` again.
    """
    total = 0.0
    for k in range(ws.island.n_grouped):
        c = ws.island.grouped[k]
        if ws.contacts[c].is_compliant:
            continue
        # a unit impulse of this contact, on bodies at rest
        _copy_coordinates(ws, ws.step.y_guess.start)
        push_response(ws, c, NORMAL_ROW, 1.0, ws.step.y_guess.start + ws.model.n_q)
        evaluate_body(ws, ws.island.time, ws.step.y_guess.start, body.index)
        speed = _speed_at(ws, ws.contacts[c], body.index)
        if speed > 0.0:
            total += abs(coordinate_rates(ws, body)[i]) * allowed_gap(ws, c) / speed
    evaluate_body(ws, ws.island.time, ws.step.y_stage.start, body.index)
    return float(_LARGEST_CORRECTION * total)


@kernel("b1(ws, BodyRecord)")
def _is_displaced(ws: Workspace, body: BodyRecord) -> bool:
    """True if a body has velocities in ``y_stage`` that are not zero, so that the projection displaces it."""
    first = ws.step.y_stage.start + ws.model.n_q + body.u
    for i in range(first, first + body.n_u):
        if ws.floats[i] != 0.0:
            return True
    return False


@kernel()
def _displace(ws: Workspace) -> None:
    """Move the bodies in ``y`` by the velocities in ``y_stage`` for unit time.

    A motion larger than allowed ends the run, and no body is moved. The bodies themselves turn these velocities into
    coordinate rates, dq = B du.
    """
    for body in ws.bodies:
        if not _is_displaced(ws, body):
            continue
        evaluate_body(ws, ws.island.time, ws.step.y_stage.start, body.index)
        rates = coordinate_rates(ws, body)
        for i in range(body.n_q):
            # in unit time the body moves by its rates
            motion, allowed = rates[i], _allowed_motion(ws, body.q + i)
            # the bound by gaps is costly, and rarely needed
            if abs(motion) > allowed:
                allowed += _allowed_motion_by_gaps(ws, body, i)
            if abs(motion) > allowed:
                fail_check(ws, Status.MOTION_UNEXPLAINED, body.index, motion, allowed)
                return
    for body in ws.bodies:
        if _is_displaced(ws, body):
            rates = coordinate_rates(ws, body)
            for i in range(body.n_q):
                ws.island.y[body.q + i] += rates[i]
    normalise_quaternions(ws)


@entry_point("f8(ws, b1, b1)")
def project_closed(ws: Workspace, at_event: bool, averaged: bool) -> float:
    """Put the closed contacts on their constraints, gap and rates zero, island by island. Energy that this removes [J].

    If ``averaged``, the islands with forces averaged over time are projected, at the end of their span; else the rest.
    Kinetic energy is always counted. The potential energy of closed gaps counts at an event only: after a step it is an
    error of the step, which is in no account. Coordinates and velocities in ``y`` change.
    """
    # an event changes which contacts are closed; after a step they are grouped
    if at_event:
        group_closed(ws)
    if ws.island.n_grouped == 0:
        return 0.0
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    _copy_coordinates(ws, ws.step.y_stage.start)
    loss, has_moved = 0.0, False
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        if is_averaged(ws) != averaged:
            continue
        projected = _project_active(ws, at_event)
        loss += projected.loss
        has_moved = projected.has_moved or has_moved
    if has_moved:
        # potential energy before the displacement
        before = energies_of_bodies(ws)[1]
        _displace(ws)
        evaluate_free_bodies(ws, ws.island.time, ws.island.y.start, of_all_bodies=True)
        if at_event:
            loss += before - energies_of_bodies(ws)[1]
    return loss


@kernel("Projected(ws, b1)")
def _project_active(ws: Workspace, at_event: bool) -> Projected:
    """Project the rates of the active contacts, and add the velocities that close their gaps to ``y_stage``.

    Result: kinetic energy that was removed, and whether velocities were added. Nothing is projected if a contact is
    past the end of its feature, or if its features have changed in the step: its rate is then the rate of another gap.
    The next event opens such a contact.
    """
    for active in ws.actives:
        evaluate_kinematics(ws, active.contact)
        contact = ws.contacts[active.contact]
        if contact.past_feature > ws.tolerance.gap or (not at_event and feature_guard(ws, contact) < 0.0):
            return Projected(0.0, False)
    # at an event a slow slip is removed too, which needs the tangential rows
    if not at_event and _is_lone_slip(ws):
        # without a gap the velocities are zero, and displace nothing
        return Projected(_project_lone_slip(ws), True)
    for active in ws.actives:
        evaluate_jacobian(ws, active.contact)
    loss = project_rates(ws, at_event)
    return Projected(loss, _add_gaps(ws))


@entry_point()
def project_joints(ws: Workspace) -> None:
    """Bring residuals and rates of the joints to zero by the least motion, and evaluate the bodies there.

    Newton's method ends at a negligible residual, or if round-off stops its progress: far from the origin round-off is
    larger than the tolerance. A first residual above that of the tolerance of steps, or a last one above that of the
    gap tolerance, ends the run.
    """
    worst, before = 0.0, math.inf
    for iteration in range(_MOST_ITERATIONS):
        evaluate_bodies(ws, ws.island.time, ws.island.y.start)
        _copy_coordinates(ws, ws.step.y_stage.start)
        worst = 0.0
        for articulation in ws.articulations:
            velocities = ws.step.y_stage.start + ws.model.n_q
            worst = max(worst, _subtract(ws, articulation, articulation.residual, velocities))
        # joints that are farther apart than steps can lead are not moved
        if iteration == 0 and worst > _allowed_residual(ws):
            break
        # an iteration that does not even halve the residual makes no progress any more
        if worst <= NEGLIGIBLE * ws.tolerance.gap or worst > 0.5 * before or iteration == _MOST_ITERATIONS - 1:
            break
        # the last iteration moves nothing, so that the bodies are evaluated at their end
        before = worst
        _displace(ws)
    # a residual that is not a number fails, too; _displace may have failed before; -1: no single joint
    if not worst <= ALLOWED * ws.tolerance.gap and ws.run.failure == Status.RUNNING:
        fail_check(ws, Status.JOINTS_APART, -1, worst, ALLOWED * ws.tolerance.gap)
    for articulation in ws.articulations:
        _subtract(ws, articulation, articulation.rate, ws.island.y.start + ws.model.n_q)


@kernel("f8(ws)")
def _allowed_residual(ws: Workspace) -> float:
    """Residual of a joint that the tolerances of gaps and steps allow [m or 1].

    The tolerance of steps is relative to the largest coordinate and its scale.
    """
    size = 0.0
    for i in range(ws.model.n_q):
        size = max(size, ws.step.y_scale[i] + abs(ws.island.y[i]))
    return float(max(ALLOWED * ws.tolerance.gap, ALLOWED * ws.tolerance.relative * size))


@kernel("f8(ws, Articulation, i8, i8)")
def _subtract(ws: Workspace, articulation: Articulation, excess: int, out: int) -> float:
    """Subtract Y^T times the residuals or rates at ``excess`` from the velocities at ``out``. Largest of their sizes.

    Y^T is the response of an articulation (bodies that joints tie together) that makes these residuals or rates zero.
    """
    worst = 0.0
    for line in range(articulation.n_rows):
        worst = max(worst, abs(ws.floats[excess + line]))
        subtract_response(ws, articulation, line, ws.floats[excess + line], out + articulation.u)
    return worst
