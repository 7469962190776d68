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
    for a in range(ws.n_active):
        active = ws.actives[a]
        contact = ws.contacts[active.slot]
        speed = length(contact.slip)
        active.mu = 0.0
        active.normal_held, active.tangent_held = 1, 1 if contact.mode == STICK else 0
        if contact.mode == SLIDE and not contact.is_compliant and speed > 0.0:
            active.mu = slip_coefficient(ws, active.slot, speed)
            active.direction = contact.slip[0] / speed, contact.slip[1] / speed
            if reduced_coefficient(ws, a) < _NEXT_TO_ZERO * diagonal_block(ws, a).nn:
                active.tangent_held = jammed = 1
        for r in range(3):
            active.free[r] = contact.rate[r]
    if jammed == 0:
        return False
    resolve(ws)
    for a in range(ws.n_active):
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
    m = ws.n_active
    for a in range(m):
        active = ws.actives[a]
        c = active.slot
        contact = ws.contacts[c]
        ws.map_block[a] = slip_coefficient(ws, c, length(contact.slip))
        for i in range(1, ws.map_width):
            ws.map_block[i * m + a] = ws.floats[contact.map_parameters + i - 1]
    write_dense(ws)
    behind = ws.offsets.impulse + 3 * m
    for i in range(GUARD):
        ws.floats[behind + i] = UNTOUCHED
    call_map(
        ws.impact_map,
        m,
        at(ws.floats, ws.offsets.matrix),
        at(ws.floats, ws.offsets.impact_z0),
        at(ws.floats, ws.offsets.map_block),
        at(ws.floats, ws.offsets.impulse),
    )
    for i in range(GUARD):
        if ws.floats[behind + i] != UNTOUCHED:
            ws.map_past = m
    _split_loss(ws)


@kernel()
def _split_loss(ws: Workspace) -> None:
    """Split the energy that the impulses take, contact by contact, by the mean rates they act on."""
    for a in range(ws.n_active):
        active = ws.actives[a]
        normal = tangential = 0.0
        for r in range(3):
            line = 3 * a + r
            mean = 0.5 * add_product(ws, 2.0 * ws.impact_z0[line], a, r, ws.offsets.impulse)
            if r == 0:
                normal -= ws.impulse[line] * mean
            else:
                tangential -= ws.impulse[line] * mean
        active.stored, active.returned, active.rubbed = normal, 0.0, tangential
