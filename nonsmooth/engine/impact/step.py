"""One step inside an impact: explicit, or implicit if the direction of a slip next to rest makes it stiff.

A contact may leave its static bound slowly, or slip with little more force than friction takes. Its slip v then stays
near rest for long. The direction of v follows the forces within an impulse of the order of |v|, and explicit steps must
not be longer than that. The stages of an implicit step end with friction against their own slip
(:mod:`nonsmooth.engine.contact.implicit_slip`), as in the motion. A slip that keeps its direction, as the terminal one
does, is exact in such a step of any length.

The explicit pair is tried first: it costs less, and few steps are stiff. Only a step that it rejects is checked for
stiffness.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.implicit_slip import oppose_slips
from nonsmooth.engine.contact.problem import slip_coefficient
from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.rates import evaluate_impact_rates, impact_slope, write_impact_slope
from nonsmooth.engine.impact.scales import reached_energy
from nonsmooth.engine.impact.state import ContactState, is_loaded, normal_force, state_at, state_size
from nonsmooth.engine.memory import implicit_tableau
from nonsmooth.engine.memory.layout import DEFORMATION, IMPACT_STATE, LAST_STAGE, N_STAGES
from nonsmooth.engine.memory.modes import Mode, Phase
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, entry_point, kernel
from nonsmooth.engine.numerics.arrays import copy_numbers
from nonsmooth.engine.numerics.runge_kutta import stage_part, weigh_part, write_implicit_interpolant
from nonsmooth.engine.numerics.vectors import length, unit

_STIFF = 1.0
"""Relaxations of the direction of a slip within a step, above which an explicit step is too long."""
_SETTLED = 10.0
"""Relaxations of the direction while the slip changes by its own size, above which it is in equilibrium."""
_CAUTION = 4.0
"""Factor by which errors of implicit steps count. Their estimate is of low order, and they add up."""
_STRAIGHT = 1e-13
"""Second difference of slopes that counts as zero, relative to the slopes. It is round-off of a few operations."""


# --- explicit steps ---------------------------------------------------------------------------------------------------


@entry_point("f8(ws, f8)")
def try_impact_step(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` in pseudo-time to ``y_new``. Returns its error, relative to the tolerance [1].

    A stiff step that the explicit pair rejects is taken implicitly. A slip that an implicit step stops sticks from then
    on, unless the step is tried again. The slope at the start must be in the first of ``slopes``.
    """
    reset_attempt(ws)
    n, slopes = state_size(ws), ws.impact.slopes.start
    for stage in range(1, N_STAGES):
        # the state of the last stage is that at the end of the step
        out = ws.impact.y_new.start if stage == LAST_STAGE else ws.impact.y_stage.start
        stage_part(ws, ws.coefficients.stages.start, ws.impact.y.start, slopes, n, n, stage, h, out)
        impact_slope(ws, out, slopes + stage * n)
    # the errors take the place of the state of a stage
    weigh_part(ws, ws.coefficients.error_weights.start, slopes, n, n, h, ws.impact.y_stage.start)
    error = _relative_error(ws, ws.impact.y_stage.start)
    if not error <= 1.0:
        if _check_stiffness(ws, h):
            # if both are rejected, the next step need be no shorter than the better one demands
            return min(_try_implicit_step(ws, h), error)
        # the stiffness check has left other rates, but guards are written from those at the end
        evaluate_impact_rates(ws, ws.impact.y_new.start)
    return error


@kernel()
def reset_attempt(ws: Workspace) -> None:
    """Undo the last attempt of a step: slips that it stopped slide again, and the step counts as explicit.

    The stop of a slip in an accepted step is no longer marked as halted, so it is kept.
    """
    ws.impact.is_step_implicit = False
    for active in ws.actives:
        if active.was_halted:
            active.was_halted = active.sticks = False


@kernel("f8(ws, i8)")
def _relative_error(ws: Workspace, errors: int) -> float:
    """Largest error of the active contacts, relative to the tolerance [1], from the errors of a state at ``errors``.

    It is infinite if an error is not finite. ``errors`` is an offset of the floats.
    """
    worst = 0.0
    for active in ws.actives:
        # the numbers of an idle contact do not change
        if active.phase != Phase.IDLE:
            worst = _worse_error(ws, active, state_at(ws, errors, active), worst)
            # a maximum does not show what is not a number
            if not worst < math.inf:
                return math.inf
    return worst / float(ws.tolerance.impact)


@kernel("f8(ws, ActiveContact, impact_state, f8)")
def _worse_error(ws: Workspace, active: ActiveContact, error: ContactState, worst: float) -> float:
    """Larger one of ``worst`` and the ``error`` of an active contact, relative to its scales [1]; infinite for a NaN.

    An error of the impulses counts by the energy p . G p of what it moves, relative to the energy of the contact.
    Energies count relative to that energy, too. Quotients are formed only where they exceed ``worst``.
    """
    energy, own = reached_energy(ws, active), diagonal_block(ws, active.index).entries
    p0, p1, p2 = error.impulse[0], error.impulse[1], error.impulse[2]
    moved = own[0] * p0 * p0 + own[1] * p0 * p1 + own[2] * p0 * p2
    moved = moved + own[3] * p1 * p0 + own[4] * p1 * p1 + own[5] * p1 * p2
    moved = abs(moved + own[6] * p2 * p0 + own[7] * p2 * p1 + own[8] * p2 * p2)
    deformed, worked, dissipated = abs(error.deformation), abs(error.work), abs(error.dissipated)
    stored, lost = abs(error.energy), abs(error.lost)
    if not moved + deformed + worked + dissipated + stored + lost < math.inf:
        return math.inf
    accounted = max(max(worked, dissipated), max(stored, lost))
    if moved > worst * worst * energy:
        worst = math.sqrt(moved / energy)
    if deformed > worst * active.deformation_scale:
        worst = deformed / active.deformation_scale
    if accounted > worst * energy:
        worst = accounted / energy
    return worst


# --- steps of a lone contact ------------------------------------------------------------------------------------------


@kernel("b1(ws, f8)")
def try_linear_step(ws: Workspace, h: float) -> bool:
    """Take one step of ``h`` to ``y_new`` by the midpoint rule. True if the slope is linear, so that it is exact.

    A contact that alone has a load moves so while its slip keeps its direction. The slope at the end shows whether it
    did. Slopes and forces at the end are left as those of the last stage. If False, the caller takes an ordinary step,
    which writes all of them anew.
    """
    n = state_size(ws)
    middle, end = ws.impact.slopes.start + n, ws.impact.slopes.start + LAST_STAGE * n
    for i in range(n):
        ws.impact.y_stage[i] = ws.impact.y[i] + 0.5 * h * ws.impact.slopes[i]
    impact_slope(ws, ws.impact.y_stage.start, middle)
    for i in range(n):
        ws.impact.y_new[i] = ws.impact.y[i] + h * ws.floats[middle + i]
    impact_slope(ws, ws.impact.y_new.start, end)
    for active in ws.actives:
        if not _is_straight(ws, active, middle, end):
            return False
    return True


@kernel("b1(ws, ActiveContact, i8, i8)")
def _is_straight(ws: Workspace, active: ActiveContact, middle: int, end: int) -> bool:
    """True if the slope of an active contact is linear over the step: those at the start, ``middle`` and ``end`` agree.

    The last two are offsets of the floats. The second difference of the three slopes must be round-off. A component of
    an impulse is compared with the force: one that is round-off relative to the force is straight.
    """
    force = abs(active.force[0]) + abs(active.force[1]) + abs(active.force[2])
    for component in range(IMPACT_STATE):
        i = IMPACT_STATE * active.index + component
        first, half, last = ws.impact.slopes[i], ws.floats[middle + i], ws.floats[end + i]
        size = abs(first) + abs(last) + abs(half)
        # impulses come first in the state
        if component < DEFORMATION:
            size = max(size, force)
        if not abs(first + last - 2.0 * half) <= _STRAIGHT * size:
            return False
    return True


# --- implicit steps ---------------------------------------------------------------------------------------------------


@kernel("b1(ws, f8)")
def _check_stiffness(ws: Workspace, h: float) -> bool:
    """True if the direction of a slip follows the forces too fast for an explicit step of ``h``, and is in equilibrium.

    Then an implicit step is tried. A slip that passes close to rest turns fast and changes fast. Its further direction
    depends on every digit, which explicit steps find. Leaves the rates at the start of the step.
    """
    evaluate_impact_rates(ws, ws.impact.slopes.start)
    for active in ws.actives:
        (v1, v2), (before_1, before_2) = active.slip, active.slip_before
        # the rates of a slope are z_0 + G f, so that G f is left
        active.slip_acceleration = v1 - before_1, v2 - before_2
    evaluate_impact_rates(ws, ws.impact.y.start)
    for active in ws.actives:
        own = diagonal_block(ws, active.index)
        # over the slip speed, this is the rate with which the direction relaxes
        turning = length(state_at(ws, ws.impact.slopes.start, active).friction) * max(own.t11, own.t22)
        is_settled = not active.sticks and turning > _SETTLED * length(active.slip_acceleration)
        if is_settled and h * turning > _STIFF * length(active.slip):
            return True
    return False


@kernel("f8(ws, f8)")
def _try_implicit_step(ws: Workspace, h: float) -> float:
    """Take one step of ``h`` to ``y_new`` whose stages end with friction against their own slip.

    Returns its error relative to the tolerance [1], infinite if a stage has no solution. The slopes are left so that
    the dense output of the explicit step is the interpolant of this one.
    """
    # the errors take the place of the state of a stage
    n, errors, slopes = state_size(ws), ws.impact.y_stage.start, ws.impact.slopes.start
    _begin_implicit_step(ws)
    has_solution = True
    # the slopes of stages 0 and 1 are that at the start
    for stage in range(2, N_STAGES):
        has_solution = has_solution and _solve_stage(ws, h, stage)
    # a slip that the step has stopped sticks at its end; it is marked even if the step fails, so that it can be undone
    for active in ws.actives:
        active.was_halted = active.mode_past == Mode.SLIDE and active.sticks
    if not has_solution:
        return math.inf
    weigh_part(ws, ws.coefficients.implicit_errors.start, slopes, n, n, h, errors)
    error = _CAUTION * _relative_error(ws, errors)
    # the errors are not needed any more: their place serves as a work array
    write_implicit_interpolant(ws, ws.impact.y.start, ws.impact.y_new.start, slopes, n, h, errors)
    return error


@kernel()
def _begin_implicit_step(ws: Workspace) -> None:
    """Set the modes in which the contacts begin an implicit step, and the slope of its first stage.

    That slope is the slope at the start, which is stored before it. Marks the step as implicit: its slips may reverse.
    """
    ws.impact.is_step_implicit = True
    for active in ws.actives:
        active.mode_past = Mode.STICK if active.sticks else Mode.SLIDE
        if active.phase == Phase.IDLE:
            active.mode_past = Mode.OPEN
        null_space_force = ws.contacts[active.contact].null_space_force
        for r in range(3):
            # redundant impulses are those of least norm; the motion chooses its forces anew after the impact
            null_space_force[r] = 0.0
    n, slopes = state_size(ws), ws.impact.slopes.start
    copy_numbers(ws.floats, slopes, n, slopes + n)


@kernel("b1(ws, f8, i8)")
def _solve_stage(ws: Workspace, h: float, stage: int) -> bool:
    """Find the slope of an implicit stage of a step of ``h``, at the state to which this slope leads. True if found.

    The friction of slips, which is stiff, is solved for. Deformations, which are not, are iterated. False if no
    friction opposes the slips, or if the iteration does not settle.
    """
    n, slopes = state_size(ws), ws.impact.slopes.start
    out = ws.impact.y_new.start if stage == LAST_STAGE else ws.impact.y_stage.start
    # the slope of the stage, its last iterate, and the pseudo-time from the explicit part of the stage to its end
    here, guess, ahead = slopes + stage * n, ws.impact.y_guess.start, implicit_tableau.DIAGONAL * h
    # the slope of the stage before is the first guess
    copy_numbers(ws.floats, here - n, n, here)
    for _ in range(implicit_tableau.ITERATIONS):
        stage_part(ws, ws.coefficients.implicit_stages.start, ws.impact.y.start, slopes, n, n, stage, h, out)
        copy_numbers(ws.floats, here, n, guess)
        _write_problem(ws, ahead, out, guess)
        if not oppose_slips(ws):
            return False
        for active in ws.actives:
            impulse = state_at(ws, out, active).impulse
            for r in range(3):
                impulse[r] += ahead * active.force[r]
        evaluate_impact_rates(ws, out)
        write_impact_slope(ws, here)
        _advance_stage(ws, ahead, out, here, guess)
        # the guess now holds the last change of the state
        if _relative_error(ws, guess) <= implicit_tableau.SETTLED:
            return True
    return False


@kernel("void(ws, f8, i8, i8, i8)")
def _advance_stage(ws: Workspace, ahead: float, out: int, here: int, guess: int) -> None:
    """Add ``ahead`` times the slope at ``here`` to the numbers of the state at ``out`` other than impulses.

    The impulses have been added with the forces. The last change of the slope, times ``ahead``, replaces the ``guess``,
    for the test of convergence. The slope depends on no energy, so energies count as unchanged.
    """
    # ahead: pseudo-time of the implicit part of the stage
    for i in range(state_size(ws)):
        component = i % IMPACT_STATE
        change = ws.floats[here + i] - ws.floats[guess + i] if component <= DEFORMATION else 0.0
        ws.floats[guess + i] = ahead * change
        if component >= DEFORMATION:
            ws.floats[out + i] += ahead * ws.floats[here + i]


@kernel("void(ws, f8, i8, i8)")
def _write_problem(ws: Workspace, ahead: float, y: int, guess: int) -> None:
    """Write the contact problem at the end of a stage, which is ``ahead`` in pseudo-time from the state at ``y``.

    The normal forces are those at the end, by the ``guess`` of the slope there. The slips are those with which the
    stage would end without forces.
    """
    n = state_size(ws)
    # go to the guessed end for the normal forces, and back below for the slips
    for i in range(n):
        ws.floats[y + i] += ahead * ws.floats[guess + i]
    evaluate_impact_rates(ws, y)
    ws.problem.acceleration_scale = 0.0
    for active in ws.actives:
        _write_given(ws, active, y, guess)
    for i in range(n):
        ws.floats[y + i] -= ahead * ws.floats[guess + i]
    evaluate_impact_rates(ws, y)
    for active in ws.actives:
        # a held contact keeps its gap rate; a slip at rest, or of a contact that sticks, is not removed but kept
        moves = active.mode_past == Mode.SLIDE and length(active.slip) > active.rest_slip
        active.free[0] = 0.0
        for r in range(1, 3):
            active.free[r] = active.rate[r] / ahead if moves else 0.0


@kernel("void(ws, ActiveContact, i8, i8)")
def _write_given(ws: Workspace, active: ActiveContact, y: int, guess: int) -> None:
    """Write what is known of an active contact at the state ``y``: normal force, mode, friction and slip direction.

    The direction is opposite to the friction of the ``guess``. Forces of loaded contacts follow from their deformation.
    """
    own = diagonal_block(ws, active.index)
    active.has_given_force, active.mode_tried, active.is_at_rest = is_loaded(active), active.mode_past, False
    if active.has_given_force:
        active.given_force = normal_force(ws, active, state_at(ws, y, active).deformation)
        active.normal_force = active.given_force
    if active.mode_past == Mode.SLIDE:
        active.friction_coefficient = slip_coefficient(ws, active.contact, length(active.slip))
        # the contact problem treats a slip that friction may stop as one that begins
        active.is_at_rest = active.friction_coefficient > 0.0
        t1, t2 = state_at(ws, guess, active).friction
        if length((t1, t2)) > 0.0:
            active.direction = unit((-t1, -t2))
    acceleration = max(own.nn, own.t11, own.t22) * abs(active.normal_force)
    ws.problem.acceleration_scale = max(ws.problem.acceleration_scale, acceleration)
