"""The energetic multiple impact, Eqs. (19) to (28), integrated in pseudo-time with all of its events located.

    start ---> attempt ---> accept ---> no event ---> attempt
                  ^            |
               shorter       event ---> switch phases, change the clock ---> attempt

attempt  Takes a step of the Runge-Kutta pair, and steps to the first guard that fires within it. A lone contact aims at
         its next event instead (:mod:`nonsmooth.engine.impact.clock`).
accept   Takes over the state, and lets slips stick that the step has stopped.
switch   Changes the phases whose guards vanish (:mod:`nonsmooth.engine.impact.phases`).

The impact ends when no contact is loaded (:mod:`nonsmooth.engine.impact.end`). The right-hand side is smooth between
its events only. An integrator that steps over them, as one with impulses of fixed size does, is of first order; and it
does not find which of two contacts turns first, which decides how the energy is distributed.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.engine.impact.clock import Aim, aim_at_event, change_clock, has_arrived
from nonsmooth.engine.impact.end import cut_short, end_trapped, has_faded, is_finished, write_impact_results
from nonsmooth.engine.impact.friction import choose_friction, count_slow_step, count_stopped_slips, orient
from nonsmooth.engine.impact.guards import NO_GUARD, arm_impact_guards, first_fired, prepare_guards, write_impact_guards
from nonsmooth.engine.impact.location import Switch, locate_switch
from nonsmooth.engine.impact.phases import end_faint, has_reached_rim, start_phases, switch_phases
from nonsmooth.engine.impact.rates import write_impact_slope
from nonsmooth.engine.impact.scales import raise_impulse_scales, scale_impact
from nonsmooth.engine.impact.state import NOISE, state_size
from nonsmooth.engine.impact.step import reset_attempt, try_impact_step, try_linear_step
from nonsmooth.engine.impact.step_length import first_step, graded_step, lone_step, rejection_factor, step_after_switch
from nonsmooth.engine.memory.layout import LAST_STAGE
from nonsmooth.engine.memory.modes import NO_CONTACT, ImpactOutcome, Truncation
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel, result
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.arrays import copy_numbers
from nonsmooth.engine.numerics.roots import TRUSTED
from nonsmooth.engine.numerics.runge_kutta import step_factor, trend

MOST_STEPS = 100000
"""Largest number of steps of an impact or of one window of it, and largest number of windows.

Ever smaller bounces of several contacts may excite each other without end.
"""
_WORK = 8
"""Work of a step, in evaluations of a contact: seven stages and the guards."""
_LONG = 6
"""Number of phases per contact after which an impact may be a cascade without end."""
_LEAST_ERROR = 1e-2
"""Relative error below which errors show no trend [1]."""
_UNTRUSTED = 0.25
"""Factor by which a step is shortened if the step to a switch within it has too large an error."""


@result
class ImpactPace(NamedTuple):
    """Lengths and error that determine the length of the next step."""

    h: float
    """Length of the next step, in pseudo-time."""
    h_before: float
    """Length of the last step, or 0 at the start and after a switch of phases."""
    error_before: float
    """Error of the last step, relative to the tolerance."""


@result
class Attempt(NamedTuple):
    """Result of an attempt of a step."""

    h: float
    """Length that was tried, in pseudo-time."""
    error: float
    """Error, relative to the tolerance."""
    guard: int
    """Guard at whose root the step ends, or ``NO_GUARD``."""
    is_accepted: bool
    """The error is small enough."""
    h_again: float
    """Length to try next if the attempt is not accepted, in pseudo-time."""


# --- the impact -------------------------------------------------------------------------------------------------------


@entry_point("ImpactOutcome(ws, f8)")
def energetic_impact(ws: Workspace, seed: float) -> ImpactOutcome:
    """Integrate the impact of the active contacts, from their rates before the impact.

    Writes the impulse of every active contact [N s] and its energies stored in compression, returned in expansion and
    dissipated by friction [J]. The result is ``FINISHED``, or the reason why the impact has no end
    (:class:`ImpactOutcome`). ``seed`` [m/s] is the speed that scales an impact without collision, which has no speed
    of approach (Painleve's paradox). For other impacts it is zero.
    """
    # integrate a single contact over its normal impulse. If all other contacts become idle later, change_clock replaces
    # the common variable of integration by the impulse of the last contact
    ws.impact.lone_contact = 0 if len(ws.actives) == 1 else NO_CONTACT
    ws.impact.may_be_lone, ws.impact.is_step_implicit = True, False
    ws.event.truncation = Truncation.NONE
    ws.impact.slow_steps = 0
    shortest = scale_impact(ws, seed)
    # negative if a force law has no scale
    if not shortest > 0.0:
        return ImpactOutcome.INVALID
    h = first_step(ws, shortest)
    start_phases(ws, h, seed)
    return run_impact(ws, h, shortest, is_windowed=False)


@entry_point("ImpactOutcome(ws, f8, f8, b1)")
def run_impact(ws: Workspace, h: float, shortest: float, is_windowed: bool) -> ImpactOutcome:
    """Integrate from the present phases and state, with a first step of ``h`` in pseudo-time.

    The active contacts are all contacts of the impact or, if ``is_windowed``, of a part of it. ``shortest`` is the
    pseudo-time of the shortest compression.

    Returns one of these outcomes:

    FINISHED: no contact is loaded.
    MOVED: a contact at the rim of the window, its outermost layer, is not idle. The impact must continue in another
    window, with the first step ``impact.h``.
    INVALID: a law returned a number that is not finite.
    ENDLESS: the run was interrupted, or the impact took too many steps.
    """
    prepare_guards(ws)
    write_impact_slope(ws, ws.impact.slopes.start)
    # there is no step before the first one
    pace = ImpactPace(h=h, h_before=0.0, error_before=1.0)
    for _ in range(MOST_STEPS):
        # callers discard an interrupted impact, so it needs no results
        if interrupted(ws, _WORK * len(ws.actives)):
            return ImpactOutcome.ENDLESS
        if is_finished(ws):
            write_impact_results(ws)
            return ImpactOutcome.FINISHED
        attempt = _attempt(ws, pace.h)
        if not attempt.is_accepted:
            if not attempt.error < math.inf and attempt.h < NOISE * shortest:
                # a law without a finite value here has none at any step
                return ImpactOutcome.INVALID
            pace = pace._replace(h=attempt.h_again)
            continue
        copy_numbers(ws.floats, ws.impact.y_new.start, state_size(ws), ws.impact.y.start)
        raise_impulse_scales(ws)
        count_stopped_slips(ws)
        if attempt.guard == NO_GUARD:
            pace = _next_pace(ws, pace, attempt)
            _prepare_after_smooth_step(ws, shortest)
            continue
        pace = pace._replace(h=_pass_switch(ws, attempt, shortest, is_windowed), h_before=0.0)
        # a lone contact has no deformation with which the next window could continue
        if is_windowed and ws.impact.lone_contact == NO_CONTACT and has_reached_rim(ws):
            ws.impact.h = pace.h
            return ImpactOutcome.MOVED
        write_impact_slope(ws, ws.impact.slopes.start)
    cut_short(ws)
    write_impact_results(ws)
    return ImpactOutcome.ENDLESS


# --- a step -----------------------------------------------------------------------------------------------------------


@kernel("Attempt(ws, f8)")
def _attempt(ws: Workspace, h: float) -> Attempt:
    """Try a step of ``h`` in pseudo-time, or a shorter one that ends at an event.

    If it is accepted, ``y_new`` holds the state at its end. A lone contact, whose events are known in closed form, aims
    at the next one. It may then move so simply that the midpoint rule is exact.
    """
    reset_attempt(ws)
    aimed = aim_at_event(ws, h) if ws.impact.lone_contact != NO_CONTACT else Aim(h=graded_step(ws, h), guard=NO_GUARD)
    is_linear = aimed.guard != NO_GUARD and try_linear_step(ws, aimed.h)
    error = 0.0 if is_linear else try_impact_step(ws, aimed.h)
    ws.totals.n_impact_steps += 1
    if not error <= 1.0:
        h_again = aimed.h * rejection_factor(ws, error)
        return Attempt(h=aimed.h, error=error, guard=NO_GUARD, is_accepted=False, h_again=h_again)
    switch = _step_to_switch(ws, aimed, is_linear)
    # the shorter step to the switch may have a larger error than the full one, if the motion is not smooth in it
    if not switch.error <= TRUSTED:
        h_again = aimed.h * _UNTRUSTED
        return Attempt(h=aimed.h, error=switch.error, guard=NO_GUARD, is_accepted=False, h_again=h_again)
    # h: also if the step ended at an event, the next one starts from the length that was accurate enough
    return Attempt(h=aimed.h, error=error, guard=switch.guard, is_accepted=True, h_again=aimed.h)


@kernel("Switch(ws, Aim, b1)")
def _step_to_switch(ws: Workspace, aimed: Aim, is_linear: bool) -> Switch:
    """Shorten an accepted step to the first guard that fires in it. It is kept if it ends where it was aimed.

    ``is_linear`` is true for a step of the midpoint rule, which has no interpolant.
    """
    # the last stage of the step has left the forces at its end
    write_impact_guards(ws, ws.impact.y_new.start)
    fired = first_fired(ws, NO_GUARD)
    if has_arrived(ws, aimed) and (fired == NO_GUARD or fired == aimed.guard):
        return Switch(guard=aimed.guard, error=0.0)
    if fired == NO_GUARD:
        return Switch(guard=NO_GUARD, error=0.0)
    if is_linear:
        # location needs the interpolant of the full step
        try_impact_step(ws, aimed.h)
        write_impact_guards(ws, ws.impact.y_new.start)
    return locate_switch(ws, aimed.h, fired)


@kernel("ImpactPace(ws, ImpactPace, Attempt)")
def _next_pace(ws: Workspace, pace: ImpactPace, attempt: Attempt) -> ImpactPace:
    """Pace after an accepted step without an event: by its error, and on the common clock by the trend of errors.

    The phases of a lone contact are polynomials, so their errors have no trend. After a switch there is none yet.
    """
    factor, error = step_factor(attempt.error), max(_LEAST_ERROR, attempt.error)
    if pace.h_before > 0.0 and ws.impact.lone_contact == NO_CONTACT:
        factor = min(factor, trend(error, pace.error_before, attempt.h / pace.h_before))
    return ImpactPace(h=attempt.h * factor, h_before=attempt.h, error_before=error)


# --- between two steps ------------------------------------------------------------------------------------------------


@kernel("void(ws, f8)")
def _prepare_after_smooth_step(ws: Workspace, shortest: float) -> None:
    """Write guards, slip directions and first slope of the next step, after one without an event.

    The first slope is the last one of the step before. It is evaluated only if forces have changed: friction is chosen
    anew for a slip that stays next to rest, which counts as a phase, and contacts end whose forces move nothing.
    """
    if count_slow_step(ws):
        choose_friction(ws, first_step(ws, shortest), turns_rate=False)
        prepare_guards(ws)
        end_trapped(ws)
        write_impact_slope(ws, ws.impact.slopes.start)
        ws.event.n_phases += 1
        return
    orient(ws)
    if end_trapped(ws):
        prepare_guards(ws)
        write_impact_slope(ws, ws.impact.slopes.start)
        return
    arm_impact_guards(ws)
    n, slopes = state_size(ws), ws.impact.slopes.start
    copy_numbers(ws.floats, slopes + LAST_STAGE * n, n, slopes)


@kernel("f8(ws, Attempt, f8, b1)")
def _pass_switch(ws: Workspace, attempt: Attempt, shortest: float, is_windowed: bool) -> float:
    """Change the phases at the guard that fired, and the clock, and end contacts that are trapped or faded.

    Returns the length of the next step, in pseudo-time. Contacts that feed each other ever smaller bounces are faded:
    they are cut short after many phases.
    """
    h = step_after_switch(ws, attempt.h, shortest)
    switch_phases(ws, first_step(ws, shortest), attempt.guard)
    if len(ws.actives) > 1 and change_clock(ws):
        # the pseudo-time of the other clock has another unit
        h = shortest if ws.impact.lone_contact == NO_CONTACT else lone_step(ws)
    n_contacts = ws.impact.n_colliding if is_windowed else len(ws.actives)
    if ws.event.n_phases > _LONG * n_contacts and has_faded(ws):
        cut_short(ws)
    end_trapped(ws)
    if is_windowed:
        end_faint(ws)
    return h
