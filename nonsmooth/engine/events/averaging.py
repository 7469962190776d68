"""Islands whose forces are averaged over a contact time: when that begins, and when it ends."""

from __future__ import annotations

import math

from nonsmooth.engine.bodies.touching import touch
from nonsmooth.engine.contact.mean_forces import (
    averaging_time,
    is_averaged,
    is_settled,
)
from nonsmooth.engine.delassus.islands import activate_group, group_closed
from nonsmooth.engine.flow.averaging_time import find_mean_forces
from nonsmooth.engine.flow.mean_work import account_for_mean_forces
from nonsmooth.engine.flow.projection import project_closed
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.vectors import length

_LARGEST_BURST = 20000.0
"""Evaluations of forces beyond one in a contact time: so many are the stop of a slip, not yet a crowd of them."""


@kernel("b1(ws)")
def average_active(ws: Workspace) -> bool:
    """Let the forces of the active contacts be averaged from now on; return 0 where they cannot be, or are.

    A contact by itself has a solution of its own.  Where forces of the instant led nowhere when they were asked for
    last, or not for as long as they had not been asked for, they are asked for again after twice that.
    """
    time = averaging_time(ws)
    if ws.problem.n_active == 1 or time == 0.0 or is_averaged(ws):
        return False
    for a in range(ws.problem.n_active):
        contact = ws.contacts[ws.actives[a].contact]
        again = ws.island.time - contact.mean_forces_asked <= max(time, contact.mean_forces_wait)
        contact.mean_forces_wait = max(time, 2.0 * contact.mean_forces_wait) if again else 0.0
        contact.mode_after_averaging = Mode.SLIDE
        contact.mean_span = 0.0
        for r in range(3):
            contact.mean_force[r] = 0.0
    return True


@kernel("b1(ws, i8)")
def average_island_of(ws: Workspace, c: int) -> bool:
    """Let the forces of the island of closed contact ``c`` be averaged from now on; return 0 where they cannot be."""
    if ws.contacts[c].mode == Mode.OPEN:
        return False
    group_closed(ws)
    activate_group(ws, ws.contacts[c].group)
    return average_active(ws)


@kernel("b1(ws, b1)")
def stays_averaged(ws: Workspace, ends: bool) -> bool:
    """Return 1 if the forces of the active contacts are averaged, and stay so where the last ones end (1)."""
    if not is_averaged(ws):
        return False
    if not ends:
        return True
    # a contact by itself has forces of its own
    if ws.problem.n_active == 1:
        return False
    if not is_settled(ws):
        return True
    for a in range(ws.problem.n_active):
        contact = ws.contacts[ws.actives[a].contact]
        if ws.island.time < contact.mean_forces_asked + contact.mean_forces_wait:
            return True
    return False


@kernel()
def end_averaging(ws: Workspace) -> None:
    """Put the contacts whose forces are averaged on their constraints before the averaging is over.

    What it pushed too much is taken back by that, and what its forces did on the way is booked.
    """
    touch(ws)
    account_for_mean_forces(ws)
    ws.totals.closing_loss += project_closed(ws, at_event=True, averaged=True)
    ws.island.averaged_until = math.inf


@kernel("void(ws, b1)")
def agree_on_averaged_modes(ws: Workspace, follows: bool) -> None:
    """Agree on the modes of the active contacts, whose forces are averaged: slips are those at hand."""
    find_mean_forces(ws, follows)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        speed = length(contact.slip)
        contact.mode_agreed = active.mode_tried
        contact.direction_agreed = active.direction
        if speed > ws.tolerance.velocity and active.mode_tried != Mode.OPEN:
            contact.mode_agreed = Mode.SLIDE
            contact.direction_agreed = contact.slip[0] / speed, contact.slip[1] / speed


@kernel("i8(ws)")
def contact_of_burst(ws: Workspace) -> int:
    """Return the contact whose slow slip, or else whose events, let time hardly pass, or -1.

    Evaluations of forces fill a store that empties with time.
    """
    time = math.inf
    for i in range(ws.island.n_grouped):
        time = min(time, ws.contacts[ws.island.grouped[i]].contact_time)
    if time == 0.0:
        return -1
    ws.island.burst = max(0.0, ws.island.burst - (ws.island.time - ws.island.burst_time) / time) + float(
        ws.totals.n_evaluations - ws.island.burst_evaluations
    )
    ws.island.burst_time, ws.island.burst_evaluations = ws.island.time, ws.totals.n_evaluations
    if ws.island.burst <= _LARGEST_BURST:
        return -1
    which, fastest = -1, 1.0
    busiest, events = -1, 1
    for i in range(ws.island.n_grouped):
        c = ws.island.grouped[i]
        contact = ws.contacts[c]
        speed, friction = length(contact.slip_at_end), length((contact.force[1], contact.force[2]))
        turns = contact.contact_time * contact.slip_per_force * friction / max(speed, ws.tolerance.velocity)
        if contact.mode == Mode.SLIDE and not contact.is_averaged and turns > fastest:
            which, fastest = c, turns
        recent = ws.island.time - contact.burst_start <= contact.contact_time
        if not contact.is_averaged and recent and contact.burst_events > events:
            busiest, events = c, contact.burst_events
    return which if which >= 0 else busiest
