"""A trial of the contact problem: forces for the modes under trial, and the test of these forces by the contact laws.

Each solver only proposes modes. Every proposal is tried here: the forces of the modes follow from linear equations
(:mod:`nonsmooth.engine.contact.forces`), and the laws decide. So a solution is exact to round-off whatever the
tolerance of the solver, and solvers need no proof of convergence.

The laws, with accelerations a and forces f of each contact:

* open:     f = 0, a_n >= 0;
* sticking: a = 0, f_n >= 0, |f_t| <= mu_s f_n;
* sliding:  a_n = 0, f_n >= 0, f_t = -mu f_n d. At rest, the slip acceleration must point along d.

The comparisons need a scale. The largest summand of the accelerations is taken, not the largest acceleration, because
the summands cancel each other and leave round-off of their own size.
"""

from __future__ import annotations

import math
from enum import IntEnum

from nonsmooth.engine.contact.distribution import distribute, is_out_of_reach
from nonsmooth.engine.contact.forces import friction_of_slip, reduced_coefficient, resolve
from nonsmooth.engine.delassus.delassus import acceleration, diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, entry_point, kernel, result
from nonsmooth.engine.numerics.arrays import largest_size
from nonsmooth.engine.numerics.vectors import length, unit

NO_FORCE = 1e-9
"""Force or acceleration that counts as zero, relative to the largest. Round-off of elimination is smaller."""
_SHARED_ROUND_OFF = 1e-5
"""Part of the zero force of the island that counts as zero in each contact: round-off of large forces reaches all."""
_DISTRIBUTED = 0.1
"""Distance of redundant forces to their cones, relative to the least zero force, at which they count as distributed."""
EQUAL = 1e3
"""Acceleration, in zero accelerations, that still shows a contact at rest. More contacts than can stick independently
disagree by so much."""


@result
class Verdict(IntEnum):
    """What the contact laws say of forces and modes under trial."""

    VIOLATED = 0
    """A law is violated."""
    FULFILLED = 1
    """All laws are fulfilled."""
    REDISTRIBUTABLE = 2
    """Only bounds of redundant forces are violated. Other forces that give the same motion may keep them."""


@kernel()
def find_tried_forces(ws: Workspace) -> None:
    """Find the forces of the active contacts in the modes under trial [N], and count the effort, which is limited.

    In these modes the forces follow from linear equations. No inequality is checked. A law may give normal forces.
    """
    for active in ws.actives:
        is_open = active.mode_tried == Mode.OPEN
        active.is_normal_force_unknown = not (is_open or active.has_given_force)
        # a contact without friction is at rest by chance, and no force keeps it there
        active.sticks = active.mode_tried == Mode.STICK and active.static_coefficient > 0.0
        if is_open:
            active.normal_force = 0.0
        elif active.has_given_force:
            active.normal_force = active.given_force
    resolve(ws)
    ws.totals.n_evaluations += 1
    # the cost of an elimination grows with the cube
    ws.problem.effort += float(ws.problem.n_unknown) ** 3


@kernel()
def evaluate_accelerations(ws: Workspace) -> None:
    """Write the accelerations b + G f of the active contacts [m/s^2], and the thresholds of zero for the contact laws.

    These are the acceleration and the force of the island that count as zero, in ``small_acceleration`` and
    ``small_force``. b is without contact forces, G the Delassus matrix, f the contact forces.
    """
    # round-off of an acceleration is relative to the largest of its terms
    scale = ws.problem.acceleration_scale
    force_scale = largest_size(ws.floats, ws.problem.forces.start, 3 * ws.problem.n_active)
    for active in ws.actives:
        own = diagonal_block(ws, active.index).nn
        # a force that causes the largest acceleration sets a scale if all present forces are small
        if own > 0.0:
            force_scale = max(force_scale, scale / own)
    for active in ws.actives:
        for r in range(3):
            total = active.free[r]
            for block in range(active.first_block, active.end_block):
                force = ws.actives[ws.island.block_column[block]].force
                for s in range(3):
                    part = ws.island.delassus[DELASSUS * block + 3 * r + s] * force[s]
                    total += part
                    scale = max(scale, abs(part))
            active.acceleration[r] = total
    ws.problem.small_acceleration, ws.problem.small_force = NO_FORCE * scale, NO_FORCE * force_scale


@kernel("f8(ws, i8)")
def small_force(ws: Workspace, a: int) -> float:
    """Force of active contact ``a`` that counts as zero [N].

    Its own forces set the scale: those of a heavy body in the same island may be many orders larger.
    """
    own, size = diagonal_block(ws, a).nn, largest_size(ws.floats, ws.problem.forces.start + 3 * a, 3)
    # a force that causes the largest acceleration of the problem is not small, either
    if own > 0.0:
        size = max(size, ws.problem.acceleration_scale / own)
    return float(NO_FORCE * size + _SHARED_ROUND_OFF * ws.problem.small_force)


@entry_point("b1(ws, b1)")
def verify(ws: Workspace, is_lenient: bool) -> bool:
    """Find the forces of the modes under trial. True if modes and forces fulfil the laws, see :func:`check_laws`."""
    # redundant forces are those of least norm; if lenient, tensile ones of them may be replaced
    find_tried_forces(ws)
    return check_laws(ws, is_lenient)


@kernel("b1(ws, b1)")
def check_laws(ws: Workspace, is_lenient: bool) -> bool:
    """True if the forces fulfil the contact laws in the modes under trial, False if they violate one.

    Redundant forces that exceed Coulomb's bound, or are tensile if ``is_lenient``, are replaced by others that give the
    same motion, if there are any within the bounds.
    """
    verdict = _check(ws, is_lenient)
    if verdict != Verdict.REDISTRIBUTABLE:
        return verdict == Verdict.FULFILLED
    # what the check of the smallest force allows
    allowed = _DISTRIBUTED * _least_small_force(ws)
    if is_out_of_reach(ws, allowed):
        return False
    # no distance inside the cones (inset 0) is needed; the forces come as close as they can, and the check decides
    distribute(ws, inset=0.0, allowed=allowed)
    # distribution moves normal forces, and with them the friction of sliding contacts
    for active in ws.actives:
        if active.mode_tried == Mode.SLIDE:
            friction_of_slip(ws, active.index)
    return _check(ws, is_lenient) == Verdict.FULFILLED


@kernel("f8(ws)")
def _least_small_force(ws: Workspace) -> float:
    """Least force that counts as zero, of the active contacts whose forces are redundant [N].

    Friction of least norm may be far larger than its bound. So a given normal force sets the scale of its contact.
    """
    least = math.inf
    for active in ws.actives:
        if active.has_redundant_force and active.is_normal_force_unknown:
            least = min(least, small_force(ws, active.index))
        elif active.has_redundant_force:
            least = min(least, NO_FORCE * active.normal_force + _SHARED_ROUND_OFF * ws.problem.small_force)
    return least


@kernel("Verdict(ws, b1)")
def _check(ws: Workspace, is_lenient: bool) -> Verdict:
    """Verdict on the forces of all active contacts: the worst one of a contact. Writes their accelerations."""
    evaluate_accelerations(ws)
    verdict = Verdict.FULFILLED
    for active in ws.actives:
        own = _check_contact(ws, active, is_lenient)
        # no other contact can mend this
        if own == Verdict.VIOLATED:
            return own
        if own == Verdict.REDISTRIBUTABLE:
            verdict = own
    return verdict


@kernel("Verdict(ws, ActiveContact, b1)")
def _check_contact(ws: Workspace, active: ActiveContact, is_lenient: bool) -> Verdict:
    """Verdict on the force of one contact in the mode under trial.

    If ``is_lenient``, tensile forces that are not unique are redistributable rather than a violation.
    """
    if active.has_given_force:
        # it has no friction without a force, and its normal acceleration is free
        return Verdict.FULFILLED if active.mode_tried == Mode.OPEN else _check_friction(ws, active)
    if active.mode_tried == Mode.OPEN:
        # a contact that approaches is not open
        separates = active.normal_acceleration >= -ws.problem.small_acceleration
        return Verdict.FULFILLED if separates else Verdict.VIOLATED
    # a closed contact keeps its gap; a number that is not finite is a violation, too
    if not abs(active.normal_acceleration) <= _allowed_acceleration(ws):
        return Verdict.VIOLATED
    # if more force means more approach (Painleve's paradox), the balance is unstable; of a slip that begins, as at
    # rest, this is not checked
    slips = active.mode_tried == Mode.SLIDE and not active.is_at_rest
    if slips and reduced_coefficient(ws, active.index) <= 0.0:
        return Verdict.VIOLATED
    is_tensile = not active.normal_force >= -small_force(ws, active.index)
    # tensile forces that are not unique may be replaced by others of the same motion
    if is_tensile and not (is_lenient and ws.problem.is_deficient):
        return Verdict.VIOLATED
    of_friction = _check_friction(ws, active)
    if of_friction == Verdict.FULFILLED and is_tensile:
        return Verdict.REDISTRIBUTABLE
    return of_friction


@kernel("f8(ws)")
def _allowed_acceleration(ws: Workspace) -> float:
    """Acceleration of a closed contact that counts as zero [m/s^2]: along the normal, or tangential if it sticks."""
    # redundant contacts may disagree by more than round-off
    small = ws.problem.small_acceleration
    return float(EQUAL * small if ws.problem.is_deficient else small)


@kernel("Verdict(ws, ActiveContact)")
def _check_friction(ws: Workspace, active: ActiveContact) -> Verdict:
    """Verdict on the friction of one closed contact in the mode under trial.

    A contact that slips from before has its friction by construction. The bound of one that sticks, or the direction of
    a slip that begins, is checked.
    """
    a1, a2 = active.slip_acceleration
    if active.mode_tried == Mode.STICK:
        # a contact that sticks has no slip acceleration
        if not abs(a1) + abs(a2) <= _allowed_acceleration(ws):
            return Verdict.VIOLATED
        if length(active.friction) <= active.static_coefficient * active.normal_force + small_force(ws, active.index):
            return Verdict.FULFILLED
        # other friction of the same motion may be within its bound
        return Verdict.REDISTRIBUTABLE if active.has_redundant_force else Verdict.VIOLATED
    if not active.is_at_rest:
        return Verdict.FULFILLED
    small = ws.problem.small_acceleration
    # the slip must begin along the direction d that the friction opposes
    forward = a1 * active.direction[0] + a2 * active.direction[1]
    across = a1 * active.direction[1] - a2 * active.direction[0]
    is_opposed = forward >= -small and abs(across) <= small
    return Verdict.FULFILLED if is_opposed else Verdict.VIOLATED


@kernel()
def guess_modes_from_forces(ws: Workspace) -> None:
    """Guess modes and slip directions from the present forces and their accelerations, for a trial of these modes.

    A projection decides: f - a / g is projected on Coulomb's cone, where g is the inverse mass of the contact. Forces
    of the solution are their own projections (Alart and Curnier 1991). A projection on the apex means open, on the
    inside of the cone sticking, on its surface sliding. The accelerations are overwritten.
    """
    for active in ws.actives:
        for r in range(3):
            active.acceleration[r] = acceleration(ws, active, r)
        # g times the normal component of f - a / g
        compression = active.normal_force * diagonal_block(ws, active.index).nn - active.normal_acceleration
        active.mode_tried = Mode.SLIDE
        if active.is_at_rest:
            g = tangential_inverse_mass(ws, active)
            # g times the tangential components; a slip that begins opposes them
            y1 = g * active.friction[0] - active.slip_acceleration[0]
            y2 = g * active.friction[1] - active.slip_acceleration[1]
            norm = length((y1, y2))
            if norm > 0.0:
                active.direction = unit((-y1, -y2))
            # TODO: a projection would have the radius mu y_n of the projected normal force, not mu f_n
            # a contact that the search has let slide must not stick again
            if not active.was_freed and norm <= g * active.friction_coefficient * active.normal_force:
                active.mode_tried = Mode.STICK
        if active.has_given_force:
            compression = active.given_force
        if compression <= 0.0:
            active.mode_tried = Mode.OPEN


@kernel("f8(ws, ActiveContact)")
def tangential_inverse_mass(ws: Workspace, active: ActiveContact) -> float:
    """Larger slip acceleration of a contact per unit of its own friction along t1 or t2 [1/kg]. It is a scale only.

    A contact that cannot slip gets its normal inverse mass instead.
    """
    # TODO: the larger diagonal entry depends on the choice of the tangents; the larger eigenvalue would not
    own = diagonal_block(ws, active.index)
    largest = max(own.t11, own.t22)
    # not zero, because callers divide by the result
    return float(largest if largest > 0.0 else own.nn)
