"""Keep g = 0, g' = 0 and v = 0 of the closed contacts by momentum-consistent corrections."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies, evaluate_body, evaluate_free_bodies
from nonsmooth.engine.bodies.kinematics import (
    evaluate_jacobian,
    evaluate_kinematics,
    evaluate_row,
    evaluate_row_response,
    push_response,
    row,
)
from nonsmooth.engine.contact.forces import resolve
from nonsmooth.engine.contact.held_contacts import coupling
from nonsmooth.engine.contact.mean_forces import is_averaged
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus, diagonal_block
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.self_check import ALLOWED, NEGLIGIBLE, fail_check, energies_of_bodies, allowed_gap, held_gap
from nonsmooth.engine.memory.layout import NORMAL_ROW
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    frame_at,
    kernel,
)
from nonsmooth.engine.numerics.vectors import cross, dot, minus

_ROUND_OFF = 8.0 * 2.0**-52
"""The square of a length of one this near to one is one, but for round-off."""
_DAMPING = 1e-8
"""Of the diagonal of G, added to it: contacts that nearly repeat each other need not be closed exactly, where that
would move a body by more than half the gap over the root of this.  A contact alone repeats none."""
_LARGEST_CORRECTION = 10.0
"""Corrections move bodies by no more than so many times what the tolerances explain of a gap."""
_MOST_ITERATIONS = 5
"""Of Newton's method, which is quadratic: two or three do within the tolerances of a step."""


@entry_point("f8(ws, b1)")
def project_rates(ws: Workspace, at_event: bool) -> float:
    """Bring gap rates of the active contacts, and slip velocities of those that do not slip, to zero.

    At an event (1) a slip that is only about to start counts as none: its direction would be that of round-off.  The
    correction is the damped impulse of least kinetic energy, without friction on sliding contacts.
    Returns the kinetic energy it removes [J]; the work of the driven bodies is booked.
    """
    m = ws.problem.n_active
    if m == 0:
        return 0.0
    assemble_delassus(ws)
    for a in range(m):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        active.is_normal_force_unknown = not contact.is_compliant
        active.normal_force = 0.0
        slow = max(abs(contact.rate[1]), abs(contact.rate[2])) <= ws.tolerance.velocity
        rubs = contact.has_traction_law
        active.sticks = contact.mode == Mode.STICK or (at_event and slow and not rubs)
        active.friction_coefficient, active.direction = 0.0, contact.direction
        for r in range(3):
            active.free[r] = contact.rate[r]
    part = _DAMPING if m > 1 else 0.0
    _damp(ws, part)
    resolve(ws)
    add_response(ws, ws.problem.forces.start, ws.island.y.start + ws.model.n_q)
    loss = 0.0
    for a in range(m):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        for r in range(3):
            impulse = active.force[r]
            damping = diagonal_block(ws, a).entries[4 * r] * part / (1.0 + part)
            loss -= 0.5 * impulse * (contact.rate[r] - damping * impulse)
            ws.totals.driven_work -= impulse * contact.prescribed_rate[r]
    return loss


@kernel("void(ws, f8)")
def _damp(ws: Workspace, part: float) -> None:
    """Add a part of its diagonal to the Delassus matrix of the active contacts."""
    for a in range(ws.problem.n_active):
        for r in range(3):
            diagonal_block(ws, a).entries[4 * r] *= 1.0 + part


@kernel("b1(ws)")
def _add_gaps(ws: Workspace) -> bool:
    """Add to ``y_stage`` the velocities that bring the gaps of the active contacts to zero in unit time, along K W.

    They are those of damped least squares, damped the more the nearer the gaps are to what the tolerances explain.
    Return 1, or 0 where no gap is left, or one that nothing explains.
    """
    m = ws.problem.n_active
    worst = share = 0.0
    for a in range(m):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        gap = abs(held_gap(ws, c)) if not contact.is_compliant else 0.0
        worst = max(worst, gap)
        share = max(share, gap / allowed_gap(ws, c))
    if worst <= NEGLIGIBLE * ws.tolerance.gap or share > 1.0:
        return False
    assemble_delassus(ws)
    for a in range(m):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        active.is_normal_force_unknown = not contact.is_compliant
        active.sticks = False
        active.normal_force = active.friction_coefficient = 0.0
        active.direction = contact.direction
        active.free[0] = held_gap(ws, c)
    if m > 1:
        _damp(ws, max(_DAMPING, (0.5 * share / _LARGEST_CORRECTION) ** 2))
    resolve(ws)
    add_response(ws, ws.problem.forces.start, ws.step.y_stage.start + ws.model.n_q)
    return True


@kernel("f8(ws)")
def _project_lone_slip(ws: Workspace) -> float:
    """Take gap and gap rate of an island of one rigid contact that slides, whose geometry and rates are at hand.

    The gap's velocity is added to ``y_stage``; return the kinetic energy that the other takes [J].
    """
    c = ws.actives[0].contact
    contact = ws.contacts[c]
    evaluate_row(ws, c, NORMAL_ROW, contact.axis_n)
    evaluate_row_response(ws, c, NORMAL_ROW, NORMAL_ROW)
    own, gap, rate = coupling(ws, c, NORMAL_ROW, c, NORMAL_ROW), held_gap(ws, c), contact.rate[0]
    if own <= 0.0:
        return 0.0
    if NEGLIGIBLE * ws.tolerance.gap < abs(gap) <= allowed_gap(ws, c):
        push_response(ws, c, NORMAL_ROW, -gap / own, ws.step.y_stage.start + ws.model.n_q)
    impulse, prescribed = -rate / own, rate - row(ws, c, NORMAL_ROW, ws.island.velocities)
    push_response(ws, c, NORMAL_ROW, impulse, ws.island.y.start + ws.model.n_q)
    ws.totals.driven_work -= impulse * prescribed
    return float(-0.5 * impulse * rate)


@kernel("b1(ws)")
def _is_lone_slip(ws: Workspace) -> bool:
    """Return 1 if the active contact is one, rigid, and slides."""
    contact = ws.contacts[ws.actives[0].contact]
    return ws.problem.n_active == 1 and not contact.is_compliant and contact.mode == Mode.SLIDE


@kernel()
def normalise_quaternions(ws: Workspace) -> None:
    """Bring every body's unit quaternion back to unit length; one that is farther off than explained fails the run."""
    for number in range(ws.model.n_bodies):
        body = ws.bodies[number]
        offset = body.quaternion
        if offset < 0:
            continue
        q = ws.island.y.start + body.q + offset
        square = 0.0
        for i in range(4):
            square += ws.floats[q + i] * ws.floats[q + i]
        if abs(square - 1.0) <= _ROUND_OFF:
            continue
        if abs(square - 1.0) > ALLOWED * 4.0 * ws.tolerance.relative:
            fail_check(
                ws,
                Status.QUATERNION_UNEXPLAINED,
                number,
                math.sqrt(square) - 1.0,
                ALLOWED * 2.0 * ws.tolerance.relative,
            )
        factor = 1.0 / math.sqrt(square)
        for i in range(4):
            ws.floats[q + i] *= factor


@kernel("f8(ws, i8)")
def _allowed_motion(ws: Workspace, i: int) -> float:
    """Return how far a correction may move coordinate ``i``, by the tolerances of steps, gaps and event times."""
    step = ws.tolerance.relative * (ws.step.y_scale[i] + abs(ws.island.y[i]))
    return float(_LARGEST_CORRECTION * ALLOWED * (step + ws.tolerance.gap + ws.tolerance.time * abs(ws.island.slopes[i])))


@kernel("f8(ws, i8, i8)")
def _speed_at(ws: Workspace, c: int, number: int) -> float:
    """Return how fast the witness point of contact ``c`` on a body moves [m/s], 0 where the contact is of others."""
    contact, fastest = ws.contacts[c], 0.0
    for side in range(2):
        if (contact.body_a if side == 0 else contact.body_b) == number:
            frame = frame_at(ws.floats, contact.frame_a if side == 0 else contact.frame_b)
            point = contact.point_a if side == 0 else contact.point_b
            velocity = minus(frame.velocity, cross(minus(point, frame.origin), frame.spin))
            fastest = max(fastest, math.sqrt(dot(velocity, velocity)))
    return float(fastest)


@kernel("f8(ws, i8, i8)")
def _allowed_motion_by_gaps(ws: Workspace, number: int, i: int) -> float:
    """Return how far coordinate ``i`` of a body may move as its closed contacts lose what is explained of their gaps.

    What a tolerance of lengths says of angles depends on the levers: each contact alone is let push the body until its
    witness point has moved so far.
    """
    body, total = ws.bodies[number], 0.0
    for place in range(ws.island.n_grouped):
        c = ws.island.grouped[place]
        if ws.contacts[c].is_compliant:
            continue
        for j in range(ws.model.n_y):
            ws.step.y_guess[j] = ws.island.y[j] if j < ws.model.n_q else 0.0
        push_response(ws, c, NORMAL_ROW, 1.0, ws.step.y_guess.start + ws.model.n_q)
        evaluate_body(ws, ws.island.time, ws.step.y_guess.start, number)
        speed = _speed_at(ws, c, number)
        if speed > 0.0:
            total += abs(ws.floats[body.tail + i]) * allowed_gap(ws, c) / speed
    evaluate_body(ws, ws.island.time, ws.step.y_stage.start, number)
    return float(_LARGEST_CORRECTION * total)


@kernel("b1(ws, i8)")
def _is_displaced(ws: Workspace, number: int) -> bool:
    """Return 1 if the velocities in ``y_stage`` move a body."""
    body = ws.bodies[number]
    first = ws.step.y_stage.start + ws.model.n_q + body.u
    for i in range(first, first + body.n_u):
        if ws.floats[i] != 0.0:
            return True
    return False


@kernel()
def _displace(ws: Workspace) -> None:
    """Move the bodies by the velocities in ``y_stage`` for unit time, unless the tolerances do not explain so much."""
    # dq = B du: let the bodies turn the displacement into coordinate rates
    for number in range(ws.model.n_bodies):
        body = ws.bodies[number]
        if not _is_displaced(ws, number):
            continue
        evaluate_body(ws, ws.island.time, ws.step.y_stage.start, number)
        for i in range(body.n_q):
            motion, most = ws.floats[body.tail + i], _allowed_motion(ws, body.q + i)
            # asked only where it matters
            if abs(motion) > most:
                most += _allowed_motion_by_gaps(ws, number, i)
            if abs(motion) > most:
                fail_check(ws, Status.MOTION_UNEXPLAINED, number, motion, most)
                return
    for number in range(ws.model.n_bodies):
        body = ws.bodies[number]
        if _is_displaced(ws, number):
            for i in range(body.n_q):
                ws.island.y[body.q + i] += ws.floats[body.tail + i]
    normalise_quaternions(ws)


@entry_point("f8(ws, b1, b1)")
def project_closed(ws: Workspace, at_event: bool, averaged: bool) -> float:
    """Put the closed contacts on their constraints, island by island; return the energy that this removes [J].

    What the gaps take counts at an event (1); within a step it is the error of the step, which no energy paid for.
    Of islands whose forces are ``averaged`` (1) only these come to rest, where that ends; else only the others (0).
    """
    if at_event:
        group_closed(ws)
    if ws.island.n_grouped == 0:
        return 0.0
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for i in range(ws.model.n_y):
        ws.step.y_stage[i] = ws.island.y[i] if i < ws.model.n_q else 0.0
    loss = 0.0
    moved = 0
    for group in range(ws.island.n_groups):
        activate_group(ws, group)
        if is_averaged(ws) != averaged:
            continue
        past = 0.0
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            c = active.contact
            contact = ws.contacts[c]
            evaluate_kinematics(ws, c)
            past = max(past, contact.past_feature)
        if past > ws.tolerance.gap:
            # behind the end of a feature its rate is that of another one; the event that comes drops the contact
            continue
        if not at_event and _is_lone_slip(ws):
            loss += _project_lone_slip(ws)
            moved += 1
            continue
        for a in range(ws.problem.n_active):
            evaluate_jacobian(ws, ws.actives[a].contact)
        loss += project_rates(ws, at_event)
        moved += _add_gaps(ws)
    if moved > 0:
        before = energies_of_bodies(ws)[1]
        _displace(ws)
        evaluate_free_bodies(ws, ws.island.time, ws.island.y.start, of_all_bodies=True)
        if at_event:
            loss += before - energies_of_bodies(ws)[1]
    return loss


@entry_point()
def project_joints(ws: Workspace) -> None:
    """Bring residuals and rates of the joints to zero by the least motion, and evaluate the bodies there."""
    worst, before = 0.0, math.inf
    for iteration in range(_MOST_ITERATIONS):
        evaluate_bodies(ws, ws.island.time, ws.island.y.start)
        for i in range(ws.model.n_y):
            ws.step.y_stage[i] = ws.island.y[i] if i < ws.model.n_q else 0.0
        worst = 0.0
        for number in range(ws.model.n_articulations):
            residuals = ws.articulations[number].residual
            worst = max(worst, _add_correction(ws, number, residuals, ws.step.y_stage.start + ws.model.n_q))
        if iteration == 0 and worst > _allowed_residual(ws):
            break
        # far from the origin round-off alone is more than the tolerance, and no iteration helps
        if worst <= NEGLIGIBLE * ws.tolerance.gap or worst > 0.5 * before or iteration == _MOST_ITERATIONS - 1:
            break
        before = worst
        _displace(ws)
    if not worst <= ALLOWED * ws.tolerance.gap and ws.run.failure == Status.RUNNING:
        fail_check(ws, Status.JOINTS_APART, -1, worst, ALLOWED * ws.tolerance.gap)
    for number in range(ws.model.n_articulations):
        _add_correction(ws, number, ws.articulations[number].rate, ws.island.y.start + ws.model.n_q)


@kernel("f8(ws)")
def _allowed_residual(ws: Workspace) -> float:
    """Return the residual of a joint that the tolerances of steps explain [m or 1]."""
    size = 0.0
    for i in range(ws.model.n_q):
        size = max(size, ws.step.y_scale[i] + abs(ws.island.y[i]))
    return float(max(ALLOWED * ws.tolerance.gap, ALLOWED * ws.tolerance.relative * size))


@kernel("f8(ws, i8, i8, i8)")
def _add_correction(ws: Workspace, number: int, wrong: int, out: int) -> float:
    """Subtract Y^T times what is ``wrong``, residuals or rates, from the velocities; return the largest of it."""
    articulation, worst = ws.articulations[number], 0.0
    n, first = articulation.n_u, out + articulation.u
    for line in range(articulation.n_rows):
        value = ws.floats[wrong + line]
        worst = max(worst, abs(value))
        for i in range(n):
            ws.floats[first + i] -= ws.floats[articulation.solved_response + line * n + i] * value
    return worst
