"""Contact at an instant: modes and forces of closed contacts that fulfil Eqs. (14)-(18).

The accelerations of the contacts are a = b + G f, with the laws of :mod:`nonsmooth.engine.contact.trial`. With friction
there may be several solutions. So the past modes are tried first: the solution that continues the past is kept. This is
also the cheapest trial, because modes rarely change. Only then do the solvers search
(:mod:`nonsmooth.engine.memory.solvers` explains their order), and every answer is verified.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.articulations import constrain
from nonsmooth.engine.bodies.compliance import decouple_normals
from nonsmooth.engine.bodies.kinematics import row, row_size
from nonsmooth.engine.contact.search import find_modes
from nonsmooth.engine.contact.trial import verify
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import ENUMERATED_AT_LAST, MOST_PIVOTED, Solver
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, at, call_scalar, entry_point, kernel
from nonsmooth.engine.numerics.arrays import copy_numbers
from nonsmooth.engine.numerics.linear import multiply
from nonsmooth.engine.numerics.vectors import Pair, length, unit

_LEAST_SLIP_SPEED = 1e-300
"""Smallest speed of a slip at which a friction law is evaluated [m/s]. At speed 0 it gives the static coefficient."""


# --- friction ---------------------------------------------------------------------------------------------------------


@kernel("f8(ws, i8, f8)")
def friction_coefficient(ws: Workspace, c: int, speed: float) -> float:
    """Friction coefficient of contact ``c`` at a slip ``speed`` [m/s]. At speed 0 it is the static one."""
    contact = ws.contacts[c]
    return call_scalar(contact.friction_function, speed, at(ws.floats, contact.friction_parameters))


@kernel("f8(ws, i8, f8)")
def slip_coefficient(ws: Workspace, c: int, speed: float) -> float:
    """Friction coefficient of contact ``c`` that slides at ``speed`` [m/s]: at speed 0, of a slip that begins."""
    # at speed 0 the law would give the static coefficient
    return friction_coefficient(ws, c, max(speed, _LEAST_SLIP_SPEED))


@kernel("v2(ws, i8, v2, f8, b1)")
def slip_direction(ws: Workspace, c: int, slip: Pair, rest_speed: float, may_reverse: bool) -> Pair:
    """Unit direction of the ``slip`` [m/s] of contact ``c``, with the sign of the direction at the start of the step.

    So the friction stays smooth if a slip reverses within a step, and the event of the reversal can be located. If
    ``may_reverse``, as in an implicit step, which stops slips itself, the sign is that of the slip. A slip up to
    ``rest_speed`` [m/s] counts as rest: the direction at the start of the step is returned.
    """
    (d1, d2), (v1, v2) = ws.contacts[c].direction, slip
    speed = length(slip)
    if not speed > rest_speed:
        return d1, d2
    inverse = (1.0 if may_reverse or v1 * d1 + v2 * d2 >= 0.0 else -1.0) / speed
    return inverse * v1, inverse * v2


@kernel("void(ws, i8, v2, f8, b1)")
def follow_slip(ws: Workspace, a: int, slip: Pair, rest_speed: float, may_reverse: bool) -> None:
    """Set direction and coefficient of the friction of active contact ``a`` for its ``slip`` [m/s].

    ``rest_speed`` and ``may_reverse`` are those of :func:`slip_direction`.
    """
    active = ws.actives[a]
    active.direction = slip_direction(ws, active.contact, slip, rest_speed, may_reverse)
    active.friction_coefficient = slip_coefficient(ws, active.contact, length(slip))


@kernel("void(ws, ActiveContact)")
def write_friction(ws: Workspace, active: ActiveContact) -> None:
    """Write the friction of an active contact from its slip: coefficients, direction, and whether it is at rest.

    It is at rest if its slip is within the velocity tolerance. Its normal force counts as not given by a law.
    """
    contact = ws.contacts[active.contact]
    speed = length(contact.slip)
    # only impacts give normal forces; `decouple_normals` makes those of compliant contacts known
    active.has_given_force = False
    active.static_coefficient = friction_coefficient(ws, active.contact, speed=0.0)
    active.is_at_rest = not speed > ws.tolerance.velocity
    if active.is_at_rest:
        # the slip may begin: its last direction is the first guess
        active.direction = contact.direction
        active.friction_coefficient = slip_coefficient(ws, active.contact, speed=0.0)
    else:
        active.direction = unit(contact.slip)
        active.friction_coefficient = slip_coefficient(ws, active.contact, speed)


# --- accelerations without contact forces -----------------------------------------------------------------------------


@kernel("void(ws, i8)")
def accelerate_freely(ws: Workspace, number: int) -> None:
    """Write the accelerations M^-1 h of body ``number`` without contact forces to ``du``. h are its other forces.

    Those of a body in ballistic motion (in closed form) are stored, and computed again only after its state has
    changed: ``version`` counts the evaluations of a body.
    """
    body = ws.bodies[number]
    n_u, du, du_free = body.n_u, ws.island.du.start + body.u, ws.island.du_free.start + body.u
    # the results of the body's law: rates of q, then the forces h, then the inverse mass matrix
    force = body.tail + body.n_q
    inverse_mass = force + n_u
    if not body.is_ballistic:
        multiply(ws.floats, inverse_mass, n_u, force, du)
        return
    if body.accelerated_version != body.version:
        multiply(ws.floats, inverse_mass, n_u, force, du_free)
        body.accelerated_version = body.version
    copy_numbers(ws.floats, du_free, n_u, du)


@kernel("void(ws, b1)")
def free_acceleration(ws: Workspace, of_all_bodies: bool) -> None:
    """Write the accelerations without contact forces to ``du``, those of the joints included.

    These are the accelerations of all bodies, or else of the bodies that are integrated. Others have a motion in closed
    form, or a step of their own.
    """
    for i in range(ws.model.n_bodies if of_all_bodies else ws.island.n_integrated):
        accelerate_freely(ws, i if of_all_bodies else ws.island.integrated[i])
    if ws.model.n_joints > 0:
        for number in range(ws.model.n_articulations):
            # only joints have rows; their forces change the accelerations
            if ws.articulations[number].n_rows > 0:
                constrain(ws, number)


@kernel()
def accelerate_touching(ws: Workspace) -> None:
    """Write the accelerations without contact forces to ``du``, of the bodies of touching contacts at least.

    An event needs no others. With joints, all bodies are evaluated, because joints pass accelerations on.
    """
    if ws.model.n_joints > 0:
        free_acceleration(ws, of_all_bodies=True)
        return
    for contact in ws.contacts:
        if contact.is_touching:
            accelerate_freely(ws, contact.body_a)
            accelerate_freely(ws, contact.body_b)


# --- the problem ------------------------------------------------------------------------------------------------------


@entry_point()
def write_contact_problem(ws: Workspace) -> None:
    """Write Delassus matrix G, free accelerations b of Eq. (18), and friction of the active contacts.

    Their kinematics must be evaluated, and ``du`` must hold the accelerations without contact forces.
    """
    assemble_delassus(ws)
    # at least one that changes a velocity by its tolerance in the largest step: far smaller ones count as zero
    ws.problem.acceleration_scale = ws.tolerance.velocity / ws.tolerance.largest_step
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        for r in range(3):
            # bias: the acceleration at constant velocities of the bodies
            bias, free = contact.bias[r], row(ws, active.contact, r, ws.island.du.start)
            active.free[r] = bias + free
            # of the parts and not of their sum, which may cancel and leave their round-off
            size = max(abs(bias), row_size(ws, active.contact, r, ws.island.du.start))
            ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, size)
        write_friction(ws, active)
    # the normal forces of compliant contacts are known
    decouple_normals(ws)


@entry_point("b1(ws)")
def solve_contact(ws: Workspace) -> bool:
    """Find modes and forces of the active contacts. True if they are found.

    Before: :func:`write_contact_problem` has been called, and ``mode_tried`` holds the past modes, of which some may be
    unknown: then no past is tried. After: ``mode_tried``, ``force`` and ``direction`` describe the solution; if False,
    they are those of the last attempt.
    """
    ws.problem.effort = 0.0
    has_past = True
    for active in ws.actives:
        # a contact that slips cannot stick
        if not active.is_at_rest and active.mode_tried == Mode.STICK:
            active.mode_tried = Mode.SLIDE
        active.mode_past = active.mode_tried
        if active.mode_tried == Mode.UNKNOWN:
            has_past = False
    # of several solutions, the one that continues the past is taken
    if has_past and verify(ws, is_lenient=False):
        return True
    if ws.options.solver != Solver.AUTO:
        return find_modes(ws, ws.options.solver)
    # the fastest solver first; the last two are for few contacts only
    if find_modes(ws, Solver.NEWTON) or find_modes(ws, Solver.GAUSS_SEIDEL):
        return True
    if ws.problem.n_active <= MOST_PIVOTED and find_modes(ws, Solver.LEMKE):
        return True
    return ws.problem.n_active <= ENUMERATED_AT_LAST and find_modes(ws, Solver.ENUMERATION)


@entry_point("b1(ws)")
def solve_from_rates(ws: Workspace) -> bool:
    """Find modes and forces of a contact problem that the user gives by matrices. True if they are found.

    Before: the Delassus matrix G, the free accelerations b, their scale and the slip velocities are written.
    """
    # the user gives the slip velocities, which `rate` holds
    for active in ws.actives:
        write_friction(ws, active)
    return solve_contact(ws)


@kernel()
def accelerate(ws: Workspace) -> None:
    """Add the response of the bodies to the contact forces to ``du``. Normal forces of compliant contacts become zero.

    The response to these forces is in ``du`` already, so it must not be added again.
    """
    for active in ws.actives:
        if ws.contacts[active.contact].is_compliant:
            active.normal_force = 0.0
    add_response(ws, ws.problem.forces.start, ws.island.du.start)
