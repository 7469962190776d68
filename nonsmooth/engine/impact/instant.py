"""Impulses that need no integration: those of a law that maps velocities, and those that stop a jammed slip."""

from __future__ import annotations

from nonsmooth.engine.contact.forces import reduced_coefficient, resolve
from nonsmooth.engine.contact.problem import slip_coefficient
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block, write_dense
from nonsmooth.engine.memory.blocks import GUARD, UNTOUCHED
from nonsmooth.engine.memory.modes import SLIDE, STICK
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    call_map,
    kernel,
)
from nonsmooth.engine.numerics.vectors import length

_NEXT_TO_ZERO = 1e-3
"""A reduced normal coefficient below this part of the plain one, where steps can shrink no more, is singular."""


@kernel("b1(ws)")
def jam_slips(ws: Workspace) -> bool:
    """Stop the slips that are at the Painleve singularity; return 1 if there are any and pushing impulses do that.

    In the limit of the singularity friction is at its bound all the way and the gap stays closed, so the
    impulse is the one that brings slip and gap rate to rest together.  The other contacts keep their modes.
    """
    jammed = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.contact]
        speed = length(contact.slip)
        active.friction_coefficient = 0.0
        active.is_normal_force_unknown, active.sticks = True, contact.mode == STICK
        if contact.mode == SLIDE and not contact.is_compliant and speed > 0.0:
            active.friction_coefficient = slip_coefficient(ws, active.contact, speed)
            active.direction = contact.slip[0] / speed, contact.slip[1] / speed
            if reduced_coefficient(ws, a) < _NEXT_TO_ZERO * diagonal_block(ws, a).nn:
                active.sticks = jammed = 1
        for r in range(3):
            active.free[r] = contact.rate[r]
    if jammed == 0:
        return False
    resolve(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if not active.force[0] >= 0.0:
            return False
        for r in range(3):
            active.impulse[r] = active.force[r]
    _split_loss(ws)
    return True


@kernel()
def map_impact(ws: Workspace) -> None:
    """Let a law that maps velocities to impulses treat the colliding set."""
    m = ws.problem.n_active
    for a in range(m):
        active = ws.actives[a]
        c = active.contact
        contact = ws.contacts[c]
        ws.impact.map_block[a] = slip_coefficient(ws, c, length(contact.slip))
        for i in range(1, ws.model.map_width):
            ws.impact.map_block[i * m + a] = ws.floats[contact.map_parameters + i - 1]
    write_dense(ws)
    behind = ws.impact.impulse.start + 3 * m
    for i in range(GUARD):
        ws.floats[behind + i] = UNTOUCHED
    call_map(
        ws.options.impact_map,
        m,
        at(ws.floats, ws.problem.matrix.start),
        at(ws.floats, ws.impact.rates_before.start),
        at(ws.floats, ws.impact.map_block.start),
        at(ws.floats, ws.impact.impulse.start),
    )
    for i in range(GUARD):
        if ws.floats[behind + i] != UNTOUCHED:
            ws.run.n_past_map = m
    _split_loss(ws)


@kernel()
def _split_loss(ws: Workspace) -> None:
    """Split the energy that the impulses take, contact by contact, by the mean rates they act on."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        normal = tangential = 0.0
        for r in range(3):
            line = 3 * a + r
            mean = 0.5 * add_product(ws, 2.0 * ws.impact.rates_before[line], a, r, ws.impact.impulse.start)
            if r == 0:
                normal -= ws.impact.impulse[line] * mean
            else:
                tangential -= ws.impact.impulse[line] * mean
        active.energy_stored, active.energy_returned, active.energy_dissipated = normal, 0.0, tangential
