"""Slip that is an unknown of the contact problem, where its direction turns too fast to be followed.

At the end of a stage of an implicit step the slip is v0 + tau a, a the acceleration that the forces give and v0 what
it would be without it.  Coulomb's friction opposes v0 + tau a, or holds it at zero: with v0 / tau added to the
accelerations without forces that is the problem of incipient slip, and stopping, creeping and breaking away are one.
"""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.kinematics import evaluate_contact, row
from nonsmooth.engine.contact.forces import reduced_coefficient
from nonsmooth.engine.contact.polish import polish
from nonsmooth.engine.contact.problem import friction_coefficient
from nonsmooth.engine.contact.trial import hold_tried
from nonsmooth.engine.delassus.delassus import add_product, add_response, assemble_delassus
from nonsmooth.engine.memory.modes import SLIDE, STICK
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, contact_at, kernel

_INCIPIENT = 1e-300


@kernel("void(S, F, I, i8)")
def _lay(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Write acceleration without forces, coefficients, mode and slip direction of active contact ``a``."""
    c = k[S.active + a]
    contact = contact_at(S, w, k, c)
    v1, v2 = contact.rate[1], contact.rate[2]
    speed = math.sqrt(v1 * v1 + v2 * v2)
    w[S.turned + c] = 0.0
    w[S.mu_static + a] = friction_coefficient(S, w, k, c, 0.0)
    w[S.mu + a] = friction_coefficient(S, w, k, c, max(speed, _INCIPIENT))
    k[S.mode_tried + a] = contact.mode
    k[S.at_rest + a] = 1 if w[S.mu + a] > 0.0 else 0
    for i in range(2):
        w[S.d + 2 * a + i] = contact.direction[i]
    for r in range(3):
        free = row(S, w, k, c, r, S.du)
        w[S.b + 3 * a + r] = free + contact.bias[r]
        if r > 0 and contact.mode == SLIDE:
            w[S.b + 3 * a + r] = free + contact.rate[r] / S.ahead - row(S, w, k, c, r, S.guess)
        S.acceleration_scale = max(S.acceleration_scale, abs(free), abs(contact.bias[r]))


@kernel("i8(S, F, I)")
def _stop_and_go(S: Scalars, w: Floats, k: Integers) -> int:
    """Hold the slips that friction would turn round, and let go those that it cannot hold; return how many."""
    changed = 0
    for a in range(S.n_active):
        if k[S.mode + k[S.active + a]] != SLIDE or k[S.at_rest + a] == 0:
            continue
        f, d = S.f + 3 * a, S.d + 2 * a
        if k[S.mode_tried + a] == STICK:
            t1, t2 = w[f + 1], w[f + 2]
            norm = math.sqrt(t1 * t1 + t2 * t2)
            if norm > w[S.mu + a] * w[f]:
                k[S.mode_tried + a] = SLIDE
                w[d], w[d + 1] = -t1 / norm, -t2 / norm
                changed += 1
            continue
        a1 = add_product(S, w, k, w[S.b + 3 * a + 1], a, 1, S.f)
        a2 = add_product(S, w, k, w[S.b + 3 * a + 2], a, 2, S.f)
        if a1 * w[d] + a2 * w[d + 1] < 0.0:
            k[S.mode_tried + a] = STICK
            changed += 1
    return changed


@kernel()
def _note(S: Scalars, w: Floats, k: Integers) -> None:
    """Add what the forces do to ``du``, and note power and what is held."""
    add_response(S, w, k, S.f, S.du)
    for a in range(S.n_active):
        c = k[S.active + a]
        contact = contact_at(S, w, k, c)
        slides = contact.mode == SLIDE
        if slides and reduced_coefficient(S, w, k, a) <= 0.0:
            S.singular = c
        k[S.tangent_held + a] = 0 if slides else 1
        for r in range(3):
            S.driven_power += w[S.f + 3 * a + r] * (row(S, w, k, c, r, S.own) - contact.rate[r])


@kernel()
def hold_at_end(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the forces ``f`` of the active contacts with which a stage ends, and add what they do to ``du``.

    Geometry and rates are those of the state that the accelerations at ``guess`` lead to.  Where no forces are found,
    or they are not unique, ``unsettled`` is raised.
    """
    S.acceleration_scale = 0.0
    for a in range(S.n_active):
        evaluate_contact(S, w, k, k[S.active + a], 3)
    assemble_delassus(S, w, k)
    for a in range(S.n_active):
        _lay(S, w, k, a)
    settled = 0
    for _round in range(2 + S.n_active):
        if polish(S, w, k) == 0:
            break
        hold_tried(S, w, k)
        if _stop_and_go(S, w, k) == 0:
            settled = 1
            break
    if settled == 0 or S.deficient == 1:
        S.unsettled = 1
    _note(S, w, k)
