"""What a run looks at in itself: figures that no tolerance explains end it by name, before anything builds on them."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_geometry
from nonsmooth.engine.flow.mean_work import account_for_mean_forces
from nonsmooth.engine.memory.layout import EXCHANGED
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    call_compliance,
    frame_at,
    kernel,
)
from nonsmooth.engine.numerics.vectors import Pair, minus
from nonsmooth.engine.pairs.overlaps import check_pairs

ALLOWED = 1e3
"""What steps and events within their tolerances leave adds up to no more than so many of them."""
NEGLIGIBLE = 1.0 / ALLOWED
"""Gaps, rates, times and residuals below this part of their tolerance are none: all of them together stay within it."""
ADJACENT = 10.0
"""Gaps and rates of so many tolerances are those of surfaces next to each other, as neighbours at rest are."""
_ROUND_OFF = 1e-12
"""Part of an energy that sums over a run do not tell from none."""


@kernel("void(ws, Status, i8, f8, f8)")
def fail_check(ws: Workspace, status: Status, number: int, found: float, allowed: float) -> None:
    """End the run by ``status``, with the number of the body or contact, what was found there and what is explained."""
    if ws.run.failure == Status.RUNNING:
        ws.run.failure, ws.run.failed_number, ws.run.found, ws.run.allowed = status, number, found, allowed


@kernel("f8(ws, i8)")
def held_gap(ws: Workspace, c: int) -> float:
    """Return the gap that a closed contact is to lose; past the end of its features it only tells how far."""
    contact = ws.contacts[c]
    return float(contact.gap if contact.past_feature <= 0.0 else 0.0)


@kernel("f8(ws, i8)")
def tolerated_gap(ws: Workspace, c: int) -> float:
    """Return the gap that a closed contact may have, or an open one lack, by the tolerances [m].

    Those are of gaps, of steps, relative to where the witness points are, and of event times.
    """
    contact = ws.contacts[c]
    farthest = 0.0
    for side in range(2):
        point = contact.point_a if side == 0 else contact.point_b
        arm = minus(point, frame_at(ws.floats, contact.frame_a if side == 0 else contact.frame_b).origin)
        far = 0.0
        for i in range(3):
            far += abs(point[i]) + abs(arm[i])
        farthest = max(farthest, far)
    late = ws.tolerance.time * abs(contact.gap_rate_at_start)
    return float(ALLOWED * (ws.tolerance.gap + ws.tolerance.relative * farthest + late))


@kernel("f8(ws, i8)")
def allowed_gap(ws: Workspace, c: int) -> float:
    """Return the same [m], and the way on which a gap comes to rest where forces are averaged."""
    contact = ws.contacts[c]
    way = contact.mean_gap_change if contact.is_averaged else 0.0
    return float(tolerated_gap(ws, c) + way)


@kernel("b1(ws, i8)")
def _has_closed_contact(ws: Workspace, c: int) -> bool:
    """Return 1 if some contact of the same two frames as contact ``c`` is closed."""
    contact = ws.contacts[c]
    for other in range(ws.island.n_contacts):
        another = ws.contacts[other]
        if another.mode != Mode.OPEN and another.frame_a == contact.frame_a and another.frame_b == contact.frame_b:
            return True
    return False


@kernel("f8(ws, i8)")
def _allowed_overlap(ws: Workspace, number: int) -> float:
    """Return by how much a pair of convex parts may overlap by the tolerances of gaps and of steps [m]."""
    pair = ws.pairs[number]
    farthest = 0.0
    for side in range(2):
        origin = frame_at(ws.floats, pair.frame_a if side == 0 else pair.frame_b).origin
        farthest = max(farthest, abs(origin[0]) + abs(origin[1]) + abs(origin[2]))
    return float(ALLOWED * (ws.tolerance.gap + ws.tolerance.relative * (farthest + pair.size)))


@kernel()
def check_gaps(ws: Workspace) -> None:
    """Look at pairs and gaps where a step begins: open contacts must be apart, closed rigid ones closed.

    Bodies that springs let into each other overlap at other features, too, as long as one contact of theirs is closed.
    """
    if ws.model.n_pairs > 0:
        check_pairs(ws)
    if ws.run.passed_pair >= 0:
        explained = ws.run.passed_allowed + _allowed_overlap(ws, ws.run.passed_pair)
        if ws.run.passed_depth > explained:
            fail_check(ws, Status.PASSED, ws.pairs[ws.run.passed_pair].contact, ws.run.passed_depth, explained)
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        gap = contact.gap_at_end
        if contact.mode == Mode.OPEN:
            gap = min(0.0, gap)
            if contact.overlap_at_end < 0.0 and not _has_closed_contact(ws, c):
                gap = contact.overlap_at_end
        elif contact.is_compliant or contact.past_feature > 0.0:
            continue
        # looked at closely only where it is not plainly explained
        if abs(gap) > ALLOWED * ws.tolerance.gap and abs(gap) > allowed_gap(ws, c):
            fail_check(ws, Status.GAP_UNEXPLAINED, c, gap, allowed_gap(ws, c))


@kernel("f8(ws, i8, f8)")
def _stored_energy(ws: Workspace, c: int, depth: float) -> float:
    """Return the energy of a spring at a depth [J]: of its force at rest, by Gauss's rule."""
    contact, total = ws.contacts[c], 0.0
    for i in range(-1, 2):
        weight, place = (8.0 - 3.0 * i * i) / 18.0, 0.5 * (1.0 + i * math.sqrt(0.6))
        parameters = at(ws.floats, contact.normal_parameters)
        total += weight * call_compliance(contact.normal_function, place * depth, 0.0, contact.closing_rate, parameters)
    return float(depth * total)


@kernel("f8(ws, i8, b1)")
def _deepest_other(ws: Workspace, c: int, after: bool) -> float:
    """Return the least gap of the other closed contacts of the frames of a contact, before an event or after it."""
    contact, deepest = ws.contacts[c], 0.0
    for other in range(ws.island.n_contacts):
        another = ws.contacts[other]
        mode = another.mode_agreed if after else another.mode
        same = another.frame_a == contact.frame_a and another.frame_b == contact.frame_b
        if other != c and same and mode != Mode.OPEN:
            deepest = min(deepest, another.gap)
    return float(deepest)


@kernel()
def check_new_springs(ws: Workspace) -> None:
    """Look at springs that begin or end inside of a body at an event, before modes are taken over.

    One contact may take over from another at the depth that this has; what springs gain or lose beside that is energy
    from nowhere.  A spring that begins deeper than all others of its bodies ends the run.
    """
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if not contact.is_compliant or (contact.mode == Mode.OPEN) == (contact.mode_agreed == Mode.OPEN):
            continue
        if contact.mode != Mode.OPEN:
            # past its end only what takes over knows the depth
            if contact.past_feature > 0.0:
                ws.run.jumped_energy -= _stored_energy(ws, c, -_deepest_other(ws, c, after=True))
            continue
        tolerated = allowed_gap(ws, c)
        if contact.gap >= -tolerated:
            continue
        ws.run.jumped_energy += _stored_energy(ws, c, -contact.gap)
        ws.run.jump_time = ws.island.time
        explained = tolerated - _deepest_other(ws, c, after=False)
        if contact.gap < -explained:
            fail_check(ws, Status.GAP_UNEXPLAINED, c, contact.gap, explained)


@kernel("f8(ws)")
def _accounted_energy(ws: Workspace) -> float:
    """Return what the account says of the energy that events gave and took so far [J]."""
    return float(ws.totals.driven_work - ws.totals.restitution_loss - ws.totals.friction_loss - ws.totals.closing_loss)


@kernel("v2(ws)")
def energies_of_bodies(ws: Workspace) -> Pair:
    """Kinetic and potential energy of the bodies as evaluated [J]."""
    kinetic = potential = 0.0
    for number in range(ws.model.n_bodies):
        body = ws.bodies[number]
        n_u = body.n_u
        if n_u > 0:
            energies = body.tail + body.n_q + n_u + n_u * n_u
            kinetic += ws.floats[energies]
            potential += ws.floats[energies + 1]
    return kinetic, potential


@kernel()
def open_energy_account(ws: Workspace) -> None:
    """Keep the energy and the account as they are before an event, the bodies being evaluated."""
    ws.island.has_energy_account = True
    ws.island.kinetic_before, ws.island.potential_before = energies_of_bodies(ws)
    ws.island.accounted_before = _accounted_energy(ws)


@kernel()
def close_energy_account(ws: Workspace) -> None:
    """Compare the energy after an event, the bodies being evaluated, with its account; keep the worst of all events.

    Impacts are integrated within their tolerance of the energies in them; next to none are those below round-off of the
    potential energy, or of what the run exchanged so far.
    """
    if not ws.island.has_energy_account:
        return
    ws.island.has_energy_account = False
    kinetic, potential = energies_of_bodies(ws)
    booked = _accounted_energy(ws) - ws.island.accounted_before
    change = kinetic - ws.island.kinetic_before + (potential - ws.island.potential_before)
    exchanged = abs(ws.island.y[ws.model.n_q + ws.model.n_u + EXCHANGED])
    explained = ALLOWED * ws.tolerance.impact * (ws.island.kinetic_before + kinetic + abs(booked))
    explained += _ROUND_OFF * (exchanged + abs(potential) + abs(ws.island.potential_before))
    share = abs(change - booked) / explained if explained > 0.0 else 0.0
    if share > ws.run.worst_energy_ratio:
        ws.run.worst_energy_ratio, ws.run.worst_energy, ws.run.worst_energy_time = (
            share,
            change - booked,
            ws.island.time,
        )


@kernel("f8(ws)")
def scale_energy(ws: Workspace) -> float:
    """Return the kinetic energy of velocities as large as their scales, the bodies being evaluated [J]."""
    total = 0.0
    for number in range(ws.model.n_bodies):
        body = ws.bodies[number]
        masses, scales = body.tail + body.n_q + body.n_u, ws.step.y_scale.start + ws.model.n_q + body.u
        for i in range(body.n_u):
            total += 0.5 * ws.floats[masses + i * (body.n_u + 1)] * ws.floats[scales + i] ** 2
    return total


@kernel()
def check_end(ws: Workspace) -> None:
    """Look at the state in which the run ends as at one in which a step begins."""
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        evaluate_geometry(ws, c)
        contact.gap_at_end, contact.overlap_at_end = contact.gap, contact.overlap
    account_for_mean_forces(ws)
    ws.run.energy_scale = scale_energy(ws)
    close_energy_account(ws)
    check_gaps(ws)
