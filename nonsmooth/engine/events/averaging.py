"""Averaged forces of an island: when this time-stepping fallback begins, and when it ends.

The forces of an island are averaged over a contact time (:mod:`nonsmooth.engine.contact.mean_forces`) if events or
evaluations accumulate there: bounces shorter than the contact time, a contact problem without a solution, or a slip
whose direction turns too fast. Events are counted for each contact, because many events elsewhere in a large system are
no accumulation. Averaging ends when the instantaneous forces have a solution again. If they soon fail
again, the waiting time before the next attempt doubles, so that failing attempts cost little.
"""

from __future__ import annotations

import math

from nonsmooth.engine.contact.mean_forces import averaging_time, has_no_stopping_slip, is_averaged
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.averaging_time import find_mean_forces
from nonsmooth.engine.flow.projection import project_closed
from nonsmooth.engine.memory.modes import NO_CONTACT, Mode
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import length

_LARGEST_BURST = 20000.0
"""Evaluations of forces beyond one per contact time that are no accumulation. The stop of one slip takes fewer."""
_MOST_EVENTS = 100
"""Most events of one contact within a burst that are no accumulation. Short bounces end long before."""
_BURST = 1e-2
"""Length of a burst of events, relative to the contact time."""


@kernel("b1(ws)")
def average_active(ws: Workspace) -> bool:
    """Let the forces of the active contacts be averaged over time from now on. False if they cannot be, or already are.

    This is the fallback for an island whose events accumulate. The contact problem of a single contact always has a
    solution. If the instantaneous forces of a contact failed soon after their last attempt, the wait before the next
    attempt is doubled. Otherwise there is no wait.
    """
    # 0 if there is no contact time over which to average
    time = averaging_time(ws)
    if ws.problem.n_active == 1 or time == 0.0 or is_averaged(ws):
        return False
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        # mean_forces_asked: last time at which instantaneous forces were tried; mean_forces_wait: until the next try
        fails_again = ws.island.time - contact.mean_forces_asked <= max(time, contact.mean_forces_wait)
        contact.mean_forces_wait = max(time, 2.0 * contact.mean_forces_wait) if fails_again else 0.0
        # any mode but OPEN marks the contact as averaged; its first span is a contact time
        contact.mode_after_averaging = Mode.SLIDE
        contact.mean_span = 0.0
        for r in range(3):
            contact.mean_force[r] = 0.0
    return True


@kernel("b1(ws, i8)")
def average_island_of(ws: Workspace, c: int) -> bool:
    """Let the forces of the island of contact ``c``, which becomes the active one, be averaged over time from now on.

    False if the contact is open, or the forces cannot be averaged or already are. The closed contacts are grouped anew.
    """
    if ws.contacts[c].mode == Mode.OPEN:
        return False
    group_closed(ws)
    activate_group(ws, ws.contacts[c].group)
    return average_active(ws)


@kernel("b1(ws, b1)")
def stays_averaged(ws: Workspace, ends: bool) -> bool:
    """True if the forces of the active contacts stay averaged over time, False if they are or become instantaneous.

    ``ends`` is true at the end of a span. Averaging then continues if a slip would soon stop, or if the last attempt
    without averaging was less than ``mean_forces_wait`` [s] ago. It ends for a single contact.
    """
    if not is_averaged(ws):
        return False
    if not ends:
        return True
    if ws.problem.n_active == 1:
        return False
    # a slip would stop within a contact time
    if not has_no_stopping_slip(ws):
        return True
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        if ws.island.time < contact.mean_forces_asked + contact.mean_forces_wait:
            return True
    return False


@kernel()
def end_averaging(ws: Workspace) -> None:
    """End the span of averaged forces before its time, as gaps deviate from its plan: project its closed contacts.

    The projection removes what the forces pushed too much. The event that follows finds what comes after the span.
    """
    ws.totals.closing_loss += project_closed(ws, at_event=True, averaged=True)
    # no span has an end
    ws.island.averaged_until = math.inf


@kernel("void(ws, b1)")
def agree_on_averaged_modes(ws: Workspace, follows: bool) -> None:
    """Find the forces of the active contacts, averaged over a span, and their modes: a contact that slips now slides.

    A span that ``follows`` another one may be longer.
    """
    find_mean_forces(ws, follows)
    for active in ws.actives:
        contact = ws.contacts[active.contact]
        speed = length(contact.slip)
        # the modes under trial are those at the end of the span
        contact.mode_agreed = active.mode_tried
        contact.direction_agreed = active.direction
        if speed > ws.tolerance.velocity and active.mode_tried != Mode.OPEN:
            contact.mode_agreed = Mode.SLIDE
            contact.direction_agreed = contact.slip[0] / speed, contact.slip[1] / speed


@kernel("i8(ws)")
def contact_of_burst(ws: Workspace) -> int:
    """Contact at which evaluations of forces accumulate so that time hardly passes, or ``NO_CONTACT``.

    The contact is the one whose slip direction relaxes fastest, if more than once per contact time, or else the one
    with the most events in its present burst, a short time with several events. The forces of its island are then
    averaged by the caller. Contacts whose forces are averaged already do not count. Updates the measure of evaluations.
    """
    if _update_burst(ws) <= _LARGEST_BURST:
        return NO_CONTACT
    which, fastest = NO_CONTACT, 1.0
    busiest, n_events = NO_CONTACT, 1
    for i in range(ws.island.n_grouped):
        contact = ws.contacts[ws.island.grouped[i]]
        speed, friction = length(contact.slip_at_end), length((contact.force[1], contact.force[2]))
        # relaxations of the slip direction per contact time
        turns = contact.contact_time * contact.slip_per_force * friction / max(speed, ws.tolerance.velocity)
        if contact.mode == Mode.SLIDE and not contact.is_averaged and turns > fastest:
            which, fastest = contact.index, turns
        is_recent = ws.island.time - contact.burst_start <= contact.contact_time
        if not contact.is_averaged and is_recent and contact.burst_events > n_events:
            busiest, n_events = contact.index, contact.burst_events
    return which if which != NO_CONTACT else busiest


@kernel("f8(ws)")
def _update_burst(ws: Workspace) -> float:
    """Measure of accumulating evaluations of forces: it grows by 1 with each, and falls by 1 per contact time.

    Updates it to the present time. The contact time is the shortest one of the closed contacts, of which there must be
    one. If it is zero, the measure is 0, as forces cannot be averaged.
    """
    time = math.inf
    for i in range(ws.island.n_grouped):
        time = min(time, ws.contacts[ws.island.grouped[i]].contact_time)
    if time == 0.0:
        return 0.0
    decayed = max(0.0, ws.island.burst - (ws.island.time - ws.island.burst_time) / time)
    ws.island.burst = decayed + float(ws.totals.n_evaluations - ws.island.burst_evaluations)
    ws.island.burst_time, ws.island.burst_evaluations = ws.island.time, ws.totals.n_evaluations
    return float(ws.island.burst)


@kernel("void(ws, i8)")
def count_event(ws: Workspace, c: int) -> None:
    """Count an event of contact ``c`` in its present burst of events, or in a new one if that is over.

    A burst lasts for a small part of the contact time. Too many events within it show that time hardly passes.
    """
    contact = ws.contacts[c]
    if abs(ws.island.time - contact.burst_start) > max(ws.tolerance.time, _BURST * contact.contact_time):
        contact.burst_start, contact.burst_events = ws.island.time, 0
    contact.burst_events += 1


@kernel("b1(ws, i8)")
def is_stalled(ws: Workspace, c: int) -> bool:
    """True if contact ``c`` has so many events in a small part of its contact time that time hardly passes."""
    return ws.contacts[c].burst_events > _MOST_EVENTS
