"""Friction inside an impact: who sticks, who slips, and which way a slip starts."""

from __future__ import annotations

import math

from nonsmooth.engine.contact.cone import SWEEPS, gauss_seidel
from nonsmooth.engine.contact.forces import resolve
from nonsmooth.engine.contact.problem import friction_coefficient
from nonsmooth.engine.delassus.delassus import add_product, own_block
from nonsmooth.engine.impact.rates import (
    COMPRESSION,
    DEFORMATION,
    EXPANSION,
    HELD,
    IMPULSE,
    STRIDE,
    evaluate_impact_rates,
    normal_force,
)
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room

_IDLE = 1e-10
"""A slip that starts with less than this part of the largest acceleration does not."""


@kernel()
def _stop_slips(S: Scalars, w: Floats, k: Integers) -> None:
    """Bring the slip velocities of the contacts at rest to exactly zero, by the impulses of least norm.

    What is left there is round-off, but its direction would stiffen the slip that starts from it.
    """
    for a in range(S.n_active):
        k[S.normal_held + a] = 0
        k[S.tangent_held + a] = k[S.at_rest + a]
        w[S.f + 3 * a] = w[S.mu + a] = 0.0
        for r in range(3):
            w[S.b + 3 * a + r] = w[S.impact_z + 3 * a + r]
    resolve(S, w, k)
    for a in range(S.n_active):
        for r in range(1, 3):
            w[S.impact_y + STRIDE * a + IMPULSE + r] += w[S.f + 3 * a + r]
    evaluate_impact_rates(S, w, k, S.impact_y)


@kernel("void(S, F, I)")
def _hold_idle(S: Scalars, w: Floats, k: Integers) -> None:
    """Let stick who was found on its bound but does not start to slip.

    Where several contacts share their friction at will, some stand on their bounds by chance.
    """
    largest = 0.0
    for a in range(S.n_active):
        largest = max(largest, w[own_block(S, k, a)] * w[S.f + 3 * a])
    for a in range(S.n_active):
        if k[S.at_rest + a] == 1 and k[S.tangent_held + a] == 0 and w[S.mu_static + a] > 0.0:
            v1, v2 = add_product(S, w, k, 0.0, a, 1, S.f), add_product(S, w, k, 0.0, a, 2, S.f)
            if math.sqrt(v1 * v1 + v2 * v2) <= _IDLE * largest:
                k[S.tangent_held + a] = 1


@room("void(S, F, I, f8)")
def choose_friction(S: Scalars, w: Floats, k: Integers, probe: float) -> None:
    """Decide which contacts at rest stick and which way the others start to slide.

    ``probe`` is the pseudo-time after which forces are compared where none has built up yet.
    """
    evaluate_impact_rates(S, w, k, S.impact_y)
    open_question = 0
    for a in range(S.n_active):
        v1, v2 = w[S.impact_z + 3 * a + 1], w[S.impact_z + 3 * a + 2]
        speed = math.sqrt(v1 * v1 + v2 * v2)
        w[S.mu_static + a] = friction_coefficient(S, w, k, k[S.active + a], 0.0)
        slow = speed <= w[S.rest_slip + a] or k[S.tangent_held + a] == 1
        # without friction nothing can stop a slip, however slow
        k[S.at_rest + a] = 1 if slow and (w[S.mu_static + a] > 0.0 or speed == 0.0) else 0
        open_question = max(open_question, k[S.at_rest + a])
    if open_question == 1:
        _stop_slips(S, w, k)
    for a in range(S.n_active):
        c = k[S.active + a]
        v1, v2 = w[S.impact_z + 3 * a + 1], w[S.impact_z + 3 * a + 2]
        speed = math.sqrt(v1 * v1 + v2 * v2)
        if speed == 0.0:
            # stopping the slips of others has stopped this one, too
            k[S.at_rest + a] = 1
        k[S.normal_held + a] = 1 if k[S.phase + a] == HELD else 0
        k[S.tangent_held + a] = 0
        x = w[S.impact_y + STRIDE * a + DEFORMATION]
        w[S.f + 3 * a] = 0.0
        if k[S.phase + a] == COMPRESSION or k[S.phase + a] == EXPANSION:
            x = max(x, -probe * w[S.impact_z + 3 * a])
            w[S.f + 3 * a] = normal_force(S, w, k, a, x)
        if k[S.at_rest + a] == 0:
            w[S.d + 2 * a], w[S.d + 2 * a + 1] = v1 / speed, v2 / speed
        else:
            w[S.d + 2 * a], w[S.d + 2 * a + 1] = w[S.direction + 2 * c], w[S.direction + 2 * c + 1]
        w[S.mu + a] = friction_coefficient(S, w, k, c, max(speed, 1e-300))
        for r in range(1, 3):
            w[S.f + 3 * a + r] = -w[S.mu + a] * w[S.f + 3 * a] * w[S.d + 2 * a + r - 1]
    if open_question == 1:
        for i in range(3 * S.n_active):
            w[S.b + i] = 0.0
        gauss_seidel(S, w, k, SWEEPS)
        _hold_idle(S, w, k)
    for a in range(S.n_active):
        c = k[S.active + a]
        if w[S.f + 3 * a] <= 0.0:
            k[S.tangent_held + a] = 0
        for i in range(2):
            w[S.direction + 2 * c + i] = w[S.d + 2 * a + i]


@kernel("void(S, F, I, i8)")
def break_away(S: Scalars, w: Floats, k: Integers, a: int) -> None:
    """Let the active contact ``a`` slip against the friction that held it."""
    c = k[S.active + a]
    t1, t2 = w[S.f + 3 * a + 1], w[S.f + 3 * a + 2]
    norm = math.sqrt(t1 * t1 + t2 * t2)
    k[S.tangent_held + a] = 0
    if norm > 0.0:
        w[S.direction + 2 * c], w[S.direction + 2 * c + 1] = -t1 / norm, -t2 / norm
