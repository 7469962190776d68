"""What a run looks at in itself: figures that no tolerance explains end it by name, before anything builds on them."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.bodies import evaluate_bodies
from nonsmooth.engine.bodies.kinematics import evaluate_geometry
from nonsmooth.engine.flow.mean_work import book_mean_forces
from nonsmooth.engine.memory.layout import EXCHANGED
from nonsmooth.engine.memory.modes import GAP_UNEXPLAINED, OPEN, PASSED, RUNNING
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    at,
    body_at,
    call_compliance,
    contact_at,
    frame_at,
    kernel,
    pair_at,
)
from nonsmooth.engine.numerics.vectors import minus
from nonsmooth.engine.pairs.look import look_at_pairs

EXPLAINED = 1e3
"""What steps and events within their tolerances leave adds up to no more than so many of them."""
NOUGHT = 1.0 / EXPLAINED
"""Gaps, rates, times and residuals below this part of their tolerance are none: all of them together stay within it."""
NEAR = 10.0
"""Gaps and rates of so many tolerances are those of surfaces next to each other, as neighbours at rest are."""
_ROUND_OFF = 1e-12
"""Part of an energy that sums over a run do not tell from none."""


@kernel("void(S, i8, i8, f8, f8)")
def blame(S: Scalars, status: int, number: int, found: float, allowed: float) -> None:
    """End the run by ``status``, with the number of the body or contact, what was found there and what is explained."""
    if S.failed == RUNNING:
        S.failed, S.blamed, S.found, S.allowed = status, number, found, allowed


@kernel("f8(S, F, I, i8)")
def held_gap(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return the gap that a closed contact is to lose; past the end of its features it only tells how far."""
    contact = contact_at(S, w, k, c)
    return float(contact.gap if contact.beyond <= 0.0 else 0.0)


@kernel("f8(S, F, I, i8)")
def tolerated_gap(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return the gap that a closed contact may have, or an open one lack, by the tolerances [m].

    Those are of gaps, of steps, relative to where the witness points are, and of event times.
    """
    contact = contact_at(S, w, k, c)
    farthest = 0.0
    for side in range(2):
        point = contact.point_a if side == 0 else contact.point_b
        arm = minus(point, frame_at(w, contact.frame_a if side == 0 else contact.frame_b).origin)
        far = 0.0
        for i in range(3):
            far += abs(point[i]) + abs(arm[i])
        farthest = max(farthest, far)
    late = S.time_tolerance * abs(contact.gap_rate_first)
    return float(EXPLAINED * (S.gap_tolerance + S.rtol * farthest + late))


@kernel("f8(S, F, I, i8)")
def explained_gap(S: Scalars, w: Floats, k: Integers, c: int) -> float:
    """Return the same [m], and the way on which a gap comes to rest where forces are averaged."""
    contact = contact_at(S, w, k, c)
    way = contact.mean_way if contact.averaged != OPEN else 0.0
    return float(tolerated_gap(S, w, k, c) + way)


@kernel("i8(S, F, I, i8)")
def _presses(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return 1 if some contact of the same two frames as contact ``c`` is closed."""
    contact = contact_at(S, w, k, c)
    for other in range(S.n_contacts):
        another = contact_at(S, w, k, other)
        if another.mode != OPEN and another.frame_a == contact.frame_a and another.frame_b == contact.frame_b:
            return 1
    return 0


@kernel("f8(S, F, I, i8)")
def _tolerated_overlap(S: Scalars, w: Floats, k: Integers, number: int) -> float:
    """Return by how much a pair of convex parts may overlap by the tolerances of gaps and of steps [m]."""
    pair = pair_at(S, w, k, number)
    farthest = 0.0
    for side in range(2):
        origin = frame_at(w, pair.frame_a if side == 0 else pair.frame_b).origin
        farthest = max(farthest, abs(origin[0]) + abs(origin[1]) + abs(origin[2]))
    return float(EXPLAINED * (S.gap_tolerance + S.rtol * (farthest + pair.size)))


@kernel("void(S, F, I)")
def check_gaps(S: Scalars, w: Floats, k: Integers) -> None:
    """Look at pairs and gaps where a step begins: open contacts must be apart, closed rigid ones closed.

    Bodies that springs let into each other overlap at other features, too, as long as one contact of theirs is closed.
    """
    if S.n_pairs > 0:
        look_at_pairs(S, w, k)
    if S.passed >= 0:
        explained = S.passed_explained + _tolerated_overlap(S, w, k, S.passed)
        if S.passed_depth > explained:
            blame(S, PASSED, pair_at(S, w, k, S.passed).contact, S.passed_depth, explained)
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        gap = contact.gap_end
        if contact.mode == OPEN:
            gap = min(0.0, gap)
            if contact.overlap_end < 0.0 and _presses(S, w, k, c) == 0:
                gap = contact.overlap_end
        elif contact.normal_function != 0 or contact.beyond > 0.0:
            continue
        # looked at closely only where it is not plainly explained
        if abs(gap) > EXPLAINED * S.gap_tolerance and abs(gap) > explained_gap(S, w, k, c):
            blame(S, GAP_UNEXPLAINED, c, gap, explained_gap(S, w, k, c))


@kernel("f8(S, F, I, i8, f8)")
def _stored(S: Scalars, w: Floats, k: Integers, c: int, depth: float) -> float:
    """Return the energy of a spring at a depth [J]: of its force at rest, by Gauss's rule."""
    contact, total = contact_at(S, w, k, c), 0.0
    for i in range(-1, 2):
        weight, place = (8.0 - 3.0 * i * i) / 18.0, 0.5 * (1.0 + i * math.sqrt(0.6))
        parameters = at(w, contact.normal_parameters)
        total += weight * call_compliance(contact.normal_function, place * depth, 0.0, contact.closing_rate, parameters)
    return float(depth * total)


@kernel("f8(S, F, I, i8, i8)")
def _deepest_other(S: Scalars, w: Floats, k: Integers, c: int, after: int) -> float:
    """Return the least gap of the other closed contacts of the frames of a contact, before an event or after it."""
    contact, deepest = contact_at(S, w, k, c), 0.0
    for other in range(S.n_contacts):
        another = contact_at(S, w, k, other)
        mode = another.mode_agreed if after == 1 else another.mode
        same = another.frame_a == contact.frame_a and another.frame_b == contact.frame_b
        if other != c and same and mode != OPEN:
            deepest = min(deepest, another.gap)
    return float(deepest)


@kernel("void(S, F, I)")
def check_begun(S: Scalars, w: Floats, k: Integers) -> None:
    """Look at springs that begin or end inside of a body at an event, before modes are taken over.

    One contact may take over from another at the depth that this has; what springs gain or lose beside that is energy
    from nowhere.  A spring that begins deeper than all others of its bodies ends the run.
    """
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.normal_function == 0 or (contact.mode == OPEN) == (contact.mode_agreed == OPEN):
            continue
        if contact.mode != OPEN:
            # past its end only what takes over knows the depth
            if contact.beyond > 0.0:
                S.jumped -= _stored(S, w, k, c, -_deepest_other(S, w, k, c, 1))
            continue
        tolerated = explained_gap(S, w, k, c)
        if contact.gap >= -tolerated:
            continue
        S.jumped += _stored(S, w, k, c, -contact.gap)
        S.jump_t = S.t
        explained = tolerated - _deepest_other(S, w, k, c, 0)
        if contact.gap < -explained:
            blame(S, GAP_UNEXPLAINED, c, contact.gap, explained)


@kernel("f8(S)")
def _booked(S: Scalars) -> float:
    """Return what the account says of the energy that events gave and took so far [J]."""
    return float(S.driven_work - S.restitution_loss - S.friction_loss - S.closing_loss)


@kernel("f8(S, F, I, i8)")
def energy_of_bodies(S: Scalars, w: Floats, k: Integers, which: int) -> float:
    """Return the kinetic (0) or potential (1) energy of the bodies as evaluated [J]."""
    total = 0.0
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        n_u = body.nu
        if n_u > 0:
            total += w[body.tail + body.nq + n_u + n_u * n_u + which]
    return total


@kernel("void(S, F, I)")
def open_account(S: Scalars, w: Floats, k: Integers) -> None:
    """Keep the energy and the account as they are before an event, the bodies being evaluated."""
    S.account_open = 1
    S.kinetic_before, S.potential_before = energy_of_bodies(S, w, k, 0), energy_of_bodies(S, w, k, 1)
    S.booked_before = _booked(S)


@kernel("void(S, F, I)")
def close_account(S: Scalars, w: Floats, k: Integers) -> None:
    """Compare the energy after an event, the bodies being evaluated, with its account; keep the worst of all events.

    Impacts are integrated within their tolerance of the energies in them; next to none are those below round-off of the
    potential energy, or of what the run exchanged so far.
    """
    if S.account_open == 0:
        return
    S.account_open = 0
    kinetic, potential = energy_of_bodies(S, w, k, 0), energy_of_bodies(S, w, k, 1)
    booked = _booked(S) - S.booked_before
    change = kinetic - S.kinetic_before + (potential - S.potential_before)
    exchanged = abs(w[S.y + S.n_q + S.n_u + EXCHANGED])
    explained = EXPLAINED * S.impact_rtol * (S.kinetic_before + kinetic + abs(booked))
    explained += _ROUND_OFF * (exchanged + abs(potential) + abs(S.potential_before))
    share = abs(change - booked) / explained if explained > 0.0 else 0.0
    if share > S.open_share:
        S.open_share, S.open_energy, S.open_t = share, change - booked, S.t


@kernel("f8(S, F, I)")
def scale_energy(S: Scalars, w: Floats, k: Integers) -> float:
    """Return the kinetic energy of velocities as large as their scales, the bodies being evaluated [J]."""
    total = 0.0
    for number in range(S.n_bodies):
        body = body_at(S, w, k, number)
        masses, scales = body.tail + body.nq + body.nu, S.y_scale + S.n_q + body.u
        for i in range(body.nu):
            total += 0.5 * w[masses + i * (body.nu + 1)] * w[scales + i] ** 2
    return total


@kernel("void(S, F, I)")
def check_end(S: Scalars, w: Floats, k: Integers) -> None:
    """Look at the state in which the run ends as at one in which a step begins."""
    evaluate_bodies(S, w, k, S.t, S.y)
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        evaluate_geometry(S, w, k, c)
        contact.gap_end, contact.overlap_end = contact.gap, contact.overlap
    book_mean_forces(S, w, k)
    S.scale_energy = scale_energy(S, w, k)
    close_account(S, w, k)
    check_gaps(S, w, k)
