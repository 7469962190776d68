"""Finds out whether an event occurs within a step, and by which fraction of the step.

Open gaps are proved not to close (:mod:`nonsmooth.engine.flow.clearance`), or their closing is found. Forces, slips and
guards of the user are sampled at the end of a step, guards of the user also in its middle. Forces and slips are sampled
in the middle, too, if at a stage a force or slip violated its mode, or a force was smaller than at both ends.
"""

from __future__ import annotations

from nonsmooth.engine.flow.arming import arm_further, store_end
from nonsmooth.engine.flow.clearance import bound_speeds, find_doubtful
from nonsmooth.engine.flow.deflation import deflate
from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.flow.gap_search import (
    evaluate_gap_guard,
    evaluate_slip_guard,
    first_closing,
)
from nonsmooth.engine.flow.guard_numbers import (
    contact_of,
    friction_guard,
    normal_guard,
    normal_of,
    number_of_guards,
)
from nonsmooth.engine.flow.guard_values import evaluate_guards, evaluate_motion, write_guards
from nonsmooth.engine.flow.guards import NO_GUARD, DependsOn, first_fired, sign_depends_on
from nonsmooth.engine.flow.meeting import first_meeting, watch_pairs
from nonsmooth.engine.flow.redundant_forces import blend_chosen_forces, choose_at_end
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.roots import SHORT
from nonsmooth.engine.pairs.motion import bound_carriers

_MIDDLE = 0.5
"""Fraction of the step at which forces and guards of the user are sampled between its ends."""
_NEAR = 0.2
"""If a parabola through three samples of a force dips below this part of the end values, the dip is evaluated."""


@kernel("b1(ws)")
def asks_forces(ws: Workspace) -> bool:
    """True if there are contact forces that can be evaluated at any time within the step.

    In an implicit step, contact forces are known at the ends of stages only.
    """
    return ws.island.n_grouped > 0 and ws.island.stage_time == 0.0


@entry_point("void(ws, f8, f8, b1)")
def guards_within(ws: Workspace, h: float, theta: float, needs_forces: bool) -> None:
    """Interpolate the motion at the fraction ``theta`` of the step of ``h`` [s], and evaluate the guards there.

    Guards of closed contacts keep their values unless ``needs_forces``.
    """
    state_within(ws, h, theta, ws.step.y_stage.start)
    blend_chosen_forces(ws, theta)
    evaluate_guards(ws, ws.island.time + theta * h, ws.step.y_stage.start, theta * h, needs_forces)


@kernel("f8(ws, f8, f8, i8, b1)")
def guard_at(ws: Workspace, h: float, theta: float, i: int, needs_forces: bool) -> float:
    """Value of guard ``i`` at the fraction ``theta`` of the step of ``h`` [s].

    For a gap or a slip velocity, only the two bodies of the contact are evaluated, for other guards the whole system.
    """
    alone = sign_depends_on(ws, i)
    if alone == DependsOn.GAP:
        evaluate_gap_guard(ws, h, theta, i)
    elif alone == DependsOn.SLIP:
        evaluate_slip_guard(ws, h, theta, contact_of(ws, i))
    else:
        guards_within(ws, h, theta, needs_forces)
    return float(ws.guards[i].value)


@kernel("f8(ws, f8, i8)")
def _lowest(ws: Workspace, h: float, i: int) -> float:
    """Fraction of the step at which guard ``i`` is found to be negative, or 0 if it is found positive.

    Parabolas through three samples, first those at start, middle and end of the step, lead to the minimum of the guard.
    """
    low, middle, high = 0.0, _MIDDLE, 1.0
    g_low, g_middle, g_high = ws.guards[i].initial, ws.guards[i].middle, ws.guards[i].at_end
    for _iteration in range(8):
        left, right = (g_middle - g_low) / (middle - low), (g_high - g_middle) / (high - middle)
        bend = (right - left) / (high - low)
        if bend <= 0.0:
            return 0.0
        vertex = 0.5 * (low + middle) - 0.5 * left / bend
        value = g_middle + (vertex - middle) * (left + bend * (vertex - low))
        if not low < vertex < high or value > _NEAR * max(g_low, g_high):
            return 0.0
        if abs(vertex - middle) < SHORT:
            return 0.0
        g = guard_at(ws, h, vertex, i, needs_forces=True)
        if g < 0.0:
            return float(vertex)
        if vertex > middle:
            low, g_low, middle, g_middle = middle, g_middle, vertex, g
        else:
            high, g_high, middle, g_middle = middle, g_middle, vertex, g
        if g_middle > min(g_low, g_high):
            return 0.0
    return 0.0


@kernel("f8(ws, f8)")
def _force_dip(ws: Workspace, h: float) -> float:
    """Fraction of the step at which a contact pulls, or exceeds its static friction bound, between samples; else 0."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.mode != Mode.OPEN:
            for i in (normal_guard(c), friction_guard(ws, c)):
                if ws.guards[i].is_armed and (i == normal_guard(c) or contact.mode == Mode.STICK):
                    theta = _lowest(ws, h, i)
                    if theta > 0.0:
                        return theta
    return 0.0


@kernel("f8(ws, f8, f8, i8)")
def closed_before(ws: Workspace, h: float, theta: float, asked: int) -> float:
    """Fraction of the step, up to ``theta``, at which an open gap has closed or parts of bodies meet, or 0 if none has.

    If a gap has closed, the guards are afterwards evaluated at this fraction. If no gap has closed, contact ``asked``
    is afterwards evaluated at ``theta``.
    """
    found = 0.0
    if ws.step.n_may_close > 0:
        found = first_closing(ws, h, theta, asked)
        if found > 0.0:
            guards_within(ws, h, found, asks_forces(ws))
    if ws.model.n_pairs > 0:
        earlier = first_meeting(ws, h, found if found > 0.0 else theta)
        if earlier > 0.0:
            guards_within(ws, h, earlier, asks_forces(ws))
            return earlier
    return found


@entry_point("f8(ws, f8)")
def first_crossing(ws: Workspace, h: float) -> float:
    """First fraction of the step of ``h`` [s] at which some guard is found to have fired, or 0 if none fires.

    Bodies and forces must be evaluated at the end of the step before the call. After the call, the guards are evaluated
    at the returned fraction.
    """
    closed = asks_forces(ws)
    write_guards(ws, ws.island.time + h, ws.step.y_new.start, forces_are_known=True)
    choose_at_end(ws, h)
    store_end(ws)
    bound_speeds(ws)
    bound_carriers(ws)
    ws.step.meeting, ws.step.is_undecided = NO_PAIR, False
    if ws.model.n_pairs > 0:
        watch_pairs(ws, h)
    find_doubtful(ws, h)
    deflate(ws, h)
    fired = first_fired(ws, forces_are_known=True, located=NO_GUARD)
    # sample the middle only if at a stage a force or slip violated its mode, or a force was smaller than at both ends
    suspect = ws.step.has_doubtful_force
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        normal = normal_of(ws, contact)
        suspect = suspect or contact.least_force < min(normal.initial, normal.at_end)
    needs_forces = closed and suspect
    looks = needs_forces + ws.model.n_own_guards
    if looks > 0:
        guards_within(ws, h, _MIDDLE, needs_forces)
        if first_fired(ws, needs_forces, NO_GUARD) >= 0:
            if needs_forces != closed:
                guards_within(ws, h, _MIDDLE, closed)
            return _MIDDLE
        arm_further(ws, needs_forces)
        for i in range(number_of_guards(ws)):
            ws.guards[i].middle = ws.guards[i].value
        if needs_forces and fired < 0:
            theta = _force_dip(ws, h)
            if theta > 0.0:
                return theta
    # search for unseen closings only if no guard has fired; else `locate` finds its root first, then gaps before it
    if fired < 0 and ws.step.n_may_close + ws.model.n_pairs > 0:
        theta = closed_before(ws, h, 1.0, -1)
        if theta > 0.0:
            return theta
    blend_chosen_forces(ws, 1.0)
    if looks > 0:
        evaluate_motion(ws, ws.island.time + h, ws.step.y_new.start)
        for i in range(number_of_guards(ws)):
            ws.guards[i].value = ws.guards[i].at_end
        for c in range(ws.island.n_contacts):
            contact = ws.contacts[c]
            contact.gap_rate = contact.gap_rate_at_end
            contact.past_feature = contact.past_feature_at_end
        deflate(ws, h)
    elif fired >= 0 or ws.step.n_may_close == 0:
        return 1.0 if fired >= 0 else 0.0
    # check all guards again: some were armed only within the step
    return 1.0 if first_fired(ws, forces_are_known=True, located=NO_GUARD) >= 0 else 0.0
