"""The clock of an impact, which is its variable of integration.

It is common to all contacts, or, while only one contact is loaded, the normal impulse of this lone contact.

As functions of this impulse, the phases of a lone contact are polynomials (:mod:`nonsmooth.engine.impact.rates`). So
the next event is known in closed form, and a step can end at it. The state is stored when the clock changes. If another
contact is loaded before the lone contact has ended its phases, the impact returns to the stored state. It then
continues with the common clock until its end.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.impact.guards import NO_GUARD, GuardKind, guard_of, prepare_guards
from nonsmooth.engine.impact.state import NOISE, expansion_efficiency, returned_part, state_at, state_of, state_size
from nonsmooth.engine.memory.modes import NO_CONTACT, Phase
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, kernel, result
from nonsmooth.engine.numerics.arrays import copy_numbers

_AT_EVENT = 4.0 * NOISE
"""Value [1] within which the guard that a step aims at has fired. It is round-off of a few operations."""


@result
class Aim(NamedTuple):
    """A step that ends at the next event of a lone contact."""

    h: float
    """Length of the step, in pseudo-time."""
    guard: int
    """Guard at whose root the step ends, or ``NO_GUARD``."""


# --- changes of the clock ---------------------------------------------------------------------------------------------


@kernel("b1(ws)")
def change_clock(ws: Workspace) -> bool:
    """Choose the clock, which is the variable of integration of the impact. True if the clock changes.

    If only one contact is not idle, its normal impulse becomes the clock, because the next event is then known in
    closed form. If another contact is loaded before the phases of this contact end, the clock becomes the common one
    again, and the impact returns to the state before the first change.
    """
    # contacts that are not idle, other than the present lone one, and the last of them
    n_others, last = 0, NO_CONTACT
    for active in ws.actives:
        if active.phase != Phase.IDLE and active.index != ws.impact.lone_contact:
            n_others += 1
            last = active.index
    if ws.impact.lone_contact == NO_CONTACT:
        if n_others != 1 or not _can_be_clock(ws, ws.actives[last]):
            return False
        _store_state(ws)
        ws.impact.lone_contact = last
    elif n_others == 0:
        return False
    else:
        # one attempt is made in an impact: the common clock continues for good
        ws.impact.lone_contact, ws.impact.may_be_lone = NO_CONTACT, False
        _restore_state(ws)
    # guards on the other clock have other scales
    prepare_guards(ws)
    return True


@kernel("b1(ws, ActiveContact)")
def _can_be_clock(ws: Workspace, active: ActiveContact) -> bool:
    """True if the impulse of an active contact, the only one that is not idle, may be the variable of integration."""
    # this is tried once in an impact; a held contact stores no energy that could be used up
    if not ws.impact.may_be_lone or active.phase == Phase.HELD:
        return False
    state = state_of(ws, active)
    # a steep force returns all energy long before the deformation is zero: then only the deformation ends the phase
    return active.phase != Phase.EXPANSION or state.energy > state.lost


@kernel()
def _store_state(ws: Workspace) -> None:
    """Store the state of the impact before a lone contact becomes the clock, for :func:`_restore_state`."""
    copy_numbers(ws.floats, ws.impact.y.start, state_size(ws), ws.impact.y_kept.start)
    ws.impact.phases_kept = ws.event.n_phases
    for active in ws.actives:
        active.phase_kept, active.sticking_kept = active.phase, active.sticks
        active.stored_kept, active.returned_kept = active.energy_stored, active.energy_returned
        active.accounted_kept = active.work_accounted
        active.direction_kept = ws.contacts[active.contact].direction


@kernel()
def _restore_state(ws: Workspace) -> None:
    """Return to the state of the impact before a lone contact became the clock, because another one is loaded."""
    copy_numbers(ws.floats, ws.impact.y_kept.start, state_size(ws), ws.impact.y.start)
    ws.event.n_phases = ws.impact.phases_kept
    for active in ws.actives:
        active.phase, active.sticks = active.phase_kept, active.sticking_kept
        active.energy_stored, active.energy_returned = active.stored_kept, active.returned_kept
        active.work_accounted = active.accounted_kept
        ws.contacts[active.contact].direction = active.direction_kept


# --- the next event of a lone contact ---------------------------------------------------------------------------------


@kernel("Aim(ws, f8)")
def aim_at_event(ws: Workspace, h: float) -> Aim:
    """Step of the lone contact to its next event, at most ``h`` [N s], and the guard whose root that event is.

    This contact alone has a load, and its normal impulse is the variable of integration. Gap rate and slip are linear
    in it while the slip keeps its direction, so their roots are known. The guard is ``NO_GUARD`` if there is no event
    within ``h``.
    """
    active = ws.actives[ws.impact.lone_contact]
    direction = ws.contacts[active.contact].direction
    # own: its Delassus block, row by row; no other contact has a force
    rate, force, own = active.rate, active.force, diagonal_block(ws, active.index).entries
    # slopes of the gap rate, and of the slip along its direction, per pseudo-time
    growth = slip = slip_growth = 0.0
    for j in range(3):
        growth += own[j] * force[j]
    for r in range(1, 3):
        slip += rate[r] * direction[r - 1]
        for j in range(3):
            slip_growth += own[3 * r + j] * force[j] * direction[r - 1]
    found = _aim_at_end_of_phase(ws, active, growth, Aim(h=h, guard=NO_GUARD))
    # friction may stop the slip before the phase ends
    if not active.sticks and active.friction_coefficient > 0.0 and slip > 0.0 and slip_growth < 0.0:
        root = -slip / slip_growth
        if root < found.h:
            return Aim(h=root, guard=guard_of(ws, active, GuardKind.FRICTION).index)
    return found


@kernel("Aim(ws, ActiveContact, f8, Aim)")
def _aim_at_end_of_phase(ws: Workspace, active: ActiveContact, growth: float, aim: Aim) -> Aim:
    """Shorten the step ``aim`` to the end of the phase of the lone contact, whose gap rate g' has the slope ``growth``.

    A compression ends at g' + growth s = 0, where s is the pseudo-time. An expansion ends when the energy E that it has
    still to return is used up: E + E' s + E'' s^2 / 2 = 0 with E' = -g' / efficiency. A later end leaves the step as it
    is.
    """
    rate = active.gap_rate
    # the step is aimed only if the gap rate grows, as it does under the contact's own force unless friction prevents it
    if active.phase == Phase.COMPRESSION and growth > 0.0:
        root = -rate / growth
        if 0.0 < root < aim.h:
            return Aim(h=root, guard=guard_of(ws, active, GuardKind.RATE).index)
    if active.phase == Phase.EXPANSION and growth > 0.0:
        state = state_of(ws, active)
        energy, first = state.energy - state.lost, state_at(ws, ws.impact.slopes.start, active).energy
        # the root is 2 E / (sqrt(E'^2 - 2 E'' E) - E'), in which nothing cancels
        square = first * first + 2.0 * growth / expansion_efficiency(ws, active, rate) * energy
        speed = math.sqrt(max(0.0, square)) - first
        if speed > 0.0 and 0.0 < 2.0 * energy / speed < aim.h:
            return Aim(h=2.0 * energy / speed, guard=guard_of(ws, active, GuardKind.ENERGY).index)
    return aim


@kernel("b1(ws, Aim)")
def has_arrived(ws: Workspace, aim: Aim) -> bool:
    """True if the guard that a step of the lone contact aimed at is zero within round-off, False if it aimed at none.

    Then the step ends at its event and need not be shortened. The energy guard is the energy that expansion has still
    to return, relative to ``energy_scale``. If that energy is small from the start, lost * part / (1 - part) with the
    returned part, the threshold is relative to it.
    """
    if aim.guard == NO_GUARD:
        return False
    active = ws.actives[ws.impact.lone_contact]
    near, lost = _AT_EVENT, state_of(ws, active).lost
    if aim.guard == guard_of(ws, active, GuardKind.ENERGY).index and lost != 0.0:
        # lost is 1 - part of the energy at the start of the expansion, so part is below 1 here
        part = returned_part(ws, active)
        returned = lost * part / ((1.0 - part) * active.energy_scale)
        near = _AT_EVENT * min(1.0, returned)
    return abs(ws.impact_guards[aim.guard].value) <= near
