"""Forces that are not unique, chosen anew where they come to a bound.

The motion does not depend on the choice, and may ask for one choice after the other, each good for a short time only.
So behind an instant at which forces were chosen they are chosen at the end of the step, too, if those at hand pass a
bound there, and in between they go from one choice to the other: as the forces that keep the bounds are a convex set,
these do so, too, but for the curvature of the motion, which the guards look at.
"""

from __future__ import annotations

from nonsmooth.engine.delassus.islands import group_closed
from nonsmooth.engine.flow.flight import state_within
from nonsmooth.engine.flow.flow import right_hand_side
from nonsmooth.engine.flow.guard_numbers import first_own_guard
from nonsmooth.engine.flow.guard_values import write_guards
from nonsmooth.engine.flow.guards import NO_GUARD, first_fired, has_fired, is_of_redundant_force
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("b1(ws)")
def choose_forces_again(ws: Workspace) -> bool:
    """Choose the forces that are not unique anew; true if all closed contacts can keep their bounds.

    A second time within the time tolerance there is no choice: then all forces vanish.
    """
    if ws.island.time - ws.island.last_choice <= ws.tolerance.time:
        return False
    ws.island.last_choice = ws.island.time
    group_closed(ws)
    return right_hand_side(ws, ws.island.time, ws.island.y.start, may_choose=True, of_all_bodies=True)


@kernel("void(ws, f8)")
def blend_chosen_forces(ws: Workspace, theta: float) -> None:
    """Take the forces between those chosen at the start and the end of the step at the fraction ``theta`` of it."""
    if not ws.step.is_blended:
        return
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        for r in range(3):
            first, end = contact.choice_at_start[r], contact.choice_at_end[r]
            contact.null_space_force[r] = first + theta * (end - first)


@kernel("b1(ws, f8, i8)")
def _choose_at(ws: Workspace, elapsed: float, y: int) -> bool:
    """Choose forces at the time ``elapsed`` in the step and the state ``y``; true if there are any.

    Where there are none, what lets forces hold that were chosen would let their end be late.
    """
    if right_hand_side(ws, ws.island.time + elapsed, y, may_choose=True, of_all_bodies=False):
        return True
    for c in range(ws.island.n_contacts):
        ws.contacts[c].slack = 0.0
    return False


@kernel("b1(ws)")
def _exceeds_bound(ws: Workspace) -> bool:
    """Return 1 if a force that is chosen has passed its bound."""
    for i in range(first_own_guard(ws)):
        if is_of_redundant_force(ws, i) and has_fired(ws, i):
            return True
    return False


@kernel("void(ws, f8)")
def choose_at_end(ws: Workspace, h: float) -> None:
    """Choose forces at the end of the step of ``h`` where those of its start, chosen there, pass a bound.

    The guards must be written there, and are for the choice.
    """
    ws.step.is_blended = False
    if ws.island.last_choice != ws.island.time or ws.island.stage_time > 0.0 or not _exceeds_bound(ws):
        return
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        for r in range(3):
            contact.choice_at_start[r] = contact.null_space_force[r]
    ws.step.is_blended = True
    if not _choose_at(ws, h, ws.step.y_new.start):
        right_hand_side(ws, ws.island.time + h, ws.step.y_new.start, may_choose=False, of_all_bodies=False)
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        for r in range(3):
            contact.choice_at_end[r] = contact.null_space_force[r]
    write_guards(ws, ws.island.time + h, ws.step.y_new.start, forces_are_known=True)


@kernel("b1(ws, f8)")
def can_choose_within(ws: Workspace, high: float) -> bool:
    """Return 1 if forces can be chosen at the fraction ``high`` of the step though those in between pass a bound there.

    Where they have no room but that of one value the motion bends it, the less the shorter the step is; within the time
    tolerance that is an event.
    """
    if not ws.step.is_blended or high == 1.0 or ws.step.h <= ws.tolerance.time:
        return False
    fired = first_fired(ws, forces_are_known=True, located=NO_GUARD)
    if not 0 <= fired < first_own_guard(ws) or not is_of_redundant_force(ws, fired):
        return False
    state_within(ws, ws.step.h, high, ws.step.y_stage.start)
    return _choose_at(ws, high * ws.step.h, ws.step.y_stage.start)
