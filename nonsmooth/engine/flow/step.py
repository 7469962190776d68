"""One step of the smooth motion: explicit, or implicit where friction turns slips too fast for that.

Between events the motion is smooth, but next to rest the direction of a slip relaxes at a rate of mu f_N G / |v|, and
an explicit step bears no more than some relaxations.  An implicit one, whose stages end with friction against their own
slip (:mod:`nonsmooth.engine.contact.implicit_slip`), is as long as its accuracy allows.
"""

from __future__ import annotations

import math

from nonsmooth.engine.flow.flight import land
from nonsmooth.engine.flow.flow import is_violated, slope
from nonsmooth.engine.flow.spins import choose_spins, keep_spins, stage_spins, weigh_spins
from nonsmooth.engine.memory import implicit_tableau, tableau
from nonsmooth.engine.memory.layout import LAST_STAGE, N_ACCOUNTS, N_STAGES
from nonsmooth.engine.memory.modes import OPEN, SLIDE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, body_at, contact_at, entry_point, kernel
from nonsmooth.engine.numerics.roots import TRUSTED
from nonsmooth.engine.numerics.runge_kutta import (
    stage_part,
    stage_state,
    weigh_part,
    weigh_slopes,
    write_implicit_interpolant,
)
from nonsmooth.engine.numerics.vectors import length

STIFF = 2.0
"""Relaxations within a step that an explicit one bears."""
_SLOWEST = 1e-3
"""Slips below this part of what counts as zero relax no faster."""
_SHARE = tableau.NODES[1] / tableau.NODES[2]
"""Where the second stage lies between the first and the third."""


@kernel("f8(S, F, i8, i8, f8)")
def _worst_error(S: Scalars, w: Floats, first: int, end: int, worst: float) -> float:
    """Return the largest error of some components relative to the tolerance, or ``worst`` if that is larger."""
    for i in range(first, end):
        explained = S.rtol * (w[S.y_scale + i] + max(abs(w[S.y + i]), abs(w[S.y_new + i])))
        error = abs(w[S.y_stage + i])
        # few of them are divided
        if error > worst * explained or error != error:
            worst = error / explained
    return worst


@kernel("f8(S, F, I)")
def _relative_error(S: Scalars, w: Floats, k: Integers) -> float:
    """Return the largest of the errors in ``y_stage`` relative to the tolerance, of what is integrated."""
    n, worst = S.n_y, 0.0
    for span in range(S.n_spans):
        first = k[S.span_first + span]
        worst = _worst_error(S, w, first, min(first + k[S.span_length + span], S.n_q + S.n_u), worst)
    if S.n_states > 0:
        worst = _worst_error(S, w, S.n_q + S.n_u + N_ACCOUNTS, n, worst)
    return worst


@kernel("f8(S, F, I, f8)")
def _unseen(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Return how far the second stage is from the first and third, relative to what a step of the tolerance explains.

    It has no weight in the result, nor in the error: a force that only it meets, as where it throws the later stages
    out of a contact, would count for nothing.  Its own error is of the order (L h)^3 where that of the step is of the
    order (L h)^5.
    """
    first = S.slopes + S.n_q
    second, third = first + S.n_y, first + 2 * S.n_y
    y_scale, y, y_new = S.y_scale + S.n_q, S.y + S.n_q, S.y_new + S.n_q
    worst, rtol = 0.0, math.sqrt(S.rtol)
    for number in range(S.n_integrated):
        body = body_at(S, w, k, k[S.integrated + number])
        for i in range(body.u, body.u + body.nu):
            change = h * abs(w[second + i] - (1.0 - _SHARE) * w[first + i] - _SHARE * w[third + i])
            explained = rtol * (w[y_scale + i] + max(abs(w[y + i]), abs(w[y_new + i])))
            if change > worst * explained:
                worst = change / explained
    return worst if worst > 1.0 else 0.0


@kernel("f8(S, F, I)")
def relaxation(S: Scalars, w: Floats, k: Integers) -> float:
    """Return how fast slip directions relax where the step starts [1/s]; 0 where an implicit step is none.

    For that some closed contact must slide, and all must be rigid.
    """
    fastest = 0.0
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        contact = contact_at(S, w, k, c)
        if contact.normal_function != 0:
            return 0.0
        if contact.mode == SLIDE and contact.averaged == OPEN:
            friction, speed = length((contact.force[1], contact.force[2])), length(contact.slip_end)
            fastest = max(fastest, contact.mobility * friction / max(speed, _SLOWEST * S.velocity_tolerance))
    return fastest


@kernel("i8(S, F, I)")
def _holds(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if no force of a closed contact violates its mode: when it begins to is for explicit steps to find."""
    for i in range(S.n_grouped):
        c = k[S.grouped + i]
        if is_violated(S, w, k, c) == 1:
            return 0
    return 1


@kernel("void(S, F, f8, i8, i8)")
def _predict_stage(S: Scalars, w: Floats, h: float, stage: int, out: int) -> None:
    """Write the state at which a stage is looked for first to ``out``, and the slope that leads there to its place."""
    n = S.n_y
    here = S.slopes + stage * n
    stage_state(S, w, S.implicit_stages, S.y, S.slopes, n, stage, h, S.y_guess)
    stage_state(S, w, S.implicit_predictor, S.y, S.slopes, n, stage, h, out)
    for i in range(n):
        w[here + i] = (w[out + i] - w[S.y_guess + i]) / S.stage_time


@kernel("i8(S, F, I, f8, i8)")
def _solve_stage(S: Scalars, w: Floats, k: Integers, h: float, stage: int) -> int:
    """Find the slope of a stage at the state that it leads to itself; return 1 if it is found.

    Friction of slips, which is stiff, is solved for; all else is iterated, until what would be left if it fell on as
    it fell last is small.
    """
    n = S.n_y
    out = S.y_new if stage == LAST_STAGE else S.y_stage
    here = S.slopes + stage * n
    _predict_stage(S, w, h, stage, out)
    S.unsettled = 0
    before = 0.0
    for _iteration in range(implicit_tableau.ITERATIONS):
        for i in range(n):
            w[S.y_guess + i] = w[here + i]
        S.ahead, S.guess = S.stage_time, S.y_guess + S.n_q
        slope(S, w, k, S.t + implicit_tableau.NODES[stage] * h, out, here, 0, 0)
        S.ahead = 0.0
        if S.unsettled == 1:
            return 0
        worst = 0.0
        for i in range(n):
            change = S.stage_time * (w[here + i] - w[S.y_guess + i])
            w[out + i] += change
            if i < S.n_q + S.n_u:
                worst = max(worst, abs(change) / (S.rtol * (w[S.y_scale + i] + abs(w[S.y + i]))))
        # where the step ends what was evaluated is to be that of its end
        left = worst * worst / (before - worst) if before > worst and stage < LAST_STAGE else worst
        if left <= implicit_tableau.SETTLED:
            return _holds(S, w, k)
        before = worst
    return 0


@kernel("i8(S, F, I)")
def _settle(S: Scalars, w: Floats, k: Integers) -> int:
    """Write the slope at the start with friction against the slip that a stage makes of it; return 1 if it is found."""
    for i in range(S.n_y):
        w[S.y_guess + i] = 0.0
    S.unsettled = 0
    S.ahead, S.guess = S.stage_time, S.y_guess + S.n_q
    slope(S, w, k, S.t, S.y, S.slopes + S.n_y, 0, 0)
    S.ahead = 0.0
    return 0 if S.unsettled == 1 else _holds(S, w, k)


@kernel("f8(S, F, I, f8)")
def _try_implicit_step(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Take one step of ``h`` whose stages end with friction against their own slip; return its relative error.

    Leaves slopes from which the dense output of the explicit step makes the interpolant of this one.  Where no implicit
    step went before the slip may not have settled, and the slope on which it will takes the place of that at the start.
    """
    n = S.n_y
    S.stage_time = implicit_tableau.DIAGONAL * h
    for i in range(n):
        w[S.slopes + n + i] = w[S.slopes + i]
    if S.follows == 0 and _settle(S, w, k) == 0:
        return math.inf
    for stage in range(2, N_STAGES):
        if _solve_stage(S, w, k, h, stage) == 0:
            return math.inf
    weigh_slopes(S, w, S.implicit_errors, S.slopes, n, h, S.y_stage)
    error = _relative_error(S, w, k)
    S.replaced = 1
    for i in range(n):
        w[S.slope_kept + i], w[S.slopes + i] = w[S.slopes + i], w[S.slopes + n + i]
    write_implicit_interpolant(S, w, S.y, S.y_new, S.slopes, n, h, S.y_stage)
    return error


@kernel("f8(S, F, I, f8)")
def explicit_step(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Take one explicit step of ``h`` of what is integrated; return its relative error."""
    n = S.n_y
    S.stage_time = 0.0
    choose_spins(S, w, k)
    if S.n_integrated == 0:
        for i in range(S.n_q + S.n_u, n):
            w[S.y_new + i] = w[S.y + i]
            w[S.slopes + LAST_STAGE * n + i] = 0.0
        return 0.0
    keep_spins(S, w, k, 0, S.y)
    for stage in range(1, N_STAGES):
        out = S.y_new if stage == LAST_STAGE else S.y_stage
        for span in range(S.n_spans):
            i, length = k[S.span_first + span], k[S.span_length + span]
            stage_part(S, w, S.stages, S.y + i, S.slopes + i, length, n, stage, h, out + i)
        stage_spins(S, w, k, stage, h, out)
        slope(S, w, k, S.t + tableau.NODES[stage] * h, out, S.slopes + stage * n, 0, 0)
        keep_spins(S, w, k, stage, out)
    for span in range(S.n_spans):
        i, length = k[S.span_first + span], k[S.span_length + span]
        weigh_part(S, w, S.error_weights, S.slopes + i, length, n, h, S.y_stage + i)
    weigh_spins(S, w, k, h, S.y_stage)
    return max(_relative_error(S, w, k), _unseen(S, w, k, h))


@kernel("f8(S, F, I, f8)")
def _integrated(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Take one step of ``h`` of what is integrated; return its relative error."""
    if S.stage_time > 0.0:
        error = _try_implicit_step(S, w, k, h)
        return error if error < math.inf else explicit_step(S, w, k, h)
    error = explicit_step(S, w, k, h)
    if error > 1.0 and h * S.relaxation > STIFF:
        implicit = _try_implicit_step(S, w, k, h)
        return implicit if implicit < math.inf else explicit_step(S, w, k, h)
    return error


@entry_point("f8(S, F, I, f8)")
def try_step(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Take one step of ``h`` from ``y`` to ``y_new``; return its error relative to the tolerance.

    It is implicit where the one tried before was, as is then a part of it, however short.  ``slopes`` must hold the
    slope at ``y`` first; its last entry becomes the slope at ``y_new``.  A force or slip that violates its mode at some
    stage raises ``suspect``.
    """
    S.suspect = 0
    if S.replaced == 1:
        S.replaced = 0
        for i in range(S.n_y):
            w[S.slopes + i] = w[S.slope_kept + i]
    for c in range(S.n_contacts):
        contact_at(S, w, k, c).least_force = 1e300
    error = _integrated(S, w, k, h)
    # where nobody trusts the step, it is not asked where the others are
    return error + land(S, w, k, h) if S.n_flying > 0 and error <= TRUSTED else error


@kernel("f8(S, F, I, f8)")
def try_length(S: Scalars, w: Floats, k: Integers, h: float) -> float:
    """Take one step of ``h``, implicit where an explicit one does not do; return its relative error."""
    if h * S.relaxation <= STIFF:
        S.stage_time = 0.0
    return float(try_step(S, w, k, h))
