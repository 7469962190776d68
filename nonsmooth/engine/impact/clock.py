"""The clock of an impact: common to all contacts, until one is left in action, which gets its own."""

from __future__ import annotations

from nonsmooth.engine.impact.guards import prepare_guards
from nonsmooth.engine.impact.rates import EXPANSION, HELD, IDLE, STRIDE
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, contact_at, impact_state, kernel


@kernel("i8(S, F, I)")
def change_clock(S: Scalars, w: Floats, k: Integers) -> int:
    """Give the last contact in action its own clock; go back to where it got it if it does not stay alone.

    Returns 1 if the clock has changed.
    """
    acting = 0
    last = -1
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        if active.phase != IDLE:
            acting += 1
            last = a
    n = STRIDE * S.n_active
    if S.lone < 0:
        if acting != 1 or S.may_be_lone == 0:
            return 0
        phase, state = active_at(S, w, k, last).phase, impact_state(w, S.impact_y, last)
        if phase == HELD:
            return 0
        if phase == EXPANSION and not state.energy > state.lost:
            # its own clock runs until the energy is used up, of which the integration's error has left none: a steep
            # force has given all of it back long before the deformation, which ends the phase on the common clock
            return 0
        for i in range(n):
            w[S.impact_kept + i] = w[S.impact_y + i]
        _keep_phases(S, w, k)
        S.lone = last
        prepare_guards(S, w, k)
        return 1
    if acting == 0 or (acting == 1 and last == S.lone):
        return 0
    for i in range(n):
        w[S.impact_y + i] = w[S.impact_kept + i]
    S.lone = -1
    S.may_be_lone = 0
    _restore_phases(S, w, k)
    return 1


@kernel("void(S, F, I)")
def _keep_phases(S: Scalars, w: Floats, k: Integers) -> None:
    S.phases_kept = S.phases
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        active.phase_kept, active.held_kept = active.phase, active.tangent_held
        active.stored_kept, active.returned_kept, active.booked_kept = active.stored, active.returned, active.booked
        active.direction_kept = contact_at(S, w, k, active.slot).direction


@kernel("void(S, F, I)")
def _restore_phases(S: Scalars, w: Floats, k: Integers) -> None:
    S.phases = S.phases_kept
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        active.phase, active.tangent_held = active.phase_kept, active.held_kept
        active.stored, active.returned, active.booked = active.stored_kept, active.returned_kept, active.booked_kept
        contact.direction = active.direction_kept
    prepare_guards(S, w, k)
