"""One step of the smooth motion: explicit, or implicit if friction turns slips too fast for that.

Close to rest, the direction of a slip v relaxes at the rate mu f_n G / |v|, with G the effective inverse mass. An
explicit step is stable for about two such relaxation times only. An implicit step, whose stages end with friction
against their own slip (:mod:`nonsmooth.engine.contact.implicit_slip`), is as long as its accuracy allows. Only this
friction is implicit. All other forces are iterated, because they are not stiff.

The explicit pair is of order 5 with an error estimate of order 4 (:mod:`nonsmooth.engine.memory.tableau`). It steps
only the parts of the state that belong to integrated bodies.
"""

from __future__ import annotations

import math

from nonsmooth.engine.flow.flight import land
from nonsmooth.engine.flow.flow import is_violated, slope
from nonsmooth.engine.flow.spins import choose_spins_in_space, store_spin_slope, write_spin_errors, write_spins_of_stage
from nonsmooth.engine.memory import implicit_tableau, tableau
from nonsmooth.engine.memory.layout import LAST_STAGE, N_ACCOUNTS, N_STAGES
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.roots import TRUSTED
from nonsmooth.engine.numerics.runge_kutta import stage_part, weigh_part, write_implicit_interpolant
from nonsmooth.engine.numerics.tolerances import NEGLIGIBLE
from nonsmooth.engine.numerics.vectors import length

LARGEST_EXPLICIT = 2.0
"""Relaxation times within a step up to which an explicit step is used. It is about the limit of its stability."""
_SECOND_NODE = tableau.NODES[1] / tableau.NODES[2]
"""Node of the second stage relative to that of the third."""


@kernel("f8(ws, i8, i8, f8)")
def _largest_error(ws: Workspace, first: int, end: int, worst: float) -> float:
    """Largest error of entries ``first`` to ``end`` - 1 of the state, relative to the tolerance, at least ``worst``.

    ``y_stage`` holds the errors. The tolerance is relative to the scale of an entry, plus the larger of its values at
    start and end of the step. An error that is not a number is passed on.
    """
    for i in range(first, end):
        allowed = ws.tolerance.relative * (ws.step.y_scale[i] + max(abs(ws.island.y[i]), abs(ws.step.y_new[i])))
        error = abs(ws.step.y_stage[i])
        # this comparison avoids most divisions; a number that differs from itself is not a number
        if error > worst * allowed or error != error:
            worst = error / allowed
    return worst


@kernel("f8(ws)")
def _relative_error(ws: Workspace) -> float:
    """Largest error in ``y_stage`` of all that is integrated but the energy accounts, relative to the tolerance.

    The accounts, which follow the velocities in the state, shorten no step.
    """
    worst = 0.0
    # a span is a connected part of the state that is integrated; the last one reaches past the velocities, and is cut
    for span in range(ws.island.n_spans):
        first = ws.island.span_first[span]
        worst = _largest_error(ws, first, min(first + ws.island.span_length[span], ws.model.n_q + ws.model.n_u), worst)
    if ws.model.n_states > 0:
        # inner states of laws
        worst = _largest_error(ws, ws.model.n_q + ws.model.n_u + N_ACCOUNTS, ws.model.n_y, worst)
    return worst


@kernel("f8(ws, f8)")
def _error_of_second_stage(ws: Workspace, h: float) -> float:
    """Deviation of the second stage from the line between the first and the third, relative to the tolerance.

    Of the accelerations; 0 if within the tolerance. The second stage has no weight in the result, nor in the error
    estimate. A force that only this stage meets would be lost, for example if it throws the later stages out of a
    contact. With the rate L of the motion, the deviation is of the order (L h)^3, and the error of the step of the
    order (L h)^5. So it is compared with the square root of the tolerance.
    """
    first = ws.island.slopes.start + ws.model.n_q
    second, third = first + ws.model.n_y, first + 2 * ws.model.n_y
    # the slopes of a stage are n_y numbers; accelerations and velocities are behind the n_q coordinates
    y_scale = ws.step.y_scale.start + ws.model.n_q
    y, y_new = ws.island.y.start + ws.model.n_q, ws.step.y_new.start + ws.model.n_q
    worst, tolerance = 0.0, math.sqrt(ws.tolerance.relative)
    for number in range(ws.island.n_integrated):
        body = ws.bodies[ws.island.integrated[number]]
        for i in range(body.u, body.u + body.n_u):
            on_line = (1.0 - _SECOND_NODE) * ws.floats[first + i]
            change = h * abs(ws.floats[second + i] - on_line - _SECOND_NODE * ws.floats[third + i])
            allowed = tolerance * (ws.floats[y_scale + i] + max(abs(ws.floats[y + i]), abs(ws.floats[y_new + i])))
            if change > worst * allowed:
                worst = change / allowed
    return worst if worst > 1.0 else 0.0


@kernel("f8(ws)")
def relaxation_rate(ws: Workspace) -> float:
    """Largest rate at which a slip direction relaxes at the start of the step [1/s]: friction mu f_n G / slip speed.

    An explicit step is stable for about two relaxation times. The rate is 0 if no implicit step is possible: that needs
    a contact that slides with instantaneous forces, and all closed contacts must be rigid.
    """
    fastest = 0.0
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        if contact.is_compliant:
            return 0.0
        if contact.mode == Mode.SLIDE and not contact.is_averaged:
            friction, speed = length((contact.force[1], contact.force[2])), length(contact.slip_at_end)
            # the last step ended where this one starts; a slip that begins has no speed
            slip = max(speed, NEGLIGIBLE * ws.tolerance.velocity)
            fastest = max(fastest, contact.slip_per_force * friction / slip)
    return fastest


@kernel("b1(ws)")
def _are_modes_valid(ws: Workspace) -> bool:
    """True if no force of a closed contact violates its mode.

    Else the implicit step is given up: explicit steps find the time at which a force does, which is an event.
    """
    for i in range(ws.island.n_grouped):
        if is_violated(ws, ws.island.grouped[i]):
            return False
    return True


@kernel("void(ws, f8, i8, i8)")
def _predict_stage(ws: Workspace, h: float, stage: int, out: int) -> None:
    """Write the first guess of the state of an implicit stage to ``out``, and the slope that leads there to its slope.

    The state is extrapolated from the stages before. ``y_guess`` is the state without the stage's own slope, whose
    weight is the stage time. The step is one of ``h`` [s].
    """
    n, stages, predictor = ws.model.n_y, ws.coefficients.implicit_stages.start, ws.coefficients.implicit_predictor.start
    y, slopes = ws.island.y.start, ws.island.slopes.start
    here = slopes + stage * n
    # all n numbers of the state; the slopes of two stages are n apart, too
    stage_part(ws, stages, y, slopes, n, n, stage, h, ws.step.y_guess.start)
    stage_part(ws, predictor, y, slopes, n, n, stage, h, out)
    for i in range(n):
        ws.floats[here + i] = (ws.floats[out + i] - ws.step.y_guess[i]) / ws.island.stage_time


@kernel("b1(ws, f8, i8)")
def _solve_stage(ws: Workspace, h: float, stage: int) -> bool:
    """Find the slope of a stage of an implicit step at the state to which it leads. True if found in the present modes.

    Friction of slips is solved for. All else is iterated until the estimated remaining change is small: it is that of
    a geometric sequence. The last stage must have the slope of its own state, so its last change itself must be small.
    The state is left in ``y_stage``, of the last stage in ``y_new``.
    """
    n = ws.model.n_y
    out = ws.step.y_new.start if stage == LAST_STAGE else ws.step.y_stage.start
    here = ws.island.slopes.start + stage * n
    _predict_stage(ws, h, stage, out)
    # becomes true if the slip at the end of the stage is not found
    ws.problem.is_unsettled = False
    # no change is known before the first iteration
    before = 0.0
    for _iteration in range(implicit_tableau.ITERATIONS):
        for i in range(n):
            ws.step.y_guess[i] = ws.floats[here + i]
        _evaluate_implicit_slope(ws, ws.island.time + ws.coefficients.implicit_nodes[stage] * h, out, here)
        if ws.problem.is_unsettled:
            return False
        worst = _change_of_stage(ws, here, out)
        # with the ratio r = worst / before of the changes, those that follow add up to worst r / (1 - r)
        left = worst * worst / (before - worst) if before > worst and stage < LAST_STAGE else worst
        if left <= implicit_tableau.SETTLED:
            return _are_modes_valid(ws)
        before = worst
    return False


@kernel("void(ws, f8, i8, i8)")
def _evaluate_implicit_slope(ws: Workspace, t: float, y: int, out: int) -> None:
    """Write the slope at time ``t`` [s] and state ``y`` to ``out``, with friction against the slip that it leads to.

    ``y_guess`` holds the first guess of the slope. ``is_unsettled`` becomes true if no such friction is found.
    """
    # a positive stage time of the contact problem selects this friction, but only for this slope
    ws.problem.stage_time, ws.problem.guess = ws.island.stage_time, ws.step.y_guess.start + ws.model.n_q
    slope(ws, t, y, out, may_choose=False, of_all_bodies=False)
    ws.problem.stage_time = 0.0


@kernel("f8(ws, i8, i8)")
def _change_of_stage(ws: Workspace, here: int, out: int) -> float:
    """Correct the state of a stage at ``out`` by the change of its slope at ``here`` since the guess in ``y_guess``.

    Result: largest change of a coordinate or velocity, relative to the tolerance of a step.
    """
    worst = 0.0
    for i in range(ws.model.n_y):
        change = ws.island.stage_time * (ws.floats[here + i] - ws.step.y_guess[i])
        ws.floats[out + i] += change
        if i < ws.model.n_q + ws.model.n_u:
            worst = max(worst, abs(change) / (ws.tolerance.relative * (ws.step.y_scale[i] + abs(ws.island.y[i]))))
    return worst


@kernel("b1(ws)")
def _find_first_slope(ws: Workspace) -> bool:
    """Write the slope at the start, with friction against the slip that a stage leads to, to that of the second stage.

    Right after an event this is the slope on which the slip settles. An implicit step has no second stage, so the place
    is free. True if the slope is found and its forces keep the modes.
    """
    # the accelerations are guessed to be zero
    for i in range(ws.model.n_y):
        ws.step.y_guess[i] = 0.0
    ws.problem.is_unsettled = False
    out = ws.island.slopes.start + ws.model.n_y
    _evaluate_implicit_slope(ws, ws.island.time, ws.island.y.start, out)
    return False if ws.problem.is_unsettled else _are_modes_valid(ws)


@kernel("f8(ws, f8)")
def _try_implicit_step(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` [s] whose stages end with friction against their own slip. Its relative error.

    The error is infinite if a stage is not found. The slopes become those with which the dense output of the explicit
    step gives the interpolant of this step. Right after an event the slip may not have settled yet: then the slope on
    which it settles replaces the first one. ``first_slope`` keeps the first one for the next attempt. The step ends in
    ``y_new``.
    """
    n, slopes = ws.model.n_y, ws.island.slopes.start
    ws.island.stage_time = implicit_tableau.DIAGONAL * h
    # the implicit stages start from the second slope: the first one, or that on which the slip settles
    for i in range(n):
        ws.island.slopes[n + i] = ws.island.slopes[i]
    if not ws.step.uses_last_slope and not _find_first_slope(ws):
        return math.inf
    for stage in range(2, N_STAGES):
        if not _solve_stage(ws, h, stage):
            return math.inf
    weigh_part(ws, ws.coefficients.implicit_errors.start, ws.island.slopes.start, n, n, h, ws.step.y_stage.start)
    error = _relative_error(ws)
    ws.step.has_replaced_slope = True
    for i in range(n):
        ws.step.first_slope[i], ws.island.slopes[i] = ws.island.slopes[i], ws.island.slopes[n + i]
    # the errors in y_stage are evaluated, so it is free as a work array
    write_implicit_interpolant(ws, ws.island.y.start, ws.step.y_new.start, slopes, n, h, ws.step.y_stage.start)
    return error


@kernel("f8(ws, f8)")
def explicit_step(ws: Workspace, h: float) -> float:
    """Take one explicit step of ``h`` [s] of all that is integrated, to ``y_new``. Its error relative to the tolerance.

    Spins that change direction are integrated along axes in space. The stage time becomes 0, which marks explicit
    steps.
    """
    ws.island.stage_time = 0.0
    choose_spins_in_space(ws)
    # only ballistic bodies: energy accounts and inner states, behind the velocities, stay as they are
    if ws.island.n_integrated == 0:
        for i in range(ws.model.n_q + ws.model.n_u, ws.model.n_y):
            ws.step.y_new[i] = ws.island.y[i]
            ws.island.slopes[LAST_STAGE * ws.model.n_y + i] = 0.0
        return 0.0
    store_spin_slope(ws, stage=0, state=ws.island.y.start)
    for stage in range(1, N_STAGES):
        out = ws.step.y_new.start if stage == LAST_STAGE else ws.step.y_stage.start
        _write_stage(ws, h, stage, out)
        slopes = ws.island.slopes.start + stage * ws.model.n_y
        # the last stage is at the end of the step, so its slope is the first one of the next step
        slope(ws, ws.island.time + ws.coefficients.nodes[stage] * h, out, slopes, may_choose=False, of_all_bodies=False)
        store_spin_slope(ws, stage, out)
    _write_errors(ws, h)
    return max(_relative_error(ws), _error_of_second_stage(ws, h))


@kernel("void(ws, f8, i8, i8)")
def _write_stage(ws: Workspace, h: float, stage: int, out: int) -> None:
    """Write the integrated parts of the state of an explicit stage to ``out``, from the slopes of the stages before.

    These parts are spans: entries of the state that follow one another. The step is one of ``h`` [s].
    """
    y, slopes = ws.island.y.start, ws.island.slopes.start
    for span in range(ws.island.n_spans):
        i, n = ws.island.span_first[span], ws.island.span_length[span]
        stage_part(ws, ws.coefficients.stages.start, y + i, slopes + i, n, ws.model.n_y, stage, h, out + i)
    write_spins_of_stage(ws, stage, h, out)


@kernel("void(ws, f8)")
def _write_errors(ws: Workspace, h: float) -> None:
    """Write the error estimates of the integrated parts of the state, in a step of ``h`` [s], to ``y_stage``.

    These parts are spans: entries of the state that follow one another.
    """
    errors, slopes = ws.step.y_stage.start, ws.island.slopes.start
    for span in range(ws.island.n_spans):
        i, n = ws.island.span_first[span], ws.island.span_length[span]
        weigh_part(ws, ws.coefficients.error_weights.start, slopes + i, n, ws.model.n_y, h, errors + i)
    write_spin_errors(ws, h, errors)


@kernel("f8(ws, f8)")
def _step_integrated(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` [s] of all that is integrated. Its error relative to the tolerance.

    It is implicit if the last one was (its stage time is positive), or if an explicit step fails and is longer than its
    stability allows: ``relaxation`` is the rate at which slip directions relax. If no implicit step is found (its error
    is infinite), it is explicit.
    """
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
    """Take one step of ``h`` [s] from ``y`` to ``y_new``. Its error relative to the tolerance.

    It is implicit if the one that was tried before was implicit. So a part of an implicit step is implicit too, however
    short. ``slopes`` must hold the slope at ``y`` first. Its last entry becomes the slope at ``y_new``. If a force or
    slip violates its mode at some stage, ``has_doubtful_force`` is set: the search for events then looks within the
    step.
    """
    ws.step.has_doubtful_force = False
    # the implicit step before this one has replaced the slope at y
    if ws.step.has_replaced_slope:
        ws.step.has_replaced_slope = False
        for i in range(ws.model.n_y):
            ws.island.slopes[i] = ws.step.first_slope[i]
    # the stages find the least normal guards
    for contact in ws.contacts:
        contact.least_force = math.inf
    error = _step_integrated(ws, h)
    # a step that is rejected anyway needs no motion of the ballistic bodies; land gives 0, or NaN for an invalid motion
    return error + land(ws, h) if ws.island.n_ballistic > 0 and error <= TRUSTED else error


@kernel("f8(ws, f8)")
def try_length(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` [s], implicit only if an explicit one may be unstable. Error relative to the tolerance.

    ``relaxation`` is the rate at which slip directions relax [1/s]. A stage time of 0 lets the step begin as explicit.
    """
    if h * ws.step.relaxation <= LARGEST_EXPLICIT:
        ws.island.stage_time = 0.0
    return float(try_step(ws, h))
