"""One step of the smooth motion: explicit, or implicit where friction turns slips too fast for that.

Between events the motion is smooth, but next to rest the direction of a slip relaxes at a rate of mu f_N G / |v|, and
an explicit step bears no more than some relaxations.  An implicit one, whose stages end with friction against their own
slip (:mod:`nonsmooth.engine.contact.implicit_slip`), is as long as its accuracy allows.
"""

from __future__ import annotations

import math

from nonsmooth.engine.flow.flight import land
from nonsmooth.engine.flow.flow import is_violated, slope
from nonsmooth.engine.flow.spins import choose_spins_in_space, store_spin_slope, write_spins_of_stage, write_spin_errors
from nonsmooth.engine.memory import implicit_tableau, tableau
from nonsmooth.engine.memory.layout import LAST_STAGE, N_ACCOUNTS, N_STAGES
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    kernel,
)
from nonsmooth.engine.numerics.roots import TRUSTED
from nonsmooth.engine.numerics.runge_kutta import (
    stage_part,
    stage_state,
    weigh_part,
    weigh_slopes,
    write_implicit_interpolant,
)
from nonsmooth.engine.numerics.vectors import length

LARGEST_EXPLICIT = 2.0
"""Relaxations within a step that an explicit one bears."""
_SMALLEST_SLIP = 1e-3
"""Slips below this part of what counts as zero relax no faster."""
_SECOND_NODE = tableau.NODES[1] / tableau.NODES[2]
"""Where the second stage lies between the first and the third."""


@kernel("f8(ws, i8, i8, f8)")
def _largest_error(ws: Workspace, first: int, end: int, worst: float) -> float:
    """Return the largest error of some components relative to the tolerance, or ``worst`` if that is larger."""
    for i in range(first, end):
        explained = ws.tolerance.relative * (ws.step.y_scale[i] + max(abs(ws.island.y[i]), abs(ws.step.y_new[i])))
        error = abs(ws.step.y_stage[i])
        # few of them are divided
        if error > worst * explained or error != error:
            worst = error / explained
    return worst


@kernel("f8(ws)")
def _relative_error(ws: Workspace) -> float:
    """Return the largest of the errors in ``y_stage`` relative to the tolerance, of what is integrated."""
    n, worst = ws.model.n_y, 0.0
    for span in range(ws.island.n_spans):
        first = ws.island.span_first[span]
        worst = _largest_error(ws, first, min(first + ws.island.span_length[span], ws.model.n_q + ws.model.n_u), worst)
    if ws.model.n_states > 0:
        worst = _largest_error(ws, ws.model.n_q + ws.model.n_u + N_ACCOUNTS, n, worst)
    return worst


@kernel("f8(ws, f8)")
def _error_of_second_stage(ws: Workspace, h: float) -> float:
    """Return how far the second stage is from the first and third, relative to what a step of the tolerance explains.

    It has no weight in the result, nor in the error: a force that only it meets, as where it throws the later stages
    out of a contact, would count for nothing.  Its own error is of the order (L h)^3 where that of the step is of the
    order (L h)^5.
    """
    first = ws.island.slopes.start + ws.model.n_q
    second, third = first + ws.model.n_y, first + 2 * ws.model.n_y
    y_scale, y, y_new = (
        ws.step.y_scale.start + ws.model.n_q,
        ws.island.y.start + ws.model.n_q,
        ws.step.y_new.start + ws.model.n_q,
    )
    worst, rtol = 0.0, math.sqrt(ws.tolerance.relative)
    for number in range(ws.island.n_integrated):
        body = ws.bodies[ws.island.integrated[number]]
        for i in range(body.u, body.u + body.n_u):
            change = h * abs(
                ws.floats[second + i] - (1.0 - _SECOND_NODE) * ws.floats[first + i] - _SECOND_NODE * ws.floats[third + i]
            )
            explained = rtol * (ws.floats[y_scale + i] + max(abs(ws.floats[y + i]), abs(ws.floats[y_new + i])))
            if change > worst * explained:
                worst = change / explained
    return worst if worst > 1.0 else 0.0


@kernel("f8(ws)")
def relaxation_rate(ws: Workspace) -> float:
    """Return how fast slip directions relax where the step starts [1/s]; 0 where an implicit step is none.

    For that some closed contact must slide, and all must be rigid.
    """
    fastest = 0.0
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        if contact.is_compliant:
            return 0.0
        if contact.mode == Mode.SLIDE and not contact.is_averaged:
            friction, speed = length((contact.force[1], contact.force[2])), length(contact.slip_at_end)
            fastest = max(fastest, contact.slip_per_force * friction / max(speed, _SMALLEST_SLIP * ws.tolerance.velocity))
    return fastest


@kernel("b1(ws)")
def _are_modes_valid(ws: Workspace) -> bool:
    """Return 1 if no force of a closed contact violates its mode: when it begins to is for explicit steps to find."""
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        if is_violated(ws, c):
            return False
    return True


@kernel("void(ws, f8, i8, i8)")
def _predict_stage(ws: Workspace, h: float, stage: int, out: int) -> None:
    """Write the state at which a stage is looked for first to ``out``, and the slope that leads there to its place."""
    n = ws.model.n_y
    here = ws.island.slopes.start + stage * n
    stage_state(
        ws,
        ws.coefficients.implicit_stages.start,
        ws.island.y.start,
        ws.island.slopes.start,
        n,
        stage,
        h,
        ws.step.y_guess.start,
    )
    stage_state(
        ws, ws.coefficients.implicit_predictor.start, ws.island.y.start, ws.island.slopes.start, n, stage, h, out
    )
    for i in range(n):
        ws.floats[here + i] = (ws.floats[out + i] - ws.step.y_guess[i]) / ws.island.stage_time


@kernel("b1(ws, f8, i8)")
def _solve_stage(ws: Workspace, h: float, stage: int) -> bool:
    """Find the slope of a stage at the state that it leads to itself; return 1 if it is found.

    Friction of slips, which is stiff, is solved for; all else is iterated, until what would be left if it fell on as
    it fell last is small.
    """
    n = ws.model.n_y
    out = ws.step.y_new.start if stage == LAST_STAGE else ws.step.y_stage.start
    here = ws.island.slopes.start + stage * n
    _predict_stage(ws, h, stage, out)
    ws.problem.is_unsettled = False
    before = 0.0
    for _iteration in range(implicit_tableau.ITERATIONS):
        for i in range(n):
            ws.step.y_guess[i] = ws.floats[here + i]
        ws.problem.stage_time, ws.problem.guess = ws.island.stage_time, ws.step.y_guess.start + ws.model.n_q
        slope(ws, ws.island.time + implicit_tableau.NODES[stage] * h, out, here, may_choose=False, of_all_bodies=False)
        ws.problem.stage_time = 0.0
        if ws.problem.is_unsettled:
            return False
        worst = 0.0
        for i in range(n):
            change = ws.island.stage_time * (ws.floats[here + i] - ws.step.y_guess[i])
            ws.floats[out + i] += change
            if i < ws.model.n_q + ws.model.n_u:
                worst = max(worst, abs(change) / (ws.tolerance.relative * (ws.step.y_scale[i] + abs(ws.island.y[i]))))
        # where the step ends what was evaluated is to be that of its end
        left = worst * worst / (before - worst) if before > worst and stage < LAST_STAGE else worst
        if left <= implicit_tableau.SETTLED:
            return _are_modes_valid(ws)
        before = worst
    return False


@kernel("b1(ws)")
def _find_first_slope(ws: Workspace) -> bool:
    """Write the slope at the start with friction against the slip that a stage makes of it; return 1 if it is found."""
    for i in range(ws.model.n_y):
        ws.step.y_guess[i] = 0.0
    ws.problem.is_unsettled = False
    ws.problem.stage_time, ws.problem.guess = ws.island.stage_time, ws.step.y_guess.start + ws.model.n_q
    slope(
        ws,
        ws.island.time,
        ws.island.y.start,
        ws.island.slopes.start + ws.model.n_y,
        may_choose=False,
        of_all_bodies=False,
    )
    ws.problem.stage_time = 0.0
    return False if ws.problem.is_unsettled else _are_modes_valid(ws)


@kernel("f8(ws, f8)")
def _try_implicit_step(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` whose stages end with friction against their own slip; return its relative error.

    Leaves slopes from which the dense output of the explicit step makes the interpolant of this one.  Where no implicit
    step went before the slip may not have settled, and the slope on which it will takes the place of that at the start.
    """
    n = ws.model.n_y
    ws.island.stage_time = implicit_tableau.DIAGONAL * h
    for i in range(n):
        ws.island.slopes[n + i] = ws.island.slopes[i]
    if not ws.step.uses_last_slope and not _find_first_slope(ws):
        return math.inf
    for stage in range(2, N_STAGES):
        if not _solve_stage(ws, h, stage):
            return math.inf
    weigh_slopes(ws, ws.coefficients.implicit_errors.start, ws.island.slopes.start, n, h, ws.step.y_stage.start)
    error = _relative_error(ws)
    ws.step.has_replaced_slope = True
    for i in range(n):
        ws.step.first_slope[i], ws.island.slopes[i] = ws.island.slopes[i], ws.island.slopes[n + i]
    write_implicit_interpolant(
        ws, ws.island.y.start, ws.step.y_new.start, ws.island.slopes.start, n, h, ws.step.y_stage.start
    )
    return error


@kernel("f8(ws, f8)")
def explicit_step(ws: Workspace, h: float) -> float:
    """Take one explicit step of ``h`` of what is integrated; return its relative error."""
    n = ws.model.n_y
    ws.island.stage_time = 0.0
    choose_spins_in_space(ws)
    if ws.island.n_integrated == 0:
        for i in range(ws.model.n_q + ws.model.n_u, n):
            ws.step.y_new[i] = ws.island.y[i]
            ws.island.slopes[LAST_STAGE * n + i] = 0.0
        return 0.0
    store_spin_slope(ws, 0, ws.island.y.start)
    for stage in range(1, N_STAGES):
        out = ws.step.y_new.start if stage == LAST_STAGE else ws.step.y_stage.start
        for span in range(ws.island.n_spans):
            i, length = ws.island.span_first[span], ws.island.span_length[span]
            stage_part(
                ws,
                ws.coefficients.stages.start,
                ws.island.y.start + i,
                ws.island.slopes.start + i,
                length,
                n,
                stage,
                h,
                out + i,
            )
        write_spins_of_stage(ws, stage, h, out)
        slope(
            ws,
            ws.island.time + tableau.NODES[stage] * h,
            out,
            ws.island.slopes.start + stage * n,
            may_choose=False,
            of_all_bodies=False,
        )
        store_spin_slope(ws, stage, out)
    for span in range(ws.island.n_spans):
        i, length = ws.island.span_first[span], ws.island.span_length[span]
        weigh_part(
            ws, ws.coefficients.error_weights.start, ws.island.slopes.start + i, length, n, h, ws.step.y_stage.start + i
        )
    write_spin_errors(ws, h, ws.step.y_stage.start)
    return max(_relative_error(ws), _error_of_second_stage(ws, h))


@kernel("f8(ws, f8)")
def _step_integrated(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` of what is integrated; return its relative error."""
    if ws.island.stage_time > 0.0:
        error = _try_implicit_step(ws, h)
        return error if error < math.inf else explicit_step(ws, h)
    error = explicit_step(ws, h)
    if error > 1.0 and h * ws.step.relaxation > LARGEST_EXPLICIT:
        implicit = _try_implicit_step(ws, h)
        return implicit if implicit < math.inf else explicit_step(ws, h)
    return error


@entry_point("f8(ws, f8)")
def try_step(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` from ``y`` to ``y_new``; return its error relative to the tolerance.

    It is implicit where the one tried before was, as is then a part of it, however short.  ``slopes`` must hold the
    slope at ``y`` first; its last entry becomes the slope at ``y_new``.  A force or slip that violates its mode at some
    stage raises ``suspect``.
    """
    ws.step.has_doubtful_force = False
    if ws.step.has_replaced_slope:
        ws.step.has_replaced_slope = False
        for i in range(ws.model.n_y):
            ws.island.slopes[i] = ws.step.first_slope[i]
    for c in range(ws.island.n_contacts):
        ws.contacts[c].least_force = math.inf
    error = _step_integrated(ws, h)
    # where nobody trusts the step, it is not asked where the others are
    return error + land(ws, h) if ws.island.n_ballistic > 0 and error <= TRUSTED else error


@kernel("f8(ws, f8)")
def try_length(ws: Workspace, h: float) -> float:
    """Take one step of ``h``, implicit where an explicit one does not do; return its relative error."""
    if h * ws.step.relaxation <= LARGEST_EXPLICIT:
        ws.island.stage_time = 0.0
    return float(try_step(ws, h))
