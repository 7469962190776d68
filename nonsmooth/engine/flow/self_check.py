"""Self-checks of a run: gaps, overlaps and energies must be within what the tolerances allow.

An engine of nonsmooth motion can be wrong without a crash: a missed contact leaves bodies inside each other, a spring
that begins inside of a body creates energy. So gaps are checked at the start of each step, and the energy of each event
is compared with its account. The bounds follow from the tolerances of gaps, steps and event times. A run that exceeds
them ends with the contact or body, the value that was found and the value that is allowed.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.equations import energies, inverse_mass
from nonsmooth.engine.bodies.kinematics import evaluate_geometry
from nonsmooth.engine.memory.layout import EXCHANGED, NO_PAIR
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, at, call_compliance, frame_at, kernel
from nonsmooth.engine.numerics.tolerances import ALLOWED
from nonsmooth.engine.numerics.vectors import Pair as EnergyPair
from nonsmooth.engine.numerics.vectors import minus
from nonsmooth.engine.pairs.overlaps import check_pairs

_ROUND_OFF = 1e-12
"""Round-off of the energies that are summed over a run, relative to their absolute sum."""


@kernel("void(ws, Status, i8, f8, f8)")
def fail_check(ws: Workspace, status: Status, number: int, found: float, allowed: float) -> None:
    """End the run with a status, the number of the body or contact, the value that was found and the allowed one.

    Only the first failure of a run is stored.
    """
    if ws.run.failure == Status.RUNNING:
        ws.run.failure, ws.run.failed_number, ws.run.found, ws.run.allowed = status, number, found, allowed


@kernel("f8(ContactRecord)")
def held_gap(contact: ContactRecord) -> float:
    """Gap that a projection must close [m]. Past the end of the features the gap is only a distance, so it is 0."""
    return float(contact.gap if contact.past_feature <= 0.0 else 0.0)


@kernel("f8(ws, i8)")
def tolerated_gap(ws: Workspace, c: int) -> float:
    """Gap that a closed contact ``c`` may have, or overlap of an open one, by the tolerances [m].

    These are the tolerances of gaps, of steps (relative to the distances of the witness points from the origins of
    space and bodies), and of event times (by the gap rate at the start of the step).
    """
    contact = ws.contacts[c]
    farthest = 0.0
    for side in range(2):
        point = contact.point_a if side == 0 else contact.point_b
        offset = minus(point, frame_at(ws.floats, contact.frame_a if side == 0 else contact.frame_b).origin)
        # both distances in the 1-norm
        far = 0.0
        for i in range(3):
            far += abs(point[i]) + abs(offset[i])
        farthest = max(farthest, far)
    late = ws.tolerance.time * abs(contact.gap_rate_at_start)
    return float(ALLOWED * (ws.tolerance.gap + ws.tolerance.relative * farthest + late))


@kernel("f8(ws, i8)")
def allowed_gap(ws: Workspace, c: int) -> float:
    """Gap that a closed contact may have [m]: by the tolerances, plus its change until averaged forces stop it."""
    contact = ws.contacts[c]
    change = contact.mean_gap_change if contact.is_averaged else 0.0
    return float(tolerated_gap(ws, c) + change)


@kernel("b1(ws, ContactRecord)")
def _has_closed_contact(ws: Workspace, contact: ContactRecord) -> bool:
    """True if some contact of the same two frames as ``contact`` is closed: other features may then overlap."""
    for other in ws.contacts:
        if other.mode != Mode.OPEN and other.frame_a == contact.frame_a and other.frame_b == contact.frame_b:
            return True
    return False


@kernel("f8(ws, i8)")
def _allowed_overlap(ws: Workspace, number: int) -> float:
    """Overlap of pair ``number`` of convex parts that the tolerances of gaps and of steps allow [m].

    If no contact of a guarded pair is closed, each step is searched for its first meeting, so the tolerance of gaps
    suffices. The tolerance of steps is relative to the distance from the origin of space plus the size of the parts.
    """
    pair = ws.pairs[number]
    if ws.pairs[pair.group].is_guarded and not ws.pairs[pair.group].is_closed:
        return float(ALLOWED * ws.tolerance.gap)
    farthest = 0.0
    for side in range(2):
        origin = frame_at(ws.floats, pair.frame_a if side == 0 else pair.frame_b).origin
        farthest = max(farthest, abs(origin[0]) + abs(origin[1]) + abs(origin[2]))
    return float(ALLOWED * (ws.tolerance.gap + ws.tolerance.relative * (farthest + pair.size)))


@kernel()
def check_gaps(ws: Workspace) -> None:
    """Check pairs and gaps at the start of a step: open contacts must be apart, and closed rigid ones without gap.

    A pair is two convex parts of bodies with contacts. Past their end, features of other bodies may overlap only while
    a contact of theirs is closed. A check that fails ends the run.
    """
    if ws.model.n_pairs > 0:
        check_pairs(ws)
    # the pair whose overlap exceeds the depth of its closed contacts most, or -1
    if ws.run.passed_pair >= 0:
        allowed = ws.run.passed_allowed + _allowed_overlap(ws, ws.run.passed_pair)
        if ws.run.passed_depth > allowed:
            fail_check(ws, Status.PASSED, ws.pairs[ws.run.passed_pair].contact, ws.run.passed_depth, allowed)
    for contact in ws.contacts:
        gap = contact.gap_at_end
        if contact.mode == Mode.OPEN:
            # a positive gap is no error, and an open spring at depth has an event at the start of the step
            gap = 0.0 if contact.is_compliant else min(0.0, gap)
            # past the end of features the gap is a distance, and the overlap is stored apart; pairs are checked above
            if contact.overlap_at_end < 0.0 and contact.pair == NO_PAIR and not _has_closed_contact(ws, contact):
                gap = contact.overlap_at_end
        elif contact.is_compliant or contact.past_feature > 0.0:
            # a compliant contact has a depth, and past the end of features the gap is only a distance
            continue
        # the first bound is cheap, and decides most cases
        if abs(gap) > ALLOWED * ws.tolerance.gap and abs(gap) > allowed_gap(ws, contact.index):
            fail_check(ws, Status.GAP_UNEXPLAINED, contact.index, gap, allowed_gap(ws, contact.index))


@kernel("f8(ws, ContactRecord, f8)")
def _stored_energy(ws: Workspace, contact: ContactRecord, depth: float) -> float:
    """Energy of a compliant contact at a ``depth`` [m]: the integral of its force at rest [J].

    Gauss's three-point rule is exact for polynomials of degree five.
    """
    total = 0.0
    for i in range(-1, 2):
        # Gauss's rule on [0, 1]: weights 5/18, 8/18 and 5/18
        weight, node = (8.0 - 3.0 * i * i) / 18.0, 0.5 * (1.0 + i * math.sqrt(0.6))
        parameters = at(ws.floats, contact.normal_parameters)
        # 0.0 is the rate of the depth
        total += weight * call_compliance(contact.normal_function, node * depth, 0.0, contact.closing_rate, parameters)
    return float(depth * total)


@kernel("f8(ws, ContactRecord, b1)")
def _deepest_other(ws: Workspace, contact: ContactRecord, after: bool) -> float:
    """Least gap of the other closed contacts of the same two frames, or 0 [m]; closed before or ``after`` an event.

    Its depth is that at which a contact may replace another one. After the event, the modes are those in
    ``mode_agreed``.
    """
    deepest = 0.0
    for other in ws.contacts:
        mode = other.mode_agreed if after else other.mode
        is_same_pair = other.frame_a == contact.frame_a and other.frame_b == contact.frame_b
        if other.index != contact.index and is_same_pair and mode != Mode.OPEN:
            # past the end of its features, an open contact has a substitute as gap, and its depth as overlap
            deepest = min(deepest, other.gap, other.overlap)
    return float(deepest)


@kernel()
def check_new_springs(ws: Workspace) -> None:
    """Check compliant contacts that close or open inside of a body at an event, before their modes are taken over.

    ``mode`` is still the old mode, ``mode_agreed`` the new one. A contact may replace another one at the depth of that
    one. The energy that springs gain or lose by changes of depth is summed up in ``jumped_energy``. A spring that
    closes deeper than all others of its bodies ends the run.
    """
    for contact in ws.contacts:
        # rigid, or a spring that stays open or stays closed
        if not contact.is_compliant or (contact.mode == Mode.OPEN) == (contact.mode_agreed == Mode.OPEN):
            continue
        if contact.mode != Mode.OPEN:
            # it opens past its end: its depth there is that of the contact which replaces it
            if contact.past_feature > 0.0:
                depth = -_deepest_other(ws, contact, after=True)
                ws.run.jumped_energy -= _stored_energy(ws, contact, depth)
            continue
        tolerated = allowed_gap(ws, contact.index)
        # a spring that begins at the surface gains no energy
        if contact.gap >= -tolerated:
            continue
        ws.run.jumped_energy += _stored_energy(ws, contact, -contact.gap)
        ws.run.jump_time = ws.island.time
        # the gap of the deepest one is negative: a contact may begin at that depth
        allowed = tolerated - _deepest_other(ws, contact, after=False)
        if contact.gap < -allowed:
            fail_check(ws, Status.GAP_UNEXPLAINED, contact.index, contact.gap, allowed)


@kernel("f8(ws)")
def _accounted_energy(ws: Workspace) -> float:
    """Energy that events and projections have given to the bodies so far [J]: driven work minus all losses."""
    return float(ws.totals.driven_work - ws.totals.restitution_loss - ws.totals.friction_loss - ws.totals.closing_loss)


@kernel("v2(ws)")
def energies_of_bodies(ws: Workspace) -> EnergyPair:
    """Kinetic and potential energy of the bodies at their last evaluation [J]."""
    kinetic = potential = 0.0
    for body in ws.bodies:
        if body.n_u > 0:
            # kinetic and potential; driven bodies have none
            energy = energies(ws, body)
            kinetic += energy[0]
            potential += energy[1]
    return kinetic, potential


@kernel()
def open_energy_account(ws: Workspace) -> None:
    """Store the energies of the bodies and their account before an event [J]. The bodies must be evaluated.

    :func:`close_energy_account` compares them with those after the event.
    """
    ws.island.has_energy_account = True
    ws.island.kinetic_before, ws.island.potential_before = energies_of_bodies(ws)
    ws.island.accounted_before = _accounted_energy(ws)


@kernel()
def close_energy_account(ws: Workspace) -> None:
    """Compare the energy after an event with its account, and store the worst difference of the run [J].

    The bodies must be evaluated. The worst difference is the largest relative to the allowed one: the tolerance of
    impacts times the kinetic energies, and round-off of the potential energy and of all that the run exchanged so far.
    """
    # no event has come since the last comparison
    if not ws.island.has_energy_account:
        return
    ws.island.has_energy_account = False
    kinetic, potential = energies_of_bodies(ws)
    accounted = _accounted_energy(ws) - ws.island.accounted_before
    change = kinetic - ws.island.kinetic_before + (potential - ws.island.potential_before)
    exchanged = abs(ws.island.y[ws.model.n_q + ws.model.n_u + EXCHANGED])
    allowed = ALLOWED * ws.tolerance.impact * (ws.island.kinetic_before + kinetic + abs(accounted))
    allowed += _ROUND_OFF * (exchanged + abs(potential) + abs(ws.island.potential_before))
    # nothing is allowed only if nothing moves and nothing was exchanged
    ratio = abs(change - accounted) / allowed if allowed > 0.0 else 0.0
    if ratio > ws.run.worst_energy_ratio:
        ws.run.worst_energy_ratio, ws.run.worst_energy = ratio, change - accounted
        ws.run.worst_energy_time = ws.island.time


@kernel("f8(ws)")
def scale_energy(ws: Workspace) -> float:
    """Sum over all velocities of the kinetic energy of one at its scale ``y_scale``, while the others are free [J].

    An energy for comparison, in states of rest too. The bodies must be evaluated. The reciprocal of a diagonal entry of
    M^-1 is the mass that moves with a velocity if all other velocities are free.
    """
    total = 0.0
    for body in ws.bodies:
        inverse = inverse_mass(ws, body)
        for i in range(body.n_u):
            # entries i (n_u + 1) are the diagonal
            own = inverse[i * (body.n_u + 1)]
            if own > 0.0:
                total += 0.5 * ws.step.y_scale[ws.model.n_q + body.u + i] ** 2 / own
    return total


@kernel()
def check_end(ws: Workspace) -> None:
    """Check the state in which the run ends: gaps as at the start of a step, and the energy of the last event.

    Also stores the energy with which unexplained changes are compared.
    """
    evaluate_bodies(ws, ws.island.time, ws.island.y.start)
    for contact in ws.contacts:
        evaluate_geometry(ws, contact.index)
        contact.gap_at_end, contact.overlap_at_end = contact.gap, contact.overlap
    ws.run.energy_scale = scale_energy(ws)
    close_energy_account(ws)
    check_gaps(ws)
