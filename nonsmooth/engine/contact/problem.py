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
from nonsmooth.engine.memory.modes import SLIDE, STICK
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
    Floats,
    Integers,
    Scalars,
    active_at,
    articulation_at,
    at,
    body_at,
    call_scalar,
    contact_at,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.linear import multiply
from nonsmooth.engine.numerics.vectors import Pair, length

_INCIPIENT = 1e-300
"""The least speed of what slips: at speed 0 laws give the static limit."""


@kernel("f8(S, F, I, i8, f8)")
def friction_coefficient(S: Scalars, w: Floats, k: Integers, c: int, speed: float) -> float:
    """Return the friction coefficient of contact ``c``; speed 0 is the static limit."""
    contact = contact_at(S, w, k, c)
    return call_scalar(contact.friction_function, speed, at(w, contact.friction_parameters))


@kernel("f8(S, F, I, i8, f8)")
def slip_coefficient(S: Scalars, w: Floats, k: Integers, c: int, speed: float) -> float:
    """Return the friction coefficient of contact ``c`` as it slips; at speed 0 that of a slip that begins."""
    return friction_coefficient(S, w, k, c, max(speed, _INCIPIENT))


@kernel("v2(S, F, I, i8, v2, f8)")
def slip_direction(S: Scalars, w: Floats, k: Integers, c: int, slip: Pair, still: float) -> Pair:
    """Return the direction of a slip of contact ``c``, continued smoothly through a reversal.

    Within an implicit step of an impact, which stops slips itself, it is that of the slip.  A slip no faster than
    ``still`` has no direction of its own: that at the start of the step holds.
    """
    d1, d2 = contact_at(S, w, k, c).direction
    v1, v2 = slip
    speed = length(slip)
    if speed > still:
        inverse = (1.0 if S.turning == 1 or v1 * d1 + v2 * d2 >= 0.0 else -1.0) / speed
        d1, d2 = inverse * v1, inverse * v2
    return d1, d2


@kernel("void(S, F, I, i8, v2, f8)")
def follow_slip(S: Scalars, w: Floats, k: Integers, a: int, slip: Pair, still: float) -> None:
    """Write the direction of a slip (:func:`slip_direction`) and its coefficient of the active contact ``a``."""
    active = active_at(S, w, k, a)
    active.direction = slip_direction(S, w, k, active.slot, slip, still)
    active.mu = slip_coefficient(S, w, k, active.slot, length(slip))


@kernel("void(S, F, I, i8)")
def accelerate_freely(S: Scalars, w: Floats, k: Integers, number: int) -> None:
    """Write M^-1 h of one body to ``du``."""
    body = body_at(S, w, k, number)
    n_u = body.nu
    force = body.tail + body.nq
    if body.flies == 0:
        multiply(w, force + n_u, n_u, force, S.du + body.u)
        return
    if body.accelerated != body.version:
        multiply(w, force + n_u, n_u, force, S.du_free + body.u)
        body.accelerated = body.version
    for i in range(body.u, body.u + n_u):
        w[S.du + i] = w[S.du_free + i]


@kernel("void(S, F, I, i8)")
def free_acceleration(S: Scalars, w: Floats, k: Integers, every: int) -> None:
    """Write M^-1 h to ``du``, and what the joints leave of it, of every body (1), or of those that are integrated."""
    for i in range(S.n_bodies if every == 1 else S.n_integrated):
        accelerate_freely(S, w, k, i if every == 1 else k[S.integrated + i])
    if S.n_joints > 0:
        for number in range(S.n_articulations):
            if articulation_at(S, w, k, number).rows > 0:
                constrain(S, w, k, number)


@kernel()
def accelerate_touching(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the same of the bodies of contacts that touch, which is all that an instant asks for."""
    if S.n_joints > 0:
        free_acceleration(S, w, k, 1)
        return
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        if contact.touching == 1:
            accelerate_freely(S, w, k, contact.body_a)
            accelerate_freely(S, w, k, contact.body_b)


@kernel("void(S, F, I, i8)")
def write_friction(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Write coefficients, slip direction and whether it is at rest of active contact ``a``."""
    active = active_at(S, w, k, a)
    c = active.slot
    contact = contact_at(S, w, k, c)
    v1, v2 = contact.slip
    speed = length(contact.slip)
    active.given = 0
    active.mu_static = friction_coefficient(S, w, k, c, 0.0)
    if speed > S.velocity_tolerance:
        active.at_rest = 0
        active.direction = v1 / speed, v2 / speed
        active.mu = slip_coefficient(S, w, k, c, speed)
    else:
        active.at_rest = 1
        active.direction = contact.direction
        active.mu = slip_coefficient(S, w, k, c, 0.0)


@entry_point()
def set_up(S: Scalars, w: Floats, k: Integers) -> None:
    """Write G and b of Eq. (18) and the friction data of the active contacts, kinematics and M^-1 h being known."""
    assemble_delassus(S, w, k)
    S.acceleration_scale = 0.0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        c = active.slot
        contact = contact_at(S, w, k, c)
        for r in range(3):
            bias, free = contact.bias[r], row(S, w, k, c, r, S.du)
            active.free[r] = bias + free
            S.acceleration_scale = max(S.acceleration_scale, abs(bias), abs(free))
        write_friction(S, w, k, a)
    decouple_normals(S, w, k)


@entry_point("i8(S, F, I)")
def solve_contact(S: Scalars, w: Floats, k: Integers) -> int:
    """Find modes and forces of the active contacts, ``mode_tried`` holding the past modes; return 1 if found.

    The kinematics of the active contacts must be evaluated and :func:`set_up` called.  A past mode of -1 is none.  On
    return ``mode_tried``, ``active_forces`` and ``active_directions`` describe the solution.
    """
    S.effort = 0.0
    past = 1
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        if active.at_rest == 0 and active.mode_tried == STICK:
            active.mode_tried = SLIDE
        active.mode_past = active.mode_tried
        if active.mode_tried < 0:
            past = 0
    if past == 1 and verify(S, w, k, 0) == 1:
        return 1
    if S.solver != AUTO:
        return find_modes(S, w, k, S.solver)
    if find_modes(S, w, k, NEWTON) == 1 or find_modes(S, w, k, GAUSS_SEIDEL) == 1:
        return 1
    if S.n_active <= MOST_PIVOTED and find_modes(S, w, k, LEMKE) == 1:
        return 1
    if S.n_active <= ENUMERATED_AT_LAST:
        return find_modes(S, w, k, ENUMERATION)
    return 0


@entry_point("i8(S, F, I)")
def solve_from_rates(S: Scalars, w: Floats, k: Integers) -> int:
    """Solve on G and b as given, the friction following from the slip velocities in ``rate``; return 1 if solved."""
    for a in range(S.n_active):
        write_friction(S, w, k, a)
    return solve_contact(S, w, k)


@kernel("void(S, F, I)")
def accelerate(S: Scalars, w: Floats, k: Integers) -> None:
    """Add the accelerations that the contact forces give to ``du``; it holds those of given normal forces."""
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        if contact_at(S, w, k, active.slot).normal_function != 0:
            active.normal_force = 0.0
    add_response(S, w, k, S.active_forces, S.du)
