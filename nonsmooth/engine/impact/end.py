"""How an impact ends: energy accounts of its phases, and reasons to end it before its last expansion is complete.

An impact is over when no contact is loaded. It may also end in these ways:

trapped     Contacts are loaded, but their forces move nothing: the energy is never returned.
faded       The compressions have become smaller than the tolerance, or too slow for a bounce: they are left out.

After such an end, contacts may still approach. :func:`how_over` classifies this approach.
"""

from __future__ import annotations

import math

from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.rates import evaluate_impact_rates
from nonsmooth.engine.impact.scales import REST
from nonsmooth.engine.impact.state import NOISE, is_loaded, is_lone, least_efficiency, state_of
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.layout import SINGULAR
from nonsmooth.engine.memory.modes import Phase, Truncation
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, kernel
from nonsmooth.engine.numerics.vectors import Pair, length

_LOCKED = 0.1
"""Largest unbalanced part of the contact forces in a trapped impact, relative to the size of these forces.

Both are defined in :func:`_balance`. The contact forces on a wedged body nearly cancel. If the unbalanced part is
larger, the bodies will separate.
"""
_NEGLIGIBLE_APPROACH = 1e-3
"""Approach that is neglected after a truncated impact, relative to the fastest rate before the impact."""
_LEAST_TOLERANCE = 1e-11
"""Least relative tolerance for the energies and approaches that are neglected at the end of an impact.

It replaces a smaller tolerance of the impact, because smaller energies and approaches are round-off.
"""


# --- accounts ---------------------------------------------------------------------------------------------------------


@kernel("void(ws, ActiveContact)")
def account(ws: Workspace, active: ActiveContact) -> None:
    """Add the work of an active contact since the last call [J] to its stored or, in expansion, its returned energy.

    To be called before its phase changes, and at the end. A contact that is idle or held does no work.
    """
    state = state_of(ws, active)
    done = state.work - active.work_accounted
    # the work of a force that brakes the bodies is negative
    if active.phase == Phase.COMPRESSION:
        active.energy_stored -= done
    else:
        active.energy_returned += done
    active.work_accounted = state.work


@kernel("void(ws, ActiveContact)")
def lose_energy(ws: Workspace, active: ActiveContact) -> None:
    """Set the stored energy and the deformation of an active contact to zero: the energy is lost to restitution.

    ``lost`` is the part of the stored energy that would not be returned, so it becomes zero, too.
    """
    # no account is needed: the loss to restitution is the account of stored energy less that of returned energy
    state = state_of(ws, active)
    state.deformation = state.energy = state.lost = 0.0


@kernel("void(ws, ActiveContact)")
def end_phase(ws: Workspace, active: ActiveContact) -> None:
    """End the phase of an active contact, which is idle from then on. Energy that is left is lost to restitution."""
    account(ws, active)
    active.phase = Phase.IDLE
    active.sticks = False
    lose_energy(ws, active)


@kernel()
def write_impact_results(ws: Workspace) -> None:
    """Write the impulses [N s] and energies [J] of the impact, and the rates [m/s] with which it ends."""
    for active in ws.actives:
        state = state_of(ws, active)
        for r in range(3):
            active.impulse[r] = state.impulse[r]
        # the work of the last phase is not yet in the energies stored and returned; the dissipated one is in the state
        account(ws, active)
        active.energy_dissipated = state.dissipated
    evaluate_impact_rates(ws, ws.impact.y.start)


# --- is the impact over? ----------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def is_finished(ws: Workspace) -> bool:
    """True if the impact is over: no contact is in expansion or in compression.

    A compression on the common clock counts only if it has a deformation, or approaches by more than round-off. A held
    contact stores no energy, so the impact does not wait for it.
    """
    for active in ws.actives:
        # a lone contact, whose impulse is the clock, has an energy in place of a deformation
        has_begun = is_lone(ws, active) or state_of(ws, active).deformation > 0.0
        begins = has_begun or active.gap_rate < -NOISE * ws.impact.speed_scale
        if active.phase == Phase.EXPANSION or (active.phase == Phase.COMPRESSION and begins):
            return False
    return True


@kernel("b1(ws)")
def end_trapped(ws: Workspace) -> bool:
    """End the phases of trapped contacts, whose forces can no longer move a body. True if there were any.

    Their energy is lost to restitution. Then no contact is loaded any more, so the impact is over.
    """
    if not _is_trapped(ws):
        return False
    for active in ws.actives:
        if is_loaded(active):
            end_phase(ws, active)
            ws.event.n_phases += 1
    return True


@kernel("b1(ws)")
def _is_trapped(ws: Workspace) -> bool:
    """True if contacts are loaded, but none of them moves, and their forces move nothing.

    Joints may let a point move along one line only. The point is wedged if that line lies within the cone of friction:
    slip and approach stop together, and the joints take the force of the contact. From G f = 0 follows f . G f = 0: the
    forces accelerate no part of the bodies. So the state stays, and the deformation is never returned.

    Rates with next to no energy count as zero, and so do rates too slow to bounce. A small part of the forces may be
    left unbalanced. The energy that this part could return is its square, relative to the stored energy.
    """
    if _moves(ws):
        return False
    stored, lightest = 0.0, math.inf
    for active in ws.actives:
        if active.phase != Phase.IDLE:
            stored += state_of(ws, active).energy
        # half of the smallest effective mass: times the square of the slow speed it is the least energy of a bounce
        lightest = min(lightest, 0.5 / diagonal_block(ws, active.index).nn)
    # the unbalanced part of the forces is left / size
    left, size = _balance(ws)
    if left < max(SINGULAR, ws.tolerance.impact) * size:
        return True
    returns_little = left * left * stored < size * size * lightest * ws.event.slow_speed * ws.event.slow_speed
    return returns_little and left < _LOCKED * size


@kernel("b1(ws)")
def _moves(ws: Workspace) -> bool:
    """True if a loaded contact approaches or separates fast enough to have an energy and to bounce.

    Bounces from the slow speed are shorter than their contact time.
    """
    brought = 0.0
    for active in ws.actives:
        brought = max(brought, active.energy_scale)
    for active in ws.actives:
        # gap rate whose energy is REST^2 of the largest one brought
        rest_rate = max(REST * math.sqrt(brought * diagonal_block(ws, active.index).nn), ws.event.slow_speed)
        if is_loaded(active) and abs(active.gap_rate) > rest_rate:
            return True
    return False


@kernel("v2(ws)")
def _balance(ws: Workspace) -> Pair:
    """Return the unbalanced part and the size of the present contact forces f, two numbers [m/s per pseudo-time].

    The unbalanced part is the largest component of G f, the acceleration of the contacts in pseudo-time. If it is 0,
    the forces move nothing. The size is the largest sum of the magnitudes of the terms of a component.
    """
    left = size = 0.0
    for active in ws.actives:
        for r in range(3):
            total = total_size = 0.0
            for block in range(active.first_block, active.end_block):
                force = ws.actives[ws.island.block_column[block]].force
                for s in range(3):
                    part = ws.island.delassus[DELASSUS * block + 3 * r + s] * force[s]
                    total += part
                    total_size += abs(part)
            size, left = max(size, total_size), max(left, abs(total))
    return left, size


# --- cascades of ever smaller compressions ----------------------------------------------------------------------------


@kernel("b1(ws)")
def has_faded(ws: Workspace) -> bool:
    """True if the impact may be cut short: stored energies and approaches are below the tolerance or do not bounce.

    A bounce from the slow speed is shorter than its contact time.
    """
    small = max(ws.tolerance.impact, _LEAST_TOLERANCE)
    # after the impact, an approach within the tolerance of velocities counts as rest
    slowest = max(ws.event.slow_speed, ws.tolerance.velocity)
    slow = max(slowest, small * ws.impact.speed_scale)
    for active in ws.actives:
        inverse_mass = diagonal_block(ws, active.index).nn
        stored = state_of(ws, active).energy if active.phase != Phase.IDLE else 0.0
        # energies are quadratic in speeds; the second one is the kinetic energy of a bounce from the slowest speed
        least = max(small * small * active.energy_scale, 0.5 * slowest * slowest / inverse_mass)
        if active.gap_rate < -slow or stored > least:
            return False
        # a contact that separates fast returns the rest of its energy by itself
        if active.gap_rate > slow and stored > 0.0 and active.phase == Phase.EXPANSION:
            return False
    return True


@kernel()
def cut_short(ws: Workspace) -> None:
    """End all phases of a cascade of ever smaller compressions. Their energy is lost to restitution.

    The contact problem after the impact stops what still approaches.
    """
    for active in ws.actives:
        end_phase(ws, active)
    # an impact that was cut short after too many steps gets another truncation from its caller, see `how_over`
    ws.event.truncation = Truncation.SLOW


@kernel("Truncation(ws)")
def how_over(ws: Workspace) -> Truncation:
    """How the impact of the active contacts, which was cut short, would end: a member of :class:`Truncation`.

    SLOW: the approach that remains is negligible. Contacts that slip may feed each other's bounces without end.
    FAST: compressions of light bodies stop a heavy one gradually. Each compression loses energy, so the limit of
    infinitely many is common rest: an inelastic impact.
    NONE: the impact has no end. A slip that is faster than the approach may feed the bounces, and a contact without
    loss never damps them.
    """
    before, approach, slip, loses = 0.0, 0.0, 0.0, True
    for active in ws.actives:
        before = max(before, abs(active.rate_before[0]), abs(active.rate_before[1]), abs(active.rate_before[2]))
        approach = max(approach, -active.gap_rate)
        slip = max(slip, length(active.slip))
        loses = loses and least_efficiency(ws, active) < 1.0
    if approach <= _NEGLIGIBLE_APPROACH * before:
        return Truncation.SLOW
    return Truncation.FAST if loses and slip <= approach else Truncation.NONE
