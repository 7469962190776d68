"""Impulses that need no integration: those of a law that maps velocities, and those that stop a jammed slip."""

from __future__ import annotations

from nonsmooth.engine.contact.forces import reduced_coefficient, resolve
from nonsmooth.engine.contact.problem import slip_coefficient
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block, write_dense
from nonsmooth.engine.memory.blocks import GUARD, UNTOUCHED
from nonsmooth.engine.memory.modes import SLIDE, STICK
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, at, call_map, contact_at, kernel
from nonsmooth.engine.numerics.vectors import length

_NEXT_TO_ZERO = 1e-3
"""A reduced normal coefficient below this part of the plain one, where steps can shrink no more, is singular."""


@kernel("i8(S, F, I)")
def jam_slips(S: Scalars, w: Floats, k: Integers) -> int:
    """Stop the slips that are at the Painleve singularity; return 1 if there are any and pushing impulses do that.

    In the limit of the singularity friction is at its bound all the way and the gap stays closed, so the
    impulse is the one that brings slip and gap rate to rest together.  The other contacts keep their modes.
    """
    jammed = 0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        speed = length(contact.slip)
        active.mu = 0.0
        active.normal_held, active.tangent_held = 1, 1 if contact.mode == STICK else 0
        if contact.mode == SLIDE and contact.normal_function == 0 and speed > 0.0:
            active.mu = slip_coefficient(S, w, k, active.slot, speed)
            active.direction = contact.slip[0] / speed, contact.slip[1] / speed
            if reduced_coefficient(S, w, k, a) < _NEXT_TO_ZERO * diagonal_block(S, w, k, a).nn:
                active.tangent_held = jammed = 1
        for r in range(3):
            active.free[r] = contact.rate[r]
    if jammed == 0:
        return 0
    resolve(S, w, k)
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        if not active.force[0] >= 0.0:
            return 0
        for r in range(3):
            active.impulse[r] = active.force[r]
    _split_loss(S, w, k)
    return 1


@kernel()
def map_impact(S: Scalars, w: Floats, k: Integers) -> None:
    """Let a law that maps velocities to impulses treat the colliding set."""
    m = S.n_active
    for a in range(m):
        active = active_at(S, w, k, a)
        c = active.slot
        contact = contact_at(S, w, k, c)
        w[S.map_block + a] = slip_coefficient(S, w, k, c, length(contact.slip))
        for i in range(1, S.map_width):
            w[S.map_block + i * m + a] = w[contact.map_parameters + i - 1]
    write_dense(S, w, k)
    behind = S.impulse + 3 * m
    for i in range(GUARD):
        w[behind + i] = UNTOUCHED
    call_map(S.impact_map, m, at(w, S.matrix), at(w, S.impact_z0), at(w, S.map_block), at(w, S.impulse))
    for i in range(GUARD):
        if w[behind + i] != UNTOUCHED:
            S.map_past = m
    _split_loss(S, w, k)


@kernel()
def _split_loss(S: Scalars, w: Floats, k: Integers) -> None:
    """Split the energy that the impulses take, contact by contact, by the mean rates they act on."""
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        normal = tangential = 0.0
        for r in range(3):
            line = 3 * a + r
            mean = 0.5 * add_product(S, w, k, 2.0 * w[S.impact_z0 + line], a, r, S.impulse)
            if r == 0:
                normal -= w[S.impulse + line] * mean
            else:
                tangential -= w[S.impulse + line] * mean
        active.stored, active.returned, active.rubbed = normal, 0.0, tangential
