"""Redundant forces over a step: contact forces that are not unique are chosen anew when one of them reaches its bound.

The motion does not depend on the choice. But each choice may be valid for a short time only, and a step per choice
would be slow. So after an instant at which forces were chosen, they are also chosen at the end of the step, if those of
the start exceed a bound there. Within the step they are blended linearly from one choice to the other. The forces that
keep all bounds are a convex set, so the blend keeps them too, apart from the curvature of the motion. The guards check
that.
"""

from __future__ import annotations

from nonsmooth.engine.delassus.islands import group_closed
from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.flow.flow import right_hand_side
from nonsmooth.engine.flow.guard_numbers import first_user_guard
from nonsmooth.engine.flow.guard_values import write_guards
from nonsmooth.engine.flow.guards import NO_GUARD, first_fired, has_fired, is_of_redundant_force
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("b1(ws)")
def choose_forces_again(ws: Workspace) -> bool:
    """Choose the redundant forces (those that are not unique) anew at the present state. True if they keep all bounds.

    Then a force at its bound is no event. False if no choice keeps the bounds, or if the last choice was less than the
    time tolerance ago: all forces may vanish then, and choices would never end.
    """
    if ws.island.time - ws.island.last_choice <= ws.tolerance.time:
        return False
    ws.island.last_choice = ws.island.time
    group_closed(ws)
    return right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose=True, of_all_bodies=True)


@kernel("void(ws, f8)")
def blend_chosen_forces(ws: Workspace, theta: float) -> None:
    """Interpolate the null-space forces between the choices at both ends of the step, at its fraction ``theta``.

    Null-space forces are the part of the contact forces that does not change the motion. Without a choice at the end
    they stay constant over the step.
    """
    if not ws.step.is_blended:
        return
    for contact in ws.contacts:
        for r in range(3):
            first, end = contact.choice_at_start[r], contact.choice_at_end[r]
            contact.null_space_force[r] = first + theta * (end - first)


@kernel("b1(ws, f8, i8)")
def _choose_at(ws: Workspace, elapsed: float, y: int) -> bool:
    """Choose the redundant forces after ``elapsed`` [s] of the step, at the state ``y``. True if all keep their bounds.

    Else no choice keeps them. Then ``slack``, the excess over the bounds that such a choice is allowed, is removed,
    because it would delay the end of the mode.
    """
    if right_hand_side(ws, ws.island.time + elapsed, y, may_choose=True, of_all_bodies=False):
        return True
    for contact in ws.contacts:
        contact.slack = 0.0
    return False


@kernel("b1(ws)")
def _exceeds_bound(ws: Workspace) -> bool:
    """True if a guard that depends on a redundant force has fired. Only such guards make a new choice worthwhile."""
    for i in range(first_user_guard(ws)):
        if is_of_redundant_force(ws, i) and has_fired(ws, i):
            return True
    return False


@kernel("void(ws, f8)")
def choose_at_end(ws: Workspace, h: float) -> None:
    """Choose the redundant forces at the end of the step of ``h`` [s] too, if those of its start exceed a bound there.

    Within the step the forces are then blended from one choice to the other (``is_blended``). This is done only if the
    forces were chosen at the very start, and only in explicit steps: in implicit ones forces exist at the ends of
    stages only. The guards must be written at the end of the step. They are written anew if forces were chosen.
    """
    ws.step.is_blended = False
    is_chosen_at_start = ws.island.last_choice == ws.island.time
    if not is_chosen_at_start or ws.island.stage_time > 0.0 or not _exceeds_bound(ws):
        return
    for contact in ws.contacts:
        for r in range(3):
            contact.choice_at_start[r] = contact.null_space_force[r]
    ws.step.is_blended = True
    # forces of a failed choice are evaluated again without their slack
    if not _choose_at(ws, h, ws.step.y_new.start):
        right_hand_side(ws, ws.island.time + h, ws.step.y_new.start, may_choose=False, of_all_bodies=False)
    for contact in ws.contacts:
        for r in range(3):
            contact.choice_at_end[r] = contact.null_space_force[r]
    write_guards(ws, ws.island.time + h, ws.step.y_new.start, forces_are_known=True)


@kernel("b1(ws, f8)")
def can_choose_within(ws: Workspace, high: float) -> bool:
    """True if redundant forces can be chosen at the fraction ``high`` of the step although the blend exceeds a bound.

    Then a shorter step keeps the bounds, and there is no event. This happens if the bounds allow a single choice only,
    which changes nonlinearly over the step. False in a step within the time tolerance, and at its end (``high`` 1),
    which has its own choice: the bound is then an event. Chooses forces at that fraction of the step.
    """
    if not ws.step.is_blended or high == 1.0 or ws.step.h <= ws.tolerance.time:
        return False
    fired = first_fired(ws, forces_are_known=True, located=NO_GUARD)
    if not 0 <= fired < first_user_guard(ws) or not is_of_redundant_force(ws, fired):
        return False
    state_within(ws, ws.step.h, high, ws.step.y_stage.start)
    return _choose_at(ws, high * ws.step.h, ws.step.y_stage.start)
