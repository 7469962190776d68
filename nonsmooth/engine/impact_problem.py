"""The energetic multiple impact, Eqs. (19)-(28), integrated in pseudo-time with all of its events located.

Every phase has guards that are positive while it is valid; the first to become negative ends it:
compression (the gap rate turns positive), expansion (it turns negative again, or the stored energy is
spent), rest (the contact is pushed in), hold (its force would pull), slip (it comes to rest), stick
(the static bound).  The impact ends when every contact is idle or held.
"""

from __future__ import annotations

import math

from nonsmooth.engine.cone import gauss_seidel
from nonsmooth.engine.contact_problem import friction_coefficient
from nonsmooth.engine.forces import evaluate_margins, resolve
from nonsmooth.engine.impact_rates import (
    COMPRESSION,
    EXPANSION,
    HELD,
    IDLE,
    NOISE,
    REST,
    STRIDE,
    efficiency,
    evaluate_impact_forces,
    evaluate_impact_rates,
    impact_slope,
    normal_force,
    try_impact_step,
)
from nonsmooth.engine.kernel import at, call_scalar, kernel, room
from nonsmooth.engine.runge_kutta import dense_state, step_factor

FINISHED, ENDLESS, INVALID = 1, 2, 3
_MOST_STEPS = 100000
_UNUSED = 1e300
_TOGETHER = 1e-13
_WRONG = -1e-7
_AT_EVENT = 4.0 * NOISE
_SHORT = 1e-7


@kernel("f8(S, F, I)")
def _scale(S, w, k):
    """Set the scales of speed, deformation and force; return the shortest time of a compression."""
    m = S.n_active
    width = 3 * m
    S.speed_scale = S.impact_seed
    for a in range(m):
        S.speed_scale = max(S.speed_scale, -w[S.impact_z0 + 3 * a])
    shortest = _UNUSED
    for a in range(m):
        energy = S.speed_scale * S.speed_scale / w[S.delassus + 3 * a * width + 3 * a]
        x = 1.0
        w[S.impact_energy_scale + a] = energy
        if a != S.lone:
            c = k[S.active + a]
            for _iteration in range(4):
                force = call_scalar(k[S.force_function + c], x, at(w, k[S.force_parameters + c]))
                double = call_scalar(k[S.force_function + c], 2.0 * x, at(w, k[S.force_parameters + c]))
                if not (force > 0.0 and double > 0.0):
                    S.culprit = c
                    return -1.0
                x *= (energy / (force * x)) ** (math.log(2.0) / math.log(2.0 * double / force))
        w[S.impact_x_scale + a] = x
        w[S.impact_f_scale + a] = energy / x
        shortest = min(shortest, (energy if a == S.lone else x) / S.speed_scale)
    return shortest


@kernel()
def _stop_slips(S, w, k):
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
            w[S.impact_y + STRIDE * a + r] += w[S.f + 3 * a + r]
    evaluate_impact_rates(S, w, k, S.impact_y)


@kernel("void(S, F, I, f8)")
def _choose_friction(S, w, k, probe):
    """Decide which contacts at rest stick and which way the others start to slide.

    ``probe`` is the pseudo-time after which forces are compared where none has built up yet.
    """
    evaluate_impact_rates(S, w, k, S.impact_y)
    open_question = 0
    for a in range(S.n_active):
        v1, v2 = w[S.impact_z + 3 * a + 1], w[S.impact_z + 3 * a + 2]
        speed = math.sqrt(v1 * v1 + v2 * v2)
        k[S.at_rest + a] = 1 if speed <= REST * S.speed_scale or k[S.tangent_held + a] == 1 else 0
        open_question = max(open_question, k[S.at_rest + a])
    if open_question == 1:
        _stop_slips(S, w, k)
    for a in range(S.n_active):
        c = k[S.active + a]
        v1, v2 = w[S.impact_z + 3 * a + 1], w[S.impact_z + 3 * a + 2]
        speed = math.sqrt(v1 * v1 + v2 * v2)
        k[S.normal_held + a] = 1 if k[S.phase + a] == HELD else 0
        k[S.tangent_held + a] = 0
        w[S.mu_static + a] = friction_coefficient(S, w, k, c, 0.0)
        x = w[S.impact_y + STRIDE * a + 3]
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
        gauss_seidel(S, w, k)
    for a in range(S.n_active):
        c = k[S.active + a]
        if w[S.f + 3 * a] <= 0.0:
            k[S.tangent_held + a] = 0
        for i in range(2):
            w[S.direction + 2 * c + i] = w[S.d + 2 * a + i]


@kernel("void(S, F, I, i8)")
def _break_away(S, w, k, a):
    """Let the active contact ``a`` slip against the friction that held it."""
    c = k[S.active + a]
    t1, t2 = w[S.f + 3 * a + 1], w[S.f + 3 * a + 2]
    norm = math.sqrt(t1 * t1 + t2 * t2)
    k[S.tangent_held + a] = 0
    if norm > 0.0:
        w[S.direction + 2 * c], w[S.direction + 2 * c + 1] = -t1 / norm, -t2 / norm


@kernel("void(S, F, I, i8)")
def _evaluate_guards(S, w, k, y):
    """Evaluate the forces at the impact state ``y`` and write the guards."""
    evaluate_impact_forces(S, w, k, y)
    _write_guards(S, w, k, y)


@kernel("void(S, F, I, i8)")
def _write_guards(S, w, k, y):
    """Write the three guards of every active contact: rate, energy, friction; all of order 1."""
    evaluate_margins(S, w, k)
    for a in range(S.n_active):
        c = k[S.active + a]
        guard = S.impact_guard + 3 * a
        rate = w[S.impact_z + 3 * a] / S.speed_scale
        phase = k[S.phase + a]
        force_scale = 1.0 if a == S.lone else w[S.impact_f_scale + a]
        w[guard + 1] = 1.0
        if phase == COMPRESSION:
            w[guard] = NOISE - rate
        elif phase == HELD:
            w[guard] = NOISE + w[S.f + 3 * a] / force_scale
        else:
            w[guard] = NOISE + rate
        if phase == EXPANSION:
            w[guard + 1] = w[y + STRIDE * a + 3] / w[S.impact_x_scale + a]
            if a == S.lone:
                w[guard + 1] = w[y + STRIDE * a + 6] / w[S.impact_energy_scale + a]
        if phase == IDLE:
            w[guard + 2] = 1.0
        elif k[S.tangent_held + a] == 1:
            w[guard + 2] = NOISE + w[S.margin + a] / force_scale
        else:
            slip = (
                w[S.impact_z + 3 * a + 1] * w[S.direction + 2 * c]
                + w[S.impact_z + 3 * a + 2] * w[S.direction + 2 * c + 1]
            )
            w[guard + 2] = NOISE + slip / S.speed_scale


@kernel("i8(S, F, I, i8)")
def _fired(S, w, k, but):
    """Return the first guard that ends its phase, other than ``but``, or -1.

    A guard left slightly negative by a switch is not armed until it has been positive.
    """
    for i in range(3 * S.n_active):
        value = w[S.impact_guard + i]
        if i != but and ((value < 0.0 and k[S.armed + i] == 1) or value < _WRONG):
            return i
    return -1


@kernel()
def _arm(S, w, k):
    """Arm the guards that are positive now, where the next step starts."""
    for i in range(3 * S.n_active):
        w[S.impact_guard_first + i] = w[S.impact_guard + i]
        if w[S.impact_guard + i] > 0.0:
            k[S.armed + i] = 1


@kernel("void(S, F, I)")
def _prepare_guards(S, w, k):
    """Evaluate the guards where a phase begins and arm those that are positive."""
    for i in range(3 * S.n_active):
        k[S.armed + i] = 0
    _evaluate_guards(S, w, k, S.impact_y)
    _arm(S, w, k)


@kernel("f8(S, F, I, f8, f8, i8)")
def _guard_at(S, w, k, h, theta, i):
    dense_state(S, w, S.impact_y, S.impact_slopes, STRIDE * S.n_active, h, theta, S.impact_stage)
    _evaluate_guards(S, w, k, S.impact_stage)
    return w[S.impact_guard + i]


@kernel("f8(S, F, I, f8, f8, f8, i8)")
def _root(S, w, k, h, high, g_high, i):
    """Return the fraction of the step at which guard ``i`` vanishes on the interpolant (Anderson-Bjorck).

    The guards are left evaluated there, the slope of guard ``i`` in ``guard_slope``.
    """
    low, g_low = 0.0, w[S.impact_guard_first + i]
    if g_low <= 0.0:
        S.guard_slope = 0.0
        return 1e-3 * high
    theta = high
    for _iteration in range(60):
        S.guard_slope = (g_high - g_low) / ((high - low) * h)
        theta = high - g_high * (high - low) / (g_high - g_low)
        g = _guard_at(S, w, k, h, theta, i)
        if abs(g) <= 1e-13 or high - low <= 1e-14:
            return theta
        if g < 0.0:
            ratio = 1.0 - g / g_high
            g_low *= ratio if ratio > 0.0 else 0.5
            high, g_high = theta, g
        else:
            ratio = 1.0 - g / g_low
            g_high *= ratio if ratio > 0.0 else 0.5
            low, g_low = theta, g
    return theta


@kernel("f8(S, F, I, f8)")
def _locate(S, w, k, h):
    """Return the step that ends at the first guard to fire within ``h``; keep the guard in ``trigger``.

    Called with the guards evaluated at the end of the step.
    """
    theta = 1.0
    first = _fired(S, w, k, -1)
    while first >= 0:
        S.trigger = first
        theta = _root(S, w, k, h, theta, w[S.impact_guard + first], first)
        first = _fired(S, w, k, first)
    i = S.trigger
    step = theta * h
    for _iteration in range(4):
        # the interpolant is of lower order than the step: correct on the step itself
        try_impact_step(S, w, k, step)
        S.impact_steps += 1
        _write_guards(S, w, k, S.impact_new)
        if not S.guard_slope < 0.0:
            break
        correction = min(0.2 * theta * h, max(-0.2 * theta * h, -w[S.impact_guard + i] / S.guard_slope))
        step += correction
        if abs(correction) <= _SHORT * h:
            # so short a way is straight
            n = STRIDE * S.n_active
            for j in range(n):
                w[S.impact_new + j] += correction * w[S.impact_slopes + 6 * n + j]
            break
    return step


@kernel("f8(S, F, I, f8)")
def _aim(S, w, k, h):
    """Shorten the step of a lone contact so that it ends at the next event, which its polynomials foretell.

    Leaves the guard that it aims at in ``aimed``, -1 for none.
    """
    S.aimed = -1
    a = S.lone
    shortest = h
    width = 3 * S.n_active
    rates, forces, block = S.impact_z + 3 * a, S.f + 3 * a, S.delassus + 3 * a * width + 3 * a
    c = k[S.active + a]
    growth = slip = slip_growth = 0.0
    for j in range(3):
        growth += w[block + j] * w[forces + j]
    for r in range(1, 3):
        slip += w[rates + r] * w[S.direction + 2 * c + r - 1]
        for j in range(3):
            slip_growth += w[block + width * r + j] * w[forces + j] * w[S.direction + 2 * c + r - 1]
    if k[S.phase + a] == COMPRESSION and growth > 0.0:
        root = -w[rates] / growth
        if 0.0 < root < shortest:
            shortest, S.aimed = root, 3 * a
    if k[S.phase + a] == EXPANSION and w[rates] > 0.0:
        # E + E' s + E'' s^2 / 2 = 0, with E'' = E' growth / rate
        energy, first = w[S.impact_y + STRIDE * a + 6], w[S.impact_slopes + STRIDE * a + 6]
        square = first * first - 2.0 * first * growth / w[rates] * energy
        root = 2.0 * energy / (math.sqrt(max(0.0, square)) - first)
        if 0.0 < root < shortest:
            shortest, S.aimed = root, 3 * a + 1
    if k[S.tangent_held + a] == 0 and slip > 0.0 and slip_growth < 0.0:
        root = -slip / slip_growth
        if root < shortest:
            shortest, S.aimed = root, 3 * a + 2
    return shortest


@kernel("void(S, F, I, i8)")
def _account(S, w, k, a):
    """Book the work of the phase that ends at the active contact ``a``."""
    work = w[S.impact_y + STRIDE * a + 4]
    done = work - w[S.impact_mark + a]
    if k[S.phase + a] == COMPRESSION:
        w[S.stored + a] -= done
    else:
        w[S.returned + a] += done
    w[S.impact_mark + a] = work


@kernel("void(S, F, I, f8)")
def _switch(S, w, k, probe):
    """Change the phases whose guards have come to zero."""
    _evaluate_guards(S, w, k, S.impact_y)
    friction = 0
    for a in range(S.n_active):
        guard = S.impact_guard + 3 * a
        phase = k[S.phase + a]
        if phase == EXPANSION and (S.trigger == 3 * a + 1 or w[guard + 1] < _TOGETHER):
            _account(S, w, k, a)
            k[S.phase + a] = IDLE
            w[S.impact_y + STRIDE * a + 3] = w[S.impact_y + STRIDE * a + 6] = 0.0
            k[S.tangent_held + a] = 0
            S.phases += 1
        elif S.trigger == 3 * a or w[guard] < _TOGETHER:
            friction += _turn(S, w, k, a)
            S.phases += 1
        elif S.trigger == 3 * a + 2 or w[guard + 2] < _TOGETHER:
            S.phases += 1
            if k[S.tangent_held + a] == 1:
                _break_away(S, w, k, a)
            else:
                # a slip that only turned far from its first direction goes on
                v1, v2 = w[S.impact_z + 3 * a + 1], w[S.impact_z + 3 * a + 2]
                speed = math.sqrt(v1 * v1 + v2 * v2)
                c = k[S.active + a]
                if speed > REST * S.speed_scale:
                    w[S.direction + 2 * c], w[S.direction + 2 * c + 1] = v1 / speed, v2 / speed
                else:
                    friction = 1
    if friction > 0:
        _choose_friction(S, w, k, probe)
    _prepare_guards(S, w, k)


@kernel("i8(S, F, I, i8)")
def _turn(S, w, k, a):
    """Change the normal phase of the active contact ``a``; return 1 if friction must be chosen anew."""
    phase = k[S.phase + a]
    if phase == COMPRESSION:
        _account(S, w, k, a)
        if efficiency(S, w, k, a, 1e-300) > 0.0:
            k[S.phase + a] = EXPANSION
            return 0
        # without restitution the stored energy is lost at once and the contact stays closed
        w[S.impact_y + STRIDE * a + 3] = w[S.impact_y + STRIDE * a + 6] = 0.0
        k[S.phase + a] = HELD
        evaluate_impact_forces(S, w, k, S.impact_y)
        if w[S.f + 3 * a] < 0.0:
            k[S.phase + a] = IDLE
        return 1
    if phase == HELD:
        k[S.phase + a] = IDLE
        k[S.tangent_held + a] = 0
        return 0
    if phase == EXPANSION:
        _account(S, w, k, a)
    k[S.phase + a] = COMPRESSION
    return 1 if phase == IDLE else 0


@kernel("f8(S, F, i8)")
def _impulse_scale(S, w, a):
    return S.speed_scale / w[S.delassus + 3 * a * 3 * S.n_active + 3 * a]


@kernel("i8(S, F, I)")
def _change_clock(S, w, k):
    """Give the last contact in action its own clock; go back to where it got it if it does not stay alone.

    Returns 1 if the clock has changed.
    """
    acting = 0
    last = -1
    for a in range(S.n_active):
        if k[S.phase + a] != IDLE:
            acting += 1
            last = a
    n = STRIDE * S.n_active
    if S.lone < 0:
        if acting != 1 or k[S.phase + last] == HELD or S.may_be_lone == 0:
            return 0
        for i in range(n):
            w[S.impact_kept + i] = w[S.impact_y + i]
        _keep_phases(S, w, k)
        S.lone = last
        return 1
    if acting == 0 or (acting == 1 and last == S.lone):
        return 0
    for i in range(n):
        w[S.impact_y + i] = w[S.impact_kept + i]
    _restore_phases(S, w, k)
    S.lone = -1
    S.may_be_lone = 0
    return 1


@kernel("void(S, F, I)")
def _keep_phases(S, w, k):
    S.phases_kept = S.phases
    for a in range(S.n_active):
        c = k[S.active + a]
        k[S.kept + 2 * a], k[S.kept + 2 * a + 1] = k[S.phase + a], k[S.tangent_held + a]
        w[S.books_kept + 5 * a] = w[S.stored + a]
        w[S.books_kept + 5 * a + 1] = w[S.returned + a]
        w[S.books_kept + 5 * a + 2] = w[S.impact_mark + a]
        w[S.books_kept + 5 * a + 3] = w[S.direction + 2 * c]
        w[S.books_kept + 5 * a + 4] = w[S.direction + 2 * c + 1]


@kernel("void(S, F, I)")
def _restore_phases(S, w, k):
    S.phases = S.phases_kept
    for a in range(S.n_active):
        c = k[S.active + a]
        k[S.phase + a], k[S.tangent_held + a] = k[S.kept + 2 * a], k[S.kept + 2 * a + 1]
        w[S.stored + a] = w[S.books_kept + 5 * a]
        w[S.returned + a] = w[S.books_kept + 5 * a + 1]
        w[S.impact_mark + a] = w[S.books_kept + 5 * a + 2]
        w[S.direction + 2 * c] = w[S.books_kept + 5 * a + 3]
        w[S.direction + 2 * c + 1] = w[S.books_kept + 5 * a + 4]
    _prepare_guards(S, w, k)


@kernel("i8(S, F, I)")
def _finished(S, w, k):
    for a in range(S.n_active):
        if k[S.phase + a] == COMPRESSION or k[S.phase + a] == EXPANSION:
            return 0
    return 1


@kernel("void(S, F, I, f8)")
def _start(S, w, k, probe):
    for i in range(STRIDE * S.n_active):
        w[S.impact_y + i] = 0.0
    S.phases = 0
    for a in range(S.n_active):
        w[S.stored + a] = w[S.returned + a] = w[S.impact_mark + a] = 0.0
        k[S.tangent_held + a] = 0
        pushed = w[S.impact_z0 + 3 * a] < -NOISE * S.speed_scale
        if S.painleve == 1 and k[S.impacting + k[S.active + a]] == 1:
            # an impact without collision starts from a seed of deformation instead of a speed
            pushed = True
            w[S.impact_y + STRIDE * a + 3] = 1e-3 * w[S.impact_x_scale + a]
        k[S.phase + a] = COMPRESSION if pushed else IDLE
        S.phases += 1 if pushed else 0
    _choose_friction(S, w, k, probe)
    # a resting contact that the others press in takes part from the start
    pressed = 0
    width = 3 * S.n_active
    for a in range(S.n_active):
        growth = 0.0
        for j in range(width):
            growth += w[S.delassus + 3 * a * width + j] * w[S.f + j]
        if k[S.phase + a] == IDLE and growth < 0.0 and w[S.impact_z0 + 3 * a] <= REST * S.speed_scale:
            k[S.phase + a] = COMPRESSION
            S.phases += 1
            pressed = 1
    if pressed == 1:
        _choose_friction(S, w, k, probe)


@room("i8(S, F, I)")
def energetic_impact(S, w, k):
    """Carry the active contacts from the rates ``impact_z0`` through the impact; return how it ended.

    Leaves the impulses in ``impulse`` and, per active contact, the energies ``stored`` in compression,
    ``returned`` in expansion and ``rubbed`` away by friction.
    """
    m = S.n_active
    n = STRIDE * m
    S.speed_scale = 0.0
    S.aimed = -1
    S.lone = 0 if m == 1 else -1
    S.may_be_lone = 1
    shortest = _scale(S, w, k)
    if not shortest > 0.0:
        return INVALID
    _start(S, w, k, 1e-2 * shortest)
    _prepare_guards(S, w, k)
    impact_slope(S, w, k, S.impact_y, S.impact_slopes)
    h = shortest * (0.25 if m == 1 else S.impact_rtol**0.4)
    for _step in range(_MOST_STEPS):
        if _finished(S, w, k) == 1:
            _finish(S, w, k)
            return FINISHED
        if S.lone >= 0:
            h = _aim(S, w, k, h)
        error = try_impact_step(S, w, k, h)
        S.impact_steps += 1
        if not error <= 1.0:
            if not error < _UNUSED and h < 1e-12 * shortest:
                return INVALID
            h *= step_factor(error) if error < _UNUSED else 0.1
            continue
        grown = h * step_factor(error)
        # the last stage has left the forces at the end of the step
        _write_guards(S, w, k, S.impact_new)
        S.trigger = _fired(S, w, k, -1)
        aimed = S.aimed >= 0 and abs(w[S.impact_guard + max(0, S.aimed)]) <= _AT_EVENT
        fired = 1 if S.trigger >= 0 or aimed else 0
        if aimed and (S.trigger < 0 or S.trigger == S.aimed):
            S.trigger = S.aimed
        elif fired == 1:
            _locate(S, w, k, h)
        if fired == 1:
            grown = max(h, shortest * S.impact_rtol**0.4)
        for i in range(n):
            w[S.impact_y + i] = w[S.impact_new + i]
        if fired == 1:
            _switch(S, w, k, 1e-2 * shortest)
            if m > 1 and _change_clock(S, w, k) == 1:
                grown = shortest if S.lone < 0 else 0.25 * _impulse_scale(S, w, S.lone)
            impact_slope(S, w, k, S.impact_y, S.impact_slopes)
        else:
            _arm(S, w, k)
            for i in range(n):
                w[S.impact_slopes + i] = w[S.impact_slopes + 6 * n + i]
        h = grown
    return ENDLESS


@kernel("void(S, F, I)")
def _finish(S, w, k):
    for a in range(S.n_active):
        for r in range(3):
            w[S.impulse + 3 * a + r] = w[S.impact_y + STRIDE * a + r]
        done = w[S.impact_y + STRIDE * a + 4] - w[S.impact_mark + a]
        w[S.returned + a] += done
        w[S.rubbed + a] = w[S.impact_y + STRIDE * a + 5]
    evaluate_impact_rates(S, w, k, S.impact_y)


