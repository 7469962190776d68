"""How an impact ends: the books of its phases, and ends other than that of the last expansion."""

from __future__ import annotations

import math

from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.rates import COMPRESSION, EXPANSION, IDLE, NOISE, efficiency, evaluate_impact_rates
from nonsmooth.engine.impact.scales import REST
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.modes import Truncation
from nonsmooth.engine.native.kernel import Workspace, impact_state, kernel
from nonsmooth.engine.numerics.linear import SINGULAR
from nonsmooth.engine.numerics.vectors import length

_LOCKED = 0.1
"""Forces of which no more than this part is left unbalanced are those of a wedge, not of bodies that part."""

_NEGLIGIBLE_APPROACH = 1e-3
"""Approach that is neglected after a truncated impact, relative to the fastest rate before the impact."""


@kernel("void(ws, i8)")
def account(ws: Workspace, a: int) -> None:
    """Book the work of the phase that ends at the active contact ``a``, or of the part of it so far."""
    active = ws.actives[a]
    state = impact_state(ws.floats, ws.impact.y.start, a)
    done = state.work - active.work_accounted
    if active.phase == COMPRESSION:
        active.energy_stored -= done
    else:
        active.energy_returned += done
    active.work_accounted = state.work


@kernel("void(ws, i8)")
def empty(ws: Workspace, a: int) -> None:
    """Take the energy that is left of the active contact ``a``."""
    state = impact_state(ws.floats, ws.impact.y.start, a)
    state.deformation = state.energy = state.lost = 0.0


@kernel("b1(ws)")
def finished(ws: Workspace) -> bool:
    """Return 1 if no contact is loaded: compressions that have not come to anything, and do not, are none."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        begins = a == ws.impact.lone_contact or impact_state(ws.floats, ws.impact.y.start, a).deformation > 0.0
        comes = begins or active.gap_rate < -NOISE * ws.impact.speed_scale
        if active.phase == EXPANSION or (active.phase == COMPRESSION and comes):
            return False
    return True


@kernel("b1(ws)")
def _trapped(ws: Workspace) -> bool:
    """Return 1 if contacts are loaded, but none of them moves, and their forces move nothing.

    A point that joints let move across one line only is wedged where that line lies within the cone of friction: slip
    and approach stop together, and the force of the contact goes into the joints.  G f = 0 means f.G f = 0, the forces
    then accelerate no part of the bodies, and so it stays: the deformation is never given back.  Rates that have next
    to no energy count as none, and those too slow to bounce; they would not change either.  Nor would what a small part
    of the forces gives back, the square of it in parts of what is stored.
    """
    brought = 0.0
    for a in range(ws.problem.n_active):
        brought = max(brought, ws.actives[a].energy_scale)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        loaded = active.phase == COMPRESSION or active.phase == EXPANSION
        still = max(REST * math.sqrt(brought * diagonal_block(ws, a).nn), ws.event.slow_speed)
        if loaded and abs(active.gap_rate) > still:
            return False
    size = left = stored = 0.0
    lightest = math.inf
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.phase != IDLE:
            stored += impact_state(ws.floats, ws.impact.y.start, a).energy
        lightest = min(lightest, 0.5 / diagonal_block(ws, a).nn)
        for r in range(3):
            total = total_size = 0.0
            for block in range(active.first_block, active.end_block):
                force = ws.actives[ws.island.block_column[block]].force
                for s in range(3):
                    part = ws.island.delassus[DELASSUS * block + 3 * r + s] * force[s]
                    total += part
                    total_size += abs(part)
            size, left = max(size, total_size), max(left, abs(total))
    if left < max(SINGULAR, ws.tolerance.impact) * size:
        return True
    little = left * left * stored < size * size * lightest * ws.event.slow_speed * ws.event.slow_speed
    return little and left < _LOCKED * size


@kernel("b1(ws)")
def end_trapped(ws: Workspace) -> bool:
    """End the phases of contacts that are trapped, if they are (1); what they have stored is lost to restitution."""
    if not _trapped(ws):
        return False
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.phase == COMPRESSION or active.phase == EXPANSION:
            account(ws, a)
            active.phase = IDLE
            active.sticks = False
            empty(ws, a)
            ws.event.n_phases += 1
    return True


@kernel("b1(ws)")
def faded(ws: Workspace) -> bool:
    """Return 1 if what is left of the impact, stored or about to be, is below the tolerance, or too slow to bounce."""
    small = max(ws.tolerance.impact, 1e-11)
    # behind the impact, what is within the tolerance of velocities is no approach
    slowest = max(ws.event.slow_speed, ws.tolerance.velocity)
    slow = max(slowest, small * ws.impact.speed_scale)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, ws.impact.y.start, a)
        stored = state.energy if active.phase != IDLE else 0.0
        least = max(small * small * active.energy_scale, 0.5 * slowest * slowest / diagonal_block(ws, a).nn)
        if active.gap_rate < -slow or stored > least:
            return False
        if active.gap_rate > slow and stored > 0.0 and active.phase == EXPANSION:
            return False
    return True


@kernel()
def cut_short(ws: Workspace) -> None:
    """End a cascade of ever smaller compressions; what still approaches is for the instant to stop."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        account(ws, a)
        active.phase = IDLE
        active.sticks = False
        empty(ws, a)
    ws.event.truncation = Truncation.SLOW


@kernel()
def finish(ws: Workspace) -> None:
    """Hand over the impulses and the energies."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        state = impact_state(ws.floats, ws.impact.y.start, a)
        for r in range(3):
            active.impulse[r] = state.impulse[r]
        account(ws, a)
        active.energy_dissipated = state.rubbed
    evaluate_impact_rates(ws, ws.impact.y.start)


@kernel("Truncation(ws)")
def how_over(ws: Workspace) -> Truncation:
    """How the impact of the active contacts ended that was cut short: a member of :class:`Truncation`.

    If the approach that remains is negligible, the impact is over. Contacts that slip may feed each other's bounces
    without end, however small the bounces are.

    A fast approach may remain if the compressions of light bodies stop a heavy one gradually. Each compression loses
    energy, so the limit of infinitely many is common rest: an inelastic impact. Slip that is faster than the approach
    may feed the bounces, and a contact without loss never damps them: then the impact has no end.
    """
    before = behind = slip = 0.0
    loses = True
    for active in ws.actives:
        before = max(before, abs(active.rate_before[0]), abs(active.rate_before[1]), abs(active.rate_before[2]))
        behind = max(behind, -active.gap_rate)
        slip = max(slip, length(active.slip))
        if not min(efficiency(ws, active.index, 0.0), efficiency(ws, active.index, 1e-300)) < 1.0:
            loses = False
    if behind <= _NEGLIGIBLE_APPROACH * before:
        return Truncation.SLOW
    return Truncation.FAST if loses and slip <= behind else Truncation.NONE
