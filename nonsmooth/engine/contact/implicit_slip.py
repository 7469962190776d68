"""Slip that is an unknown of the contact problem, where its direction turns too fast to be followed.

At the end of a stage of an implicit step the slip is v0 + tau a, a the acceleration that the forces give and v0 what
it would be without it.  Coulomb's friction opposes v0 + tau a, or holds it at zero: with v0 / tau added to the
accelerations without forces that is the problem of incipient slip, and stopping, creeping and breaking away are one.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.anisotropy import turn_facing
from nonsmooth.engine.bodies.kinematics import evaluate_contact, row
from nonsmooth.engine.contact.distribution import distribute
from nonsmooth.engine.contact.forces import friction_of_slip, reduced_coefficient
from nonsmooth.engine.contact.null_space_forces import shift_forces
from nonsmooth.engine.contact.polish import EXACT, has_slip_that_begins, polish
from nonsmooth.engine.contact.problem import friction_coefficient, slip_coefficient
from nonsmooth.engine.contact.trial import hold_tried
from nonsmooth.engine.delassus.delassus import add_product, add_response, assemble_delassus, diagonal_block
from nonsmooth.engine.memory.layout import FIRST_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import length

_FAINT = 1e-13
"""What is held by this part of the largest force more than the bound of friction stays: it is round-off."""
_ARRIVED = 1e-10
"""Forces that are not unique may be so much out of their cones, relative to the largest."""
_TURNS = 8
"""Newton steps of the direction of a slip that is alone; from a step before three or four do."""


@kernel("void(ws, i8)")
def _lay(ws: Workspace, a: int) -> None:
    """Write acceleration without forces, coefficients, mode and slip direction of active contact ``a``."""
    active = ws.actives[a]
    c = active.contact
    contact = ws.contacts[c]
    contact.dissipated_by_spin = 0.0
    if contact.mode == Mode.SLIDE:
        active.friction_coefficient = slip_coefficient(ws, c, length(contact.slip))
    else:
        active.friction_coefficient = friction_coefficient(ws, c, 0.0)
    active.static_coefficient = active.friction_coefficient
    active.mode_tried = active.mode_past = contact.mode
    active.has_given_force = False
    active.is_at_rest = active.friction_coefficient > 0.0
    active.direction = contact.direction
    for r in range(3):
        free = row(ws, c, r, ws.island.du.start)
        active.free[r] = free + contact.bias[r]
        if r > 0 and contact.mode == Mode.SLIDE:
            active.free[r] = free + contact.rate[r] / ws.problem.stage_time - row(ws, c, r, ws.problem.guess)
        ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, abs(free), abs(contact.bias[r]))


@kernel("b1(ws)")
def _halts(ws: Workspace) -> bool:
    """Return 1 if a slip is held: whether others share its load, forces that are not unique tell."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.mode_past == Mode.SLIDE and active.mode_tried == Mode.STICK:
            return True
    return False


@kernel("i8(ws)")
def _stop_and_go(ws: Workspace) -> int:
    """Hold the slips that friction would turn round, and let go those that it cannot hold; return how many."""
    largest = 0.0
    for i in range(3 * ws.problem.n_active):
        largest = max(largest, abs(ws.problem.forces[i]))
    small = _FAINT * largest
    if ws.problem.is_deficient:
        shift_forces(ws)
    if ws.problem.is_deficient and _halts(ws):
        small = 2.0 * _ARRIVED * largest
        distribute(ws, 0.0, _ARRIVED * largest)
        for a in range(ws.problem.n_active):
            if ws.actives[a].mode_tried == Mode.SLIDE:
                friction_of_slip(ws, a)
    changed = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.mode_past != Mode.SLIDE or not active.is_at_rest:
            continue
        if active.mode_tried == Mode.STICK:
            t1, t2 = active.friction
            norm = length(active.friction)
            if norm > active.friction_coefficient * active.normal_force + small:
                active.mode_tried = Mode.SLIDE
                active.direction = -t1 / norm, -t2 / norm
                changed += 1
            continue
        a1 = add_product(ws, active.free[1], a, FIRST_ROW, ws.problem.forces.start)
        a2 = add_product(ws, active.free[2], a, SECOND_ROW, ws.problem.forces.start)
        if a1 * active.direction[0] + a2 * active.direction[1] < 0.0:
            active.mode_tried = Mode.STICK
            changed += 1
    return changed


@kernel("b1(ws)")
def oppose_slips(ws: Workspace) -> bool:
    """Find forces whose friction opposes the slip of all that slides, or holds it at zero; return 1 if found.

    Of what slides ``mode_past`` is that and ``at_rest`` 1; the accelerations at which it would end without forces are
    laid, and the given normal forces.  Directions that lead nowhere are looked for from those in which slips that are
    held break away.
    """
    held = False
    for _round in range(2 * (2 + ws.problem.n_active)):
        polished = polish(ws)
        if not polished:
            if held:
                return False
            held = True
            for a in range(ws.problem.n_active):
                active = ws.actives[a]
                active.mode_tried = Mode.STICK if active.is_at_rest else active.mode_past
        if not polished or not has_slip_that_begins(ws) or ws.problem.is_deficient:
            hold_tried(ws)
        if _stop_and_go(ws) == 0:
            return True
    return False


@kernel("b1(ws)")
def _oppose_alone(ws: Workspace) -> bool:
    """Do the same for one contact that slides on, whose only unknown is a direction; return 1 if it is found."""
    active, g = ws.actives[0], diagonal_block(ws, 0)
    if ws.problem.n_active > 1 or active.mode_past != Mode.SLIDE or not active.is_at_rest or active.has_given_force:
        return False
    mu, (d1, d2) = active.friction_coefficient, active.direction
    for _turn in range(_TURNS):
        reduced = g.nn - mu * (g.n1 * d1 + g.n2 * d2)
        if not reduced > 0.0:
            return False
        force = -active.free[0] / reduced
        p1, p2 = g.n1 - mu * (g.t11 * d1 + g.t12 * d2), g.n2 - mu * (g.t12 * d1 + g.t22 * d2)
        a1, a2 = active.free[1] + force * p1, active.free[2] + force * p2
        across, along = a1 * d2 - a2 * d1, a1 * d1 + a2 * d2
        if abs(across) <= EXACT * max(ws.problem.acceleration_scale, abs(a1), abs(a2)):
            if not along > 0.0 or not force > 0.0:
                return False
            active.normal_force, active.direction = force, (d1, d2)
            ws.problem.is_deficient, active.has_redundant_force = False, False
            friction_of_slip(ws, 0)
            return True
        # what turning the direction does to the normal force, and to the acceleration
        change = mu * force * (g.n2 * d1 - g.n1 * d2) / reduced
        c1 = change * p1 - mu * force * (g.t12 * d1 - g.t11 * d2)
        c2 = change * p2 - mu * force * (g.t22 * d1 - g.t12 * d2)
        turn = -across / (c1 * d2 - c2 * d1 + along)
        d1, d2 = d1 - turn * d2, d2 + turn * d1
        size = length((d1, d2))
        d1, d2 = d1 / size, d2 / size
    return False


@kernel()
def _note(ws: Workspace) -> None:
    """Add what the forces do to ``du``, and note power and what is held."""
    add_response(ws, ws.problem.forces.start, ws.island.du.start)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        slides = contact.mode == Mode.SLIDE
        if slides and reduced_coefficient(ws, a) <= 0.0:
            ws.island.singular_contact = c
        active.sticks = not (slides)
        for r in range(3):
            ws.step.driven_power += active.force[r] * (row(ws, c, r, ws.island.velocities) - contact.rate[r])
        if slides and active.mode_tried == Mode.STICK:
            # whatever the state from which it was found has of it
            contact.slip = 0.0, 0.0


@kernel("b1(ws)")
def _solve(ws: Workspace) -> bool:
    """Find the ``active_forces`` with which a stage ends, as the contacts face; return 1 if they are found."""
    ws.problem.acceleration_scale = 0.0
    for a in range(ws.problem.n_active):
        evaluate_contact(ws, ws.actives[a].contact, 3)
    assemble_delassus(ws)
    for a in range(ws.problem.n_active):
        _lay(ws, a)
    if not ws.problem.acceleration_scale > 0.0:
        # a trial step far too long led to what is no number
        return False
    return True if _oppose_alone(ws) else oppose_slips(ws)


@kernel("i8(ws)")
def _face(ws: Workspace) -> int:
    """Let slips that are held face against what holds them; return how many had another bound than it seemed."""
    turned = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if ws.contacts[active.contact].mode == Mode.SLIDE and active.mode_tried == Mode.STICK:
            turned += turn_facing(ws, active.contact, active.force[1])
    return turned


@kernel()
def hold_at_end(ws: Workspace) -> None:
    """Write the ``active_forces`` of the active contacts with which a stage ends, and add what they do to ``du``.

    Geometry and rates are those of the state that the accelerations at ``guess`` lead to.  Where no forces are found
    ``unsettled`` is raised.
    """
    settled = False
    for _facing in range(1 + ws.problem.n_active):
        if not _solve(ws):
            break
        if _face(ws) == 0:
            settled = True
            break
    if not settled:
        ws.problem.is_unsettled = True
    _note(ws)
