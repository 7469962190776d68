"""Sustained contact at an instant: modes and forces that fulfil Eqs. (14)-(18), every answer verified.

The modes are tried in this order: the past ones (so that, of several solutions, the one continuous
with the past is kept), those found by Gauss-Seidel on the cone, and, for few contacts, all of them.
"""

from __future__ import annotations

import math

from nonsmooth.engine.cone import gauss_seidel
from nonsmooth.engine.delassus import add_response, assemble_delassus
from nonsmooth.engine.forces import evaluate_margins, resolve
from nonsmooth.engine.kernel import Floats, Integers, Scalars, at, call_scalar, kernel, room
from nonsmooth.engine.kinematics import row
from nonsmooth.engine.linkages import constrain
from nonsmooth.engine.modes import OPEN, SLIDE, STICK

_TOLERANCE = 1e-9
_INCIPIENT = 1e-300
_MOST_ENUMERATED = 5


@kernel("f8(S, F, I, i8, f8)")
def friction_coefficient(S: Scalars, w: Floats, k: Integers, c: int, speed: float) -> float:
    """Return the friction coefficient of contact ``c``; speed 0 is the static limit."""
    return call_scalar(k[S.friction_function + c], speed, at(w, k[S.friction_parameters + c]))


@kernel("void(S, F, I)")
def free_acceleration(S: Scalars, w: Floats, k: Integers) -> None:
    """Write M^-1 h of all bodies to ``du``, and what the joints leave of it."""
    for body in range(S.n_bodies):
        n_u = k[S.body_nu + body]
        force = k[S.body_tail + body] + k[S.body_nq + body]
        for i in range(n_u):
            total = 0.0
            for j in range(n_u):
                entry = w[force + n_u + i * n_u + j]
                if entry != 0.0:
                    total += entry * w[force + j]
            w[S.du + k[S.body_u + body] + i] = total
    if S.n_joints > 0:
        for linkage in range(S.n_linkages):
            if k[S.linkage_rows + linkage] > 0:
                constrain(S, w, k, linkage)


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


@kernel("void(S, F, I)")
def _hold(S: Scalars, w: Floats, k: Integers) -> None:
    """Translate the modes under trial into what is held."""
    for a in range(S.n_active):
        mode = k[S.mode_tried + a]
        k[S.normal_held + a] = 0 if mode == OPEN else 1
        k[S.tangent_held + a] = 1 if mode == STICK else 0
        if mode == OPEN:
            w[S.f + 3 * a] = 0.0


@kernel("i8(S, F, I)")
def _verified(S: Scalars, w: Floats, k: Integers) -> int:
    """Solve for the modes under trial; return 1 if the answer fulfils the laws themselves."""
    _hold(S, w, k)
    resolve(S, w, k)
    evaluate_margins(S, w, k)
    width = 3 * S.n_active
    # the accelerations that may cancel one another in b set the scale, not b itself
    scale = S.acceleration_scale
    force_scale = 0.0
    for i in range(width):
        force_scale = max(force_scale, abs(w[S.f + i]))
    for a in range(S.n_active):
        force_scale = max(force_scale, scale / w[S.delassus + 3 * a * width + 3 * a])
    for i in range(width):
        total = w[S.b + i]
        for j in range(width):
            total += w[S.delassus + i * width + j] * w[S.f + j]
            scale = max(scale, abs(w[S.delassus + i * width + j] * w[S.f + j]))
        w[S.acceleration + i] = total
    small, small_force = _TOLERANCE * scale, _TOLERANCE * force_scale
    for a in range(S.n_active):
        mode = k[S.mode_tried + a]
        normal = w[S.acceleration + 3 * a]
        if mode == OPEN:
            if not normal >= -small:
                return 0
            continue
        if not (w[S.f + 3 * a] >= -small_force and abs(normal) <= small):
            return 0
        a1, a2 = w[S.acceleration + 3 * a + 1], w[S.acceleration + 3 * a + 2]
        if mode == STICK:
            if not (w[S.margin + a] >= -small_force and abs(a1) + abs(a2) <= small):
                return 0
        elif k[S.at_rest + a] == 1:
            forward = a1 * w[S.d + 2 * a] + a2 * w[S.d + 2 * a + 1]
            across = a1 * w[S.d + 2 * a + 1] - a2 * w[S.d + 2 * a]
            if not (forward >= -small and abs(across) <= small):
                return 0
    return 1


@kernel("i8(S, F, I)")
def _enumerate(S: Scalars, w: Floats, k: Integers) -> int:
    """Try every combination of modes; return 1 at the first that is verified."""
    m = S.n_active
    if m > _MOST_ENUMERATED:
        return 0
    combinations = 1
    for _a in range(m):
        combinations *= 3
    for number in range(combinations):
        rest = number
        sensible = 1
        for a in range(m):
            choice = rest % 3
            rest //= 3
            mode = STICK if choice == 0 else (SLIDE if choice == 1 else OPEN)
            k[S.mode_tried + a] = mode
            if mode == STICK and k[S.at_rest + a] == 0:
                sensible = 0
        if sensible == 1 and _verified(S, w, k) == 1:
            return 1
    return 0


@kernel()
def _search(S: Scalars, w: Floats, k: Integers) -> None:
    """Find the modes by Gauss-Seidel from zero forces."""
    for a in range(S.n_active):
        k[S.normal_held + a] = 1
        k[S.tangent_held + a] = 0
        for i in range(3):
            w[S.f + 3 * a + i] = 0.0
    gauss_seidel(S, w, k)
    for a in range(S.n_active):
        if w[S.f + 3 * a] <= 0.0:
            k[S.mode_tried + a] = OPEN
        else:
            k[S.mode_tried + a] = STICK if k[S.tangent_held + a] == 1 else SLIDE


@kernel("i8(S, F, I)")
def _free_sliding(S: Scalars, w: Floats, k: Integers) -> int:
    """Mark the contacts at rest whose mode under trial is sliding; return how many they are."""
    freed = 0
    for a in range(S.n_active):
        k[S.freed + a] = 1 if k[S.at_rest + a] == 1 and k[S.mode_tried + a] == SLIDE else 0
        freed += k[S.freed + a]
    return freed


@kernel("i8(S, F, I)")
def _search_freed(S: Scalars, w: Floats, k: Integers) -> int:
    """Find the modes while the marked contacts may not stick; return 1 if they are verified."""
    for a in range(S.n_active):
        w[S.mu_kept + a] = w[S.mu_static + a]
        if k[S.freed + a] == 1:
            w[S.mu_static + a] = 0.0
    _search(S, w, k)
    for a in range(S.n_active):
        w[S.mu_static + a] = w[S.mu_kept + a]
    return _verified(S, w, k)


@room("i8(S, F, I)")
def solve_contact(S: Scalars, w: Floats, k: Integers) -> int:
    """Find modes and forces of the active contacts, ``mode_tried`` holding the past modes; return 1 if found.

    The kinematics of the active contacts must be evaluated and :func:`set_up` called.  On return
    ``mode_tried``, ``f`` and ``d`` describe the solution.
    """
    S.painleve = 0
    for a in range(S.n_active):
        if k[S.at_rest + a] == 0 and k[S.mode_tried + a] == STICK:
            k[S.mode_tried + a] = SLIDE
    if _verified(S, w, k) == 1:
        return 1
    # where a contact has just broken away it must not stick again at the higher static bound
    if _free_sliding(S, w, k) > 0 and _search_freed(S, w, k) == 1:
        return 1
    _search(S, w, k)
    if _verified(S, w, k) == 1:
        return 1
    # between the static and the kinetic bound the sweeps may alternate: who cannot stick is found first
    for a in range(S.n_active):
        w[S.mu_kept + a] = w[S.mu + a]
        if k[S.at_rest + a] == 1:
            w[S.mu + a] = w[S.mu_static + a]
    _search(S, w, k)
    for a in range(S.n_active):
        w[S.mu + a] = w[S.mu_kept + a]
    if _free_sliding(S, w, k) > 0 and _search_freed(S, w, k) == 1:
        return 1
    return _enumerate(S, w, k)


@kernel("void(S, F, I)")
def accelerate(S: Scalars, w: Floats, k: Integers) -> None:
    """Add the accelerations that the contact forces give to ``du``."""
    add_response(S, w, k, S.f, S.du)
