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
    Workspace,
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


@kernel("void(ws, i8)")
def evaluate_impact_guards(ws: Workspace, y: int) -> None:
    """Evaluate the forces at the impact state ``y`` and write the guards."""
    evaluate_impact_forces(ws, y)
    write_impact_guards(ws, y)


@kernel("void(ws, i8)")
def write_impact_guards(ws: Workspace, y: int) -> None:
    """Write the three guards of every active contact: rate, energy, friction; all of order 1."""
    evaluate_margins(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, y, a)
        contact = ws.contacts[active.contact]
        phase = active.phase
        if phase == IDLE:
            write_rates(ws, a, y)
        rate = active.gap_rate / ws.impact.speed_scale
        force_scale = 1.0 if a == ws.impact.lone_contact else active.force_scale
        active.energy_guard = 1.0
        if phase == COMPRESSION:
            active.rate_guard = NOISE - rate
            if a != ws.impact.lone_contact:
                active.energy_guard = _SLACK + state.deformation / active.deformation_scale
        elif phase == HELD:
            active.rate_guard = NOISE + active.normal_force / force_scale
        else:
            behind = phase == IDLE and ws.impact.faint_rate > 0.0 and contact.n_waves > 0
            active.rate_guard = (ws.impact.faint_rate if behind else NOISE) + rate
        if phase == EXPANSION:
            lost = state.lost
            active.energy_guard = state.deformation / active.deformation_scale
            if a == ws.impact.lone_contact or lost > 0.0:
                active.energy_guard = (state.energy - lost) / active.energy_scale
        if phase == IDLE or (not active.sticks and active.friction_coefficient == 0.0):
            active.friction_guard = 1.0
        elif active.sticks:
            # one that the step has stopped may have slipped in the part before
            margin = max(0.0, active.static_margin) if active.was_halted else active.static_margin
            active.friction_guard = NOISE + margin / force_scale
        elif ws.problem.is_turning:
            active.friction_guard = NOISE + length(active.slip) / ws.impact.speed_scale
        else:
            slip = active.rate[1] * contact.direction[0] + active.rate[2] * contact.direction[1]
            active.friction_guard = NOISE + slip / ws.impact.speed_scale


@kernel("i8(ws, i8)")
def fired_guard(ws: Workspace, but: int) -> int:
    """Return the first guard that ends its phase, other than ``but``, or -1.

    A guard left slightly negative by a switch is not armed until it has been positive.
    """
    for i in range(GUARDS * ws.problem.n_active):
        value = ws.impact.guards[i]
        if i != but and ((value < 0.0 and ws.impact.armed[i] == 1) or value < _WRONG):
            return i
    return -1


@kernel()
def arm_impact_guards(ws: Workspace) -> None:
    """Arm the guards that are positive now, where the next step starts."""
    for i in range(GUARDS * ws.problem.n_active):
        ws.impact.guards_at_start[i] = ws.impact.guards[i]
        if ws.impact.guards[i] > 0.0:
            ws.impact.armed[i] = 1


@kernel()
def prepare_guards(ws: Workspace) -> None:
    """Evaluate the guards where a phase begins and arm those that are positive."""
    for i in range(GUARDS * ws.problem.n_active):
        ws.impact.armed[i] = 0
    evaluate_impact_guards(ws, ws.impact.y.start)
    arm_impact_guards(ws)


@kernel("f8(ws, f8, f8, i8)")
def _guard_at(ws: Workspace, h: float, theta: float, i: int) -> float:
    interrupted(ws, ws.problem.n_active)
    dense_state(
        ws, ws.impact.y.start, ws.impact.slopes.start, STRIDE * ws.problem.n_active, h, theta, ws.impact.y_stage.start
    )
    evaluate_impact_guards(ws, ws.impact.y_stage.start)
    return ws.impact.guards[i]


@kernel("f8(ws, f8, f8, f8, i8)")
def _switch_fraction(ws: Workspace, h: float, high: float, g_high: float, i: int) -> float:
    """Return the fraction of the step at which guard ``i`` vanishes on the interpolant (Anderson-Bjorck).

    The guards are left evaluated there, the slope of guard ``i`` in ``guard_slope``.
    """
    low, g_low = 0.0, ws.impact.guards_at_start[i]
    if g_low <= 0.0:
        ws.step.guard_slope = 0.0
        return 1e-3 * high
    theta_before, g_before, largest = high, g_high, g_low
    ws.step.guard_slope = (g_high - g_low) / ((high - low) * h)
    for _iteration in range(60):
        theta = high - g_high * (high - low) / (g_high - g_low)
        g = _guard_at(ws, h, theta, i)
        # of what is nearer round-off would tell the slope
        if abs(theta - theta_before) > SHORT:
            ws.step.guard_slope = (g - g_before) / ((theta - theta_before) * h)
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


@entry_point("f8(ws, f8)")
def locate_switch(ws: Workspace, h: float) -> float:
    """Step to the first guard to fire within ``h``, kept in ``trigger``; return the error of that step.

    The error is that of a part of an accepted step, unless the motion is not as smooth as it seemed.
    Called with the guards evaluated at the end of the step.
    """
    theta = 1.0
    first = fired_guard(ws, -1)
    for _other in range(GUARDS * ws.problem.n_active):
        if first < 0:
            break
        ws.step.guard = first
        theta = _switch_fraction(ws, h, theta, ws.impact.guards[first], first)
        if ws.impact.guards_at_start[first] <= 0.0:
            # others that are wrong from the start would cut the step for one another until nothing is left of it
            break
        first = fired_guard(ws, first)
        if first >= 0 and ws.impact.guards[first] >= -TOGETHER:
            break
    i = ws.step.guard
    step = theta * h
    n = STRIDE * ws.problem.n_active
    error = 0.0
    for iteration in range(_CORRECTIONS):
        # the interpolant is of lower order than the step: correct on the step itself
        error = try_impact_step(ws, step)
        ws.totals.n_impact_steps += 1
        write_impact_guards(ws, ws.impact.y_new.start)
        if not (ws.step.guard_slope < 0.0 and error <= TRUSTED) or iteration == _CORRECTIONS - 1:
            break
        correction = min(0.2 * theta * h, max(-0.2 * theta * h, -ws.impact.guards[i] / ws.step.guard_slope))
        if abs(correction) <= SHORT * h:
            # so short a way is straight
            for j in range(n):
                ws.impact.y_new[j] += correction * ws.impact.slopes[LAST_STAGE * n + j]
            break
        step += correction
    evaluate_impact_guards(ws, ws.impact.y_new.start)
    return error


@kernel("f8(ws, f8)")
def aim(ws: Workspace, h: float) -> float:
    """Shorten the step of a lone contact so that it ends at the next event, which its polynomials foretell.

    Leaves the guard that it aims at in ``aimed``, -1 for none.
    """
    ws.impact.aimed_guard = -1
    a = ws.impact.lone_contact
    active = ws.actives[a]
    shortest = h
    contact = ws.contacts[active.contact]
    rate, force, own = active.rate, active.force, diagonal_block(ws, a).entries
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
            shortest, ws.impact.aimed_guard = root, GUARDS * a + RATE_GUARD
    if active.phase == EXPANSION and growth > 0.0:
        # E + E' s + E'' s^2 / 2 = 0, with E' = -rate / efficiency
        state = impact_state(ws.floats, ws.impact.y.start, a)
        energy, first = state.energy - state.lost, impact_state(ws.floats, ws.impact.slopes.start, a).energy
        square = first * first + 2.0 * growth / efficiency(ws, a, max(rate[0], 1e-300)) * energy
        speed = math.sqrt(max(0.0, square)) - first
        if speed > 0.0 and 0.0 < 2.0 * energy / speed < shortest:
            shortest, ws.impact.aimed_guard = 2.0 * energy / speed, GUARDS * a + ENERGY_GUARD
    if not active.sticks and active.friction_coefficient > 0.0 and slip > 0.0 and slip_growth < 0.0:
        root = -slip / slip_growth
        if root < shortest:
            shortest, ws.impact.aimed_guard = root, GUARDS * a + FRICTION_GUARD
    return shortest
