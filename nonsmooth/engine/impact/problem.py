"""The energetic multiple impact, Eqs. (19)-(28), integrated in pseudo-time with all of its events located.

A contact is idle, in compression, in expansion, or held (closed without restitution).  Guards end a phase
(:mod:`nonsmooth.engine.impact.guards`); the impact ends when every contact is idle or held.  The last
contact in action gets its own clock, in which its phases are polynomials.
"""

from __future__ import annotations

import math

from nonsmooth.engine.delassus.delassus import add_product
from nonsmooth.engine.impact.clock import change_clock
from nonsmooth.engine.impact.end import account, cut_short, empty, end_trapped, faded, finish, finished
from nonsmooth.engine.impact.friction import break_away, choose_friction
from nonsmooth.engine.impact.guards import (
    ENERGY_GUARD,
    FRICTION_GUARD,
    GUARDS,
    RATE_GUARD,
    TOGETHER,
    aim,
    arm_impact_guards,
    fired_guard,
    locate_switch,
    prepare_guards,
    write_impact_guards,
)
from nonsmooth.engine.impact.rates import (
    COMPRESSION,
    EXPANSION,
    HELD,
    IDLE,
    NOISE,
    STRIDE,
    efficiency,
    evaluate_impact_forces,
    write_impact_slope,
)
from nonsmooth.engine.impact.scales import grow_scales, scale_impact
from nonsmooth.engine.impact.step import let_go, try_impact_step, try_linear_step
from nonsmooth.engine.memory.layout import LAST_STAGE
from nonsmooth.engine.memory.modes import Truncation
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    impact_state,
    kernel,
)
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.roots import TRUSTED
from nonsmooth.engine.numerics.runge_kutta import SAFETY, SHRINK, step_factor, trend
from nonsmooth.engine.numerics.vectors import length

FINISHED, ENDLESS, INVALID, MOVED = 1, 2, 3, 4
"""How an impact ended; ENDLESS: it was cut short; MOVED: it goes on, but has come to the rim of its window."""

MOST_STEPS = 100000
"""An impact, or a window of one, that asks for more steps counts as one that goes on for ever, as does one of more
windows: ever smaller bounces feed one another.  Of thousands of drawn wedges none that ended had asked for as many."""
_PATIENCE = 20
"""Steps that a slip may take next to rest without slowing down."""
_LONG = 6
"""Phases per contact after which an impact may be a cascade that never ends."""
_FIRST = 0.25
"""The first step of an impact is the tolerance to this power, in units of the shortest compression; where no force has
built up yet, forces are compared behind it."""
_SHARE = 0.7
"""The most of its deformation that a contact loses in one step of its expansion,"""
_LAST = 2.0
"""down to this deformation, in units of that after the first step of a compression."""
_SETTLING = -0.4
"""The error of an implicit step in which slips settle grows with the power 2.5 of its length: its stages are of second
order there."""
_LEAST_ERROR = 1e-2
"""An error below this tells nothing of a trend of errors."""
_AT_EVENT = 4.0 * NOISE
"""A guard this near zero at the end of a step that was aimed at it has fired, one that began small only nearer."""
_FAR = 4.0
"""A lone contact's first step, in units of the impulse that stops it: beyond all of its events."""
_NO_RETURN = 2.0**-52
"""Efficiencies up to the spacing of doubles at one count as none: what is lost is then all that was stored."""


@kernel("void(ws, f8, i8)")
def _switch(ws: Workspace, probe: float, trigger: int) -> None:
    """Change the phases whose guards have come to zero, ``trigger`` among them; they are evaluated."""
    friction = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, ws.impact.y.start, a)
        guard = GUARDS * a
        phase = active.phase
        loaded = phase == EXPANSION or phase == COMPRESSION
        if loaded and (trigger == guard + ENERGY_GUARD or active.energy_guard < TOGETHER):
            account(ws, a)
            ws.contacts[active.contact].n_waves += 1
            active.phase = IDLE
            # a contact that opens under load leaves the others with forces that they did not have
            friction += 1 if state.lost > 0.0 else 0
            empty(ws, a)
            active.sticks = False
            ws.event.n_phases += 1
            continue
        if trigger == guard + RATE_GUARD or active.rate_guard < TOGETHER:
            friction += _turn(ws, a)
            ws.event.n_phases += 1
            # where joints leave a line to move on, slip and approach come to rest together
            friction += _rests(ws, a)
        elif trigger == guard + FRICTION_GUARD or active.friction_guard < TOGETHER:
            ws.event.n_phases += 1
            if active.sticks:
                break_away(ws, a)
            else:
                # a slip that only turned far from its first direction goes on
                v1, v2 = active.slip
                speed = length(active.slip)
                contact = ws.contacts[active.contact]
                if speed > active.rest_slip:
                    contact.direction = v1 / speed, v2 / speed
                else:
                    friction = 1
    if friction > 0:
        choose_friction(ws, probe)
    prepare_guards(ws)


@kernel("i8(ws, i8)")
def _rests(ws: Workspace, a: int) -> int:
    """Return 1 if the active contact ``a``, which slides, has come to rest."""
    active = ws.actives[a]
    if active.sticks or active.friction_coefficient == 0.0:
        return 0
    return 1 if length(active.slip) <= active.rest_slip else 0


@kernel("i8(ws, i8)")
def _turn(ws: Workspace, a: int) -> int:
    """Change the normal phase of the active contact ``a``; return 1 if friction must be chosen anew."""
    active = ws.actives[a]
    state = impact_state(ws.floats, ws.impact.y.start, a)
    phase = active.phase
    if phase == COMPRESSION:
        account(ws, a)
        share = efficiency(ws, a, 0.0)
        if min(share, efficiency(ws, a, 1e-300)) > _NO_RETURN:
            active.phase = EXPANSION
            state.lost = (1.0 - share) * state.energy
            return 0
        # without restitution the stored energy is lost at once and the contact stays closed
        empty(ws, a)
        active.phase = HELD
        evaluate_impact_forces(ws, ws.impact.y.start)
        if active.normal_force < 0.0:
            active.phase = IDLE
        return 1
    if phase == HELD:
        active.phase = IDLE
        active.sticks = False
        return 0
    if phase == EXPANSION:
        account(ws, a)
        ws.contacts[active.contact].n_waves += 1
    active.phase = COMPRESSION
    return 1 if phase == IDLE else 0


@kernel("void(ws, f8, f8)")
def start_impact(ws: Workspace, probe: float, seed: float) -> None:
    """Set the phases in which the active contacts start, and their friction."""
    for i in range(STRIDE * ws.problem.n_active):
        ws.impact.y[i] = 0.0
    ws.event.n_phases = 0
    ws.step.guard = -1
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, ws.impact.y.start, a)
        active.energy_stored = active.energy_returned = active.work_accounted = 0.0
        active.sticks = False
        pushed = active.gap_rate_before < -NOISE * ws.impact.speed_scale
        if seed > 0.0 and ws.contacts[active.contact].has_no_force:
            # an impact without collision starts from a seed of deformation instead of a speed
            pushed = True
            state.deformation = 1e-3 * active.deformation_scale
        active.phase = COMPRESSION if pushed else IDLE
        ws.event.n_phases += 1 if pushed else 0
    choose_friction(ws, probe)
    # a resting contact that the others press in takes part from the start
    pressed = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        growth = add_product(ws, 0.0, a, 0, ws.problem.forces.start)
        if active.phase == IDLE and growth < 0.0 and active.gap_rate_before <= ws.impact.rest_speed:
            active.phase = COMPRESSION
            ws.event.n_phases += 1
            pressed = 1
    if pressed == 1:
        choose_friction(ws, probe)


@kernel("b1(ws)")
def _stopping(ws: Workspace) -> bool:
    """Return 1 if some slip has come next to rest and is still slowing down, or does not get away from there."""
    slow = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.phase == IDLE or active.sticks or active.friction_coefficient == 0.0:
            continue
        v1, v2 = active.slip
        if length(active.slip) > active.rest_slip:
            continue
        power = v1 * add_product(ws, 0.0, a, 1, ws.problem.forces.start) + v2 * add_product(
            ws, 0.0, a, 2, ws.problem.forces.start
        )
        slow = 1
        if power < 0.0:
            ws.impact.slow_steps = _PATIENCE
    ws.impact.slow_steps = ws.impact.slow_steps + 1 if slow == 1 else 0
    if ws.impact.slow_steps <= _PATIENCE:
        return False
    ws.impact.slow_steps = 0
    return True


@kernel()
def _fade(ws: Workspace) -> None:
    """End what is left, below the tolerance, at contacts that the wave has passed.

    They start again at twice the rate, so that the two do not chase each other.
    """
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        passed = active.phase == EXPANSION or (active.phase == COMPRESSION and contact.n_waves > 0)
        # the energy is known to the tolerance only, the deformation better
        weak = (
            active.normal_force * impact_state(ws.floats, ws.impact.y.start, a).deformation
            <= ws.impact.faint_rate * ws.impact.faint_rate * active.energy_scale
        )
        if passed and weak and abs(active.gap_rate) <= 0.5 * ws.impact.faint_rate * ws.impact.speed_scale:
            account(ws, a)
            contact.n_waves += 1
            active.phase = IDLE
            active.sticks = False
            empty(ws, a)
            ws.event.n_phases += 1
    prepare_guards(ws)


@kernel("b1(ws)")
def _leaves(ws: Workspace) -> bool:
    """Return 1 if a contact at the rim of the window acts, so that its neighbours may be missing."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.phase != IDLE and ws.contacts[active.contact].is_at_rim:
            return True
    return False


@entry_point("i8(ws, f8)")
def energetic_impact(ws: Workspace, seed: float) -> int:
    """Carry the active contacts from the rates ``impact_z0`` through the impact; return how it ended.

    Leaves the impulses in ``impulse`` and, per active contact, the energies ``stored`` in compression,
    ``returned`` in expansion and ``rubbed`` away by friction.  An impact without collision needs a speed for its
    ``seed`` [m/s], others have none.
    """
    ws.impact.lone_contact = 0 if ws.problem.n_active == 1 else -1
    ws.impact.may_be_lone = True
    ws.event.truncation = Truncation.NONE
    ws.impact.slow_steps = 0
    shortest = scale_impact(ws, seed)
    if not shortest > 0.0:
        return INVALID
    h = first_step(ws, shortest)
    start_impact(ws, h, seed)
    return run_impact(ws, h, shortest, 0)


@kernel("f8(ws, f8)")
def first_step(ws: Workspace, shortest: float) -> float:
    """Return the first step of an impact whose shortest compression takes the time given."""
    return shortest * (_FAR if ws.problem.n_active == 1 else float(ws.tolerance.impact) ** _FIRST)


@entry_point("i8(ws, f8, f8, i8)")
def run_impact(ws: Workspace, h: float, shortest: float, windowed: int) -> int:
    """Integrate from the phases and the state at hand, with a first step of ``h``; return how it ended.

    The active contacts are all of the impact, or those of a window of it (1).
    """
    ws.impact.aimed_guard = -1
    prepare_guards(ws)
    write_impact_slope(ws, ws.impact.slopes.start)
    before, error_before = 0.0, 1.0
    for _step in range(MOST_STEPS):
        if interrupted(ws, 8 * ws.problem.n_active):
            return ENDLESS
        if finished(ws):
            finish(ws)
            return FINISHED
        ws.impact.aimed_guard = -1
        let_go(ws)
        h = aim(ws, h) if ws.impact.lone_contact >= 0 else _graded(ws, h)
        linear = try_linear_step(ws, h) if ws.impact.aimed_guard >= 0 else 0
        error = try_impact_step(ws, h) if linear == 0 else 0.0
        ws.totals.n_impact_steps += 1
        if not error <= 1.0:
            if not error < math.inf and h < NOISE * shortest:
                # a law that still has no finite value has none
                return INVALID
            h *= _shorter(ws, error)
            continue
        located = _step_to_switch(ws, h, linear)
        if not located <= TRUSTED:
            if not located < math.inf and h < NOISE * shortest:
                return INVALID
            h *= 0.25
            continue
        for i in range(STRIDE * ws.problem.n_active):
            ws.impact.y[i] = ws.impact.y_new[i]
        grow_scales(ws)
        _stop(ws)
        if ws.step.guard < 0:
            factor, error = step_factor(error), max(_LEAST_ERROR, error)
            if before > 0.0 and ws.impact.lone_contact < 0:
                factor = min(factor, trend(error, error_before, h / before))
            before, error_before = h, error
            h *= factor
            _go_on(ws, shortest)
            continue
        before = 0.0
        h = _pass_switch(ws, h, shortest, windowed)
        if windowed == 1 and ws.impact.lone_contact < 0 and _leaves(ws):
            ws.impact.h = h
            return MOVED
        write_impact_slope(ws, ws.impact.slopes.start)
    cut_short(ws)
    finish(ws)
    return ENDLESS


@kernel("f8(ws, f8)")
def _shorter(ws: Workspace, error: float) -> float:
    """Return by what part a step of that error is too long, one in which slips settle by the order that it has left."""
    if not error < math.inf:
        return 0.1
    return max(SHRINK, SAFETY * error**_SETTLING) if ws.problem.is_turning else float(step_factor(error))


@kernel()
def _stop(ws: Workspace) -> None:
    """Let stick what the step has stopped; an implicit one leaves slips in any direction."""
    if ws.problem.is_turning:
        ws.problem.is_turning = False
        _orient(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        ws.event.n_phases += active.was_halted
        active.was_halted = False


@kernel("f8(ws, f8, i8)")
def _step_to_switch(ws: Workspace, h: float, linear: int) -> float:
    """Shorten the accepted step to the first guard that fires in it, kept in ``trigger``; return the error of that.

    It is 0 where none fires, and ``trigger`` -1, or where the step was aimed at the guard.
    """
    # the last stage has left the forces at the end of the step
    write_impact_guards(ws, ws.impact.y_new.start)
    ws.step.guard = fired_guard(ws, -1)
    met = ws.impact.aimed_guard >= 0 and abs(ws.impact.guards[max(0, ws.impact.aimed_guard)]) <= _at_event(ws)
    if met and (ws.step.guard < 0 or ws.step.guard == ws.impact.aimed_guard):
        ws.step.guard = ws.impact.aimed_guard
    elif ws.step.guard >= 0:
        if linear == 1:
            # locating takes the interpolant of the full step
            try_impact_step(ws, h)
            write_impact_guards(ws, ws.impact.y_new.start)
        return float(locate_switch(ws, h))
    return 0.0


@kernel("void(ws, f8)")
def _go_on(ws: Workspace, shortest: float) -> None:
    """Prepare the next step where no guard has fired in the last."""
    if _stopping(ws):
        # close to rest the direction of the slip is stiff, and what is left of it below the tolerance
        choose_friction(ws, first_step(ws, shortest))
        prepare_guards(ws)
        end_trapped(ws)
        write_impact_slope(ws, ws.impact.slopes.start)
        ws.event.n_phases += 1
        return
    _orient(ws)
    if end_trapped(ws):
        prepare_guards(ws)
        write_impact_slope(ws, ws.impact.slopes.start)
        return
    arm_impact_guards(ws)
    n = STRIDE * ws.problem.n_active
    for i in range(n):
        ws.impact.slopes[i] = ws.impact.slopes[LAST_STAGE * n + i]


@kernel("f8(ws, f8, f8, i8)")
def _pass_switch(ws: Workspace, h: float, shortest: float, windowed: int) -> float:
    """Change the phases at the guard that fired, and the clock, and end what is over; return the next step."""
    following = max(h, shortest * ws.tolerance.impact**_FIRST)
    if ws.impact.lone_contact >= 0:
        following = _FAR * ws.actives[ws.impact.lone_contact].impulse_scale
    _switch(ws, first_step(ws, shortest), ws.step.guard)
    if ws.problem.n_active > 1 and change_clock(ws):
        following = shortest if ws.impact.lone_contact < 0 else _FAR * ws.actives[ws.impact.lone_contact].impulse_scale
    if ws.event.n_phases > _LONG * (ws.impact.n_colliding if windowed == 1 else ws.problem.n_active) and faded(ws):
        cut_short(ws)
    end_trapped(ws)
    if windowed == 1:
        _fade(ws)
    return float(following)


@kernel("f8(ws)")
def _at_event(ws: Workspace) -> float:
    """Return how near zero the guard that is aimed at counts as fired.

    Of a contact that opens under load the energy guard is what is still to come back, a part of all that may be small.
    """
    a = ws.impact.lone_contact
    active = ws.actives[a]
    state = impact_state(ws.floats, ws.impact.y.start, a)
    lost = state.lost
    if ws.impact.aimed_guard != GUARDS * a + ENERGY_GUARD or lost == 0.0:
        return _AT_EVENT
    share = efficiency(ws, a, 0.0)
    returned = lost * share / ((1.0 - share) * active.energy_scale)
    return float(_AT_EVENT * min(1.0, returned))


@kernel()
def _orient(ws: Workspace) -> None:
    """Take the present slip directions as those of the step that begins."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        v1, v2 = active.slip
        speed = length(active.slip)
        if active.phase != IDLE and not active.sticks and speed > active.rest_slip:
            contact = ws.contacts[active.contact]
            contact.direction = v1 / speed, v2 / speed
            active.friction_guard = NOISE + speed / ws.impact.speed_scale


@kernel("f8(ws, f8)")
def _graded(ws: Workspace, h: float) -> float:
    """Shorten the step towards the end of an expansion, where the force law is not smooth, geometrically."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, ws.impact.y.start, a)
        x, rate = state.deformation, impact_state(ws.floats, ws.impact.slopes.start, a).deformation
        goes = active.phase == EXPANSION and h * rate < -_SHARE * x
        if goes and x > _LAST * ws.tolerance.impact**0.4 * active.deformation_scale:
            h = -_SHARE * x / rate
    return h
