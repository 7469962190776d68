"""The scales of an impact: what counts as large and as small among its speeds, impulses, deformations and energies."""

from __future__ import annotations

import math

from nonsmooth.engine.delassus.delassus import diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.native.kernel import (
    Workspace,
    at,
    call_scalar,
    impact_state,
    kernel,
)

REST = 1e-9
"""Slip velocities below this, relative to the impact speed, count as none; so do those within the tolerance."""
CIRCLING = 30.0
"""A slip that circles round zero does so within the error of so many steps, and a wave leaves no more behind."""
_GROWN = 2.0
"""Impulses that grow by less than this factor have the same scale: what counts as none need not follow each step."""
_MET = 1e-6
"""So close, relative to the energy, need the deformation be known that takes it up: it is a scale."""


@kernel("f8(ws, f8)")
def scale_impact(ws: Workspace, seed: float) -> float:
    """Set the scales of speed, energy, impulse, deformation, force and rest; return the shortest time of a compression.

    A contact takes up no more energy than the fastest approach would bring to it, and no more than the approaches of
    all bring: next to one with a small coefficient of its own, others would else count as light.  No speed is slower
    than the ``seed``.
    """
    m = ws.problem.n_active
    ws.impact.speed_scale = seed
    brought = 0.0
    for a in range(m):
        active = ws.actives[a]
        speed = max(seed, -active.gap_rate_before)
        ws.impact.speed_scale = max(ws.impact.speed_scale, speed)
        if speed > 0.0:
            brought = max(brought, speed * speed / diagonal_block(ws, a).nn)
    ws.impact.rest_speed = max(REST, CIRCLING * ws.tolerance.impact) * ws.impact.speed_scale
    shortest = math.inf
    for a in range(m):
        active = ws.actives[a]
        energy = min(brought, ws.impact.speed_scale * ws.impact.speed_scale / diagonal_block(ws, a).nn)
        x = 1.0
        active.energy_scale = energy
        # the impulse that takes it up
        active.impulse_scale = math.sqrt(energy / diagonal_block(ws, a).nn)
        if a != ws.impact.lone_contact:
            contact = ws.contacts[active.contact]
            for _iteration in range(4):
                force = call_scalar(contact.impact_force_function, x, at(ws.floats, contact.impact_force_parameters))
                double = call_scalar(
                    contact.impact_force_function, 2.0 * x, at(ws.floats, contact.impact_force_parameters)
                )
                if not (force > 0.0 and double > 0.5001 * force):
                    ws.run.unscaled_contact = active.contact
                    return -1.0
                if abs(energy - force * x) <= _MET * energy:
                    break
                x *= (energy / (force * x)) ** (math.log(2.0) / math.log(2.0 * double / force))
        active.deformation_scale = x
        active.force_scale = energy / x
        shortest = min(shortest, (energy if a == ws.impact.lone_contact else x) / ws.impact.speed_scale)
    _set_rest_slips(ws)
    return shortest


@kernel("f8(ws, i8)")
def reached_energy(ws: Workspace, a: int) -> float:
    """Return the energy to which errors of the active contact ``a`` are relative: its scale, or what it has taken up.

    Where friction blocks the way of a light point, or slip presses bodies together, that is far more than its approach
    alone would bring.
    """
    active, state = ws.actives[a], impact_state(ws.floats, ws.impact.y.start, a)
    return float(max(active.energy_scale, abs(state.work), state.rubbed, state.energy))


@kernel()
def grow_scales(ws: Workspace) -> None:
    """Let the slips that count as none grow with the energies, as the errors do."""
    grown = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        energy, own, scale = reached_energy(ws, a), diagonal_block(ws, a).nn, active.impulse_scale
        if energy > own * (_GROWN * scale) ** 2:
            active.impulse_scale = math.sqrt(energy / own)
            grown = 1
    if grown == 1:
        _set_rest_slips(ws)


@kernel()
def _set_rest_slips(ws: Workspace) -> None:
    for a in range(ws.problem.n_active):
        ws.actives[a].rest_slip = _slip_at_rest(ws, a)


@kernel("f8(ws, i8)")
def _slip_at_rest(ws: Workspace, a: int) -> float:
    """Return the slip of the active contact ``a`` that counts as none: small by its energy, or within the error."""
    active = ws.actives[a]
    own = diagonal_block(ws, a)
    moved = 0.0
    for block in range(active.first_block, active.end_block):
        impulse = ws.actives[ws.island.block_column[block]].impulse_scale
        for i in range(3, 9):
            moved = max(moved, abs(ws.island.delassus[DELASSUS * block + i]) * impulse)
    mobility = max(own.t11, own.t22)
    small = float(ws.impact.rest_speed)
    if mobility < own.nn:
        small *= math.sqrt(mobility / own.nn)
    return float(max(small, CIRCLING * ws.tolerance.impact * moved))
