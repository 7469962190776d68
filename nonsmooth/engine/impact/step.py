"""One step inside an impact: explicit, or implicit where the direction of a slip next to rest makes it stiff.

A contact that leaves its bound slowly, or slips on little more than friction takes, stays near rest for long.  The
direction of its slip v follows the forces within an impulse of the order of |v|, and explicit steps may be no longer.
The stages of an implicit one end with friction against their own slip (:mod:`nonsmooth.engine.contact.implicit_slip`),
as in the flow: a slip that keeps its direction, as the terminal one, is exact in a step of any length.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.implicit_slip import oppose_slips
from nonsmooth.engine.contact.problem import slip_coefficient
from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.rates import (
    COMPRESSION,
    DEFORMATION,
    EXPANSION,
    IDLE,
    STRIDE,
    evaluate_impact_rates,
    impact_slope,
    normal_force,
    write_impact_slope,
)
from nonsmooth.engine.impact.scales import reached_energy
from nonsmooth.engine.memory import implicit_tableau
from nonsmooth.engine.memory.layout import LAST_STAGE, N_STAGES
from nonsmooth.engine.memory.modes import OPEN, SLIDE, STICK
from nonsmooth.engine.native.kernel import (
    Workspace,
    impact_state,
    kernel,
)
from nonsmooth.engine.numerics.runge_kutta import stage_state, weigh_slopes, write_implicit_interpolant
from nonsmooth.engine.numerics.vectors import length

_STIFF = 1.0
"""Relaxations of a direction within a step that an explicit one bears."""
_SETTLING = 10.0
"""Relaxations of a direction while its slip changes by as much as it is, with which it is settled."""
_CAREFUL = 4.0
"""Errors of implicit steps count so many times: the estimate is of low order, and they add up."""
_STRAIGHT = 1e-13
"""Second differences of slopes below this, relative to the slopes, count as zero."""


@kernel("f8(ws, f8)")
def try_impact_step(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` in pseudo-time to ``impact_new``; return its error relative to the tolerance.

    A slip that an implicit step stops is held from there on, unless it is tried anew.
    """
    let_go(ws)
    n = STRIDE * ws.problem.n_active
    for stage in range(1, N_STAGES):
        out = ws.impact.y_new.start if stage == LAST_STAGE else ws.impact.y_stage.start
        stage_state(ws, ws.coefficients.stages.start, ws.impact.y.start, ws.impact.slopes.start, n, stage, h, out)
        impact_slope(ws, out, ws.impact.slopes.start + stage * n)
    weigh_slopes(ws, ws.coefficients.error_weights.start, ws.impact.slopes.start, n, h, ws.impact.y_stage.start)
    error = _relative_error(ws, ws.impact.y_stage.start)
    if not error <= 1.0:
        if _is_stiff(ws, h):
            return min(_try_implicit_step(ws, h), error)
        evaluate_impact_rates(ws, ws.impact.y_new.start)
    return error


@kernel()
def let_go(ws: Workspace) -> None:
    """Forget the slips that the last try of a step has stopped, and that it was implicit."""
    ws.problem.is_turning = False
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.was_halted:
            active.was_halted = active.sticks = False


@kernel("f8(ws, i8)")
def _relative_error(ws: Workspace, errors: int) -> float:
    """Return the largest of the ``errors`` of a state, relative to the tolerance.

    Impulses count by the energy of what they move, energies are known to a part of what they are.
    """
    worst = 0.0
    for a in range(ws.problem.n_active):
        active, own = ws.actives[a], diagonal_block(ws, a).entries
        if active.phase == IDLE:
            continue
        error, energy = impact_state(ws.floats, errors, a), reached_energy(ws, a)
        p0, p1, p2 = error.impulse[0], error.impulse[1], error.impulse[2]
        moved = own[0] * p0 * p0 + own[1] * p0 * p1 + own[2] * p0 * p2
        moved = moved + own[3] * p1 * p0 + own[4] * p1 * p1 + own[5] * p1 * p2
        moved = abs(moved + own[6] * p2 * p0 + own[7] * p2 * p1 + own[8] * p2 * p2)
        deformed, worked, rubbed = abs(error.deformation), abs(error.work), abs(error.rubbed)
        stored, lost = abs(error.energy), abs(error.lost)
        # a maximum does not show what is not a number
        if not moved + deformed + worked + rubbed + stored + lost < math.inf:
            return math.inf
        booked = max(max(worked, rubbed), max(stored, lost))
        # few of them are divided
        if moved > worst * worst * energy:
            worst = math.sqrt(moved / energy)
        if deformed > worst * active.deformation_scale:
            worst = deformed / active.deformation_scale
        if booked > worst * energy:
            worst = booked / energy
    return worst / float(ws.tolerance.impact)


@kernel("b1(ws, f8)")
def _is_stiff(ws: Workspace, h: float) -> bool:
    """Return 1 if a slip turns too fast for an explicit step of ``h``, and faster than it changes.

    One that passes close by rest does both at once, and where it goes hangs on every digit: that is for explicit steps.
    """
    evaluate_impact_rates(ws, ws.impact.slopes.start)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        for r in range(2):
            active.acceleration[1 + r] = active.slip[r] - active.rate_before[1 + r]
    evaluate_impact_rates(ws, ws.impact.y.start)
    for a in range(ws.problem.n_active):
        active, own = ws.actives[a], diagonal_block(ws, a)
        turning = length(impact_state(ws.floats, ws.impact.slopes.start, a).friction) * max(own.t11, own.t22)
        settled = not active.sticks and turning > _SETTLING * length(active.slip_acceleration)
        if settled and h * turning > _STIFF * length(active.slip):
            return True
    return False


@kernel("void(ws, f8, i8, i8, i8)")
def _lay_stage(ws: Workspace, ahead: float, y: int, n: int, guess: int) -> None:
    """Write what is held, and what pushes, at the end of a stage that goes ``ahead`` from ``y``, its slope a guess."""
    for i in range(n):
        ws.floats[y + i] += ahead * ws.floats[guess + i]
    evaluate_impact_rates(ws, y)
    ws.problem.acceleration_scale = 0.0
    for a in range(ws.problem.n_active):
        active, state, own = ws.actives[a], impact_state(ws.floats, y, a), diagonal_block(ws, a)
        loaded = active.phase == COMPRESSION or active.phase == EXPANSION
        active.has_given_force, active.mode_tried, active.is_at_rest = loaded, active.mode_past, False
        if loaded:
            active.normal_force = normal_force(ws, a, state.deformation)
        if active.mode_past == SLIDE:
            active.friction_coefficient = slip_coefficient(ws, active.contact, length(active.slip))
            active.is_at_rest = active.friction_coefficient > 0.0
            t1, t2 = impact_state(ws.floats, guess, a).friction
            friction = length((t1, t2))
            if friction > 0.0:
                active.direction = -t1 / friction, -t2 / friction
        ws.problem.acceleration_scale = max(
            ws.problem.acceleration_scale, max(own.nn, own.t11, own.t22) * abs(active.normal_force)
        )
    for i in range(n):
        ws.floats[y + i] -= ahead * ws.floats[guess + i]
    evaluate_impact_rates(ws, y)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        moves = active.mode_past == SLIDE and length(active.slip) > active.rest_slip
        active.free[0] = 0.0
        for r in range(1, 3):
            active.free[r] = active.rate[r] / ahead if moves else 0.0


@kernel("i8(ws, f8, i8)")
def _solve_stage(ws: Workspace, h: float, stage: int) -> int:
    """Find the slope of a stage at the state that it leads to itself; return 1 if it is found.

    Friction of slips, which is stiff, is solved for; deformations are iterated.
    """
    n = STRIDE * ws.problem.n_active
    out = ws.impact.y_new.start if stage == LAST_STAGE else ws.impact.y_stage.start
    here, guess, ahead = ws.impact.slopes.start + stage * n, ws.impact.y_guess.start, implicit_tableau.DIAGONAL * h
    for i in range(n):
        ws.floats[here + i] = ws.floats[here - n + i]
    for _iteration in range(implicit_tableau.ITERATIONS):
        stage_state(
            ws, ws.coefficients.implicit_stages.start, ws.impact.y.start, ws.impact.slopes.start, n, stage, h, out
        )
        for i in range(n):
            ws.floats[guess + i] = ws.floats[here + i]
        _lay_stage(ws, ahead, out, n, guess)
        if not oppose_slips(ws):
            return 0
        for a in range(ws.problem.n_active):
            active, state = ws.actives[a], impact_state(ws.floats, out, a)
            for r in range(3):
                state.impulse[r] += ahead * active.force[r]
        evaluate_impact_rates(ws, out)
        write_impact_slope(ws, here)
        for i in range(n):
            # of energies nothing depends
            change = ws.floats[here + i] - ws.floats[guess + i] if i % STRIDE <= DEFORMATION else 0.0
            ws.floats[guess + i] = ahead * change
            if i % STRIDE >= DEFORMATION:
                ws.floats[out + i] += ahead * ws.floats[here + i]
        if _relative_error(ws, guess) <= implicit_tableau.SETTLED:
            return 1
    return 0


@kernel("f8(ws, f8)")
def _try_implicit_step(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` to ``impact_new`` whose stages end with friction against their own slip; return its error.

    Leaves slopes from which the dense output of the explicit step makes the interpolant of this one.
    """
    n = STRIDE * ws.problem.n_active
    ws.problem.is_turning = True
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.mode_past = OPEN if active.phase == IDLE else STICK if active.sticks else SLIDE
        for r in range(3):
            # what the motion keeps of forces that are not unique is chosen anew behind the impact
            ws.contacts[active.contact].null_space_force[r] = 0.0
    for i in range(n):
        ws.impact.slopes[n + i] = ws.impact.slopes[i]
    stage = 2
    while stage < N_STAGES and _solve_stage(ws, h, stage) == 1:
        stage += 1
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.was_halted = active.mode_past == SLIDE and active.sticks
    if stage < N_STAGES:
        return math.inf
    weigh_slopes(ws, ws.coefficients.implicit_errors.start, ws.impact.slopes.start, n, h, ws.impact.y_stage.start)
    error = _CAREFUL * _relative_error(ws, ws.impact.y_stage.start)
    write_implicit_interpolant(
        ws, ws.impact.y.start, ws.impact.y_new.start, ws.impact.slopes.start, n, h, ws.impact.y_stage.start
    )
    return error


@kernel("b1(ws, f8)")
def try_linear_step(ws: Workspace, h: float) -> bool:
    """Take one step of ``h`` to ``impact_new`` by the midpoint rule; return 1 if the slope is linear and it is exact.

    A lone contact whose slip keeps its direction moves like that; the slope at the end tells.
    """
    n = STRIDE * ws.problem.n_active
    middle, end = ws.impact.slopes.start + n, ws.impact.slopes.start + LAST_STAGE * n
    for i in range(n):
        ws.impact.y_stage[i] = ws.impact.y[i] + 0.5 * h * ws.impact.slopes[i]
    impact_slope(ws, ws.impact.y_stage.start, middle)
    for i in range(n):
        ws.impact.y_new[i] = ws.impact.y[i] + h * ws.floats[middle + i]
    impact_slope(ws, ws.impact.y_new.start, end)
    # a component that is round-off next to the contact's force is as straight as that force
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        force = abs(active.force[0]) + abs(active.force[1]) + abs(active.force[2])
        for i in range(STRIDE * a, STRIDE * (a + 1)):
            first, half, last = ws.impact.slopes[i], ws.floats[middle + i], ws.floats[end + i]
            size = abs(first) + abs(last) + abs(half)
            if i < STRIDE * a + DEFORMATION:
                size = max(size, force)
            if not abs(first + last - 2.0 * half) <= _STRAIGHT * size:
                return False
    return True
