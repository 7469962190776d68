"""Guards inside an impact, and stepping exactly to the first that ends its phase.

Guards are positive while a phase is valid: the gap rate (its sign in compression and expansion, the
approach of an idle contact, the force of a held one), the deformation or stored energy, and the friction (the
slip along its direction, or the distance to the static bound).
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.forces import evaluate_margins
from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.rates import (
    COMPRESSION,
    EXPANSION,
    HELD,
    IDLE,
    NOISE,
    STRIDE,
    efficiency,
    evaluate_impact_forces,
    write_rates,
)
from nonsmooth.engine.impact.step import try_impact_step
from nonsmooth.engine.memory.layout import LAST_STAGE
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    active_at,
    contact_at,
    entry_point,
    impact_state,
    kernel,
)
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.roots import SHORT, TRUSTED, weakened
from nonsmooth.engine.numerics.runge_kutta import dense_state
from nonsmooth.engine.numerics.vectors import length

_SLACK = 1e-9
"""A compression that comes to nothing, of round-off, ends at this deformation below zero, relative to a full one."""
RATE_GUARD, ENERGY_GUARD, FRICTION_GUARD = 0, 1, 2
"""Which of its guards is which; every active contact has"""
GUARDS = 3
"""so many."""
TOGETHER = 1e-13
"""Guards, which are of order 1, fire together within this of zero: round-off does not tell which one is first."""
_WRONG = -1e-7
"""A guard, of order 1, that is not armed fires below this all the same: more than a switch leaves by its error."""
_ROUGH = 1e-11
"""A guard, of order 1, need not be nearer zero on the interpolant: it is corrected on the step itself."""
_SMALL = 1e-3
"""But it must be small next to what the guard was before, which may be next to nothing, too."""
_CORRECTIONS = 8
"""Of a step to a switch, by Newton's method with the slope on the interpolant; two or three do."""


@kernel("void(S, F, I, i8)")
def evaluate_impact_guards(S: Scalars, w: Floats, k: Integers, y: int) -> None:
    """Evaluate the forces at the impact state ``y`` and write the guards."""
    evaluate_impact_forces(S, w, k, y)
    write_impact_guards(S, w, k, y)


@kernel("void(S, F, I, i8)")
def write_impact_guards(S: Scalars, w: Floats, k: Integers, y: int) -> None:
    """Write the three guards of every active contact: rate, energy, friction; all of order 1."""
    evaluate_margins(S, w, k)
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        state = impact_state(w, y, a)
        contact = contact_at(S, w, k, active.slot)
        phase = active.phase
        if phase == IDLE:
            write_rates(S, w, k, a, y)
        rate = active.gap_rate / S.speed_scale
        force_scale = 1.0 if a == S.lone else active.force_scale
        active.energy_guard = 1.0
        if phase == COMPRESSION:
            active.rate_guard = NOISE - rate
            if a != S.lone:
                active.energy_guard = _SLACK + state.deformation / active.deformation_scale
        elif phase == HELD:
            active.rate_guard = NOISE + active.normal_force / force_scale
        else:
            behind = phase == IDLE and S.faint > 0.0 and contact.waves > 0
            active.rate_guard = (S.faint if behind else NOISE) + rate
        if phase == EXPANSION:
            lost = state.lost
            active.energy_guard = state.deformation / active.deformation_scale
            if a == S.lone or lost > 0.0:
                active.energy_guard = (state.energy - lost) / active.energy_scale
        if phase == IDLE or (active.tangent_held == 0 and active.mu == 0.0):
            active.friction_guard = 1.0
        elif active.tangent_held == 1:
            # one that the step has stopped may have slipped in the part before
            margin = max(0.0, active.margin) if active.halted == 1 else active.margin
            active.friction_guard = NOISE + margin / force_scale
        elif S.turning == 1:
            active.friction_guard = NOISE + length(active.slip) / S.speed_scale
        else:
            slip = active.rate[1] * contact.direction[0] + active.rate[2] * contact.direction[1]
            active.friction_guard = NOISE + slip / S.speed_scale


@kernel("i8(S, F, I, i8)")
def fired_guard(S: Scalars, w: Floats, k: Integers, but: int) -> int:
    """Return the first guard that ends its phase, other than ``but``, or -1.

    A guard left slightly negative by a switch is not armed until it has been positive.
    """
    for i in range(GUARDS * S.n_active):
        value = w[S.impact_guard + i]
        if i != but and ((value < 0.0 and k[S.armed + i] == 1) or value < _WRONG):
            return i
    return -1


@kernel()
def arm_impact_guards(S: Scalars, w: Floats, k: Integers) -> None:
    """Arm the guards that are positive now, where the next step starts."""
    for i in range(GUARDS * S.n_active):
        w[S.impact_guard_first + i] = w[S.impact_guard + i]
        if w[S.impact_guard + i] > 0.0:
            k[S.armed + i] = 1


@kernel("void(S, F, I)")
def prepare_guards(S: Scalars, w: Floats, k: Integers) -> None:
    """Evaluate the guards where a phase begins and arm those that are positive."""
    for i in range(GUARDS * S.n_active):
        k[S.armed + i] = 0
    evaluate_impact_guards(S, w, k, S.impact_y)
    arm_impact_guards(S, w, k)


@kernel("f8(S, F, I, f8, f8, i8)")
def _guard_at(S: Scalars, w: Floats, k: Integers, h: float, theta: float, i: int) -> float:
    interrupted(S, S.n_active)
    dense_state(S, w, S.impact_y, S.impact_slopes, STRIDE * S.n_active, h, theta, S.impact_stage)
    evaluate_impact_guards(S, w, k, S.impact_stage)
    return w[S.impact_guard + i]


@kernel("f8(S, F, I, f8, f8, f8, i8)")
def _switch_fraction(S: Scalars, w: Floats, k: Integers, h: float, high: float, g_high: float, i: int) -> float:
    """Return the fraction of the step at which guard ``i`` vanishes on the interpolant (Anderson-Bjorck).

    The guards are left evaluated there, the slope of guard ``i`` in ``guard_slope``.
    """
    low, g_low = 0.0, w[S.impact_guard_first + i]
    if g_low <= 0.0:
        S.guard_slope = 0.0
        return 1e-3 * high
    theta_before, g_before, largest = high, g_high, g_low
    S.guard_slope = (g_high - g_low) / ((high - low) * h)
    for _iteration in range(60):
        theta = high - g_high * (high - low) / (g_high - g_low)
        g = _guard_at(S, w, k, h, theta, i)
        # of what is nearer round-off would tell the slope
        if abs(theta - theta_before) > SHORT:
            S.guard_slope = (g - g_before) / ((theta - theta_before) * h)
        theta_before, g_before = theta, g
        largest = max(largest, g)
        if abs(g) <= min(_ROUGH, _SMALL * largest) or high - low <= 1e-14:
            return theta
        if g < 0.0:
            g_low = weakened(g_low, g, g_high)
            high, g_high = theta, g
        else:
            g_high = weakened(g_high, g, g_low)
            low, g_low = theta, g
    return theta


@entry_point("f8(S, F, I, f8)")
def locate_switch(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Step to the first guard to fire within ``h``, kept in ``trigger``; return the error of that step.

    The error is that of a part of an accepted step, unless the motion is not as smooth as it seemed.
    Called with the guards evaluated at the end of the step.
    """
    theta = 1.0
    first = fired_guard(S, w, k, -1)
    for _other in range(GUARDS * S.n_active):
        if first < 0:
            break
        S.trigger = first
        theta = _switch_fraction(S, w, k, h, theta, w[S.impact_guard + first], first)
        if w[S.impact_guard_first + first] <= 0.0:
            # others that are wrong from the start would cut the step for one another until nothing is left of it
            break
        first = fired_guard(S, w, k, first)
        if first >= 0 and w[S.impact_guard + first] >= -TOGETHER:
            break
    i = S.trigger
    step = theta * h
    n = STRIDE * S.n_active
    error = 0.0
    for iteration in range(_CORRECTIONS):
        # the interpolant is of lower order than the step: correct on the step itself
        error = try_impact_step(S, w, k, step)
        S.impact_steps += 1
        write_impact_guards(S, w, k, S.impact_new)
        if not (S.guard_slope < 0.0 and error <= TRUSTED) or iteration == _CORRECTIONS - 1:
            break
        correction = min(0.2 * theta * h, max(-0.2 * theta * h, -w[S.impact_guard + i] / S.guard_slope))
        if abs(correction) <= SHORT * h:
            # so short a way is straight
            for j in range(n):
                w[S.impact_new + j] += correction * w[S.impact_slopes + LAST_STAGE * n + j]
            break
        step += correction
    evaluate_impact_guards(S, w, k, S.impact_new)
    return error


@kernel("f8(S, F, I, f8)")
def aim(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Shorten the step of a lone contact so that it ends at the next event, which its polynomials foretell.

    Leaves the guard that it aims at in ``aimed``, -1 for none.
    """
    S.aimed = -1
    a = S.lone
    active = active_at(S, w, k, a)
    shortest = h
    contact = contact_at(S, w, k, active.slot)
    rate, force, own = active.rate, active.force, diagonal_block(S, w, k, a).entries
    growth = slip = slip_growth = 0.0
    for j in range(3):
        growth += own[j] * force[j]
    for r in range(1, 3):
        slip += rate[r] * contact.direction[r - 1]
        for j in range(3):
            slip_growth += own[3 * r + j] * force[j] * contact.direction[r - 1]
    if active.phase == COMPRESSION and growth > 0.0:
        root = -rate[0] / growth
        if 0.0 < root < shortest:
            shortest, S.aimed = root, GUARDS * a + RATE_GUARD
    if active.phase == EXPANSION and growth > 0.0:
        # E + E' s + E'' s^2 / 2 = 0, with E' = -rate / efficiency
        state = impact_state(w, S.impact_y, a)
        energy, first = state.energy - state.lost, impact_state(w, S.impact_slopes, a).energy
        square = first * first + 2.0 * growth / efficiency(S, w, k, a, max(rate[0], 1e-300)) * energy
        speed = math.sqrt(max(0.0, square)) - first
        if speed > 0.0 and 0.0 < 2.0 * energy / speed < shortest:
            shortest, S.aimed = 2.0 * energy / speed, GUARDS * a + ENERGY_GUARD
    if active.tangent_held == 0 and active.mu > 0.0 and slip > 0.0 and slip_growth < 0.0:
        root = -slip / slip_growth
        if root < shortest:
            shortest, S.aimed = root, GUARDS * a + FRICTION_GUARD
    return shortest
