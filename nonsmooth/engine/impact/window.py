"""A large multiple impact, of which only the contacts about a travelling wave are looked at.

Most contacts of a long chain are idle at any moment of its impact.  A window holds those that act and their
neighbours; where the wave comes to its rim the impulses so far are given to the bodies, and the next window is drawn
about the contacts that act then.  The phases, deformations and energies go on as they are: no step is different.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.delassus.blocks import link_active
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus
from nonsmooth.engine.impact.end import account
from nonsmooth.engine.impact.problem import (
    ENDLESS,
    INVALID,
    MOST_STEPS,
    MOVED,
    first_step,
    run_impact,
    start_impact,
)
from nonsmooth.engine.impact.rates import IDLE, NOISE
from nonsmooth.engine.impact.scales import CIRCLING, scale_impact
from nonsmooth.engine.memory.layout import TOTALS
from nonsmooth.engine.native.kernel import (
    Floats,
    Integers,
    Scalars,
    active_at,
    articulation_at,
    contact_at,
    entry_point,
    impact_state,
    kernel,
)

LARGE = 16
"""Impacts with more contacts than this are looked at through a window: below, a window would hold most of them."""
_LAYERS = 4
"""How many neighbours deep a window reaches beyond the contacts that act: the less often a wave comes to its rim."""


@kernel("void(S, F, I)")
def _gather_colliding(S: Scalars, w: Floats, k: Integers) -> None:
    """Keep the active contacts as those of the impact, with nothing done yet, and hang them on their articulations.

    An articulation has a list of entries: first ones of all contacts, and second ones behind those of all slots.
    """
    S.n_colliding = S.n_active
    for number in range(S.n_articulations):
        articulation_at(S, w, k, number).head = -1
    for i in range(S.n_u):
        w[S.u_impact + i] = w[S.free_velocities + i]
    for i in range(S.n_colliding):
        c = k[S.active + i]
        contact = contact_at(S, w, k, c)
        k[S.colliding + i] = c
        contact.phase_kept = IDLE
        contact.held_kept = 0
        contact.waves = 0
        for j in range(TOTALS):
            contact.total[j] = 0.0
        for side in range(2):
            articulation = articulation_at(S, w, k, contact.articulation_a if side == 0 else contact.articulation_b)
            entry = side * S.n_slots + c
            k[S.chain + entry] = articulation.head
            articulation.head = entry


@kernel("void(S, F, I, f8)")
def _draw(S: Scalars, w: Floats, k: Integers, fastest: float) -> None:
    """Make the contacts that act and their neighbours the active ones; at first, given the fastest, who approaches."""
    m = 0
    for i in range(S.n_colliding):
        c = k[S.colliding + i]
        contact = contact_at(S, w, k, c)
        acts = contact.phase_kept != IDLE
        if fastest > 0.0:
            acts = contact.rate[0] < -NOISE * fastest
        contact.depth = 0 if acts else -1
        contact.rim = 0
        if acts:
            k[S.active + m] = c
            m += 1
    begin = 0
    for layer in range(1, _LAYERS + 1):
        end = m
        for i in range(begin, end):
            for side in range(2):
                contact = contact_at(S, w, k, k[S.active + i])
                articulation = articulation_at(S, w, k, contact.articulation_a if side == 0 else contact.articulation_b)
                entry = articulation.head if articulation.nu > 0 else -1
                while entry >= 0:
                    other = entry if entry < S.n_slots else entry - S.n_slots
                    neighbour = contact_at(S, w, k, other)
                    if neighbour.depth < 0:
                        neighbour.depth = layer
                        neighbour.rim = 1 if layer == _LAYERS else 0
                        k[S.active + m] = other
                        m += 1
                    entry = k[S.chain + entry]
        begin = end
    S.n_active = m


@kernel("void(S, F, I)")
def _load(S: Scalars, w: Floats, k: Integers) -> None:
    """Set matrix, rates and state of the window, whose structure takes the place of the island's."""
    link_active(S, w, k)
    assemble_delassus(S, w, k)
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        state = impact_state(w, S.impact_y, a)
        c = active.slot
        contact = contact_at(S, w, k, c)
        for r in range(3):
            active.rate_before[r] = contact.prescribed_rate[r] + row(S, w, k, c, r, S.u_impact)
        for r in range(3):
            state.impulse[r] = 0.0
        state.work = state.rubbed = 0.0
        state.deformation = contact.deformation_kept
        state.energy = contact.energy_kept
        state.lost = contact.lost_kept
        active.stored = active.returned = active.booked = 0.0
        active.phase = contact.phase_kept
        active.tangent_held = contact.held_kept


@kernel("void(S, F, I)")
def _store(S: Scalars, w: Floats, k: Integers) -> None:
    """Give the bodies the impulses of the window, and keep what goes on."""
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        state = impact_state(w, S.impact_y, a)
        c = active.slot
        contact = contact_at(S, w, k, c)
        account(S, w, k, a)
        for r in range(3):
            active.impulse[r] = state.impulse[r]
            contact.total_impulse[r] += active.impulse[r]
        contact.total_stored += active.stored
        contact.total_returned += active.returned
        contact.total_rubbed += state.rubbed
        contact.deformation_kept, contact.energy_kept, contact.lost_kept = state.deformation, state.energy, state.lost
        contact.phase_kept, contact.held_kept = active.phase, active.tangent_held
    add_response(S, w, k, S.impulse, S.u_impact)


@entry_point("i8(S, F, I)")
def windowed_impact(S: Scalars, w: Floats, k: Integers) -> int:
    """Do what ``energetic_impact`` does, for many contacts; the Delassus matrix of all of them is not needed."""
    fastest = 0.0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        fastest = max(fastest, -contact_at(S, w, k, active.slot).rate[0])
    S.may_be_lone = 1
    S.truncated = 0
    S.slow_steps = 0
    _gather_colliding(S, w, k)
    outcome = MOVED
    for window in range(MOST_STEPS):
        _draw(S, w, k, fastest if window == 0 else 0.0)
        # behind the wave what is within the error is not told from rest; where all lie in the window none leaves it
        S.faint = CIRCLING * S.impact_rtol if S.n_active < S.n_colliding else 0.0
        _load(S, w, k)
        S.lone = -1
        shortest = scale_impact(S, w, k, fastest)
        if not shortest > 0.0:
            outcome = INVALID
            break
        if window == 0:
            S.impact_h = first_step(S, shortest)
            start_impact(S, w, k, S.impact_h, 0.0)
        outcome = run_impact(S, w, k, S.impact_h, shortest, 1)
        _store(S, w, k)
        if outcome != MOVED:
            break
    S.faint = 0.0
    S.n_active = S.n_colliding
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        active.slot = k[S.colliding + a]
        contact = contact_at(S, w, k, active.slot)
        for r in range(3):
            active.impulse[r] = contact.total_impulse[r]
        active.stored, active.returned, active.rubbed = (
            contact.total_stored,
            contact.total_returned,
            contact.total_rubbed,
        )
    return ENDLESS if outcome == MOVED else outcome
