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
    for a in range(ws.n_active):
        active = ws.actives[a]
        if active.phase != IDLE:
            acting += 1
            last = a
    n = STRIDE * ws.n_active
    if ws.lone < 0:
        if acting != 1 or ws.may_be_lone == 0:
            return False
        phase, state = ws.actives[last].phase, impact_state(ws.floats, ws.offsets.impact_y, last)
        if phase == HELD:
            return False
        if phase == EXPANSION and not state.energy > state.lost:
            # its own clock runs until the energy is used up, of which the integration's error has left none: a steep
            # force has given all of it back long before the deformation, which ends the phase on the common clock
            return False
        for i in range(n):
            ws.impact_kept[i] = ws.impact_y[i]
        _keep_phases(ws)
        ws.lone = last
        prepare_guards(ws)
        return True
    if acting == 0 or (acting == 1 and last == ws.lone):
        return False
    for i in range(n):
        ws.impact_y[i] = ws.impact_kept[i]
    ws.lone = -1
    ws.may_be_lone = 0
    _restore_phases(ws)
    return True


@kernel()
def _keep_phases(ws: Workspace) -> None:
    ws.phases_kept = ws.phases
    for a in range(ws.n_active):
        active = ws.actives[a]
        active.phase_kept, active.held_kept = active.phase, active.tangent_held
        active.stored_kept, active.returned_kept, active.booked_kept = active.stored, active.returned, active.booked
        active.direction_kept = ws.contacts[active.slot].direction


@kernel()
def _restore_phases(ws: Workspace) -> None:
    ws.phases = ws.phases_kept
    for a in range(ws.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.slot]
        active.phase, active.tangent_held = active.phase_kept, active.held_kept
        active.stored, active.returned, active.booked = active.stored_kept, active.returned_kept, active.booked_kept
        contact.direction = active.direction_kept
    prepare_guards(ws)
