"""Sustained contact at an instant: modes and forces that fulfil Eqs. (14)-(18), every answer verified.

The past modes are tried first, so that, of several solutions, the one continuous with the past is kept; then the
solvers of :mod:`nonsmooth.engine.memory.solvers`.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.compliance import decouple_normals
from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.bodies.linkages import constrain
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
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, at, call_scalar, kernel, room

_INCIPIENT = 1e-300


@kernel("f8(S, F, I, i8, f8)")
def friction_coefficient(S: Scalars, w: Floats, k: Integers, c: int, speed: float) -> float:
    """Return the friction coefficient of contact ``c``; speed 0 is the static limit."""
    return call_scalar(k[S.friction_function + c], speed, at(w, k[S.friction_parameters + c]))


@kernel("void(S, F, I, i8, i8, f8)")
def follow_slip(S: Scalars, w: Floats, k: Integers, a: int, slip: int, still: float) -> None:
    """Write slip direction and coefficient of the active contact ``a``, continued smoothly through a reversal.

    Where its ``slip`` is no faster than ``still`` it has no direction of its own: that at the start of the step holds.
    """
    c = k[S.active + a]
    d1, d2 = w[S.direction + 2 * c], w[S.direction + 2 * c + 1]
    v1, v2 = w[slip], w[slip + 1]
    speed = math.sqrt(v1 * v1 + v2 * v2)
    if speed > still:
        inverse = (1.0 if v1 * d1 + v2 * d2 >= 0.0 else -1.0) / speed
        d1, d2 = inverse * v1, inverse * v2
    w[S.d + 2 * a], w[S.d + 2 * a + 1] = d1, d2
    w[S.mu + a] = friction_coefficient(S, w, k, c, max(speed, _INCIPIENT))


@kernel("void(S, F, I)")
def free_acceleration(S: Scalars, w: Floats, k: Integers) -> None:
    """Write M^-1 h of all bodies to ``du``, and what the joints leave of it."""
    for body in range(S.n_bodies):
        n_u = k[S.body_nu + body]
        force = k[S.body_tail + body] + k[S.body_nq + body]
        for i in range(n_u):
            total = 0.0
            for j in range(n_u):
                total += w[force + n_u + i * n_u + j] * w[force + j]
            w[S.du + k[S.body_u + body] + i] = total
    if S.n_joints > 0:
        for linkage in range(S.n_linkages):
            if k[S.linkage_rows + linkage] > 0:
                constrain(S, w, k, linkage)


@kernel("void(S, F, I, i8)")
def lay_friction(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Write coefficients, slip direction and whether it is at rest of active contact ``a``."""
    c = k[S.active + a]
    v1, v2 = w[S.rate + 3 * c + 1], w[S.rate + 3 * c + 2]
    speed = math.sqrt(v1 * v1 + v2 * v2)
    w[S.mu_static + a] = friction_coefficient(S, w, k, c, 0.0)
    if speed > S.velocity_tolerance:
        k[S.at_rest + a] = 0
        w[S.d + 2 * a] = v1 / speed
        w[S.d + 2 * a + 1] = v2 / speed
        w[S.mu + a] = friction_coefficient(S, w, k, c, speed)
    else:
        k[S.at_rest + a] = 1
        w[S.d + 2 * a] = w[S.direction + 2 * c]
        w[S.d + 2 * a + 1] = w[S.direction + 2 * c + 1]
        w[S.mu + a] = friction_coefficient(S, w, k, c, _INCIPIENT)


@room()
def set_up(S: Scalars, w: Floats, k: Integers) -> None:
    """Write G and b of Eq. (18) and the friction data of the active contacts, kinematics and M^-1 h being known."""
    assemble_delassus(S, w, k)
    S.acceleration_scale = 0.0
    for a in range(S.n_active):
        c = k[S.active + a]
        for r in range(3):
            bias, free = w[S.bias + 3 * c + r], row(S, w, k, c, r, S.du)
            w[S.b + 3 * a + r] = bias + free
            S.acceleration_scale = max(S.acceleration_scale, abs(bias), abs(free))
        lay_friction(S, w, k, a)
    decouple_normals(S, w, k)


@room("i8(S, F, I)")
def solve_contact(S: Scalars, w: Floats, k: Integers) -> int:
    """Find modes and forces of the active contacts, ``mode_tried`` holding the past modes; return 1 if found.

    The kinematics of the active contacts must be evaluated and :func:`set_up` called.  A past mode of -1 is none.  On
    return ``mode_tried``, ``f`` and ``d`` describe the solution.
    """
    S.effort = 0.0
    past = 1
    for a in range(S.n_active):
        if k[S.at_rest + a] == 0 and k[S.mode_tried + a] == STICK:
            k[S.mode_tried + a] = SLIDE
        k[S.mode_past + a] = k[S.mode_tried + a]
        if k[S.mode_tried + a] < 0:
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


@room("i8(S, F, I)")
def solve_from_rates(S: Scalars, w: Floats, k: Integers) -> int:
    """Solve on G and b as given, the friction following from the slip velocities in ``rate``; return 1 if solved."""
    for a in range(S.n_active):
        lay_friction(S, w, k, a)
    return solve_contact(S, w, k)


@kernel("void(S, F, I)")
def accelerate(S: Scalars, w: Floats, k: Integers) -> None:
    """Add the accelerations that the contact forces give to ``du``; it holds those of given normal forces."""
    for a in range(S.n_active):
        if k[S.normal_function + k[S.active + a]] != 0:
            w[S.f + 3 * a] = 0.0
    add_response(S, w, k, S.f, S.du)
