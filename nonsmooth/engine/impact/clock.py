"""The clock of an impact: common to all contacts, until one is left in action, which gets its own."""

from __future__ import annotations

from nonsmooth.engine.impact.guards import prepare_guards
from nonsmooth.engine.impact.rates import EXPANSION, HELD, IDLE, STRIDE
from nonsmooth.engine.native.kernel import (
    Workspace,
    impact_state,
    kernel,
)


@kernel("b1(ws)")
def change_clock(ws: Workspace) -> bool:
    """Give the last contact in action its own clock; go back to where it got it if it does not stay alone.

    Returns 1 if the clock has changed.
    """
    acting = 0
    last = -1
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.phase != IDLE:
            acting += 1
            last = a
    n = STRIDE * ws.problem.n_active
    if ws.impact.lone_contact < 0:
        if acting != 1 or not ws.impact.may_be_lone:
            return False
        phase, state = ws.actives[last].phase, impact_state(ws.floats, ws.impact.y.start, last)
        if phase == HELD:
            return False
        if phase == EXPANSION and not state.energy > state.lost:
            # its own clock runs until the energy is used up, of which the integration's error has left none: a steep
            # force has given all of it back long before the deformation, which ends the phase on the common clock
            return False
        for i in range(n):
            ws.impact.y_kept[i] = ws.impact.y[i]
        _keep_phases(ws)
        ws.impact.lone_contact = last
        prepare_guards(ws)
        return True
    if acting == 0 or (acting == 1 and last == ws.impact.lone_contact):
        return False
    for i in range(n):
        ws.impact.y[i] = ws.impact.y_kept[i]
    ws.impact.lone_contact = -1
    ws.impact.may_be_lone = False
    _restore_phases(ws)
    return True


@kernel()
def _keep_phases(ws: Workspace) -> None:
    ws.impact.phases_kept = ws.event.n_phases
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.phase_kept, active.sticking_kept = active.phase, active.sticks
        active.stored_kept, active.returned_kept, active.accounted_kept = (
            active.energy_stored,
            active.energy_returned,
            active.work_accounted,
        )
        active.direction_kept = ws.contacts[active.contact].direction


@kernel()
def _restore_phases(ws: Workspace) -> None:
    ws.event.n_phases = ws.impact.phases_kept
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        active.phase, active.sticks = active.phase_kept, active.sticking_kept
        active.energy_stored, active.energy_returned, active.work_accounted = (
            active.stored_kept,
            active.returned_kept,
            active.accounted_kept,
        )
        contact.direction = active.direction_kept
    prepare_guards(ws)
