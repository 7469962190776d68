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
from nonsmooth.engine.memory.modes import Truncation
from nonsmooth.engine.native.kernel import (
    Workspace,
    entry_point,
    impact_state,
    kernel,
)

LARGE = 16
"""Impacts with more contacts than this are looked at through a window: below, a window would hold most of them."""
_LAYERS = 4
"""How many neighbours deep a window reaches beyond the contacts that act: the less often a wave comes to its rim."""


@kernel()
def _gather_colliding(ws: Workspace) -> None:
    """Keep the active contacts as those of the impact, with nothing done yet, and hang them on their articulations.

    An articulation has a list of entries: first ones of all contacts, and second ones behind those of all slots.
    """
    ws.impact.n_colliding = ws.problem.n_active
    for number in range(ws.model.n_articulations):
        ws.articulations[number].first_colliding = -1
    for i in range(ws.model.n_u):
        ws.impact.u[i] = ws.floats[ws.island.velocities + i]
    for i in range(ws.impact.n_colliding):
        c = ws.problem.active[i]
        contact = ws.contacts[c]
        ws.impact.colliding[i] = c
        contact.window_phase = IDLE
        contact.window_sticks = False
        contact.n_waves = 0
        for j in range(TOTALS):
            contact.window_totals[j] = 0.0
        for side in range(2):
            articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
            entry = side * ws.model.n_slots + c
            ws.impact.chain[entry] = articulation.first_colliding
            articulation.first_colliding = entry


@kernel("void(ws, f8)")
def _draw(ws: Workspace, fastest: float) -> None:
    """Make the contacts that act and their neighbours the active ones; at first, given the fastest, who approaches."""
    m = 0
    for i in range(ws.impact.n_colliding):
        c = ws.impact.colliding[i]
        contact = ws.contacts[c]
        acts = contact.window_phase != IDLE
        if fastest > 0.0:
            acts = contact.rate[0] < -NOISE * fastest
        contact.layer = 0 if acts else -1
        contact.is_at_rim = False
        if acts:
            ws.problem.active[m] = c
            m += 1
    begin = 0
    for layer in range(1, _LAYERS + 1):
        end = m
        for i in range(begin, end):
            for side in range(2):
                contact = ws.contacts[ws.problem.active[i]]
                articulation = ws.articulations[contact.articulation_a if side == 0 else contact.articulation_b]
                entry = articulation.first_colliding if articulation.n_u > 0 else -1
                while entry >= 0:
                    other = entry if entry < ws.model.n_slots else entry - ws.model.n_slots
                    neighbour = ws.contacts[other]
                    if neighbour.layer < 0:
                        neighbour.layer = layer
                        neighbour.is_at_rim = layer == _LAYERS
                        ws.problem.active[m] = other
                        m += 1
                    entry = ws.impact.chain[entry]
        begin = end
    ws.problem.n_active = m


@kernel()
def _load(ws: Workspace) -> None:
    """Set matrix, rates and state of the window, whose structure takes the place of the island's."""
    link_active(ws)
    assemble_delassus(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, ws.impact.y.start, a)
        c = active.contact
        contact = ws.contacts[c]
        for r in range(3):
            active.rate_before[r] = contact.prescribed_rate[r] + row(ws, c, r, ws.impact.u.start)
        for r in range(3):
            state.impulse[r] = 0.0
        state.work = state.rubbed = 0.0
        state.deformation = contact.window_deformation
        state.energy = contact.window_energy
        state.lost = contact.window_lost
        active.energy_stored = active.energy_returned = active.work_accounted = 0.0
        active.phase = contact.window_phase
        active.sticks = contact.window_sticks


@kernel()
def _store(ws: Workspace) -> None:
    """Give the bodies the impulses of the window, and keep what goes on."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, ws.impact.y.start, a)
        c = active.contact
        contact = ws.contacts[c]
        account(ws, a)
        for r in range(3):
            active.impulse[r] = state.impulse[r]
            contact.window_impulse[r] += active.impulse[r]
        contact.window_stored += active.energy_stored
        contact.window_returned += active.energy_returned
        contact.window_dissipated += state.rubbed
        contact.window_deformation, contact.window_energy, contact.window_lost = (
            state.deformation,
            state.energy,
            state.lost,
        )
        contact.window_phase, contact.window_sticks = active.phase, active.sticks
    add_response(ws, ws.impact.impulse.start, ws.impact.u.start)


@entry_point("i8(ws)")
def windowed_impact(ws: Workspace) -> int:
    """Do what ``energetic_impact`` does, for many contacts; the Delassus matrix of all of them is not needed."""
    fastest = 0.0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        fastest = max(fastest, -ws.contacts[active.contact].rate[0])
    ws.impact.may_be_lone = True
    ws.event.truncation = Truncation.NONE
    ws.impact.slow_steps = 0
    _gather_colliding(ws)
    outcome = MOVED
    for window in range(MOST_STEPS):
        _draw(ws, fastest if window == 0 else 0.0)
        # behind the wave what is within the error is not told from rest; where all lie in the window none leaves it
        ws.impact.faint_rate = CIRCLING * ws.tolerance.impact if ws.problem.n_active < ws.impact.n_colliding else 0.0
        _load(ws)
        ws.impact.lone_contact = -1
        shortest = scale_impact(ws, fastest)
        if not shortest > 0.0:
            outcome = INVALID
            break
        if window == 0:
            ws.impact.h = first_step(ws, shortest)
            start_impact(ws, ws.impact.h, 0.0)
        outcome = run_impact(ws, ws.impact.h, shortest, 1)
        _store(ws)
        if outcome != MOVED:
            break
    ws.impact.faint_rate = 0.0
    ws.problem.n_active = ws.impact.n_colliding
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.contact = ws.impact.colliding[a]
        contact = ws.contacts[active.contact]
        for r in range(3):
            active.impulse[r] = contact.window_impulse[r]
        active.energy_stored, active.energy_returned, active.energy_dissipated = (
            contact.window_stored,
            contact.window_returned,
            contact.window_dissipated,
        )
    return ENDLESS if outcome == MOVED else outcome
