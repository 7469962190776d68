"""Slip as an unknown of the contact problem, in the stages of an implicit step.

In an implicit step, the slip at the end of a stage is v = v0 + tau a_t: tau is the time of the stage, a_t the slip
acceleration, and v0 the slip at the end without it. Coulomb's friction opposes v, or keeps it at zero. Divided by tau,
this is the problem of a slip that begins, Eq. (17), with v0 / tau added to the acceleration without contact forces. So
slips that stop, turn or start within a step need no event. An explicit step would have to follow the direction of a
slip as it turns, which takes very small steps if the slip is slow.

The modes are found by exchange: a slip whose friction would reverse it sticks, and a contact whose friction exceeds its
bound slides against this friction. The directions of the slips are made exact after each exchange
(:mod:`nonsmooth.engine.contact.slip_directions`).
"""

from __future__ import annotations

from nonsmooth.engine.bodies.anisotropy import turn_facing
from nonsmooth.engine.bodies.kinematics import evaluate_contact, row, row_size
from nonsmooth.engine.contact.distribution import distribute
from nonsmooth.engine.contact.forces import friction_of_slip, reduced_coefficient
from nonsmooth.engine.contact.null_space_forces import shift_forces
from nonsmooth.engine.contact.problem import friction_coefficient, slip_coefficient
from nonsmooth.engine.contact.slip_directions import EXACT, find_slip_directions, has_slip_that_begins
from nonsmooth.engine.contact.trial import find_tried_forces
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus, diagonal_block, slip_acceleration
from nonsmooth.engine.memory.layout import FIRST_ROW, NORMAL_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, kernel
from nonsmooth.engine.numerics.arrays import largest_size
from nonsmooth.engine.numerics.vectors import length, unit

_ROUND_OFF = 1e-13
"""Excess of friction over its bound, relative to the largest force, that is round-off."""
_DISTRIBUTED = 1e-10
"""Distance of redundant forces to their cones, relative to the largest force, that counts as zero."""
_NEWTON_STEPS = 8
"""Maximum number of Newton steps for a slip that is alone. From the last direction, three or four suffice."""


@kernel()
def add_forces_at_stage_end(ws: Workspace) -> None:
    """Find the forces of the active contacts at the end of an implicit stage [N], and add their responses to ``du``.

    The state is the one to which the accelerations at ``guess`` lead. If no forces are found, ``is_unsettled`` is set,
    and the caller rejects the step.
    """
    is_unsettled = True
    # each round but the last turns a facing (the side from which anisotropic friction is opposed, which sets its bound)
    for _ in range(1 + ws.problem.n_active):
        if not _find_forces(ws):
            break
        is_unsettled = _turn_facings(ws)
        if not is_unsettled:
            break
    # another island of this stage may have set it
    ws.problem.is_unsettled = ws.problem.is_unsettled or is_unsettled
    # of an unsettled island, whatever the forces are: nothing of the step is kept
    _add_forces(ws)


@kernel("b1(ws)")
def _find_forces(ws: Workspace) -> bool:
    """Find the forces at the end of a stage [N], for the present facing of anisotropic friction. True if found.

    The facing is the side from which friction is opposed, which sets its bound. Evaluates the contacts at the state of
    the end.
    """
    # `_write_contact` makes it the largest acceleration
    ws.problem.acceleration_scale = 0.0
    for active in ws.actives:
        evaluate_contact(ws, active.contact, rows=3)
    assemble_delassus(ws)
    for active in ws.actives:
        _write_contact(ws, active)
    if not ws.problem.acceleration_scale > 0.0:
        # all are zero, or a trial step that is far too long has led to numbers that are not finite
        return False
    # a single slip has one unknown; all other islands, and a slip that friction stops, need the exchange of modes
    return _solve_lone_slip(ws) or oppose_slips(ws)


@kernel("void(ws, ActiveContact)")
def _write_contact(ws: Workspace, active: ActiveContact) -> None:
    """Write the free acceleration b of a contact [m/s^2], its friction coefficient, mode and slip direction.

    If the contact slides, the tangential parts of b include v0 / tau: v0 is the slip at the end of the stage without
    its slip acceleration, tau the time of the stage. So b + G f is the slip at the end over tau.
    """
    c = active.contact
    contact = ws.contacts[c]
    # power of a friction moment: only traction laws have one
    contact.dissipated_by_spin = 0.0
    # a contact that sticks has its static coefficient, that at speed 0
    if contact.mode == Mode.SLIDE:
        active.friction_coefficient = slip_coefficient(ws, c, length(contact.slip))
    else:
        active.friction_coefficient = friction_coefficient(ws, c, speed=0.0)
    # friction may stop a slip within its kinetic bound; a contact that sticks has the static one
    active.static_coefficient = active.friction_coefficient
    active.mode_tried = active.mode_past = contact.mode
    active.has_given_force = False
    # friction may stop the slip, so its direction is found as that of a slip that begins; without friction none stops
    active.is_at_rest = active.friction_coefficient > 0.0
    active.direction = contact.direction
    for r in range(3):
        free = row(ws, c, r, ws.island.du.start)
        active.free[r] = free + contact.bias[r]
        if r != NORMAL_ROW and contact.mode == Mode.SLIDE:
            # the rate at the end holds the guessed acceleration, which is subtracted again
            active.free[r] = free + contact.rate[r] / ws.problem.stage_time - row(ws, c, r, ws.problem.guess)
        size = max(abs(contact.bias[r]), row_size(ws, c, r, ws.island.du.start))
        ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, size)


# --- any number of contacts -------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def oppose_slips(ws: Workspace) -> bool:
    """Find forces whose friction opposes the slips at the end of a stage, or stops them [N]. True if they are found.

    Before: the free accelerations b hold the slips v0 / tau without contact forces. A slip has ``mode_past`` SLIDE, and
    ``is_at_rest``, which here means that friction may stop it. If Newton's method finds no directions, all such
    contacts stick once, and slip directions follow from the friction that exceeds its bound. False if it fails again,
    or if the exchange of modes does not end.
    """
    has_restarted = False
    # enough for each contact to stop and be released; exchanges that cycle end here
    for _ in range(2 * (2 + ws.problem.n_active)):
        is_exact = find_slip_directions(ws)
        if not is_exact:
            if has_restarted:
                return False
            has_restarted = True
            for active in ws.actives:
                active.mode_tried = Mode.STICK if active.is_at_rest else active.mode_past
        # without slips no forces were found; redundant ones need a list of unknowns without turns
        if not is_exact or not has_slip_that_begins(ws) or ws.problem.is_deficient:
            find_tried_forces(ws)
        if not _exchange_modes(ws):
            return True
    return False


@kernel("b1(ws)")
def _exchange_modes(ws: Workspace) -> bool:
    """Stop the slips that friction would reverse, and release those that it cannot stop. True if a mode changes.

    Redundant forces are distributed anew before, because their friction decides.
    """
    largest = largest_size(ws.floats, ws.problem.forces.start, 3 * ws.problem.n_active)
    excess = _ROUND_OFF * largest
    if ws.problem.is_deficient:
        # the null-space forces chosen for the motion; in an impact they are zero
        shift_forces(ws)
    if ws.problem.is_deficient and _has_stopped_slip(ws):
        # redundant friction may exceed one bound although other contacts could take the load. Forces that count as
        # distributed may exceed their bound by half of the excess allowed here. If none are within all bounds, those
        # that come closest decide
        excess = 2.0 * _DISTRIBUTED * largest
        distribute(ws, inset=0.0, allowed=_DISTRIBUTED * largest)
        for active in ws.actives:
            if active.mode_tried == Mode.SLIDE:
                friction_of_slip(ws, active.index)
    has_changed = False
    for active in ws.actives:
        # contacts that stuck before the step stay so: events release them
        if active.mode_past == Mode.SLIDE and active.is_at_rest:
            has_changed = _exchange_mode(ws, active, excess) or has_changed
    return has_changed


@kernel("b1(ws)")
def _has_stopped_slip(ws: Workspace) -> bool:
    """True if friction stops a contact that slid before, by the modes under trial."""
    for active in ws.actives:
        if active.mode_past == Mode.SLIDE and active.mode_tried == Mode.STICK:
            return True
    return False


@kernel("b1(ws, ActiveContact, f8)")
def _exchange_mode(ws: Workspace, active: ActiveContact, allowed_excess: float) -> bool:
    """Stop or release the slip of one contact. True if its mode changes.

    Friction may exceed its bound by ``allowed_excess`` [N] before the slip is released.
    """
    if active.mode_tried == Mode.STICK:
        t1, t2 = active.friction
        if not length(active.friction) > active.friction_coefficient * active.normal_force + allowed_excess:
            return False
        # the slip begins against the friction
        active.mode_tried, active.direction = Mode.SLIDE, unit((-t1, -t2))
        return True
    a1, a2 = slip_acceleration(ws, active)
    # the slip at the end points along its direction: friction does not reverse it
    if not a1 * active.direction[0] + a2 * active.direction[1] < 0.0:
        return False
    active.mode_tried = Mode.STICK
    return True


# --- a single contact -------------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def _solve_lone_slip(ws: Workspace) -> bool:
    """Find the force of an island of one contact that continues to slide to the end of a stage [N].

    False if the island is another one, or if no force is found, as when friction stops the slip. The only unknown is
    the direction d. Newton's method is applied to the acceleration across d, without matrices.
    """
    active = ws.actives[0]
    g = diagonal_block(ws, active.index)
    if ws.problem.n_active > 1 or active.mode_past != Mode.SLIDE or not active.is_at_rest or active.has_given_force:
        return False
    mu, (d1, d2) = active.friction_coefficient, active.direction
    for _ in range(_NEWTON_STEPS):
        # normal acceleration per unit of normal force, friction included
        reduced = g.nn - mu * (g.n1 * d1 + g.n2 * d2)
        if not reduced > 0.0:
            return False
        force = -active.free[0] / reduced
        # slip acceleration per unit of normal force, friction included
        p1, p2 = g.n1 - mu * (g.t11 * d1 + g.t12 * d2), g.n2 - mu * (g.t12 * d1 + g.t22 * d2)
        a1, a2 = active.free[1] + force * p1, active.free[2] + force * p2
        across, along = a1 * d2 - a2 * d1, a1 * d1 + a2 * d2
        if abs(across) <= EXACT * max(ws.problem.acceleration_scale, abs(a1), abs(a2)):
            # the slip would reverse, or the contact separate: other methods decide
            if not along > 0.0 or not force > 0.0:
                return False
            active.normal_force, active.direction = force, (d1, d2)
            ws.problem.is_deficient, active.has_redundant_force = False, False
            friction_of_slip(ws, active.index)
            return True
        # Newton's step: derivatives of normal force and slip acceleration with respect to the angle of d
        change = mu * force * (g.n2 * d1 - g.n1 * d2) / reduced
        c1 = change * p1 - mu * force * (g.t12 * d1 - g.t11 * d2)
        c2 = change * p2 - mu * force * (g.t22 * d1 - g.t12 * d2)
        turn = -across / (c1 * d2 - c2 * d1 + along)
        # a rotation to first order; the length is restored
        d1, d2 = d1 - turn * d2, d2 + turn * d1
        size = length((d1, d2))
        d1, d2 = d1 / size, d2 / size
    return False


# --- the result of a stage --------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def _turn_facings(ws: Workspace) -> bool:
    """Set the facing of anisotropic friction: whether its force opposes slip along the law's axis or against it.

    The facing sets the bound, of a slip that friction stops and of one that goes on. The force along t1, the axis of
    the law, decides. A slip across the axis has either facing, with the same force. True if a bound changes by this,
    so that the forces must be found again.
    """
    has_turned = False
    for active in ws.actives:
        if ws.contacts[active.contact].mode != Mode.SLIDE or active.mode_tried == Mode.OPEN:
            continue
        along = active.force[FIRST_ROW]
        # the direction of a slip is known up to round-off
        if active.mode_tried == Mode.STICK or abs(along) > EXACT * length(active.friction):
            has_turned = turn_facing(ws, active.contact, along) or has_turned
    return has_turned


@kernel()
def _add_forces(ws: Workspace) -> None:
    """Add the responses to the forces to ``du``, and the power of driven bodies. Write which contacts stick.

    Slips that friction has stopped are set to zero. Contacts at Painleve's paradox (more force means more approach) are
    marked as singular: the control of the step then halves the step.
    """
    add_response(ws, ws.problem.forces.start, ws.island.du.start)
    for active in ws.actives:
        c = active.contact
        contact = ws.contacts[c]
        slides = contact.mode == Mode.SLIDE
        if slides and reduced_coefficient(ws, active.index) <= 0.0:
            ws.island.singular_contact = c
        # by the mode at the start of the step: a slip that stops within it is no event
        active.sticks = not slides
        for r in range(3):
            # of driven bodies: power on all coordinates, less power on the relative motion
            ws.step.driven_power += active.force[r] * (row(ws, c, r, ws.island.velocities) - contact.rate[r])
        if slides and active.mode_tried == Mode.STICK:
            # a stopped slip is exactly zero, and not what the guessed accelerations leave of it
            contact.slip = 0.0, 0.0
