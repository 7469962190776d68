"""Sustained contact at an instant: modes and forces that fulfil Eqs. (14)-(18), every answer verified.

The past modes are tried first, so that, of several solutions, the one continuous with the past is kept; then the
solvers of :mod:`nonsmooth.engine.memory.solvers`.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.articulations import constrain
from nonsmooth.engine.bodies.compliance import decouple_normals
from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.contact.search import find_modes
from nonsmooth.engine.contact.trial import verify
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import (
    AUTO,
    ENUMERATED_AT_LAST,
    ENUMERATION,
    GAUSS_SEIDEL,
    LEMKE,
    MOST_PIVOTED,
    NEWTON,
)
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    call_scalar,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.linear import multiply
from nonsmooth.engine.numerics.vectors import Pair, length

_INCIPIENT = 1e-300
"""The least speed of what slips: at speed 0 laws give the static limit."""


@kernel("f8(ws, i8, f8)")
def friction_coefficient(ws: Workspace, c: int, speed: float) -> float:
    """Return the friction coefficient of contact ``c``; speed 0 is the static limit."""
    contact = ws.contacts[c]
    return call_scalar(contact.friction_function, speed, at(ws.floats, contact.friction_parameters))


@kernel("f8(ws, i8, f8)")
def slip_coefficient(ws: Workspace, c: int, speed: float) -> float:
    """Return the friction coefficient of contact ``c`` as it slips; at speed 0 that of a slip that begins."""
    return friction_coefficient(ws, c, max(speed, _INCIPIENT))


@kernel("v2(ws, i8, v2, f8, b1)")
def slip_direction(ws: Workspace, c: int, slip: Pair, still: float, may_reverse: bool) -> Pair:
    """Return the direction of a slip of contact ``c``, continued smoothly through a reversal.

    If it ``may_reverse``, as within an implicit step of an impact, which stops slips itself, it is that of the slip. A
    slip no faster than ``still`` [m/s] has no direction of its own: that at the start of the step holds.
    """
    d1, d2 = ws.contacts[c].direction
    v1, v2 = slip
    speed = length(slip)
    if speed > still:
        inverse = (1.0 if may_reverse or v1 * d1 + v2 * d2 >= 0.0 else -1.0) / speed
        d1, d2 = inverse * v1, inverse * v2
    return d1, d2


@kernel("void(ws, i8, v2, f8, b1)")
def follow_slip(ws: Workspace, a: int, slip: Pair, still: float, may_reverse: bool) -> None:
    """Write the direction of a slip (:func:`slip_direction`) and its coefficient of the active contact ``a``."""
    active = ws.actives[a]
    active.direction = slip_direction(ws, active.contact, slip, still, may_reverse)
    active.friction_coefficient = slip_coefficient(ws, active.contact, length(slip))


@kernel("void(ws, i8)")
def accelerate_freely(ws: Workspace, number: int) -> None:
    """Write M^-1 h of one body to ``du``."""
    body = ws.bodies[number]
    n_u = body.n_u
    force = body.tail + body.n_q
    if not body.is_ballistic:
        multiply(ws.floats, force + n_u, n_u, force, ws.island.du.start + body.u)
        return
    if body.accelerated_version != body.version:
        multiply(ws.floats, force + n_u, n_u, force, ws.island.du_free.start + body.u)
        body.accelerated_version = body.version
    for i in range(body.u, body.u + n_u):
        ws.island.du[i] = ws.island.du_free[i]


@kernel("void(ws, b1)")
def free_acceleration(ws: Workspace, of_all_bodies: bool) -> None:
    """Write M^-1 h to ``du``, and what the joints leave of it, of every body (1), or of those that are integrated."""
    for i in range(ws.model.n_bodies if of_all_bodies else ws.island.n_integrated):
        accelerate_freely(ws, i if of_all_bodies else ws.island.integrated[i])
    if ws.model.n_joints > 0:
        for number in range(ws.model.n_articulations):
            if ws.articulations[number].n_rows > 0:
                constrain(ws, number)


@kernel()
def accelerate_touching(ws: Workspace) -> None:
    """Write the same of the bodies of contacts that touch, which is all that an instant asks for."""
    if ws.model.n_joints > 0:
        free_acceleration(ws, of_all_bodies=True)
        return
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.is_touching:
            accelerate_freely(ws, contact.body_a)
            accelerate_freely(ws, contact.body_b)


@kernel("void(ws, i8)")
def write_friction(ws: Workspace, a: int) -> None:
    """Write coefficients, slip direction and whether it is at rest of active contact ``a``."""
    active = ws.actives[a]
    c = active.contact
    contact = ws.contacts[c]
    v1, v2 = contact.slip
    speed = length(contact.slip)
    active.has_given_force = False
    active.static_coefficient = friction_coefficient(ws, c, 0.0)
    if speed > ws.tolerance.velocity:
        active.is_at_rest = False
        active.direction = v1 / speed, v2 / speed
        active.friction_coefficient = slip_coefficient(ws, c, speed)
    else:
        active.is_at_rest = True
        active.direction = contact.direction
        active.friction_coefficient = slip_coefficient(ws, c, 0.0)


@entry_point()
def set_up(ws: Workspace) -> None:
    """Write G and b of Eq. (18) and the friction data of the active contacts, kinematics and M^-1 h being known."""
    assemble_delassus(ws)
    ws.problem.acceleration_scale = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        for r in range(3):
            bias, free = contact.bias[r], row(ws, c, r, ws.island.du.start)
            active.free[r] = bias + free
            ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, abs(bias), abs(free))
        write_friction(ws, a)
    decouple_normals(ws)


@entry_point("b1(ws)")
def solve_contact(ws: Workspace) -> bool:
    """Find modes and forces of the active contacts, ``mode_tried`` holding the past modes; return 1 if found.

    The kinematics of the active contacts must be evaluated and :func:`set_up` called. A past mode may be unknown. On
    return ``mode_tried``, ``force`` and ``direction`` of the active contacts describe the solution.
    """
    ws.problem.effort = 0.0
    has_past_modes = True
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if not active.is_at_rest and active.mode_tried == Mode.STICK:
            active.mode_tried = Mode.SLIDE
        active.mode_past = active.mode_tried
        if active.mode_tried == Mode.UNKNOWN:
            has_past_modes = False
    if has_past_modes and verify(ws, is_lenient=False):
        return True
    if ws.options.solver != AUTO:
        return find_modes(ws, ws.options.solver)
    if find_modes(ws, NEWTON) or find_modes(ws, GAUSS_SEIDEL):
        return True
    if ws.problem.n_active <= MOST_PIVOTED and find_modes(ws, LEMKE):
        return True
    if ws.problem.n_active <= ENUMERATED_AT_LAST:
        return find_modes(ws, ENUMERATION)
    return False


@entry_point("b1(ws)")
def solve_from_rates(ws: Workspace) -> bool:
    """Solve on G and b as given, the friction following from the slip velocities in ``rate``; return 1 if solved."""
    for a in range(ws.problem.n_active):
        write_friction(ws, a)
    return solve_contact(ws)


@kernel()
def accelerate(ws: Workspace) -> None:
    """Add the accelerations that the contact forces give to ``du``; it holds those of given normal forces."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if ws.contacts[active.contact].is_compliant:
            active.normal_force = 0.0
    add_response(ws, ws.problem.forces.start, ws.island.du.start)
